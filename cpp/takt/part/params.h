// Parameters of coordinate systems and of the parts in them in the machine file.
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
  std::string coordinate_system;  // name
  double x = 0, y = 0;            // [mm] of the part's origin
};

struct PartParams {
  std::string name;
  std::uint32_t columns = 1;  // of stators, unless `stators` are given
  std::uint32_t rows = 1;
  std::vector<planar::Place> stators{};  // [mm] lower left corners in the coordinates of the part
  std::vector<PositionParams> positions;
  std::uint32_t initial_position = 1;  // index, from 1
  double travel_time_s = 0;            // [s] between two positions, of a simulated part
};

// Returns the lower left corners of its stators [mm].
std::vector<planar::Place> StatorsOf(const PartParams& params);

// Makes all parts. Requires: the parameters have been checked.
planar::Parts Make(const std::vector<CoordinateSystemParams>& systems, const std::vector<PartParams>& parts);

void describe(Description<CoordinateSystemParams>&);
void describe(Description<PositionParams>&);
void describe(Description<PartParams>&);

}  // namespace takt::part
