// From stretches of path to nodes of the window: places along them, as close as the bends and the axes need.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

inline constexpr double kLeastTry = 1e-3;  // mm, between two places where a path is uneven

// Whether the axes go from one place to the next about as their slopes at both say. Where they do not, something is
// between the two: where a wrist is stretched, axes turn half a turn.
bool GoesEvenly(const kinematics::Joints& before, const trajectory::PathSlopes& slopes_before,
                const kinematics::Joints& after, const trajectory::PathSlopes& slopes_after, double length) noexcept;

// Returns the number behind the last stretch that is to be sampled now. A blend that the next move may make again, and
// what is behind it, wait for that as long as there is time.
std::uint64_t SampledTo(const Context& c, const State& s) noexcept;

// Samples stretches up to there, within the budget of inverses. A path that cannot be continued ends at the last node
// (LookAhead::cut_short).
void Sample(const Context& c, int& budget, State& s) noexcept;

}  // namespace takt::group
