// Axes that follow a master: coupling, the way of their set points, faults on either side.
#include <gtest/gtest.h>

#include <cmath>

#include "machines.h"

namespace takt::engine {
namespace {

using axis::PlcState;

constexpr std::size_t kMaster = 0;
constexpr std::size_t kFollower = 1;

Machine Pair(double ratio) {
  Machine machine;
  machine.name = "pair";
  for (const char* name : {"m", "f"}) {
    axis::AxisParams a;
    a.name = name;
    a.limits.velocity = 500;
    a.limits.acceleration = 5000;
    a.limits.jerk = 100000;
    a.encoder.increments_per_unit = 10000;
    machine.axes.push_back(a);
  }
  machine.axes[kFollower].limits.velocity *= std::abs(ratio);
  machine.axes[kFollower].limits.acceleration *= std::abs(ratio);
  machine.axes[kFollower].limits.jerk *= std::abs(ratio);
  machine.axes[kFollower].follows = axis::Following{"m", ratio};
  return machine;
}

// Both axes turn fast; one turn of the master is one of the follower.
Machine FastPair(axis::AxisKind follower) {
  Machine machine = Pair(1);
  for (axis::AxisParams& a : machine.axes) {
    a.limits.velocity = 36000;
    a.limits.acceleration = 360000;
    a.limits.jerk = 36000000;
    a.encoder.increments_per_unit = 100;
    a.supervision.deviation_moving = 5;
    a.kind = axis::AxisKind::kRotary;
  }
  machine.axes[kFollower].kind = follower;
  return machine;
}

class Couple {
 public:
  explicit Couple(const Machine& m) : machine(m), engine(machine) {}

  Ticket Give(std::size_t axis, const axis::Command& body) {
    return engine.Submit(ToAxis(machine, machine.axes[axis].name, body));
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      engine.RunCycle();
      for (FeedbackEvent event; engine.feedback().TryPop(event);) last = event;
    }
  }
  void PowerOn() {
    Give(kMaster, axis::Power{});
    Give(kFollower, axis::Power{});
    Run(300);
  }
  const axis::Outputs& master() const { return engine.outputs(kMaster); }
  const axis::Outputs& follower() const { return engine.outputs(kFollower); }

  Machine machine;
  Engine engine;
  FeedbackEvent last;
};

// AX-10: it takes no motion commands of its own and does not let itself be disturbed by one.
TEST(Following, RefusesCommandsOfItsOwn) {
  Couple c(Pair(2));
  c.PowerOn();
  ASSERT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  c.Give(kMaster, axis::MoveAbsolute{.position = 100});
  c.Run(50);
  for (const axis::Command& own :
       {axis::Command(axis::MoveAbsolute{.position = 5}), axis::Command(axis::Halt{}), axis::Command(axis::Stop{}),
        axis::Command(axis::MoveVelocity{.velocity = 5}), axis::Command(axis::Jog{.forward = true})}) {
    const Ticket ticket = c.Give(kFollower, own);
    c.Run(1);
    EXPECT_EQ(c.last.ticket, ticket);
    EXPECT_EQ(c.last.error, ErrorId::kState);
  }
  c.Run(1000);
  EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  EXPECT_NEAR(c.follower().set_position, 200, 1e-9);
}

// EN-03: position, velocity and acceleration are the master's times the ratio.
TEST(Following, MovesAsTheMasterTimesTheRatio) {
  for (const double ratio : {2.0, -0.5}) {
    Couple c(Pair(ratio));
    c.PowerOn();
    c.Give(kMaster, axis::MoveAbsolute{.position = 100});
    for (int i = 0; i < 500; ++i) {
      c.Run(1);
      ASSERT_NEAR(c.follower().set_position, ratio * c.master().set_position, 1e-9);
      ASSERT_EQ(c.follower().set_velocity, ratio * c.master().set_velocity);
      ASSERT_EQ(c.follower().set_acceleration, ratio * c.master().set_acceleration);
    }
  }
}

// It couples when both stand with their loops closed, not before.
TEST(Following, WaitsUntilTheMasterStandsWithItsLoopClosed) {
  Couple c(Pair(1));
  c.Give(kFollower, axis::Power{});
  for (int i = 0; i < 300; ++i) {
    c.Run(1);
    ASSERT_TRUE(c.follower().state == PlcState::kDisabled || c.follower().state == PlcState::kStandstill);
  }
  c.Give(kFollower, axis::Power{.enable = false});
  c.Give(kMaster, axis::Power{});
  c.Run(300);
  c.Give(kMaster, axis::MoveAbsolute{.position = 300});
  c.Run(100);
  c.Give(kFollower, axis::Power{});
  c.Run(300);
  ASSERT_NE(c.master().set_velocity, 0);
  EXPECT_EQ(c.follower().state, PlcState::kStandstill);
  EXPECT_EQ(c.follower().set_velocity, 0);
  c.Run(1000);
  ASSERT_EQ(c.master().state, PlcState::kStandstill);
  EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  EXPECT_NEAR(c.follower().set_position, 0, 1e-9);
}

// AX-02: over thousands of turns of either, which are taken out of their positions now and then.
TEST(Following, GoesOnOverThousandsOfTurns) {
  for (const axis::AxisKind kind : {axis::AxisKind::kLinear, axis::AxisKind::kRotary}) {
    Couple c(FastPair(kind));
    c.PowerOn();
    ASSERT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
    c.Give(kMaster, axis::MoveVelocity{.velocity = 36000});
    c.Run(1000);
    for (int i = 0; i < 22000; ++i) {  // 2200 turns
      const double before = c.follower().set_position;
      c.Run(1);
      const double step = c.follower().set_position - before;
      ASSERT_NEAR(kind == axis::AxisKind::kLinear ? step : std::remainder(step, 360.0), 36, 1e-6) << i;
      ASSERT_LT(std::abs(c.follower().following_error), 1) << i;
      ASSERT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
    }
    // And coupled anew after that it stays where it is.
    c.Give(kMaster, axis::Halt{});
    c.Run(1000);
    c.Give(kFollower, axis::Power{.enable = false});
    c.Run(100);
    ASSERT_EQ(c.follower().state, PlcState::kDisabled);
    const double stands = c.follower().actual_position;
    c.Give(kFollower, axis::Power{});
    c.Run(300);
    EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
    EXPECT_NEAR(c.follower().set_position, stands, 0.02);
    EXPECT_LT(std::abs(c.follower().following_error), 0.1);
  }
}

// The master's loop opens in motion: the follower comes to rest along its own ramp, and couples again later.
TEST(Following, ComesToRestWhenTheMasterIsLost) {
  Couple c(Pair(1));
  c.PowerOn();
  c.Give(kMaster, axis::MoveVelocity{.velocity = 400});
  c.Run(500);
  c.engine.faults(kMaster).drive_fault = true;
  axis::Outputs before = c.follower();
  for (int i = 0; i < 300; ++i) {
    c.Run(1);
    const axis::Outputs& now = c.follower();
    ASSERT_NEAR(now.set_position - before.set_position, 0.0005 * (now.set_velocity + before.set_velocity), 1e-5) << i;
    ASSERT_LE(std::abs(now.set_acceleration), 5000 * (1 + 1e-9));
    ASSERT_LE(std::abs(now.set_acceleration - before.set_acceleration), 100 * (1 + 1e-6)) << i;
    before = now;
  }
  EXPECT_EQ(c.master().state, PlcState::kErrorStop);
  EXPECT_EQ(c.follower().state, PlcState::kStandstill);
  EXPECT_TRUE(c.follower().loop_closed);
  EXPECT_EQ(c.follower().set_velocity, 0);
  c.engine.faults(kMaster).drive_fault = false;
  c.Run(10);
  c.Give(kMaster, axis::Reset{});
  c.Run(10);
  c.Give(kMaster, axis::Power{});
  c.Run(300);
  EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
}

// A fault of the follower: the master stops with error 7, its loop closed; one that stands has no fault, but does not
// get far. After a reset of both they are coupled again.
TEST(Following, FaultStopsTheMaster) {
  Couple c(Pair(1));
  c.PowerOn();
  c.engine.faults(kFollower).drive_fault = true;
  c.Run(10);
  EXPECT_EQ(c.follower().state, PlcState::kErrorStop);
  EXPECT_EQ(c.master().state, PlcState::kStandstill);
  EXPECT_EQ(c.master().error, ErrorId::kNone);
  c.Give(kMaster, axis::MoveVelocity{.velocity = 400});
  c.Run(20);
  EXPECT_EQ(c.master().state, PlcState::kErrorStop);
  EXPECT_EQ(c.master().error, ErrorId::kAxisFault);
  EXPECT_TRUE(c.master().loop_closed);
  EXPECT_LT(c.master().set_position, 0.01);
  c.engine.faults(kFollower).drive_fault = false;
  c.Run(10);
  c.Give(kMaster, axis::Reset{});
  c.Give(kFollower, axis::Reset{});
  c.Run(10);
  c.Give(kFollower, axis::Power{});
  c.Run(300);
  EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  c.Give(kMaster, axis::MoveAbsolute{.position = 50});
  c.Run(1000);
  EXPECT_NEAR(c.follower().set_position - c.master().set_position, 0, 0.01);
  EXPECT_EQ(c.master().state, PlcState::kStandstill);
}

// AX-83: a follower that was switched on while it stood on a limit switch is not taken further out by its master.
TEST(Following, DoesNotFollowFurtherOntoALimitSwitch) {
  for (const double side : {1.0, -1.0}) {
    Machine machine = Pair(1);
    SimulatedServo servo;
    servo.axis = "f";
    servo.encoder = ServoOf(machine, kFollower).encoder;
    plant::ServoSwitch& limit = side > 0 ? servo.switches.limit_positive : servo.switches.limit_negative;
    limit.from = -1;
    limit.to = 1000;
    if (side < 0) limit.from = -1000, limit.to = 1;
    machine.simulation.servos = {servo};
    for (const double way : {-side, side}) {
      Couple c(machine);
      c.PowerOn();
      ASSERT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
      c.Give(kMaster, axis::MoveAbsolute{.position = way * 0.5});
      c.Run(300);
      if (way == side) {
        EXPECT_EQ(c.follower().state, PlcState::kErrorStop);
        EXPECT_EQ(c.follower().error, side > 0 ? ErrorId::kLimitSwitchPositive : ErrorId::kLimitSwitchNegative);
        EXPECT_EQ(c.master().error, ErrorId::kAxisFault);
        EXPECT_LT(std::abs(c.follower().set_position), 0.1);
      } else {
        EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
      }
    }
  }
}

// AX-05: the narrower limit of the following error at rest holds for a follower when it had time to settle, too.
TEST(Following, HasTimeToSettle) {
  Machine machine = Pair(1);
  axis::AxisParams& f = machine.axes[kFollower];
  f.drive.mode = DriveMode::kCyclicVelocity;
  f.loop.kp = 0.05;
  f.loop.ff = 0;
  f.loop.velocity_at_10v = 1000;
  f.supervision.deviation_moving = 10;
  f.supervision.deviation_standstill = 0.5;
  f.supervision.in_position_timeout_s = 0.5;
  Couple c(machine);
  c.PowerOn();
  c.Run(1000);
  c.Give(kMaster, axis::MoveAbsolute{.position = 100, .velocity = 300});
  double largest_at_rest = 0;
  for (int i = 0; i < 1500; ++i) {
    c.Run(1);
    if (c.follower().set_velocity == 0 && c.master().set_position > 50) {
      largest_at_rest = std::max(largest_at_rest, std::abs(c.follower().following_error));
    }
  }
  EXPECT_GT(largest_at_rest, 0.5);
  EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  EXPECT_EQ(c.follower().error, ErrorId::kNone);
}

// AX-13: the master brakes without a step of its set point, too.
TEST(Following, FaultInMotionBrakesTheMasterSmoothly) {
  Couple c(Pair(1));
  c.PowerOn();
  c.Give(kMaster, axis::MoveVelocity{.velocity = 400});
  c.Run(500);
  c.engine.faults(kFollower).drive_fault = true;
  axis::Outputs before = c.master();
  for (int i = 0; i < 300; ++i) {
    c.Run(1);
    const axis::Outputs& now = c.master();
    ASSERT_NEAR(now.set_position - before.set_position, 0.0005 * (now.set_velocity + before.set_velocity), 1e-5) << i;
    ASSERT_LE(std::abs(now.set_acceleration - before.set_acceleration), 100 * (1 + 1e-6)) << i;
    before = now;
  }
  EXPECT_EQ(c.master().error, ErrorId::kAxisFault);
  EXPECT_EQ(c.master().set_velocity, 0);
}

}  // namespace
}  // namespace takt::engine
