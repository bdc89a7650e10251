// Ruckig behind one function. Its tolerances are absolute and meant for numbers near 1: the caller chooses the scale.
#pragma once

#include <array>
#include <span>

#include "takt/trajectory/ramp.h"

namespace takt::trajectory {

// From {0, velocity, acceleration} to {distance, end_velocity, 0}.
struct PositionProblem {
  double distance = 0;
  double velocity = 0;
  double acceleration = 0;  // ignored if jerk is unlimited
  double end_velocity = 0;
  double velocity_limit = 0;  // > 0
  Bounds bounds;
};

// Consecutive stretches: up to two to come inside the limits, up to seven to the target.
struct Solution {
  std::array<Stretch, 9> stretches;
  std::size_t size = 0;

  std::span<const Stretch> all() const noexcept { return {stretches.data(), size}; }
};

// Ruckig's own tolerances at the end of a solution.
inline constexpr double kPositionTolerance = 1e-8;
inline constexpr double kVelocityTolerance = 1e-8;
inline constexpr double kAccelerationTolerance = 1e-10;

// Finds the time-optimal motion. Returns false if none is found.
bool SolveWithRuckig(const PositionProblem& problem, Solution& out) noexcept;

}  // namespace takt::trajectory
