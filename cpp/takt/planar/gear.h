// A mover on tracks that goes along with a master: an axis, whose place comes from outside in each cycle, or another
// mover. Places of both are counted over all tracks that they have left behind.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::planar {

// What else became of it.
enum class GearEnd : std::uint8_t {
  kNot,  // it goes along
  kWay,  // its way ends where the master leads it; it comes to rest there
};

struct Gear {
  std::uint32_t master = 0xffffffff;  // a mover; none: the demand comes from outside
  double offset = 0;                  // mm: own place minus the master's, both over all tracks
  double tolerance = 0;               // mm, within which it counts as in step
  std::int8_t sense = 0;              // until it has been in step: it goes this way only; 0: either
  bool takes_masters_way = false;     // its route is the master's
  double apart = 0;                   // mm: the same place as this mover counts it minus as the master counts it

  bool was_in_step = false;
  bool in_step = false;
  double error = 0;  // mm: own place minus where it should be
  GearEnd end = GearEnd::kNot;
};

void describe(Enumeration<GearEnd>&);
void describe(Description<Gear>&);

}  // namespace takt::planar
