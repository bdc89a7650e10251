#include "takt/trajectory/ruckig_solver.h"

#include <ruckig/block.hpp>
#include <ruckig/brake.hpp>
#include <ruckig/position.hpp>
#include <ruckig/profile.hpp>

namespace takt::trajectory {

namespace {

// A solver keeps three or six candidates and adds them without a bounds check. Indices beyond its array were reported
// (its issue 216), so it gets spare memory behind it.
template <typename Solver>
struct WithRoom {
  template <typename... Arguments>
  explicit WithRoom(Arguments... arguments) noexcept : solver(arguments...) {}
  Solver solver;
  std::array<ruckig::Profile, 4> room;
};

void Add(double duration, double acceleration, double jerk, Solution& out) noexcept {
  if (duration > 0 && out.size < out.stretches.size()) out.stretches[out.size++] = {duration, acceleration, jerk};
}

void Unpack(const ruckig::Block& block, bool unlimited_jerk, Solution& out) noexcept {
  out.size = 0;
  const ruckig::Profile& found = block.p_min;
  if (found.brake.duration > 0) {
    const std::size_t parts = unlimited_jerk ? 1 : 2;
    for (std::size_t i = 0; i < parts; ++i) {
      Add(found.brake.t[i], found.brake.a[i], unlimited_jerk ? 0 : found.brake.j[i], out);
    }
  }
  for (std::size_t i = 0; i < found.t.size(); ++i) Add(found.t[i], found.a[i], found.j[i], out);
}

}  // namespace

bool SolveWithRuckig(const PositionProblem& q, Solution& out) noexcept {
  const double v_max = q.velocity_limit;
  const auto& [up, down, jerk] = q.bounds;
  double position = 0;
  double velocity = q.velocity;
  double acceleration = jerk == 0 ? 0 : q.acceleration;
  ruckig::Profile input;
  ruckig::Block block;
  bool found = false;
  if (jerk == 0) {
    input.brake.get_second_order_position_brake_trajectory(velocity, v_max, -v_max, up, -down);
    input.brake.finalize_second_order(position, velocity, acceleration);
    input.set_boundary(position, velocity, acceleration, q.distance, q.end_velocity, 0);
    WithRoom<ruckig::PositionSecondOrderStep1> step(position, velocity, q.distance, q.end_velocity, v_max, -v_max, up,
                                                    -down);
    found = step.solver.get_profile(input, block);
  } else {
    input.brake.get_position_brake_trajectory(velocity, acceleration, v_max, -v_max, up, -down, jerk);
    input.brake.finalize(position, velocity, acceleration);
    input.set_boundary(position, velocity, acceleration, q.distance, q.end_velocity, 0);
    WithRoom<ruckig::PositionThirdOrderStep1> step(position, velocity, acceleration, q.distance, q.end_velocity, 0.0,
                                                   v_max, -v_max, up, -down, jerk);
    found = step.solver.get_profile(input, block);
  }
  if (found) Unpack(block, jerk == 0, out);
  return found;
}

}  // namespace takt::trajectory
