// Samples stretches of path into nodes of the window, as densely as bends and axes require.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

inline constexpr double kLeastTry = 1e-3;  // [mm] least distance between two points of an uneven path

// Returns true if the axes move from one point to the next about as the slopes at both predict. If not, something lies
// between: near a stretched wrist, axes turn by half a turn.
bool GoesEvenly(const kinematics::Joints& before, const trajectory::PathSlopes& slopes_before,
                const kinematics::Joints& after, const trajectory::PathSlopes& slopes_after, double length) noexcept;

// Returns the number after the last stretch to be sampled now. A blend that the next move may make again, and what
// follows it, wait for that as long as there is time.
std::uint64_t SampledTo(const Context& c, const State& s) noexcept;

// Samples stretches up to that one, within the budget of inverse kinematics. A path that cannot be continued ends at
// the last node (LookAhead::cut_short).
void Sample(const Context& c, int& budget, State& s) noexcept;

}  // namespace takt::group
