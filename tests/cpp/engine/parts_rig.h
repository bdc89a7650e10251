// A machine whose surface is made of parts, commanded by text, cycle by cycle.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "takt/engine/components.h"
#include "takt/engine/cycle.h"
#include "takt/engine/engine.h"
#include "texts.h"

namespace takt::engine {

// Example 6.6.1 of the manual: two levels, a lift between them.
inline const std::string kLift = R"(
name: lift
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: one, positions: [{coordinate_system: lower}]}
  - {name: two, positions: [{coordinate_system: upper}]}
  - name: three
    positions: [{coordinate_system: lower, y: 240}, {coordinate_system: upper, y: 240}]
    initial_position: 2
movers:
  - {name: mover, reference: one, initial: {x: 120, y: 120}}
)";

class PartsRig {
 public:
  explicit PartsRig(const std::string& text, const EngineOptions& options = {})
      : engine(MachineOf(text), options), machine(engine.machine()) {}

  Ticket Give(const std::string& target, const std::string& verb, const std::string& arguments = "{}") {
    const ParsedCommand parsed = ParseCommand(machine, target, verb, arguments);
    if (!parsed.sentence.empty()) throw std::runtime_error(verb + ": " + parsed.sentence);
    return engine.Submit(parsed.command);
  }
  void Run(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      engine.RunCycle();
      engine.MakeTracks();
      for (FeedbackEvent event; engine.feedback().TryPop(event);) answers[event.ticket] = event;
      if (each_cycle) each_cycle();
    }
  }
  // Runs until the command is over and returns its result.
  FeedbackEvent End(Ticket ticket, int most = 20000) {
    for (int i = 0; i < most && !IsFinal(answers[ticket].state); ++i) Run();
    EXPECT_TRUE(IsFinal(answers[ticket].state));
    return answers[ticket];
  }
  FeedbackEvent Do(const std::string& target, const std::string& verb, const std::string& arguments = "{}") {
    return End(Give(target, verb, arguments));
  }
  ErrorId ErrorOf(const std::string& target, const std::string& verb, const std::string& arguments = "{}") {
    const ParsedCommand parsed = ParseCommand(machine, target, verb, arguments);
    return parsed.sentence.empty() ? Do(target, verb, arguments).error : parsed.error;
  }

  const mover::Outputs& Mover(const std::string& name) const {
    return engine.mover_outputs(Index(machine.movers, name));
  }
  const part::Outputs& Part(const std::string& name) const { return engine.part_outputs(Index(machine.parts, name)); }

  Engine engine;
  const Machine& machine;
  std::map<Ticket, FeedbackEvent> answers;  // the last one of each
  std::function<void()> each_cycle;

 private:
  template <typename T>
  static std::size_t Index(const std::vector<T>& list, const std::string& name) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].name == name) return i;
    }
    throw std::runtime_error("nothing is called " + name);
  }
};

}  // namespace takt::engine
