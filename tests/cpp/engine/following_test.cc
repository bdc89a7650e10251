// Axes that follow a master: coupling, their set points, faults on either side.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

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

// Both axes rotate fast; one turn of the master is one of the follower.
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

// AX-10: it refuses motion commands of its own and is not disturbed by them. (Halt and stop of a follower apply to the
// master: AX-101.)
TEST(Following, RefusesCommandsOfItsOwn) {
  Couple c(Pair(2));
  c.PowerOn();
  ASSERT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
  c.Give(kMaster, axis::MoveAbsolute{.position = 100});
  c.Run(50);
  for (const axis::Command& own :
       {axis::Command(axis::MoveAbsolute{.position = 5}), axis::Command(axis::MoveSuperimposed{.distance = 5}),
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

// AX-101: the master does not move until its follower is powered, without a fault and in position; then at once, in
// step.
TEST(Following, TheMasterWaitsForItsFollower) {
  for (const int pause : {0, 1, 2, 3, 5, 50}) {
    Couple c(Pair(1));
    c.Give(kMaster, axis::Power{});
    c.Run(300);
    for (const axis::Command& move :
         {axis::Command(axis::MoveAbsolute{.position = 3}), axis::Command(axis::MoveVelocity{.velocity = 5}),
          axis::Command(axis::MoveSuperimposed{.distance = 3}), axis::Command(axis::Jog{.forward = true}),
          axis::Command(axis::StepAbsSwitch{.velocity = 5})}) {
      const Ticket ticket = c.Give(kMaster, move);
      c.Run(1);
      EXPECT_EQ(c.last.ticket, ticket);
      EXPECT_EQ(c.last.error, ErrorId::kNotInStep);
    }
    c.Give(kFollower, axis::Power{});
    while (!c.follower().loop_closed) c.Run(1);
    c.Run(pause);
    c.Give(kMaster, axis::MoveAbsolute{.position = 100});
    for (int i = 0; i < 1000; ++i) {
      c.Run(1);
      ASSERT_NEAR(c.follower().set_position, c.master().set_position, 1e-9) << pause;
    }
    EXPECT_NEAR(c.master().set_position, 100, 1e-9);
    EXPECT_TRUE(c.follower().in_step);
  }
}

// AX-02: over thousands of turns of either, which are removed from their positions from time to time.
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
    // Coupled again after that, it keeps its position.
    c.Give(kMaster, axis::Halt{});
    c.Run(1000);
    c.Give(kFollower, axis::Power{.enable = false});
    c.Run(100);
    ASSERT_EQ(c.follower().state, PlcState::kDisabled);
    ASSERT_EQ(c.master().state, PlcState::kDisabled);  // AX-101: switching one off switches all off
    const double stands = c.follower().actual_position;
    c.PowerOn();
    EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
    EXPECT_NEAR(c.follower().set_position, stands, 0.02);
    EXPECT_LT(std::abs(c.follower().following_error), 0.1);
  }
}

// The master's loop opens in motion: the follower stops along its own ramp, and couples again later.
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

// A fault of the follower: the master stops with error 7, its loop closed; a master at rest has no fault, and does not
// start to move (AX-101). After a reset of both they are coupled again.
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
  EXPECT_EQ(c.last.error, ErrorId::kNotInStep);
  EXPECT_EQ(c.master().set_position, 0);
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
  // AX-113: in motion, the axis with the fault is named.
  c.Give(kMaster, axis::MoveVelocity{.velocity = 400});
  c.Run(300);
  c.engine.faults(kFollower).drive_fault = true;
  c.Run(10);
  EXPECT_EQ(c.master().state, PlcState::kErrorStop);
  EXPECT_EQ(c.master().error, ErrorId::kAxisFault);
  EXPECT_EQ(c.master().fault_of, kFollower + 1);
  EXPECT_EQ(c.last.error, ErrorId::kAxisFault);
  EXPECT_EQ(c.last.object, (ObjectInfo{ObjectKind::kAxis, kFollower + 1}));
  EXPECT_TRUE(c.master().loop_closed);
}

// AX-83: a follower that was switched on while on a limit switch is not moved further out by its master.
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
      EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
      EXPECT_EQ(c.last.error, way == side ? ErrorId::kAwayFromLimitOnly : ErrorId::kNone);
      EXPECT_NEAR(c.follower().set_position, way == side ? 0 : way * 0.5, 1e-9);
    }
  }
}

// AX-05: the narrower limit of the following error at rest holds for a follower once it had time to settle, too.
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

// AX-101: if one of them is stopped for any reason, all stop together, along the master's ramp and in step.
TEST(Following, WhatStopsOneStopsAll) {
  struct Cause {
    const char* name;
    void (*happens)(Couple& c);
    PlcState master, follower;
    std::optional<std::size_t> on_switch{};
  };
  const Cause causes[] = {
      {"stop of the master", [](Couple& c) { c.Give(kMaster, axis::Stop{}); }, PlcState::kStandstill,
       PlcState::kSynchronizedMotion},
      {"stop of the follower", [](Couple& c) { c.Give(kFollower, axis::Stop{}); }, PlcState::kStandstill,
       PlcState::kSynchronizedMotion},
      {"halt of the follower", [](Couple& c) { c.Give(kFollower, axis::Halt{}); }, PlcState::kStandstill,
       PlcState::kSynchronizedMotion},
      {"power off of the master", [](Couple& c) { c.Give(kMaster, axis::Power{.enable = false}); }, PlcState::kDisabled,
       PlcState::kDisabled},
      {"power off of the follower", [](Couple& c) { c.Give(kFollower, axis::Power{.enable = false}); },
       PlcState::kDisabled, PlcState::kDisabled},
      {"limit switch of the follower", [](Couple&) {}, PlcState::kErrorStop, PlcState::kErrorStop, kFollower},
      {"limit switch of the master", [](Couple&) {}, PlcState::kErrorStop, PlcState::kSynchronizedMotion, kMaster},
  };
  constexpr double kSwitch = 150;  // [u] of the master, further than its position at the other stops
  for (const double ratio : {1.0, 2.0}) {
    for (const Cause& cause : causes) {
      SCOPED_TRACE(cause.name);
      Machine machine = Pair(ratio);
      if (cause.on_switch) {
        SimulatedServo servo;
        servo.axis = machine.axes[*cause.on_switch].name;
        servo.encoder = ServoOf(machine, *cause.on_switch).encoder;
        servo.switches.limit_positive.from = kSwitch * (*cause.on_switch == kFollower ? ratio : 1);
        servo.switches.limit_positive.to = 10000;
        machine.simulation.servos = {servo};
      }
      Couple c(machine);
      c.PowerOn();
      c.Give(kMaster, axis::MoveVelocity{.velocity = 300});
      c.Run(400);
      ASSERT_NEAR(c.follower().set_velocity, 300 * ratio, 1e-9);
      cause.happens(c);
      for (int i = 0; i < 300 && c.master().loop_closed && c.follower().loop_closed; ++i) {
        c.Run(1);
        if (!c.master().loop_closed || !c.follower().loop_closed) break;
        ASSERT_NEAR(c.follower().set_position, ratio * c.master().set_position, 1e-9) << i;
        ASSERT_NEAR(c.follower().set_velocity, ratio * c.master().set_velocity, 1e-9) << i;
      }
      c.Run(20);
      EXPECT_EQ(c.master().set_velocity, 0);
      EXPECT_EQ(c.follower().set_velocity, 0);
      EXPECT_EQ(c.master().state, cause.master);
      EXPECT_EQ(c.follower().state, cause.follower);
      EXPECT_LT(std::abs(c.follower().skew), 0.5);
    }
  }
}

// AX-101: if a follower is at another position when it is powered again, that is a skew, and no new zero. Nothing moves
// until a command straightens it, at its velocity.
TEST(Following, ASkewSurvivesPowerOff) {
  Machine machine = Pair(1);
  machine.axes[kFollower].follows->skew_warning = 0.5;
  machine.axes[kFollower].follows->offset = 5;  // and it is at 0
  Couple c(machine);
  for (int times = 0; times < 3; ++times) {
    c.PowerOn();
    EXPECT_EQ(c.follower().state, PlcState::kSynchronizedMotion);
    EXPECT_FALSE(c.follower().in_step);
    EXPECT_TRUE(c.follower().skewed);
    EXPECT_NEAR(c.follower().skew, -5, 0.01);
    c.Give(kMaster, axis::MoveAbsolute{.position = 10});
    c.Run(5);
    EXPECT_EQ(c.last.error, ErrorId::kNotInStep);
    c.Give(times == 1 ? kMaster : kFollower, axis::Power{.enable = false});
    c.Run(50);
    ASSERT_EQ(c.follower().state, PlcState::kDisabled);
  }
  c.PowerOn();
  const Ticket straighten = c.Give(kFollower, axis::Straighten{.velocity = 20});
  double fastest = 0;
  for (int i = 0; i < 5000 && (c.last.ticket != straighten || c.last.state != FeedbackState::kDone); ++i) {
    c.Run(1);
    fastest = std::max(fastest, std::abs(c.follower().set_velocity));
    ASSERT_EQ(c.master().set_velocity, 0);
  }
  EXPECT_EQ(c.last.ticket, straighten);
  EXPECT_NEAR(fastest, 20, 1e-6);
  c.Run(500);
  EXPECT_TRUE(c.follower().in_step);
  EXPECT_FALSE(c.follower().skewed);
  EXPECT_NEAR(c.follower().skew, 0, 0.05);
  c.Give(kMaster, axis::MoveAbsolute{.position = 10});
  c.Run(1000);
  EXPECT_NEAR(c.follower().set_position, c.master().set_position + 5, 1e-9);
  c.Give(kMaster, axis::Power{.enable = false});
  c.Run(50);
  c.PowerOn();
  EXPECT_TRUE(c.follower().in_step);
}

// AX-101: a follower that lags too far stops all.
TEST(Following, SupervisesTheSkew) {
  Machine machine = Pair(1);
  machine.axes[kFollower].follows->largest_skew = 1;
  SimulatedServo servo;
  servo.axis = "f";
  servo.encoder = ServoOf(machine, kFollower).encoder;
  servo.mechanics.upper_stop = 40;
  machine.simulation.servos = {servo};
  Couple c(machine);
  c.PowerOn();
  c.Give(kMaster, axis::MoveAbsolute{.position = 100, .velocity = 100});
  c.Run(1500);
  EXPECT_EQ(c.follower().error, ErrorId::kSkew);
  EXPECT_EQ(c.follower().state, PlcState::kErrorStop);
  EXPECT_EQ(c.master().error, ErrorId::kAxisFault);
  EXPECT_EQ(c.master().fault_of, kFollower + 1);
  EXPECT_LT(c.master().set_position, 48);
  EXPECT_FALSE(c.follower().in_step);
}

}  // namespace
}  // namespace takt::engine
