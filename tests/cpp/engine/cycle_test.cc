// The stages over a world of plain data.
#include "takt/engine/cycle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "machines.h"

namespace takt::engine {
namespace {

void RunCycles(World& world, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    Sense(world);
    Move(world);
    Control(world);
    Actuate(world);
    world.feedback.Clear();
    ++world.cycle.count;
  }
}

// AX-82: one number of one axis that is not finite: every output is zero, every loop open, in the same cycle.
TEST(InternalFault, OpensAllLoops) {
  const Machine machine = FullMachine();
  World world(machine);
  for (const axis::AxisParams& axis : machine.axes) Apply(world, ToAxis(machine, axis.name, axis::Power{}));
  RunCycles(world, 300);
  Apply(world, ToAxis(machine, "z", axis::MoveVelocity{.velocity = 50}));
  RunCycles(world, 50);
  for (const axis::State& state : world.axis_states) ASSERT_TRUE(state.loop_closed);
  axis::State& broken = world.axis_states[AxisNamed(machine, "c")];
  broken.motion.profile = trajectory::Profile{{NAN, 0, 0}};
  Sense(world);
  Move(world);
  Control(world);
  for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
    EXPECT_FALSE(world.axis_states[i].loop_closed);
    EXPECT_EQ(world.axis_states[i].error, ErrorId::kInternal);
    EXPECT_FALSE(world.servo_outputs[i].enable);
    EXPECT_FALSE(world.servo_outputs[i].release_brake);
    EXPECT_EQ(world.servo_outputs[i].voltage_v, 0);
    EXPECT_EQ(world.servo_outputs[i].velocity_counts_s, 0);
    EXPECT_TRUE(std::isfinite(world.servo_outputs[i].position_counts));
    EXPECT_EQ(world.axis_outputs[i].state, axis::PlcState::kErrorStop);
  }
}

}  // namespace
}  // namespace takt::engine
