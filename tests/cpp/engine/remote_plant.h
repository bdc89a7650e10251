// External drives, as the engine sees them: their work is done between the cycles. Answers can be withheld.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "machines.h"
#include "takt/plant/servo.h"

namespace takt::engine {

inline Machine WithExternalDrives(Machine machine, std::uint32_t missing_cycles = 5) {
  for (const axis::AxisParams& axis : machine.axes) {
    machine.external.drives.push_back({.axis = axis.name, .missing_cycles = missing_cycles});
  }
  return machine;
}

class RemotePlant {
 public:
  explicit RemotePlant(const Machine& machine) : period_s_(machine.cycle.period_s) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      params.push_back(ServoOf(machine, i));
      states.push_back(plant::MakeServoState(params[i]));
      told.emplace_back();
    }
  }

  // Carries out the engine's set points and answers, except those that `answers` excludes.
  void Serve(Engine& engine) {
    DriveSetPoint set_point;
    while (engine.set_points().TryPop(set_point)) {
      const std::size_t i = set_point.axis;
      DriveSample sample{set_point.cycle, set_point.axis, {}};
      told[i] = set_point.outputs;
      plant::Step(params[i], told[i], period_s_, states[i], sample.inputs);
      change(sample);
      if (answers(sample)) engine.drive_samples().TryPush(sample);
    }
  }

  std::function<bool(const DriveSample&)> answers = [](const DriveSample&) { return true; };
  std::function<void(DriveSample&)> change = [](DriveSample&) {};
  std::vector<plant::ServoParams> params;
  std::vector<plant::ServoState> states;
  std::vector<ServoOutputs> told;  // last set points, by axis

 private:
  const double period_s_;
};

}  // namespace takt::engine
