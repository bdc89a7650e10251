// A random walk of commands, releases and faults through an axis, with everything that must always hold checked at
// every cycle.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>
#include <set>

#include "rig.h"

namespace takt::axis {
namespace {

Command RandomCommand(std::mt19937_64& random, const AxisParams& p) {
  std::uniform_real_distribution<double> any(-1.2, 1.2);
  const auto position = [&] { return p.rotary() ? std::abs(any(random)) * 300 : any(random) * 400; };
  const auto speed = [&] { return std::abs(any(random)) * p.limits.velocity; };
  const auto ramp = [&](double limit) { return std::max(0.02, std::min(1.0, std::abs(any(random)))) * limit; };
  const double acceleration = ramp(p.limits.acceleration);
  const double deceleration = ramp(p.limits.deceleration.value());
  const double jerk =
      p.limits.jerk > 0 ? ramp(p.limits.jerk) : std::abs(any(random)) * 1e5;  // own jerk without a limit too
  const auto mode = static_cast<BufferMode>(random() % 6);
  const auto direction = static_cast<Direction>(random() % 4);
  switch (random() % 10) {
    case 0:
      return Power{random() % 4 != 0, random() % 3 == 0 ? BufferMode::kBuffered : BufferMode::kAborting};
    case 1:
      return Reset{};
    case 2:
    case 3:
      return MoveAbsolute{.position = position(),
                          .velocity = speed(),
                          .acceleration = acceleration,
                          .deceleration = deceleration,
                          .jerk = jerk,
                          .direction = direction,
                          .buffer_mode = mode};
    case 4:
      if (random() % 2) {
        return MoveAdditive{.distance = random() % 5 ? position() : any(random),
                            .velocity = speed(),
                            .acceleration = acceleration,
                            .deceleration = deceleration,
                            .jerk = jerk,
                            .buffer_mode = mode};
      }
      return MoveRelative{.distance = random() % 5 ? position() : any(random),
                          .velocity = speed(),
                          .acceleration = acceleration,
                          .deceleration = deceleration,
                          .jerk = jerk,
                          .buffer_mode = mode};
    case 5:
    case 6:
      return MoveVelocity{.velocity = speed(),
                          .acceleration = acceleration,
                          .deceleration = deceleration,
                          .jerk = jerk,
                          .direction = direction,
                          .buffer_mode = mode};
    case 7:
      return Halt{.deceleration = deceleration, .jerk = jerk, .buffer_mode = mode};
    case 8:
      return Stop{.deceleration = deceleration, .jerk = jerk, .hold = random() % 2 == 0, .buffer_mode = mode};
    default:
      return Jog{.forward = random() % 2 == 0,
                 .backward = random() % 2 == 0,
                 .velocity = speed(),
                 .acceleration = acceleration,
                 .deceleration = deceleration,
                 .jerk = jerk};
  }
}

class RandomWalkProperty : public testing::TestWithParam<int> {};

// AX-10: a random walk of commands and faults, 10,000 steps: no transition outside the table. AX-11: each command's
// feedback is Busy, Active, then one final state, once. AX-13: every set point of powered motion holds the limits and
// follows from the one before without a step, and stays inside the SW limits.
TEST_P(RandomWalkProperty, MeetsNoIllegalTransitionAndHoldsAllLimits) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  AxisParams p = GetParam() % 2 ? LinearParams() : RotaryParams();
  if (!p.rotary()) p.limits.lower = -300, p.limits.upper = 300;
  p.supervision.in_position = 0.01;
  p.supervision.deviation_moving = 2;
  const auto seed = static_cast<std::size_t>(GetParam());
  p.limits.deceleration = std::array{4000.0, 5000.0, 12000.0, 1500.0}[seed % 4];
  p.limits.jerk = std::array{100000.0, 20000.0, 0.0}[seed / 2 % 3];
  Rig rig(p, std::array{0.001, 0.004, 0.02, 0.00025}[seed / 3 % 4]);
  const trajectory::Limits limits = p.planner_limits();
  std::vector<Ticket> held;
  std::set<PlcState> seen;
  for (int step = 0; step < 10000; ++step) {
    for (auto n = random() % 4; n > 0; --n) held.push_back(rig.Give(RandomCommand(random, p)));
    if (random() % 3 == 0 && !held.empty()) rig.Let(held[random() % held.size()]);
    const auto fault = random() % 400;
    if (fault == 0) rig.inputs.limit_positive = !rig.inputs.limit_positive;
    if (fault == 1) rig.inputs.limit_negative = !rig.inputs.limit_negative;
    if (fault == 2) rig.inputs.drive_fault = true;
    if (fault == 3) rig.inputs.encoder_error = true;
    if (fault > 370)
      rig.inputs.drive_fault = rig.inputs.encoder_error = rig.inputs.limit_positive = rig.inputs.limit_negative = false;
    for (auto n = random() % 60; n > 0; --n) {
      rig.Step();
      seen.insert(rig.out.state);
      const Sample& before = rig.trace[rig.trace.size() > 1 ? rig.trace.size() - 2 : 0];
      const Sample& now = rig.trace.back();
      if (before.out.loop_closed && now.out.loop_closed &&
          std::abs(now.setpoint.position - before.setpoint.position) < 300) {
        const Worst worst = WorstOf({before, now}, limits, rig.cycle.period_s);
        ASSERT_LE(worst.velocity, 1 + 1e-9) << step;
        ASSERT_LE(worst.acceleration, 1 + 1e-9) << step;
        ASSERT_LE(worst.jerk, 1 + 1e-6) << step;
        ASSERT_LE(worst.position_step, 1 + 1e-6) << step;
      }
      if (!p.rotary()) {
        ASSERT_LE(now.setpoint.position, 300 + 1e-6) << step;
        ASSERT_GE(now.setpoint.position, -300 - 1e-6) << step;
      }
      if (rig.trace.size() > 100) rig.trace.erase(rig.trace.begin(), rig.trace.end() - 2);
    }
    ASSERT_EQ(rig.state.illegal_transitions, 0u) << step;
  }
  EXPECT_EQ(seen.size(), 6u);  // all but SynchronizedMotion and Homing
  int open = 0;
  for (const auto& [ticket, life] : rig.lives) {
    int finals = 0;
    bool active = false;
    for (const FeedbackEvent& e : life.events) {
      ASSERT_EQ(finals, 0) << "something after the end of " << ticket;
      ASSERT_FALSE(e.state == FeedbackState::kBusy && active) << ticket;
      active |= e.state == FeedbackState::kActive;
      finals += IsFinal(e.state) ? 1 : 0;
    }
    open += finals == 0 ? 1 : 0;
  }
  EXPECT_LE(open, 10);  // what is in control or waits at the end
}
// More of them in the long run (`./dev bench --long`).
INSTANTIATE_TEST_SUITE_P(Seeds, RandomWalkProperty, testing::Range(1, std::getenv("TAKT_LONG") ? 2000 : 25));

}  // namespace
}  // namespace takt::axis
