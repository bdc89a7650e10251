// One axis in front of an ideal drive: what is commanded in a cycle is measured in the next.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/core/describe.h"

namespace takt::axis {

inline AxisParams LinearParams() {
  AxisParams p;
  p.name = "x";
  p.limits = {.velocity = 500, .acceleration = 5000, .deceleration = 4000, .jerk = 100000, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 1e6;
  p.drive.ready_timeout_s = 0.5;
  return p;
}

inline AxisParams RotaryParams() {
  AxisParams p = LinearParams();
  p.name = "c";
  p.unit = "deg";
  p.kind = AxisKind::kRotary;
  p.modulus = 360;
  return p;
}

// Without a jerk limit: times are those of a trapezoid.
inline AxisParams Trapezoid(double ramp) {
  AxisParams p = LinearParams();
  p.limits.acceleration = ramp;
  p.limits.deceleration = ramp;
  p.limits.jerk = 0;
  return p;
}

// What became of one command.
struct Life {
  std::vector<FeedbackEvent> events;
  bool active = false, done = false, aborted = false, error = false, reached = false;
  ErrorId error_id = ErrorId::kNone;
  std::uint64_t active_cycle = 0, final_cycle = 0, reached_cycle = 0;
};

struct Sample {
  Outputs out;
  KinematicState setpoint;  // unwrapped
  double origin = 0;        // of its numbers
};

class Rig {
 public:
  explicit Rig(AxisParams p, double period_s = 0.001) : params(std::move(p)), storage_(256), sink_(storage_) {
    cycle.period_s = period_s;
    state = MakeState(params);
  }

  Ticket Give(const Command& command, double lease_s = 0) {
    const Ticket ticket = next_ticket_++;
    pending_.push_back([=, this] { Apply(Now(), ticket, lease_s, command, state); });
    return ticket;
  }
  void Let(Ticket ticket) {
    pending_.push_back([=, this] { Release(Now(), ticket, state); });
  }
  void Hold(Ticket ticket) {
    pending_.push_back([=, this] { Renew(Now(), ticket, state); });
  }

  void Step() {
    if (!frozen) inputs.counts = static_cast<std::uint32_t>(std::llround(commanded.position_counts));
    ready_ = commanded.enable ? ready_ + 1 : 0;
    inputs.drive_ready = ready_ > drive_delay && !inputs.drive_fault;
    Sense(Now(), inputs, state);
    for (const auto& command : pending_) command();
    pending_.clear();
    Move(Now(), state);
    Control(Now(), state, commanded);
    Publish(params, state, out);
    for (const FeedbackEvent& event : sink_.events()) Note(event);
    sink_.Clear();
    trace.push_back({out, state.setpoint, state.origin});
    ++cycle.count;
  }
  void Run(double seconds) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0; --n) Step();
  }
  // Until the command has ended or `seconds` are over. True: it has.
  bool RunToEnd(Ticket ticket, double seconds = 30) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0 && !Ended(ticket); --n) Step();
    return Ended(ticket);
  }
  bool PowerOn() { return RunToEnd(Give(Power{}), 1) && lives[next_ticket_ - 1].done; }

  bool Ended(Ticket t) {
    const Life& life = lives[t];
    return life.done || life.aborted || life.error;
  }
  Context Now() {
    machine_ = {.states = {}, .params = {}, .cam_switches = cam_switches, .cams = cams};
    return {params, cycle, planner, sink_, nullptr, machine_};
  }
  double position() const { return state.setpoint.position; }

  AxisParams params;
  std::vector<CamSwitches> cam_switches;
  std::vector<cam::Table> cams;
  Cycle cycle;
  trajectory::Planner planner;
  State state;
  Outputs out;
  ServoInputs inputs;
  ServoOutputs commanded;
  bool frozen = false;  // the encoder stands still
  int drive_delay = 3;  // cycles to readiness
  std::map<Ticket, Life> lives;
  std::vector<Sample> trace;

 private:
  void Note(const FeedbackEvent& e) {
    Life& life = lives[e.ticket];
    life.events.push_back(e);
    if (e.reached && !life.reached) life.reached_cycle = e.cycle;
    life.reached |= e.reached;
    if (e.state == FeedbackState::kActive && !life.active) life.active_cycle = e.cycle;
    life.active |= e.state == FeedbackState::kActive;
    life.done |= e.state == FeedbackState::kDone;
    life.aborted |= e.state == FeedbackState::kAborted;
    life.error |= e.state == FeedbackState::kError;
    if (IsFinal(e.state)) {
      life.error_id = e.error;
      life.final_cycle = e.cycle;
    }
  }

  MachineView machine_;
  std::vector<FeedbackEvent> storage_;
  FeedbackSink sink_;
  std::vector<std::function<void()>> pending_;
  Ticket next_ticket_ = 1;
  int ready_ = 0;
};

// The worst that a trace of set points does against limits, as ratios (1: exactly at the limit). Jerk from differences
// of acceleration: the mean jerk over a cycle can never exceed the largest one in it.
struct Worst {
  double velocity = 0, acceleration = 0, jerk = 0, position_step = 0;
};
inline Worst WorstOf(const std::vector<Sample>& trace, const trajectory::Limits& limits, double period_s,
                     std::size_t from = 1) {
  Worst worst;
  for (std::size_t i = from; i < trace.size(); ++i) {
    const KinematicState& a = trace[i - 1].setpoint;
    const KinematicState& b = trace[i].setpoint;
    worst.velocity = std::max(worst.velocity, std::abs(b.velocity) / limits.velocity);
    const bool growing = b.acceleration * b.velocity > 0;
    worst.acceleration =
        std::max(worst.acceleration, std::abs(b.acceleration) / (growing ? limits.acceleration : limits.deceleration));
    if (limits.jerk > 0) {
      worst.jerk = std::max(worst.jerk, std::abs(b.acceleration - a.acceleration) / (limits.jerk * period_s));
    }
    // No step: between two instants T apart the position moves by the mean of both velocities times T, but for j T³ /
    // 12 at most (or, without a jerk limit, a T² / 4); and at the end of a motion the planner's own tolerance, 1e-8 of
    // its length scale a³ / j².
    const double mean = 0.5 * (a.velocity + b.velocity) * period_s;
    const double strongest = std::max(limits.acceleration, limits.deceleration);
    const double tolerance =
        limits.jerk > 0 ? 2e-8 * strongest * strongest * strongest / (limits.jerk * limits.jerk) : 1e-6;
    const double bound =
        (limits.jerk > 0 ? limits.jerk * period_s / 12 : strongest / 2) * period_s * period_s + tolerance + 1e-9;
    worst.position_step = std::max(worst.position_step, std::abs(b.position - a.position - mean) / bound);
  }
  return worst;
}

inline void ExpectWithinLimits(const Rig& rig, std::size_t from = 1) {
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), rig.cycle.period_s, from);
  EXPECT_LE(worst.velocity, 1 + 1e-9);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
  EXPECT_LE(worst.position_step, 1 + 1e-6);
}

inline double Highest(const Rig& rig) {
  double highest = -HUGE_VAL;
  for (const Sample& s : rig.trace) highest = std::max(highest, s.setpoint.position);
  return highest;
}

}  // namespace takt::axis
