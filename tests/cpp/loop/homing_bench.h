// A simulated axis with switches and index pulses, for tests of homing.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/plant/servo.h"

namespace takt::axis {

// A linear axis of 200 mm: LIM- on up to -100, LIM+ on from 100, REF on from 10 to 30, NI every 10 mm at ...3.
class Bench {
 public:
  explicit Bench(double start) {
    params.name = "x";
    params.limits = {
        .velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000, .lower = {}, .upper = {}};
    params.encoder.increments_per_unit = 10000;
    servo.encoder.increments_per_unit = 10000;
    servo.encoder.index_distance = 10;
    servo.encoder.index_offset = 3;
    servo.drive.power_up_s = 0.01;
    servo.mechanics.start_position = start;
    servo.switches.limit_negative.to = -100;
    servo.switches.limit_positive.from = 100;
    servo.switches.reference.from = 10;
    servo.switches.reference.to = 30;
  }
  // The machine begins to count where it stands: the place `x` of the plant is the position x - start.
  void On() {
    plant = plant::MakeServoState(servo);
    plant::Step(servo, out, cycle.period_s, plant, in);
    state = MakeState(params);
    state.encoder = {};
    Give(Power{});
    Run(0.1);
    ASSERT_TRUE(state.loop_closed);
  }
  Ticket Give(const Command& command) {
    const Ticket ticket = next++;
    pending.push_back({ticket, command});
    return ticket;
  }
  void Step() {
    Context c{params, cycle, planner, sink};
    Sense(c, in, state);
    for (const auto& [ticket, command] : pending) Apply(c, ticket, 0, command, state);
    pending.clear();
    const KinematicState before = state.setpoint;
    const double shift = state.origin;
    Move(c, state);
    Control(c, state, out);
    Publish(params, state, seen);
    plant::Step(servo, out, cycle.period_s, plant, in);
    for (const FeedbackEvent& e : sink.events()) last[e.ticket] = e;
    sink.Clear();
    ++cycle.count;
    if (!state.loop_closed) return;
    const trajectory::Limits own = params.planner_limits();
    EXPECT_LE(std::abs(state.setpoint.velocity), own.velocity * (1 + 1e-9));
    EXPECT_LE(std::abs(state.setpoint.acceleration), own.acceleration * (1 + 1e-9));
    EXPECT_LE(std::abs(state.setpoint.acceleration - before.acceleration),
              own.jerk * cycle.period_s * (1 + 1e-6) + 1e-6);
    const double step = state.setpoint.position + state.origin - before.position - shift;
    EXPECT_NEAR(step, 0.5 * cycle.period_s * (before.velocity + state.setpoint.velocity), own.jerk * 1e-9);
    EXPECT_EQ(state.illegal_transitions, 0u);
  }
  void Run(double seconds) {
    for (double t = 0; t < seconds; t += cycle.period_s) Step();
  }
  bool RunToEnd(Ticket ticket, double seconds = 60) {
    for (double t = 0; t < seconds && !(IsFinal(last[ticket].state) && last[ticket].ticket); t += cycle.period_s)
      Step();
    return IsFinal(last[ticket].state) && last[ticket].ticket;
  }
  double place() const { return plant.load_position; }

  AxisParams params;
  plant::ServoParams servo;
  plant::ServoState plant;
  ServoInputs in;
  ServoOutputs out;
  Cycle cycle{1, 0.001};
  trajectory::Planner planner;
  State state;
  Outputs seen;
  std::array<FeedbackEvent, 256> storage;
  FeedbackSink sink{storage};
  std::map<Ticket, FeedbackEvent> last;
  std::vector<std::pair<Ticket, Command>> pending;
  Ticket next = 1;
};

}  // namespace takt::axis
