// Chooses how the tool boards (boarding.h).
//
// Candidates with several shares of the limits for the clutch and several leads are compared by the estimated time of
// the move. The fastest one is measured: its profile is sampled through the inverse kinematics, on turning carriers
// together with the motion along the path. If it exceeds a limit, the next candidate with a smaller share is measured.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

struct BoardingPlan {
  KinematicState carrier;     // travel in the previous cycle
  trajectory::Limits limits;  // of the clutch
  double lead = 0;            // initial travel of the clutch relative to the carrier [mm or rad]
  Boarding boarding;
};

// Plans boarding from rest for LookAhead::next onto the carrier of `to`. Returns false if no candidate is within the
// limits, or if the transition between carrier bindings is estimated to be faster.
bool PlanBoarding(const Context& c, const State& s, const CarrierBinding& to, BoardingPlan& plan) noexcept;

}  // namespace takt::group
