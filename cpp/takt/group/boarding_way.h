// How to board (boarding.h): the way that is chosen.
//
// Ways with several shares of the limits for the clutch, and with several leads, are compared by the estimated time of
// the move. The best one is then looked at as it is: its profile is sampled through the kinematics, on tables together
// with the motion along the path. If it takes more than there is, the next one is.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

struct BoardingWay {
  KinematicState carrier;     // its travel, a cycle ago
  trajectory::Limits limits;  // of the clutch
  double lead = 0;            // of the clutch's travel before the carrier's, at the beginning
  Boarding boarding;
};

// Finds a way onto a ride for LookAhead::next, from rest. False: none keeps the limits, or the transition between rides
// is expected to take no longer.
bool FindWay(const Context& c, const State& s, const Ride& to, BoardingWay& way) noexcept;

}  // namespace takt::group
