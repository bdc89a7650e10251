// The motion of a mover that follows a master (gear.h), without other movers; the rest is in traffic.h.
#pragma once

#include "takt/planar/braking.h"
#include "takt/planar/network.h"
#include "takt/planar/traffic.h"
#include "takt/planar/way.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {

// Returns its state at the end of the cycle as if it were alone on a straight route; the demand itself if its limits
// allow it, then `exact` becomes true. Positions on the first track of its route.
KinematicState FollowDemandAlone(trajectory::Planner& planner, const Rider& rider, const KinematicState& demand,
                                 double period_s, bool& exact) noexcept;

// Returns 1 if the mover could not come to rest before the end of its route from here with its commanded dynamics, -1
// if not before its start, else 0.
int LeavesRoute(const Network& network, const Rider& rider, const KinematicState& at) noexcept;

// Returns true if the mover keeps its maximum speed, and its maximum lateral acceleration in curves, while it brakes
// from this step on with `jerk`.
bool KeepsToLimits(const Network& network, const Rider& rider, const KinematicState& next, const Braking& braking,
                   double jerk) noexcept;
// Returns true if acceleration and jerk, as vectors, keep their maxima in this step and while the mover brakes from
// there.
bool KeepsToVectors(const Network& network, const Rider& rider, const KinematicState& next, const Braking& braking,
                    double period_s) noexcept;
// Returns true if curves ahead bound its speed below the commanded one.
bool CurvesAhead(const Network& network, const Rider& rider) noexcept;
// Returns true if from this step on only other movers can slow it down: it is no faster than commanded, and neither a
// curve nor the end of its route is near enough to matter.
bool IsUnconstrained(const Network& network, const Rider& rider, const KinematicState& step) noexcept;

// Returns true if `route` may replace its route: the tracks that it cannot avoid any more stay the same.
bool MayTake(const Network& network, const Rider& rider, const Route& route) noexcept;

// Takes over the master's route from where both routes meet. Returns false if the mover is past the branch where the
// master turns off, or if the master is beyond its route.
bool TakeMastersRoute(const Network& network, const Rider& master, Rider& rider) noexcept;

}  // namespace takt::planar
