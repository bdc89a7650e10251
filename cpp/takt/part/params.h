// What a machine file says about coordinate systems and the parts in them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/parts.h"
#include "takt/planar/point.h"

namespace takt::part {

struct CoordinateSystemParams {
  std::string name;
};

struct PositionParams {
  std::string coordinate_system;  // its name
  double x = 0, y = 0;            // mm, of the part's origin
};

struct PartParams {
  std::string name;
  std::uint32_t columns = 1;  // of stators, if they are not given one by one
  std::uint32_t rows = 1;
  std::vector<planar::Place> stators{};  // mm, their lower left corners in the part's own coordinates
  std::vector<PositionParams> positions;
  std::uint32_t initial_position = 1;  // from 1
  double travel_time_s = 0;            // s, that a simulated one takes from position to position
};

// The lower left corners of its stators.
std::vector<planar::Place> StatorsOf(const PartParams& params);

// All of them; they must have been checked.
planar::Parts Make(const std::vector<CoordinateSystemParams>& systems, const std::vector<PartParams>& parts);

void describe(Description<CoordinateSystemParams>&);
void describe(Description<PositionParams>&);
void describe(Description<PartParams>&);

}  // namespace takt::part
