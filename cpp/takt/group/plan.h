// Plans the moves in the queue: stretches of path, then nodes of the window; some work in each cycle.
#pragma once

#include "takt/group/group.h"
#include "takt/group/systems.h"

namespace takt::group {

// Returns the limits of a group's coordinates: its axes, then the tool along and about X, Y, Z.
trajectory::CoordinateLimits LimitsOf(const Context& c, const State& s) noexcept;

// Continues planning within the budget of a cycle. Refuses moves that cannot be executed.
void Plan(const Context& c, State& s) noexcept;

// Rehearses the motion ahead and lowers the window where axes would exceed their limits; with PathTiming orders a plan.
void Rehearse(const Context& c, const State& s) noexcept;

// Returns the element of the path being planned, from 1; 0 if it is no path.
std::uint32_t ElementOf(const State& s) noexcept;

// Forgets everything that was planned.
void ForgetPlan(const Context& c, State& s) noexcept;

// Computes the axes on a stretch at `way` of its segment, with their derivatives by arc length.
kinematics::Reason AxesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                          const kinematics::Joints& near, kinematics::JointMotion& motion) noexcept;

// Returns true if all moves in the queue are planned, as far as they can be executed.
bool IsPlanned(const Context& c, const State& s) noexcept;

// Returns the time until the motion rests at the end of all commanded moves [s], exact to the cycle; NaN if it does not
// move, is slowed down, or the time is not yet known.
double TimeLeft(const Context& c, const State& s) noexcept;

// Returns true if a motion can begin: the window is swept and has a node ahead.
bool MayBegin(const Context& c) noexcept;

}  // namespace takt::group
