// PP-02 to PP-05, PP-20: states, jog, homing, stops.
#include <set>

#include "cell.h"

namespace takt::pickplace {
namespace {

using M = PickPlaceState;

Ticket Begin(Cell& cell) {
  cell.Do(To(400, 0, 0));
  const Ticket ticket = cell.Execute();
  cell.Step();
  return ticket;
}

// PP-02: the table has every state, no transition twice, and transitions from each state to INIT and out of it.
TEST(StateTable, IsSound) {
  std::set<std::pair<M, M>> seen;
  std::set<M> from, to;
  for (const Transition& t : kTransitions) {
    EXPECT_NE(t.from, t.to);
    EXPECT_TRUE(seen.insert({t.from, t.to}).second);
    EXPECT_NE(std::string_view(t.by), "");
    from.insert(t.from);
    to.insert(t.to);
  }
  EXPECT_EQ(from.size(), static_cast<std::size_t>(kModuleStates));
  EXPECT_EQ(to.size(), static_cast<std::size_t>(kModuleStates));
  for (int s = 1; s < kModuleStates; ++s) EXPECT_TRUE(IsLegal(static_cast<M>(s), M::kInit)) << s;
  EXPECT_FALSE(IsLegal(M::kReady, M::kPathInterrupt));
  EXPECT_FALSE(IsLegal(M::kError, M::kMovePp));
  EXPECT_FALSE(IsLegal(M::kStop, M::kMovePp));
}

// PP-02: requests while the axes are off have to be repeated.
TEST(States, EdgesWhileOffAreLost) {
  Cell cell;
  cell.Step();
  EXPECT_EQ(cell.state.state, M::kReady);
  const Ticket off = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.rig.lives[off].error_id, ErrorId::kPowerOff);
  const Ticket jog = cell.Do(Jog{.positive = true});
  EXPECT_EQ(cell.rig.lives[jog].error_id, ErrorId::kPowerOff);
  cell.Do(Control{.regulator_on = true});
  ASSERT_TRUE(cell.RunUntil([&] { return IsOn(cell.Now(), cell.rig.state); }, 1));
  cell.Steps(50);
  EXPECT_EQ(cell.state.state, M::kReady);
  const Ticket on = cell.Execute();
  cell.Step();
  EXPECT_FALSE(cell.rig.lives[on].ended());
}

// PP-02: enable false: INIT, from every state; the path is dropped.
TEST(States, Disable) {
  Cell cell;
  cell.Start();
  const Ticket ticket = Begin(cell);
  cell.Steps(100);
  cell.Do(Control{.enable = false});
  EXPECT_EQ(cell.state.state, M::kInit);
  EXPECT_TRUE(cell.rig.lives[ticket].aborted);
  EXPECT_TRUE(cell.RunUntil([&] { return IsFree(cell.Now(), cell.rig.state); }, 2));
  cell.Do(Control{.enable = true});
  EXPECT_EQ(cell.state.state, M::kReady);
}

// PP-02: motions of the group that are not the module's, and internal control, are SERVICE; execute is refused there.
TEST(States, Service) {
  Cell cell;
  cell.Start();
  cell.rig.Give(group::MoveLinearAbsolute{.x = 50});
  cell.Steps(3);
  EXPECT_EQ(cell.state.state, M::kService);
  const Ticket ticket = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.rig.lives[ticket].error_id, ErrorId::kState);
  EXPECT_TRUE(cell.RunTo(M::kReady, 2));
  EXPECT_LT(cell.Off(50, 0, 0), 1e-6);
  cell.Do(Control{.internal_control = true});
  EXPECT_EQ(cell.state.state, M::kService);
  EXPECT_TRUE(cell.out().internal_control_active);
  cell.Do(Control{.internal_control = false});
  EXPECT_EQ(cell.state.state, M::kReady);
}

// PP-20: path_stop and path_halt stop on the path; STOP until released; the next edge continues from there.
TEST(Stops, OnThePathAndOn) {
  for (const bool halt : {false, true}) {
    SCOPED_TRACE(halt);
    Cell cell;
    cell.Start();
    const Ticket ticket = Begin(cell);
    cell.Steps(180);
    EXPECT_EQ(cell.state.state, M::kMovePp);
    cell.Do(halt ? Control{.path_halt = true} : Control{.path_stop = true});
    EXPECT_EQ(cell.state.state, M::kStop);
    ASSERT_TRUE(cell.RunUntil([&] { return cell.out().path_hold; }, 2));
    const KDL::Vector held = cell.tool();
    EXPECT_GT(held.z(), 20);  // on the leg across
    EXPECT_LT(held.z(), 30);
    EXPECT_GT(held.x(), 10);
    EXPECT_LT(held.x(), 390);
    cell.Steps(50);
    EXPECT_EQ(cell.state.state, M::kStop);
    const Ticket early = cell.Execute();
    cell.Step();
    EXPECT_EQ(cell.rig.lives[early].error_id, ErrorId::kState);
    cell.Do(halt ? Control{.path_halt = false} : Control{.path_stop = false});
    EXPECT_EQ(cell.state.state, M::kReady);
    EXPECT_TRUE(cell.out().path_hold);
    EXPECT_LT((cell.tool() - held).Norm(), 1e-9);
    EXPECT_FALSE(cell.rig.lives[ticket].ended());
    const Ticket on = cell.Execute();
    cell.Step();
    EXPECT_TRUE(cell.rig.lives[on].done);
    EXPECT_EQ(cell.state.state, M::kMovePp);
    ASSERT_TRUE(cell.RunToEnd(ticket, 5));
    EXPECT_TRUE(cell.rig.lives[ticket].done);
    EXPECT_LT(cell.Off(400, 0, 0), 1e-9);
  }
}

// PP-30: a path that was stopped has no pulse.
TEST(Stops, NoPulseBehindAStop) {
  Settings s = Fast();
  s.gripper_closing_time = 0.05;
  Cell cell(s);
  cell.Start();
  const Ticket ticket = Begin(cell);
  cell.Steps(150);
  EXPECT_TRUE(cell.out().gripper_control_active);
  cell.Do(Control{.path_stop = true});
  EXPECT_FALSE(cell.out().gripper_control_active);
  cell.Steps(300);
  cell.Do(Control{.path_stop = false});
  cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  for (const Outputs& out : cell.outs) EXPECT_FALSE(out.pulse_gripper);
}

// PP-20, PP-30: path_interrupt in MOVE_PP only; it continues when released; the pulse comes at the end of the profile.
TEST(Stops, Interrupt) {
  Settings s = Fast();
  s.gripper_closing_time = 0.05;
  Cell cell(s);
  cell.Start();
  cell.Do(Control{.path_interrupt = true});
  EXPECT_EQ(cell.state.state, M::kReady);
  cell.Do(Control{.path_interrupt = false});
  const Ticket ticket = Begin(cell);
  cell.Steps(150);
  cell.Do(Control{.path_interrupt = true});
  EXPECT_EQ(cell.state.state, M::kPathInterrupt);
  EXPECT_FALSE(cell.out().gripper_control_active);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().path_hold; }, 2));
  cell.Do(Control{.path_interrupt = false});
  EXPECT_EQ(cell.state.state, M::kMovePp);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  int pulses = 0;
  for (const Outputs& out : cell.outs) pulses += out.pulse_gripper;
  EXPECT_EQ(pulses, 1);
  EXPECT_TRUE(cell.out().pulse_gripper);
}

// PP-20: stop_all: each axis by itself; the path begins again from the start of the profile, from the tool's position.
TEST(Stops, StopAll) {
  Cell cell;
  cell.Start();
  const Ticket ticket = Begin(cell);
  cell.Steps(180);
  cell.Do(Control{.stop_all = true});
  EXPECT_EQ(cell.state.state, M::kStop);
  ASSERT_TRUE(cell.RunUntil([&] { return Stands(cell.Now(), cell.rig.state); }, 2));
  const KDL::Vector stood = cell.tool();
  cell.Do(Control{.stop_all = false});
  EXPECT_EQ(cell.state.state, M::kReady);
  cell.Steps(5);
  EXPECT_FALSE(cell.rig.lives[ticket].ended());
  cell.rig.trace.clear();
  cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  double highest = 0;
  for (const auto& sample : cell.rig.trace) highest = std::max(highest, sample.out.z);
  EXPECT_GT(highest, stood.z() + 25);  // it lifted again
  EXPECT_LT(cell.Off(400, 0, 0), 1e-9);
}

// PP-20: abort at every instant of a cycle of stopping: in motion it is refused, at rest the path is dropped.
TEST(Stops, AbortAtEveryInstant) {
  for (int instant = 0; instant < 460; instant += 7) {
    SCOPED_TRACE(instant);
    Cell cell;
    cell.Start();
    const Ticket ticket = Begin(cell);
    cell.Steps(140);
    cell.Do(Control{.path_stop = true});
    cell.Steps(instant);
    const bool stood = Stands(cell.Now(), cell.rig.state);
    const bool released = instant > 350;
    if (released) cell.Do(Control{.path_stop = false});
    cell.Do(Control{.abort = true});
    EXPECT_EQ(cell.rig.lives[ticket].aborted, stood || released);
    if (!stood && !released) {
      EXPECT_EQ(cell.state.warning, ErrorId::kState);
      continue;
    }
    cell.Do(Control{.path_stop = false, .abort = false});
    ASSERT_TRUE(cell.RunUntil([&] { return IsFree(cell.Now(), cell.rig.state); }, 1));
    EXPECT_EQ(cell.state.state, M::kReady);
    EXPECT_FALSE(cell.out().path_hold);
    cell.Do(To(0, 0, 0));
    const Ticket again = cell.Execute();
    ASSERT_TRUE(cell.RunToEnd(again, 5));
    EXPECT_TRUE(cell.rig.lives[again].done);
    EXPECT_LT(cell.Off(0, 0, 0), 1e-9);
  }
}

// PP-20: stopped at every instant of a profile and continued: it always ends at its target.
TEST(Stops, AtEveryInstantAndOn) {
  for (int instant = 0; instant < 620; instant += 13) {
    SCOPED_TRACE(instant);
    Cell cell;
    cell.Start();
    const Ticket ticket = Begin(cell);
    cell.Steps(instant);
    cell.Do(Control{.path_stop = true});
    cell.Steps(300);
    cell.Do(Control{.path_stop = false});
    EXPECT_TRUE(cell.RunTo(M::kReady, 1));
    if (!cell.rig.lives[ticket].ended()) cell.Execute();
    ASSERT_TRUE(cell.RunToEnd(ticket, 5));
    EXPECT_TRUE(cell.rig.lives[ticket].done);
    EXPECT_LT(cell.Off(400, 0, 0), 1e-9);
  }
}

// PP-03: each axis of the tool and each real one, with its own speed, as long as the key is held.
TEST(Jogs, EachAxis) {
  Settings s = Fast();
  Cell cell(s, {}, group::GantryWithAuxiliary());
  cell.Start();
  const std::array axes = {SelectAxis::kX,  SelectAxis::kY,  SelectAxis::kZ,   SelectAxis::kA1,
                           SelectAxis::kA2, SelectAxis::kA3, SelectAxis::kAux1};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (const bool positive : {true, false}) {
      SCOPED_TRACE(testing::Message() << "axis " << i << ", positive " << positive);
      const std::size_t moved = i < 3 ? i : i - 3;
      const double speed = i < 3 ? 100 : 50;
      std::vector<double> before;
      for (const auto& k : cell.rig.trace.empty() ? std::vector<KinematicState>(4) : cell.rig.trace.back().set) {
        before.push_back(k.position);
      }
      cell.Do(Control{.select_axis = axes[i]});
      const Ticket jog = cell.Do(Jog{.positive = positive, .negative = !positive});
      EXPECT_EQ(cell.state.state, positive ? M::kJogPos : M::kJogNeg);
      cell.Do(Control{.select_axis = SelectAxis::kY});  // no effect now
      cell.Steps(700);
      EXPECT_NEAR(cell.rig.trace.back().set[moved].velocity, positive ? speed : -speed, 1e-6);
      const Ticket let = cell.Do(Jog{});
      ASSERT_TRUE(cell.RunTo(M::kReady, 3));
      EXPECT_TRUE(cell.rig.lives[jog].aborted);
      EXPECT_TRUE(cell.rig.lives[let].done);
      for (std::size_t k = 0; k < 4; ++k) {
        const double way = cell.rig.trace.back().set[k].position - before[k];
        if (k == moved) {
          EXPECT_GT(positive ? way : -way, 10);
        } else {
          EXPECT_NEAR(way, 0, 1e-6);
        }
      }
    }
  }
}

// GR-48, PP-03: axes that the mechanism does not have are refused, without any effect.
TEST(Jogs, AxesThatThereAreNot) {
  Cell cell;
  cell.Start();
  for (const SelectAxis axis : {SelectAxis::kA, SelectAxis::kB, SelectAxis::kC, SelectAxis::kA4, SelectAxis::kAux1}) {
    for (const bool positive : {true, false}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(axis) << ", positive " << positive);
      cell.Do(Control{.select_axis = axis});
      const Ticket jog = cell.Do(Jog{.positive = positive, .negative = !positive});
      cell.Steps(2);
      const bool of_tool = axis <= SelectAxis::kC;
      EXPECT_EQ(cell.rig.lives[jog].error_id, of_tool ? ErrorId::kUnreachable : ErrorId::kNotGroupMember);
      EXPECT_EQ(cell.state.state, M::kReady);
      EXPECT_EQ(cell.state.warning, cell.rig.lives[jog].error_id);
      cell.Do(Jog{});
    }
  }
  cell.Do(Control{.select_axis = SelectAxis::kX});
  cell.Do(Jog{.positive = true});
  EXPECT_EQ(cell.state.state, M::kJogPos);
}

// PP-03: the direction chosen first stays; READY again only when both keys are released.
TEST(Jogs, BothKeys) {
  Cell cell;
  cell.Start();
  cell.Do(Control{.select_axis = SelectAxis::kX});
  cell.Do(Jog{.positive = true});
  cell.Steps(100);
  cell.Do(Jog{.positive = true, .negative = true});
  cell.Steps(50);
  EXPECT_GT(cell.rig.trace.back().set[0].velocity, 0);
  cell.Do(Jog{.negative = true});
  ASSERT_TRUE(cell.RunUntil([&] { return IsFree(cell.Now(), cell.rig.state); }, 2));
  cell.Steps(20);
  EXPECT_EQ(cell.state.state, M::kJogPos);
  cell.Do(Jog{});
  EXPECT_TRUE(cell.RunTo(M::kReady, 0.1));
  const Ticket both = cell.Do(Jog{.positive = true, .negative = true});
  EXPECT_EQ(cell.rig.lives[both].error_id, ErrorId::kParameter);
}

// PP-03, PP-60: a jog up to the end of an axis' range is an error that names the axis; after a reset it goes back only.
TEST(Jogs, EndsAtTheRange) {
  struct Case {
    SelectAxis axis;
    double sense;
  };
  for (const Case& one : {Case{SelectAxis::kX, 1}, Case{SelectAxis::kA1, 1}, Case{SelectAxis::kX, -1}}) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(one.axis) << " " << one.sense);
    group::Rig rig = group::Gantry();
    rig.axes[0].limits.upper = 40;
    rig.axes[0].limits.lower = -40;
    Cell cell(Fast(), {}, std::move(rig));
    cell.Start();
    const auto jog = [&](bool positive) { return cell.Do(Jog{.positive = positive, .negative = !positive}); };
    cell.Do(Control{.select_axis = one.axis});
    const Ticket ticket = jog(one.sense > 0);
    cell.Steps(2000);
    const auto is_at_limit = [&] {
      EXPECT_NEAR(cell.tool().x(), one.sense * 40, 0.01);
      EXPECT_EQ(cell.state.state, M::kError);
      EXPECT_EQ(cell.out().error,
                one.sense > 0 ? ErrorId::kModuleSoftLimitPositive : ErrorId::kModuleSoftLimitNegative);
      EXPECT_EQ(cell.out().error_axes, 1u << kFirstReal);
      EXPECT_EQ(cell.out().sw_limit_switches, 1u << kFirstReal);
      EXPECT_TRUE(cell.out().sw_limit_switch_active);
    };
    is_at_limit();
    EXPECT_TRUE(cell.rig.lives[ticket].error);
    const auto reset = [&] {
      cell.Do(Control{.reset_error = true});
      EXPECT_TRUE(cell.RunTo(M::kReady, 0.5));
      cell.Do(Control{.reset_error = false});
    };
    reset();
    EXPECT_EQ(cell.out().error_axes, 0u);
    const double x = cell.tool().x();
    jog(one.sense > 0);  // no further
    cell.Steps(50);
    is_at_limit();
    EXPECT_NEAR(cell.tool().x(), x, 1e-6);
    reset();
    jog(one.sense < 0);
    cell.Steps(200);
    EXPECT_LT(one.sense * cell.tool().x(), 39);
    EXPECT_EQ(cell.out().error, ErrorId::kNone);
    cell.Do(Jog{});
    EXPECT_TRUE(cell.RunTo(M::kReady, 0.5));
  }
}

// PP-03: a dead man's lease ends a jog.
TEST(Jogs, Lease) {
  Cell cell;
  cell.Start();
  cell.Do(Control{.select_axis = SelectAxis::kX});
  const Ticket jog = cell.Give(Jog{.positive = true}, 0.2);
  cell.Steps(100);
  EXPECT_EQ(cell.state.state, M::kJogPos);
  EXPECT_TRUE(cell.RunTo(M::kReady, 1));
  EXPECT_TRUE(cell.rig.lives[jog].done);
}

// PP-03: off its path a held path is not continued; return_to_path moves back, then it is. From STOP, READY and
// PATH_INTERRUPT, at many points of the profile.
TEST(Jogs, AwayFromThePathAndBack) {
  for (const M from : {M::kStop, M::kReady, M::kPathInterrupt}) {
    for (const int instant : {40, 70, 110, 180, 240, 280}) {
      SCOPED_TRACE(testing::Message() << "from " << static_cast<int>(from) << " at " << instant);
      Cell cell;
      cell.Start();
      const Ticket ticket = Begin(cell);
      cell.Steps(instant);
      const bool interrupts = from == M::kPathInterrupt;
      cell.Do(interrupts ? Control{.path_interrupt = true} : Control{.path_stop = true});
      cell.Steps(700);
      if (from == M::kReady) cell.Do(Control{.path_stop = false});
      ASSERT_EQ(cell.state.state, from);
      ASSERT_TRUE(cell.out().path_hold);
      const KDL::Vector held = cell.tool();
      cell.Do(Control{.select_axis = SelectAxis::kY});
      cell.Do(Jog{.positive = true});
      EXPECT_EQ(cell.state.state, M::kJogPos);
      cell.Steps(300);
      cell.Do(Jog{});
      ASSERT_TRUE(cell.RunTo(from, 2));
      EXPECT_GT((cell.tool() - held).Norm(), 5);
      EXPECT_TRUE(cell.out().off_path);
      cell.Do(Control{.path_stop = false, .path_interrupt = false});
      ASSERT_TRUE(cell.RunTo(M::kReady, 1));
      const Ticket away = cell.Execute();
      cell.Step();
      EXPECT_EQ(cell.rig.lives[away].error_id, ErrorId::kOffPath);
      const Ticket back = cell.Give(Control{.return_to_path = true});
      ASSERT_TRUE(cell.RunToEnd(back, 5));
      EXPECT_TRUE(cell.rig.lives[back].done);
      EXPECT_LT((cell.tool() - held).Norm(), 1e-6);
      EXPECT_FALSE(cell.out().off_path);
      const Ticket on = cell.Execute();
      cell.Step();
      EXPECT_TRUE(cell.rig.lives[on].done);
      ASSERT_TRUE(cell.RunToEnd(ticket, 5));
      EXPECT_TRUE(cell.rig.lives[ticket].done);
      EXPECT_LT(cell.Off(400, 0, 0), 1e-9);
    }
  }
}

// PP-04: in the given order; axes with the same number together; axes without one stay as they are. The switches come
// from outside.
TEST(Homing, InOrder) {
  Settings s = Fast();
  s.homing_order = {2, 1, 1, 0, 0, 0, 0};
  s.home_position = {11, 22, 33, 0, 0, 0, 0};
  s.home_by_module = true;
  Cell cell(s, {}, group::GantryWithAuxiliary());
  for (const char* name : {"x", "y", "z"}) {
    cell.params.homing.push_back({name, {.method = axis::HomingMethod::kSwitch, .velocity = 20}});
  }
  cell.Start();
  const Ticket ticket = cell.Do(Control{.home_execute = true});
  EXPECT_EQ(cell.state.state, M::kHoming);
  cell.Steps(200);
  const auto speed = [&](std::size_t k) { return std::abs(cell.rig.trace.back().set[k].velocity); };
  EXPECT_EQ(speed(0), 0);
  EXPECT_NEAR(speed(1), 20, 1e-9);
  EXPECT_NEAR(speed(2), 20, 1e-9);
  cell.Do(Control{.home_abs_switch = std::array<bool, kRealAxes>{false, true, false}});
  cell.Steps(300);
  EXPECT_EQ(speed(0), 0);
  EXPECT_EQ(speed(1), 0);
  cell.Do(Control{.home_abs_switch = std::array<bool, kRealAxes>{false, true, true}});
  cell.Steps(300);
  EXPECT_NEAR(speed(0), 20, 1e-9);
  cell.Do(Control{.home_abs_switch = std::array<bool, kRealAxes>{true, true, true}});
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_EQ(cell.state.state, M::kReady);
  EXPECT_FALSE(cell.rig.states[3].homing.homed);
  EXPECT_TRUE(cell.rig.states[0].homing.homed);
  EXPECT_EQ(cell.rig.axes[0].homing.method, axis::HomingMethod::kDirect);  // the axis' own parameters are restored
}

// PP-04, PP-20: a stop ends homing; axes that home directly are done in one cycle.
TEST(Homing, StopAndAtOnce) {
  Settings s = Fast();
  s.homing_order = {1, 1, 1, 0, 0, 0, 0};
  s.home_position = {11, 22, 33, 0, 0, 0, 0};
  Cell cell(s);
  cell.Start();
  const Ticket at_once = cell.Do(Control{.home_execute = true});
  ASSERT_TRUE(cell.RunToEnd(at_once, 0.1));
  cell.Steps(2);
  EXPECT_LT(cell.Off(11, 22, 33), 1e-9);
  cell.Do(Control{.home_execute = false});
  cell.rig.axes[0].homing = {.method = axis::HomingMethod::kSwitch, .velocity = 20};
  const Ticket ticket = cell.Do(Control{.home_execute = true});
  cell.Steps(100);
  EXPECT_EQ(cell.state.state, M::kHoming);
  cell.Do(Control{.path_stop = true});
  EXPECT_TRUE(cell.rig.lives[ticket].aborted);
  EXPECT_EQ(cell.state.state, M::kStop);
  cell.Steps(300);
  cell.Do(Control{.path_stop = false});
  EXPECT_TRUE(cell.RunTo(M::kReady, 1));
}

// PP-05: limit switches from outside stop each axis; error ids of the manual; READY after a reset.
TEST(Faults, LimitSwitchInputs) {
  for (const bool positive : {true, false}) {
    Cell cell;
    cell.Start();
    cell.Do(Control{.enable_hw_limit = true});
    const Ticket ticket = Begin(cell);
    cell.Steps(150);
    std::array<bool, kAllAxes> switches{};
    switches[0] = true;
    cell.Do(positive ? Control{.hw_limit_positive = switches} : Control{.hw_limit_negative = switches});
    EXPECT_EQ(cell.state.state, M::kError);
    EXPECT_EQ(cell.out().error, positive ? ErrorId::kModuleLimitSwitchPositive : ErrorId::kModuleLimitSwitchNegative);
    EXPECT_TRUE(cell.out().hw_limit_switch_active);
    EXPECT_TRUE(cell.rig.lives[ticket].error);
    ASSERT_TRUE(cell.RunUntil([&] { return Stands(cell.Now(), cell.rig.state); }, 2));
    cell.Do(Control{.reset_error = true});
    ASSERT_TRUE(cell.RunTo(M::kReady, 1));
    EXPECT_TRUE(cell.RunUntil([&] { return IsOn(cell.Now(), cell.rig.state); }, 1));
  }
}

// PP-05: a fault of an axis: ERROR with its number; reset brings everything back.
TEST(Faults, OfAnAxis) {
  Cell cell;
  cell.Start();
  const Ticket ticket = Begin(cell);
  cell.Steps(150);
  axis::Fail(cell.rig.AxisContext(1), ErrorId::kSoftLimitPositive, false, cell.rig.states[1]);
  ASSERT_TRUE(cell.RunTo(M::kError, 0.1));
  EXPECT_EQ(cell.state.error, ErrorId::kModuleSoftLimitPositive);
  EXPECT_TRUE(cell.rig.lives[ticket].error);
  cell.Steps(1000);
  EXPECT_TRUE(cell.out().sw_limit_switch_active);
  cell.Do(Control{.reset_error = true});
  ASSERT_TRUE(cell.RunTo(M::kReady, 1));
  cell.Steps(50);
  cell.Do(To(0, 0, 0));
  const Ticket again = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(again, 5));
  EXPECT_TRUE(cell.rig.lives[again].done);
}

// PP-01: a target is no longer reached once it is dropped, or the tool moves away from it by any means.
TEST(States, InTargetEnds) {
  const auto at_target = [](Cell& cell) {
    cell.Start();
    const Ticket ticket = Begin(cell);
    ASSERT_TRUE(cell.RunToEnd(ticket));
    cell.Steps(100);
    ASSERT_TRUE(cell.out().in_target);
  };
  Cell off, jogged, moved;
  at_target(off);
  off.Do(Control{.regulator_on = false});
  EXPECT_FALSE(off.out().in_target);
  at_target(jogged);
  jogged.Do(Control{.select_axis = SelectAxis::kX});
  jogged.Do(Jog{.positive = true});
  jogged.Steps(200);
  EXPECT_FALSE(jogged.out().in_target);
  at_target(moved);
  moved.rig.Give(group::MoveLinearAbsolute{.x = 10});
  moved.Steps(200);
  EXPECT_FALSE(moved.out().in_target);
}

// PP-14: two belts need two product coordinate systems.
TEST(States, WorkpieceSystemsAreDifferent) {
  Cell cell;
  cell.Start();
  const Ticket ticket = cell.Do(Configure{.workpiece_pcs1 = cell.state.settings.workpiece_pcs2});
  EXPECT_EQ(cell.rig.lives[ticket].error_id, ErrorId::kParameter);
  EXPECT_NE(cell.state.settings.workpiece_pcs1, cell.state.settings.workpiece_pcs2);
}

// PP-01: power off ends every activity.
TEST(States, PowerOff) {
  Cell cell;
  cell.Start();
  const Ticket ticket = Begin(cell);
  cell.Steps(150);
  cell.Do(Control{.regulator_on = false});
  EXPECT_TRUE(cell.rig.lives[ticket].aborted);
  ASSERT_TRUE(cell.RunUntil([&] { return !cell.out().axes_enabled; }, 2));
  EXPECT_TRUE(cell.RunTo(M::kReady, 1));
  cell.Do(Control{.regulator_on = true});
  EXPECT_TRUE(cell.RunUntil([&] { return IsOn(cell.Now(), cell.rig.state); }, 2));
}

}  // namespace
}  // namespace takt::pickplace
