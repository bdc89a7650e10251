// From the moves in the queue to stretches of path and the nodes of the window: some work in each cycle.
#pragma once

#include "takt/group/group.h"
#include "takt/group/systems.h"

namespace takt::group {

// What a group's coordinates may do: its axes, then the tool along and about X, Y, Z.
trajectory::CoordinateLimits LimitsOf(const Context& c, const State& s) noexcept;

// Goes on with planning. Moves that cannot be gone are refused.
void Plan(const Context& c, State& s) noexcept;

// Goes some way along the path ahead of the motion, and takes back what would be too much for the axes.
void Rehearse(const Context& c, const State& s) noexcept;

// The element of a path that is planned, from 1; 0: no path.
std::uint32_t ElementOf(const State& s) noexcept;

// Forgets everything that was planned.
void ForgetPlan(const Context& c, State& s) noexcept;

// The axes on a stretch, `way` from the beginning of its segment, with their derivatives by the way.
kinematics::Reason AxesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                          const kinematics::Joints& near, kinematics::JointMotion& motion) noexcept;

// All moves in the queue are, as far as they can be gone.
bool IsPlanned(const Context& c, const State& s) noexcept;

// s until the motion stands at the end of what was commanded, to the cycle; NaN: it does not move, something slows it
// down, or it is not known yet.
double TimeLeft(const Context& c, const State& s) noexcept;

// Something can be gone: what the motion can begin with is through.
bool MayBegin(const Context& c) noexcept;

}  // namespace takt::group
