// A belt on an axis at positions given by a test, and a machine with belts on an engine in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "takt/conveyor/belt.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"

namespace takt::conveyor {

class Rig {
 public:
  explicit Rig(BeltParams p = {}, double period_s = 0.001) : params(std::move(p)) {
    cycle.period_s = period_s;
    axis.loop_closed = true;
  }

  Context context() { return {params, axis, axis_params, cycle, feedback}; }
  // Steps a cycle, with the axis at this state. A measured axis is at its position at the begin of the cycle.
  void Step(const KinematicState& x) {
    axis.setpoint = axis.actual = x;
    axis.actual.acceleration = 0;
    ++cycle.count;
    conveyor::Step(context(), state);
  }
  FeedbackEvent Give(const Command& command) {
    feedback.Clear();
    Apply(context(), 1, command, state);
    return feedback.events().back();
  }
  std::uint32_t Detected(const Detect& detect = {}) {
    const FeedbackEvent event = Give(detect);
    EXPECT_EQ(event.state, FeedbackState::kDone);
    return static_cast<std::uint32_t>(event.value);
  }
  const Object& The(std::uint32_t number) const { return *Find(state, number); }
  double Place(std::uint32_t number) const { return PlaceOf(params, state, The(number)); }
  Outputs Out() {
    Outputs out;
    Publish(context(), state, out);
    return out;
  }

  BeltParams params;
  axis::State axis;
  axis::AxisParams axis_params;
  Cycle cycle;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(64);
  FeedbackSink feedback{storage};
  State state;
};

inline BeltParams Straight(axis::MasterSource source = axis::MasterSource::kSetValue) {
  BeltParams p;
  p.name = "belt";
  p.axis = "drive";
  p.source = source;
  return p;
}
inline BeltParams Table() {
  BeltParams p = Straight();
  p.kind = BeltKind::kTurning;
  return p;
}

// An engine with a machine file, and the last feedback of each command.
class Cell {
 public:
  explicit Cell(const std::string& text) : machine(Load(text)), engine(machine) {}

  static engine::Machine Load(const std::string& text) {
    engine::LoadResult loaded = engine::LoadMachine(text, "cell.yaml");
    for (const std::string& problem : loaded.problems) ADD_FAILURE() << problem;
    return loaded.machine.value();
  }
  Ticket Give(const std::string& target, const std::string& verb, const std::string& arguments = "") {
    const engine::ParsedCommand parsed = engine::ParseCommand(machine, target, verb, arguments);
    EXPECT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
    return engine.Submit(parsed.command);
  }
  // Also runs the cycle, and returns the feedback.
  FeedbackEvent Ask(const std::string& target, const std::string& verb, const std::string& arguments = "") {
    const Ticket ticket = Give(target, verb, arguments);
    Run(1);
    return last[ticket];
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      engine.RunCycle();
      for (FeedbackEvent event; engine.feedback().TryPop(event);) last[event.ticket] = event;
      if (each) each();
    }
  }
  const Outputs& Belt(std::size_t i = 0) const { return engine.belt_outputs(i); }

  engine::Machine machine;
  engine::Engine engine;
  std::map<Ticket, FeedbackEvent> last;
  std::function<void()> each;
};

}  // namespace takt::conveyor
