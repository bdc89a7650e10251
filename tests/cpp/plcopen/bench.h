// A machine with a cyclic program on it, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "takt/engine/load.h"
#include "takt/plcopen/blocks.h"

namespace takt::plcopen {

// w lags behind, and beyond 200 mm/s too far: a fault that opens the loop. The drive of r comes too late to be ready.
inline const char* kMachine = R"(
name: bench
axes:
  - name: x
    limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -10, upper: 1000}
    encoder: {increments_per_unit: 1000}
  - name: r
    unit: deg
    kind: rotary
    limits: {velocity: 360, acceleration: 3600, jerk: 36000}
    encoder: {increments_per_unit: 1000}
    drive: {ready_timeout_s: 0.1}
  - name: y
    limits: {velocity: 1000, acceleration: 10000, jerk: 200000}
    encoder: {increments_per_unit: 1000}
  - name: w
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    encoder: {increments_per_unit: 1000}
    supervision: {deviation_moving: 2}
cams:
  - {name: lift, cyclic: true, points: [{x: 0, y: 0, v: 0, a: 0}, {x: 40, y: 10, v: 0, a: 0}]}
groups:
  - name: pair
    axes: [x, y]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 300, acceleration: 3000, jerk: 60000}
    base: {y: 20, c: 180}
belts:
  - {name: feed, axis: w, origin: {y: 20, c: 180}}
paths:
  - {name: hook, elements: [{shape: line, to: {x: 40, y: 0, z: 0}}, {shape: line, to: {x: 40, y: 20, z: 0}}]}
simulation:
  servos:
    - {axis: x, switches: {touch_probe: {from: 60, to: 70}}}
    - {axis: w, drive: {velocity_feed_forward: 0, position_gain: 100}}
    - {axis: r, drive: {power_up_s: 0.2}}
)";

inline engine::Machine TheMachine() {
  engine::LoadResult loaded = engine::LoadMachine(kMachine, "bench.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

class Bench {
 public:
  Bench()
      : engine(TheMachine()),
        program(engine),
        x(program.Axis("x")),
        r(program.Axis("r")),
        y(program.Axis("y")),
        w(program.Axis("w")) {}

  // A cycle, after which blocks are to be called.
  void Step(int cycles = 1) {
    for (; cycles > 0; --cycles) {
      engine.RunCycle();
      program.Update();
    }
  }
  // Calls the block before every cycle until the condition holds.
  template <typename B, typename F>
  bool Until(B& block, F condition, int cycles = 5000) {
    for (; cycles > 0; --cycles) {
      block();
      if (condition()) return true;
      Step();
    }
    return false;
  }
  template <typename F>
  bool Until(F condition, int cycles = 5000) {
    for (; cycles > 0 && !condition(); --cycles) Step();
    return condition();
  }
  void PowerOn(AxisRef axis) {
    MC_Power power(axis);
    power.Enable = true;
    ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  }
  axis::PlcState State(AxisRef axis) const { return axis.outputs().state; }

  engine::Engine engine;
  Program program;
  AxisRef x, r, y, w;
};

// A bench with x ready to move.
class Blocks : public testing::Test {
 protected:
  void SetUp() override { bench.PowerOn(bench.x); }
  void Step(int cycles = 1) { bench.Step(cycles); }
  template <typename B, typename F>
  bool Until(B& block, F condition) {
    return bench.Until(block, condition);
  }
  const axis::Outputs& At(AxisRef axis) const { return axis.outputs(); }

  Bench bench;
  AxisRef x = bench.x;
};

// How many of the outputs that exclude one another are true.
template <typename B>
int Shown(const B& block) {
  return block.Busy() + block.Done() + block.Error() + block.CommandAborted();
}

}  // namespace takt::plcopen
