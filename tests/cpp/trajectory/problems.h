// Random problems typical of drives, and an exact check of their plans. Also used by the long run in cpp/bench.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "takt/trajectory/planner.h"

namespace takt::trajectory::testing {

struct Problem {
  KinematicState from;
  double position = 0;
  double end_velocity = 0;
  Limits limits;
};

// One millimetre (for rotary axes: 0.36 deg) in the user's unit.
inline constexpr std::array<double, 4> kUnits{1000, 1, 0.001, 0.36};  // µm, mm, m, deg

struct Mix {
  double unit = 1;
  bool start_within_limits = true;  // also the speed that the start's acceleration leads to
  bool asymmetric = false;          // deceleration differs from acceleration
  bool unlimited_jerk = false;      // in a quarter of the problems
  double end_velocity_share = 0.3;  // in problems with one
  double spread = 1;                // 1: drive-like; larger: limits further apart, by powers of ten
};

class Problems {
 public:
  Problems(std::uint64_t seed, const Mix& mix) : random_(seed), mix_(mix) {}

  Problem Next() {
    const double spread = std::pow(10, mix_.spread - 1);
    Problem p;
    Limits& l = p.limits;
    l.velocity = mix_.unit * Decades(10 / spread, 5000 * spread);
    l.acceleration = l.velocity / Decades(0.02 / spread, 1 * spread);
    l.deceleration = mix_.asymmetric ? l.acceleration * Decades(0.2, 5) : l.acceleration;
    l.jerk = l.acceleration / Decades(0.005 / spread, 0.5 * spread);
    if (mix_.unlimited_jerk && Chance(0.25)) l.jerk = 0;
    const double reach = mix_.start_within_limits ? 1 : 2;
    do {
      p.from.velocity = Signed(reach * l.velocity);
      const double least = mix_.start_within_limits ? std::min(l.acceleration, l.deceleration) : l.acceleration;
      p.from.acceleration = Signed(reach * least);
    } while (mix_.start_within_limits && l.jerk > 0 && std::abs(Leads(p.from, l)) > l.velocity);
    if (Chance(0.3)) p.from.velocity = p.from.acceleration = 0;
    if (l.jerk == 0) p.from.acceleration = 0;
    p.from.position = mix_.unit * Signed(2000);
    p.position = p.from.position + (Chance(0.5) ? 1 : -1) * mix_.unit * Decades(1e-3 / spread, 5000 * spread);
    if (Chance(mix_.end_velocity_share)) p.end_velocity = Signed(l.velocity);
    return p;
  }

  // Uniform in the logarithm.
  double Decades(double low, double high) { return low * std::pow(high / low, uniform_(random_)); }
  double Signed(double largest) { return largest * (2 * uniform_(random_) - 1); }
  bool Chance(double share) { return uniform_(random_) < share; }

 private:
  static double Leads(const KinematicState& s, const Limits& l) {
    return s.velocity + s.acceleration * std::abs(s.acceleration) / (2 * l.jerk);
  }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  Mix mix_;
};

// Excess of a plan over its limits, as a share of the limit; 0: none.
struct Excess {
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  // Steps between pieces and at the end. Position as a share of the distance covered, the others of their limits.
  double position_step = 0;
  double velocity_step = 0;
  double acceleration_step = 0;

  void Widen(const Excess& e) {
    velocity = std::max(velocity, e.velocity);
    acceleration = std::max(acceleration, e.acceleration);
    deceleration = std::max(deceleration, e.deceleration);
    jerk = std::max(jerk, e.jerk);
    position_step = std::max(position_step, e.position_step);
    velocity_step = std::max(velocity_step, e.velocity_step);
    acceleration_step = std::max(acceleration_step, e.acceleration_step);
  }
};

// Exact: extremes of velocity lie where the acceleration is 0, those of acceleration at the ends of pieces and, since
// the limit changes there, where the velocity is 0.
inline Excess Audit(const Profile& plan, const Limits& l) {
  Excess worst;
  const KinematicState& start = plan.start();
  const bool steps_allowed = l.jerk == 0;
  // The speed that the initial acceleration makes unavoidable.
  const double taken = steps_allowed ? 0 : start.acceleration * start.acceleration / (2 * l.jerk);
  const double highest = std::max({l.velocity, start.velocity, start.acceleration > 0 ? start.velocity + taken : 0});
  const double lowest = std::min({-l.velocity, start.velocity, start.acceleration < 0 ? start.velocity - taken : 0});
  const auto velocity = plan.VelocityRange();
  worst.velocity = std::max({0.0, velocity.max - highest, lowest - velocity.min}) / l.velocity;

  const auto check_acceleration = [&](double t, double a, double v) {
    if (std::abs(v) <= 1e-9 * l.velocity || a == 0) return;
    const bool grows = (a > 0) == (v > 0);
    const double limit = grows ? l.acceleration : l.deceleration;
    const bool same_sign = (a > 0) == (start.acceleration > 0);
    const double inherited = same_sign && !steps_allowed ? std::abs(start.acceleration) - l.jerk * t : 0;
    double& excess = grows ? worst.acceleration : worst.deceleration;
    excess = std::max(excess, (std::abs(a) - std::max(limit, inherited)) / limit);
  };
  KinematicState reached = start;
  double begin = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.size()); ++i) {
    const Piece& piece = plan.pieces[i];
    const double length = plan.piece_ends_s[i] - begin;
    const double covered = std::abs(plan.end().position - start.position) +
                           std::abs(reached.velocity) * plan.duration() +
                           1e-7 * std::max(std::abs(plan.end().position), std::abs(start.position));
    worst.jerk = std::max(worst.jerk, steps_allowed ? std::abs(piece.jerk) : std::abs(piece.jerk) / l.jerk - 1);
    worst.position_step = std::max(worst.position_step, std::abs(piece.position - reached.position) / covered);
    worst.velocity_step = std::max(worst.velocity_step, std::abs(piece.velocity - reached.velocity) / l.velocity);
    if (!steps_allowed) {
      worst.acceleration_step =
          std::max(worst.acceleration_step, std::abs(piece.acceleration - reached.acceleration) / l.acceleration);
    }
    std::array<double, 4> cuts{0, 0, length, length};
    const auto zeros = piece.VelocityZeros();
    if (zeros[0] > 0 && zeros[0] < length) cuts[1] = zeros[0];
    if (zeros[1] > cuts[1] && zeros[1] < length) cuts[2] = zeros[1];
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = piece.At(0.5 * (cuts[k] + cuts[k + 1])).velocity;
      check_acceleration(begin + cuts[k], piece.At(cuts[k]).acceleration, v);
      check_acceleration(begin + cuts[k + 1], piece.At(cuts[k + 1]).acceleration, v);
    }
    reached = piece.At(length);
    begin = plan.piece_ends_s[i];
    if (i + 1 == static_cast<std::size_t>(plan.size())) {
      worst.position_step = std::max(worst.position_step, std::abs(plan.end().position - reached.position) / covered);
      worst.velocity_step =
          std::max(worst.velocity_step, std::abs(plan.end().velocity - reached.velocity) / l.velocity);
      if (!steps_allowed) {
        worst.acceleration_step = std::max(worst.acceleration_step,
                                           std::abs(plan.end().acceleration - reached.acceleration) / l.acceleration);
      }
    }
  }
  return worst;
}

}  // namespace takt::trajectory::testing
