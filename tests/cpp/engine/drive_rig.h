// An engine in lock step with external drives, axis by axis.
#pragma once

#include <map>
#include <stdexcept>

#include "remote_plant.h"

namespace takt::engine {

inline constexpr std::uint32_t kMissing = 5;  // consecutive answers

// Three axes, each with another kind of drive, and an independent one.
inline Machine AxisPerMode() {
  const char* text = R"(
name: modes
axes:
  - name: csp
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
  - name: csv
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    drive: {mode: cyclic_velocity}
    loop: {kp: 0.05, ki: 0.001, kd: 0.01, ff: 0.9, velocity_at_10v: 600}
  - name: analog
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    drive: {mode: analog}
    loop: {kp: 0.05, velocity_at_10v: 600}
  - name: other
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
)";
  LoadResult loaded = LoadMachine(text, "modes.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

// An engine with an external plant.
class DriveRig {
 public:
  explicit DriveRig(const Machine& m = WithExternalDrives(AxisPerMode(), kMissing), bool journal = false)
      : machine(m), engine(machine, {.drives = true, .journal = journal}), plant(machine) {}

  void Step() {
    plant.Serve(engine);
    engine.RunCycle();
    for (FeedbackEvent event; engine.feedback().TryPop(event);) last[event.ticket] = event;
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  Ticket Give(std::size_t axis, const axis::Command& body) {
    return engine.Submit(ToAxis(machine, machine.axes[axis].name, body));
  }
  Ticket Done(std::size_t axis, const axis::Command& body) {
    const Ticket ticket = Give(axis, body);
    for (int i = 0; i < 3000 && !IsFinal(last[ticket].state); ++i) Step();
    return ticket;
  }
  void PowerOn() {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) Give(i, axis::Power{});
    Run(200);
  }
  // Moves all at 100 u/s.
  void Move() {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) Give(i, axis::MoveVelocity{.velocity = 100});
    Run(300);
  }
  // From now on the drive of this axis does not answer.
  void Silence(std::size_t axis) {
    plant.answers = [axis](const DriveSample& s) { return s.axis != axis; };
  }
  void HearAll() {
    plant.answers = [](const DriveSample&) { return true; };
  }
  const axis::Outputs& At(std::size_t axis) const { return engine.outputs(axis); }

  const Machine machine;
  Engine engine;
  RemotePlant plant;
  std::map<Ticket, FeedbackEvent> last;
};

}  // namespace takt::engine
