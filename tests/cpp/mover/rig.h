// A mover with its own cycles, and a check that its set points keep their limits.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "takt/core/describe.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/mover.h"

namespace takt::mover {

class Rig {
 public:
  explicit Rig(MoverParams p = {}, double period_s = 0.001) : params(std::move(p)), state(MakeState(params)) {
    cycle.period_s = period_s;
    inputs = Simulate(state);
    Publish(context(), inputs, state, out);
  }

  Context context() { return {params, cycle, planner, feedback, streets, grounds}; }

  // The context in the next cycle.
  Ticket Give(const Command& command) {
    Apply(context(), ++ticket, command, state);
    Hear();
    return ticket;
  }
  void Step() {
    mover::Step(context(), inputs, state);
    Publish(context(), inputs, state, out);
    Hear();
    inputs = Simulate(state);
    ++cycle.count;
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  // Steps until the command is over; returns the number of cycles.
  int Finish(Ticket of, int most = 100'000) {
    int cycles = 0;
    while (!IsFinal(Of(of).state) && cycles < most) {
      Step();
      ++cycles;
    }
    EXPECT_TRUE(IsFinal(Of(of).state));
    return cycles;
  }
  FeedbackState Become(Ticket of) {
    Finish(of);
    return Of(of).state;
  }
  void Enable() { ASSERT_EQ(Become(Give(mover::Enable{})), FeedbackState::kDone); }

  const FeedbackEvent& Of(Ticket of) { return answers[of]; }

  MoverParams params;
  TrackNetworkState streets{1, {}};
  planar::GroupRegistry grounds{1, 0, 0, {}};
  Cycle cycle;
  trajectory::Planner planner;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(64);
  FeedbackSink feedback{storage};
  State state;
  Inputs inputs;
  Outputs out;
  Ticket ticket = 0;
  std::map<Ticket, FeedbackEvent> answers;  // the last one of each
  std::map<Ticket, double> planned_s;

 private:
  void Hear() {
    for (const FeedbackEvent& event : feedback.events()) {
      const auto before = answers.find(event.ticket);
      ASSERT_FALSE(before != answers.end() && IsFinal(before->second.state)) << "final once, ticket " << event.ticket;
      if (event.state == FeedbackState::kActive) planned_s[event.ticket] = event.value;
      answers[event.ticket] = event;
    }
    EXPECT_EQ(feedback.lost(), 0u);
    feedback.Clear();
  }
};

// Compares the set points of each cycle with the preceding ones.
class Watch {
 public:
  explicit Watch(const Rig& rig) : rig_(&rig), before_(rig.state.set_point) {}

  // After each step. `outside`: set points are external, with a jerk of their own.
  void Look(bool outside = false) {
    const SetPoint& now = rig_->state.set_point;
    const MoverParams& p = rig_->params;
    const auto velocity = [](const KinematicState& k) { return k.velocity; };
    const auto acceleration = [](const KinematicState& k) { return k.acceleration; };
    const auto length = [&](auto of) { return std::hypot(of(now[kX]), of(now[kY])); };
    const auto change = [&](auto of) {
      return std::hypot(of(now[kX]) - of(before_[kX]), of(now[kY]) - of(before_[kY]));
    };
    Keeps(length(velocity), length(acceleration), change(acceleration), p.xy.maximum.limits(), outside);
    Agree(kX);
    Agree(kY);
    const std::array<const CoordinateParams*, 4> others = {&p.z, &p.a, &p.b, &p.c};
    for (std::size_t i = 0; i < 4; ++i) {
      const KinematicState& k = now[kOthers[i]];
      Keeps(std::abs(k.velocity), std::abs(k.acceleration), std::abs(k.acceleration - before_[kOthers[i]].acceleration),
            others[i]->maximum.limits(), outside);
      Agree(kOthers[i]);
      if (kOthers[i] == kC) continue;
      EXPECT_GE(k.position, others[i]->lower - 1e-6);
      EXPECT_LE(k.position, others[i]->upper + 1e-6);
    }
    // PL-10: X and Y are locked outside of a window.
    const bool moves = length(velocity) > 0 || length(acceleration) > 0;
    if (moves && rig_->out.command_mode != CommandMode::kExternalSetpointGeneration && !outside) {
      EXPECT_TRUE(InOneWindow(p.c, now[kC].position, now[kC].position)) << now[kC].position;
    }
    before_ = now;
  }

 private:
  void Keeps(double v, double a, double da, const trajectory::Limits& l, bool outside) const {
    EXPECT_LE(v, l.velocity * (1 + 1e-6));
    EXPECT_LE(a, std::max(l.acceleration, l.deceleration) * (1 + 1e-6));
    if (outside) return;
    EXPECT_LE(da, l.jerk * rig_->cycle.period_s * (1 + 1e-6));
  }
  // Position and velocity follow from acceleration, but for what jerk may do within a cycle.
  void Agree(std::size_t i) const {
    const MoverParams& p = rig_->params;
    const std::array<double, 6> jerks = {p.xy.maximum.jerk, p.xy.maximum.jerk, p.z.maximum.jerk,
                                         p.a.maximum.jerk,  p.b.maximum.jerk,  p.c.maximum.jerk};
    const double t = rig_->cycle.period_s;
    const KinematicState& k = rig_->state.set_point[i];
    const KinematicState& b = before_[i];
    EXPECT_NEAR(k.velocity - b.velocity, 0.5 * t * (k.acceleration + b.acceleration), jerks[i] * t * t + 1e-9);
    EXPECT_NEAR(k.position - b.position, 0.5 * t * (k.velocity + b.velocity),
                jerks[i] * t * t * t + 1e-9 + t * t * std::abs(k.acceleration - b.acceleration));
  }

  const Rig* rig_;
  SetPoint before_;
};

inline double Uniform(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}
inline int Whole(std::mt19937& random, int from, int to) {
  return std::uniform_int_distribution<int>(from, to)(random);
}

}  // namespace takt::mover
