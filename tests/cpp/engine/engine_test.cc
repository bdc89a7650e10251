// The whole engine: its descriptions, its first cycles, the order of axes.
#include "takt/engine/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machines.h"
#include "takt/axis/state.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"
#include "takt/engine/cycle.h"

namespace takt::engine {
namespace {

// EN-11: the descriptions of the machine file, the commands, the published state and the hashed state are complete.
TEST(Descriptions, AreComplete) {
  EXPECT_THAT(Verify(TypeOf<Machine>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<axis::Outputs>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<axis::State>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<plant::ServoState>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<group::Outputs>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<group::State>()), testing::IsEmpty());
  for (const Verb& verb : Verbs()) EXPECT_THAT(Verify(*verb.arguments), testing::IsEmpty()) << verb.name;
}

// EN-03: the follower is first in the file and still uses its master's set point of the same cycle, not of the previous
// one.
TEST(Order, FollowersSeeTheirMastersValueOfTheSameCycle) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  const std::size_t master = AxisNamed(machine, "y1");
  const std::size_t follower = AxisNamed(machine, "y2");
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(follower).state, axis::PlcState::kSynchronizedMotion);
  const double offset = engine.outputs(follower).set_position + engine.outputs(master).set_position;
  engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{.position = 100}));
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    engine.RunCycle();
    fastest = std::max(fastest, engine.outputs(master).set_velocity);
    ASSERT_EQ(engine.outputs(follower).set_velocity, -engine.outputs(master).set_velocity);
    ASSERT_NEAR(engine.outputs(follower).set_position, offset - engine.outputs(master).set_position, 1e-9);
  }
  EXPECT_GT(fastest, 100);
  // A motion command of its own is refused; a fault of the follower stops the master too.
  engine.Submit(ToAxis(machine, "y2", axis::MoveAbsolute{.position = 0}));
  engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 100, .direction = axis::Direction::kNegative}));
  for (int i = 0; i < 200; ++i) engine.RunCycle();
  engine.faults(follower).drive_fault = true;
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(master).state, axis::PlcState::kErrorStop);
  EXPECT_EQ(engine.outputs(master).set_velocity, 0);
}

// An axis that is being switched on is not disabled, though its drive is not ready yet.
TEST(Engine, IsNotDisabledWhileADriveGetsReady) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  EXPECT_TRUE(engine.all_disabled());
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.RunCycle();
  EXPECT_FALSE(engine.outputs(AxisNamed(machine, "y1")).loop_closed);
  EXPECT_FALSE(engine.all_disabled());
}

// The first cycle has the state of the machine, not zeros.
TEST(Engine, SeesTheMachineInItsFirstCycle) {
  Machine machine = FullMachine();
  machine.simulation.servos[0].switches.limit_positive.from = -1;
  machine.simulation.servos[0].mechanics.start_position = 10;
  Engine engine(machine);
  engine.RunCycle();
  EXPECT_TRUE(engine.outputs(AxisNamed(machine, "z")).limit_positive);
  EXPECT_NEAR(engine.outputs(AxisNamed(machine, "z")).actual_position, 10, 0.01);
}

}  // namespace
}  // namespace takt::engine
