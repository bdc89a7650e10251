// Invariants of the set points of the slave.
#pragma once

#include "bench.h"

namespace takt::flexcam {

// Checks that the slave never jumps: jerk, acceleration and velocity of its set points within its limits.
class Watch {
 public:
  explicit Watch(Bench& b) : b_(b) {
    b.each = [this] { Look(); };
  }
  void Look() {
    const axis::Outputs& k = b_.Knife();
    const axis::AxisLimits& l = b_.machine.axes[Bench::kKnife].limits;
    const double t = b_.machine.cycle.period_s;
    if (seen_) {
      jerk = std::max(jerk, std::abs(k.set_acceleration - before_.set_acceleration) / t);
      const double away = k.set_position - before_.set_position - t * 0.5 * (k.set_velocity + before_.set_velocity);
      const double turn = b_.machine.axes[Bench::kKnife].turn();
      const double wrapped = turn == 0 ? away : away - turn * std::round(away / turn);
      jump = std::max(jump, std::abs(wrapped) - l.jerk * (1 + 1e-5) * t * t * t / 12);
    }
    velocity = std::max(velocity, std::abs(k.set_velocity));
    acceleration = std::max(acceleration, std::abs(k.set_acceleration));
    before_ = k;
    seen_ = true;
  }
  void ExpectSmooth() const {
    const axis::AxisLimits& l = b_.machine.axes[Bench::kKnife].limits;
    EXPECT_LE(velocity, l.velocity * (1 + 1e-9));
    EXPECT_LE(acceleration, l.acceleration * (1 + 1e-9));
    EXPECT_LE(jerk, l.jerk * (1 + 1e-5));
    EXPECT_LE(jump, 1e-9);
  }
  double velocity = 0, acceleration = 0, jerk = 0, jump = 0;

 private:
  Bench& b_;
  axis::Outputs before_;
  bool seen_ = false;
};

}  // namespace takt::flexcam
