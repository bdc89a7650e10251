// The module's state machine (CAM-10, CAM-12).
#include <gtest/gtest.h>

#include "bench.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

using axis::AxisKind;

// CAM-10
TEST(States, ReadyNeedsEnableAlone) {
  Machine m = OneHill();
  Bench b(m);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  b.Tell(Control{.enable = false});
  b.Run(2);
  EXPECT_EQ(b.Module().state, ModuleState::kInit);
  const Ticket ticket = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kState);
  b.Tell(Control{.enable = true, .regulator_on = false});
  b.Run(200);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_FALSE(b.Module().axis_enabled);
}

// CAM-10: a request while the axis is off must be repeated.
TEST(States, AnEdgeBeforeTheAxisIsOnDoesNotCount) {
  Bench b(OneHill());
  b.Tell(Control{.regulator_on = false});
  b.Run(200);
  const Ticket early = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(early), ErrorId::kPowerOff);
  const Ticket jog = b.Tell(Jog{.positive = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(jog), ErrorId::kPowerOff);
  b.Tell(Control{.regulator_on = true});
  b.Run(400);
  EXPECT_TRUE(b.Module().axis_enabled);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  b.Tell(Control{.sync_cam = false});
  b.Run(2);
  EXPECT_TRUE(b.Sync());
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
}

// CAM-10
TEST(States, StopAndHaltLastAsLongAsTheyAreHeld) {
  for (const bool stop : {true, false}) {
    Settings s = QuickBothWays();
    s.stop_deceleration = 4000;
    s.halt_deceleration = 3000;
    Bench b(OneHill(s));
    b.Web(720);
    b.Run(200);
    ASSERT_TRUE(b.Sync());
    b.Run(117);
    Watch watch(b);
    b.Tell(stop ? Control{.stop = true} : Control{.halt = true});
    b.Run(500);
    EXPECT_EQ(b.Module().state, ModuleState::kStop);
    EXPECT_EQ(b.Knife().set_velocity, 0);
    b.Tell(Control{.sync_cam = false});
    b.Tell(Control{.sync_cam = true});
    b.Run(20);
    EXPECT_EQ(b.Module().state, ModuleState::kStop);
    b.Tell(stop ? Control{.stop = false} : Control{.halt = false});
    b.Run(5);
    EXPECT_EQ(b.Module().state, ModuleState::kReady);
    watch.ExpectSmooth();
  }
}

// CAM-10: the first key counts, and the module is ready again when no key is held.
TEST(States, Jogging) {
  Bench b(OneHill());
  const Ticket up = b.Tell(Jog{.positive = true});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kJogPos);
  EXPECT_NEAR(b.Knife().set_velocity, 10, 1e-9);  // the manual's initial lrJogVel
  b.Tell(Jog{.positive = true, .negative = true});
  b.Run(100);
  EXPECT_EQ(b.Module().state, ModuleState::kJogPos);
  EXPECT_EQ(b.Of(up), FeedbackState::kAborted);
  const Ticket sync = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(sync), ErrorId::kState);  // only when ready
  const Ticket none = b.Tell(Jog{});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_EQ(b.Of(none), FeedbackState::kDone);
  EXPECT_EQ(b.Knife().set_velocity, 0);
  b.Tell(Configure{.jog_velocity = 20.0});
  b.Tell(Jog{.negative = true});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kJogNeg);
  EXPECT_NEAR(b.Knife().set_velocity, -20, 1e-9);
}

// A key whose client is lost.
TEST(States, AJogEndsWithItsLease) {
  Bench b(OneHill());
  const Ticket jog = b.Tell(Jog{.positive = true}, 0.1);
  b.Run(90);
  EXPECT_EQ(b.Module().state, ModuleState::kJogPos);
  b.engine.Submit({0, 0, 0, engine::MachineCommand(engine::Renew{jog})});
  b.Run(60);
  EXPECT_EQ(b.Module().state, ModuleState::kJogPos);
  b.Run(400);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  const Ticket again = b.Tell(Jog{.positive = true}, 0.1);
  b.Run(20);
  b.engine.Submit({0, 0, 0, engine::MachineCommand(engine::Release{again})});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
}

// CAM-10
TEST(States, Homing) {
  Settings s = QuickBothWays();
  s.home_position = 77;
  Bench b(OneHill(s));
  const Ticket home = b.Tell(Control{.home_execute = true});
  b.Run(20);
  EXPECT_EQ(b.Of(home), FeedbackState::kDone);
  EXPECT_TRUE(b.Module().is_homed);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_NEAR(b.Knife().actual_position, 77, 1e-3);
}

// CAM-10: homing by the module's own section; resetting the input does not end it, a stop does.
TEST(States, HomingByTheModule) {
  Machine m = OneHill();
  m.flex_cams[0].settings.home_by_module = true;
  axis::HomingParams homing;
  homing.method = axis::HomingMethod::kSwitch;
  homing.direction = axis::HomingDirection::kPositive;
  homing.velocity = 50;
  m.flex_cams[0].homing = homing;
  Bench b(m);
  b.Tell(Control{.home_execute = true});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kHoming);
  b.Tell(Control{.home_execute = false});
  b.Run(200);
  EXPECT_EQ(b.Module().state, ModuleState::kHoming);
  EXPECT_GT(b.Knife().set_position, 10);
  b.Tell(Control{.home_abs_switch = true});
  ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kReady; }, 3000));
  EXPECT_TRUE(b.Module().is_homed);
  const Ticket again = b.Tell(Control{.home_execute = true, .home_abs_switch = false});
  b.Run(100);
  b.Tell(Control{.stop = true});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kStop);
  EXPECT_EQ(b.Of(again), FeedbackState::kAborted);
}

// CAM-10: commands of the axis' own.
TEST(States, Service) {
  Bench b(OneHill());
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 20, .velocity = 50});
  b.Run(20);
  EXPECT_EQ(b.Module().state, ModuleState::kService);
  const Ticket sync = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(sync), ErrorId::kState);
  b.Run(1000);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_EQ(b.Knife().set_position, 20);
  b.Tell(Control{.internal_control = true});
  b.Run(2);
  EXPECT_TRUE(b.Module().internal_control_active);
  EXPECT_EQ(b.Module().state, ModuleState::kService);
  b.Tell(Control{.stop = true});  // still effective
  b.Run(2);
  EXPECT_EQ(b.Module().state, ModuleState::kStop);
}

// A command of the axis during a cam takes over the slave, without a jump.
TEST(States, ACommandOfTheAxisTakesTheSlaveAway) {
  Bench b(OneHill());
  b.Web(360);
  b.Run(200);
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -10});
  b.Run(1500);
  EXPECT_EQ(b.Knife().set_position, -10);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_FALSE(b.Module().cam_synchronised);
  watch.ExpectSmooth();
}

// CAM-12: with the error numbers of the manual; only a reset ends it.
TEST(Limits, SwitchesAtTheModule) {
  struct Case {
    Control on, off;
    ErrorId error;
  };
  const Case cases[] = {
      {Control{.hw_limit_positive = true}, Control{.hw_limit_positive = false}, ErrorId::kModuleLimitSwitchPositive},
      {Control{.hw_limit_negative = true}, Control{.hw_limit_negative = false}, ErrorId::kModuleLimitSwitchNegative}};
  for (const Case& c : cases) {
    Settings s = QuickBothWays();
    s.stop_deceleration = 2500;
    s.stop_jerk = 200000;
    Bench b(OneHill(s));
    b.Web(720);
    b.Run(200);
    ASSERT_TRUE(b.Sync());
    b.Tell(c.on);  // not enabled
    b.Run(5);
    EXPECT_EQ(b.Module().state, ModuleState::kSync);
    b.Tell(c.off);
    b.Tell(Control{.enable_hw_limit = true});
    b.Run(50);
    Watch watch(b);
    b.Tell(c.on);
    b.Run(2);
    EXPECT_EQ(b.Module().state, ModuleState::kError);
    EXPECT_EQ(b.Module().error, c.error);
    b.Run(300);
    EXPECT_EQ(b.Knife().set_velocity, 0);
    EXPECT_LE(watch.jerk, 5e6 * (1 + 1e-6));
    b.Tell(c.off);
    b.Run(10);
    EXPECT_EQ(b.Module().state, ModuleState::kError);
    b.Tell(Control{.reset_error = true});
    b.Run(5);
    EXPECT_EQ(b.Module().state, ModuleState::kReady);
    EXPECT_EQ(b.Module().error, ErrorId::kNone);
    watch.ExpectSmooth();
  }
}

// CAM-12
TEST(Limits, SoftLimitsOfTheSlave) {
  for (const double sense : {1.0, -1.0}) {
    Machine m = MachineOf({UpAndDown("hill", 50 * sense)}, QuickBothWays());
    m.axes[Bench::kKnife].limits.lower = -40;
    m.axes[Bench::kKnife].limits.upper = 40;
    Bench b(m);
    b.Web(360);
    b.Run(200);
    ASSERT_TRUE(b.Sync());
    Watch watch(b);
    ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kError; }, 3000));
    b.Run(300);
    EXPECT_EQ(b.Module().error, sense > 0 ? ErrorId::kModuleSoftLimitPositive : ErrorId::kModuleSoftLimitNegative);
    EXPECT_EQ(static_cast<int>(b.Module().error), sense > 0 ? 20306 : 20307);
    EXPECT_TRUE(b.Module().sw_limit_enabled);
    EXPECT_TRUE(b.Module().sw_limit_switch_active);
    EXPECT_LE(std::abs(b.Knife().set_position), 40);
    EXPECT_EQ(b.Knife().set_velocity, 0);
    watch.ExpectSmooth();
  }
}

// CAM-12: the switches of the axis itself.
TEST(Limits, SwitchesOfTheSlave) {
  Machine m = OneHill();
  engine::SimulatedServo servo;
  servo.axis = "knife";
  servo.switches.limit_positive.from = 49;
  const plant::ServoParams ideal = engine::ServoOf(m, Bench::kKnife);
  servo.drive = ideal.drive;
  servo.mechanics = ideal.mechanics;
  m.simulation.servos = {servo};
  Bench b(m);
  b.Web(360);
  b.Run(200);
  ASSERT_TRUE(b.Sync());
  ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kError; }, 3000));
  EXPECT_EQ(static_cast<int>(b.Module().error), 20500);
  EXPECT_TRUE(b.Module().hw_limit_switch_positive);
}

// Every ticket ends, once, with any commands in the same cycle; a refused request does not affect the running action.
TEST(Tickets, End) {
  Bench b(OneHill());
  b.Web(360);
  b.Run(200);
  const Ticket in = b.Tell(Control{.sync_cam = true});
  const Ticket out = b.Tell(Control{.sync_cam = false});
  b.Run(3);
  EXPECT_EQ(b.Of(in), FeedbackState::kAborted);
  EXPECT_EQ(b.Of(out), FeedbackState::kDone);
  EXPECT_FALSE(b.Module().busy);
  const Ticket again = b.Tell(Control{.sync_cam = true});
  b.Run(20);
  const Ticket home = b.Tell(Control{.home_execute = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(home), ErrorId::kState);
  EXPECT_EQ(b.Of(again), FeedbackState::kActive);
  b.Run(300);
  EXPECT_EQ(b.Of(again), FeedbackState::kDone);
  b.Tell(Control{.stop = true});
  b.Run(200);
  b.Tell(Control{.stop = false});
  b.Run(10);
  const Ticket no_edge = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(no_edge), ErrorId::kState);  // the level has been set since before the stop
}

// A key that was pressed when something else began causes no motion later.
TEST(States, AJogDoesNotWait) {
  Bench b(OneHill());
  const Ticket jog = b.Tell(Jog{.positive = true});
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 20, .velocity = 50});
  b.Run(1500);
  EXPECT_EQ(b.Of(jog), FeedbackState::kAborted);
  EXPECT_EQ(b.Knife().set_velocity, 0);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
}

// Switching off always works, and an error is not cleared by disabling.
TEST(States, DisablingForgetsNothing) {
  Bench b(OneHill());
  b.Tell(Control{.enable = false});
  b.Run(2);
  b.Tell(Control{.regulator_on = false});
  b.Run(50);
  EXPECT_FALSE(b.Module().axis_enabled);
  b.Tell(Control{.enable = true, .regulator_on = true, .enable_hw_limit = true});
  b.Run(200);
  b.Tell(Control{.hw_limit_positive = true});
  b.Run(5);
  ASSERT_EQ(b.Module().state, ModuleState::kError);
  b.Tell(Control{.enable = false});
  b.Run(5);
  b.Tell(Control{.enable = true});
  b.Run(5);
  EXPECT_EQ(b.Module().state, ModuleState::kError);
  EXPECT_EQ(b.Module().error, ErrorId::kModuleLimitSwitchPositive);
}

// While held, nothing else moves the slave either; stops held by others are not released.
TEST(States, HeldIsHeld) {
  for (const Control& hold : {Control{.halt = true}, Control{.stop = true}}) {
    Bench b(OneHill());
    b.Tell(hold);
    b.Run(20);
    b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 20});
    b.Run(1000);
    EXPECT_LT(std::abs(b.Knife().set_position), 0.1);
    EXPECT_EQ(b.Module().state, ModuleState::kStop);
  }
  Bench b(OneHill());
  b.Give(Bench::kKnife, axis::Stop{.hold = true});
  b.Run(10);
  b.Tell(Control{.enable = false});
  b.Run(10);
  EXPECT_EQ(b.Knife().state, axis::PlcState::kStopping);
}

// The section of the module only applies to its own homing.
TEST(States, HomingByTheModuleLeavesTheAxisItsOwn) {
  Machine m = OneHill();
  m.flex_cams[0].settings.home_by_module = true;
  axis::HomingParams homing;
  homing.method = axis::HomingMethod::kSwitch;
  homing.velocity = 50;
  m.flex_cams[0].homing = homing;
  Bench b(m);
  b.Tell(Control{.home_execute = true});
  b.Run(200);
  b.Tell(Control{.stop = true});
  b.Run(100);
  b.Tell(Control{.stop = false});
  b.Run(20);
  const Ticket home = b.Give(Bench::kKnife, axis::Home{.position = 5});
  b.Run(20);
  EXPECT_EQ(b.Of(home), FeedbackState::kDone);  // at once, by the axis' own section
}

}  // namespace
}  // namespace takt::flexcam
