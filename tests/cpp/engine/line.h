// A line of equal axes on an engine in virtual time, with the result of each command.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "machines.h"

namespace takt::engine {

inline Machine LineOf(int axes, axis::AxisKind kind = axis::AxisKind::kLinear) {
  Machine machine;
  machine.name = "line";
  for (int i = 0; i < axes; ++i) {
    axis::AxisParams a;
    a.name = "a" + std::to_string(i);
    a.kind = kind;
    a.limits = {.velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000, .lower = {}, .upper = {}};
    a.encoder.increments_per_unit = 10000;
    machine.axes.push_back(a);
  }
  return machine;
}

// Multiplies the limits of one axis, so that it can follow the others at that ratio.
inline Machine WithStrong(Machine machine, std::size_t axis, double times) {
  axis::AxisLimits& limits = machine.axes[axis].limits;
  limits.velocity *= times;
  limits.acceleration *= times;
  limits.jerk *= times;
  return machine;
}

class Line {
 public:
  explicit Line(const Machine& m) : machine(m), engine(machine) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) Give(i, axis::Power{});
    Run(200);
  }

  Ticket Give(std::size_t axis, const axis::Command& body) {
    return engine.Submit(ToAxis(machine, machine.axes[axis].name, body));
  }
  void Step() {
    engine.RunCycle();
    for (FeedbackEvent event; engine.feedback().TryPop(event);) {
      last[event.ticket] = event;
      reached[event.ticket] |= event.reached;
    }
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  const axis::Outputs& At(std::size_t axis) const { return engine.outputs(axis); }

  Machine machine;
  Engine engine;
  std::map<Ticket, FeedbackEvent> last;
  std::map<Ticket, bool> reached;
};

inline axis::GearIn Gear(const char* master, double ratio = 1) {
  axis::GearIn gear;
  gear.master = Name::Of(master);
  gear.ratio_numerator = ratio;
  return gear;
}

}  // namespace takt::engine
