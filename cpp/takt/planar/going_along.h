// What a mover that goes along with a master (gear.h) does by itself; what is left of that in traffic: traffic.h.
#pragma once

#include "takt/planar/braking.h"
#include "takt/planar/network.h"
#include "takt/planar/traffic.h"
#include "takt/planar/way.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {

// Its state at the end of the cycle if it were alone on a straight way: the demand itself where its limits allow.
// `exact`: it is that. Places are those on the first track of its route.
KinematicState GoAlong(trajectory::Planner& planner, const Rider& rider, const KinematicState& demand, double period_s,
                       bool& exact) noexcept;

// Where it could not come to rest on its route any more from here, with the dynamics that it was given: 1, beyond the
// end; -1, before the start; 0: nowhere.
int RunsOut(const Network& network, const Rider& rider, const KinematicState& at) noexcept;

// Whether it keeps its greatest speed, and its lateral acceleration in curves, if from this step on it brakes with so
// much jerk.
bool KeepsToLimits(const Network& network, const Rider& rider, const KinematicState& next, const Braking& braking,
                   double jerk) noexcept;
// Whether the vectors of acceleration and jerk keep their maxima in this step, and in braking from there on.
bool KeepsToVectors(const Network& network, const Rider& rider, const KinematicState& next, const Braking& braking,
                    double period_s) noexcept;
// Whether it has to look out for curves.
bool CurvesAhead(const Network& network, const Rider& rider) noexcept;
// Whether from this step on it has to look out for nothing but others: no curve is so near that it would slow down for
// it, nor the end of its way, and it gets no faster than it was told to.
bool RunsFree(const Network& network, const Rider& rider, const KinematicState& step) noexcept;

// Whether its route may become this one: tracks that it gets onto whatever happens stay.
bool MayTake(const Network& network, const Rider& rider, const Route& route) noexcept;

// Takes over where the master's route leads on, from where both routes are the same. False: it is past the place where
// the master turns off, or the master is out of its sight.
bool TakeMastersWay(const Network& network, const Rider& master, Rider& rider) noexcept;

}  // namespace takt::planar
