// How a mover follows another: with what acceleration. That keeps a little more than the invariant asks for, which
// right_of_way.h sees to.
#pragma once

#include <cstdint>
#include <limits>

#include "takt/core/kinematic_state.h"
#include "takt/planar/braking.h"
#include "takt/planar/rider.h"
#include "takt/planar/right_of_way.h"

namespace takt::planar {

// Where it has to be able to stop: so far from here, and how fast that place goes away.
struct Limit {
  double room = std::numeric_limits<double>::infinity();
  double rate = 0;
  Brakes brakes;
  std::uint32_t by = kNobody;
};

// What holds this mover back, in its direction: the one before it, and those at nodes. The least acceleration that is
// asked for, and by which limit.
void LimitBy(const RightOfWay& w, std::uint32_t i, double speed, Limit& limit, double& least) noexcept;
// It goes just as the one before it, or falls behind: the gap needs no more than the invariant.
bool GoesAlong(const RightOfWay& w, std::uint32_t i, const KinematicState& wish, const Limit& limit) noexcept;
// The acceleration with which a mover comes up behind something that goes on by itself: so much room is left to where
// it is to be, which goes at this speed and acceleration. Both could still stop, and it would not have passed.
double ComeUp(const Rider& r, double room, const KinematicState& there, const Brakes& brakes, double period_s) noexcept;
// Behind the mover ahead: down to the gap, without a reserve for swinging, so that in the end both go as one.
double CloseUp(const RightOfWay& w, std::uint32_t i, const Limit& limit) noexcept;

}  // namespace takt::planar
