// The acceleration with which a mover follows another one. It keeps a little more distance than the invariant
// (right_of_way.h) requires.
#pragma once

#include <cstdint>
#include <limits>

#include "takt/core/kinematic_state.h"
#include "takt/planar/braking.h"
#include "takt/planar/rider.h"
#include "takt/planar/right_of_way.h"

namespace takt::planar {

// A point before which the mover must be able to stop: distance to it [mm], and the speed at which it recedes [mm/s].
struct Limit {
  double room = std::numeric_limits<double>::infinity();
  double rate = 0;
  Brakes brakes;
  std::uint32_t by = kNobody;
};

// Finds the limits that apply to a mover in its direction: of the mover ahead, and of movers at nodes. Updates `limit`
// and `least` [mm/s²] to the limit that demands the least acceleration, and that acceleration.
void LimitBy(const RightOfWay& w, std::uint32_t i, double speed, Limit& limit, double& least) noexcept;
// Returns true if `wish` is no faster than the step of the mover ahead, which brakes no harder than this one: then the
// gap needs no more than the invariant.
bool IsNoFasterThanLeader(const RightOfWay& w, std::uint32_t i, const KinematicState& wish,
                          const Limit& limit) noexcept;
// Returns the acceleration [mm/s²] with which a mover approaches from behind a point that moves independently of it:
// `room` [mm] is the distance to the point, `there` the point's speed and acceleration. The mover would not pass the
// point if both stopped.
double ApproachAcceleration(const Rider& r, double room, const KinematicState& there, const Brakes& brakes,
                            double period_s) noexcept;
// Returns the acceleration [mm/s²] that closes the gap to the mover ahead without a reserve against oscillation, so
// that in the end both move as one; minus infinity if the mover ahead is not the limit, brakes harder, moves back, or
// is nearer than the gap.
double CloseGapAcceleration(const RightOfWay& w, std::uint32_t i, const Limit& limit) noexcept;

}  // namespace takt::planar
