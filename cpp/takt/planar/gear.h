// A mover on tracks that follows a master: an axis, whose position comes from outside in each cycle, or another mover.
// Positions of both are counted over all tracks that they have left.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::planar {

// How a geared motion ended.
enum class GearEnd : std::uint8_t {
  kNot,  // it has not ended
  kWay,  // its route ends short of the master's position; it moves to that end and comes to rest
};

struct Gear {
  std::uint32_t master = 0xffffffff;  // index of a mover; none: the demand comes from outside
  double offset = 0;                  // [mm] own position minus the master's, both over all tracks
  double tolerance = 0;               // [mm] largest error that counts as in step
  std::int8_t sense = 0;              // the only direction until it has been in step; 0: either
  bool takes_masters_way = false;     // it takes over the master's route
  double apart = 0;                   // [mm] position of a point as this mover counts it minus as the master counts it

  bool was_in_step = false;
  bool in_step = false;
  double error = 0;  // [mm] own position minus the demanded one
  GearEnd end = GearEnd::kNot;
};

void describe(Enumeration<GearEnd>&);
void describe(Description<Gear>&);

}  // namespace takt::planar
