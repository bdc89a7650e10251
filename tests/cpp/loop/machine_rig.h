// A whole axis in front of its simulated servo, cycle by cycle.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/axis/sequence.h"
#include "takt/plant/servo.h"

namespace takt {

class MachineRig {
 public:
  MachineRig(axis::AxisParams axis, plant::ServoParams plant, double period_s = 0.001)
      : params(std::move(axis)), servo_params(std::move(plant)), storage_(256), sink_(storage_) {
    cycle.period_s = period_s;
    state = axis::MakeState(params);
    servo = plant::MakeServoState(servo_params);
    plant::Step(servo_params, wires_out, period_s, servo, wires_in);
  }

  Ticket Give(const axis::Command& command) {
    pending_.push_back({++last_ticket_, command});
    return last_ticket_;
  }
  void Step() {
    const axis::Context now = Now();
    axis::Sense(now, wires_in, state);
    for (const auto& [ticket, command] : pending_) axis::Apply(now, ticket, 0, command, state);
    pending_.clear();
    axis::Move(now, state);
    axis::Control(now, state, wires_out);
    axis::Publish(params, state, out);
    for (const FeedbackEvent& e : sink_.events()) {
      ends[e.ticket] = e;
      reached[e.ticket] = reached[e.ticket] || e.reached;
    }
    sink_.Clear();
    plant::Step(servo_params, wires_out, cycle.period_s, servo, wires_in);
    ++cycle.count;
  }
  void Run(double seconds) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0; --n) Step();
  }
  bool RunUntil(const std::function<bool()>& holds, double seconds = 20) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0 && !holds(); --n) Step();
    return holds();
  }
  bool RunToEnd(Ticket t, double seconds = 20) {
    return RunUntil([&] { return IsFinal(ends[t].state); }, seconds);
  }
  bool Done(Ticket t) { return ends[t].state == FeedbackState::kDone; }
  bool PowerOn() {
    const Ticket t = Give(axis::Power{});
    return RunToEnd(t) && Done(t);
  }
  bool MoveTo(double position) {
    const Ticket t = Give(axis::MoveAbsolute{.position = position});
    return RunToEnd(t) && Done(t);
  }
  axis::Context Now() { return {params, cycle, planner, sink_}; }

  axis::AxisParams params;
  plant::ServoParams servo_params;
  Cycle cycle;
  trajectory::Planner planner;
  axis::State state;
  axis::Outputs out;
  plant::ServoState servo;
  ServoInputs wires_in;
  ServoOutputs wires_out;
  std::map<Ticket, FeedbackEvent> ends;  // the last of each command
  std::map<Ticket, bool> reached;

 private:
  std::vector<FeedbackEvent> storage_;
  FeedbackSink sink_;
  std::vector<std::pair<Ticket, axis::Command>> pending_;
  Ticket last_ticket_ = 0;
};

inline axis::AxisParams StandardAxis() {
  axis::AxisParams p;
  p.name = "x";
  p.limits = {.velocity = 500, .acceleration = 5000, .deceleration = 5000, .jerk = 100000, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 1e5;
  return p;
}

// Twice the torque that the axis' largest acceleration takes.
inline plant::ServoParams StandardServo(const axis::AxisParams& axis) {
  plant::ServoParams p;
  p.drive.power_up_s = 0.01;
  p.mechanics.inertia = p.drive.max_torque / (2 * axis.limits.acceleration);
  p.encoder.increments_per_unit = axis.encoder.increments_per_unit;
  return p;
}

}  // namespace takt
