// The clutch's contract on the engine: any master, commands at any instant and repeatedly, every mode, rotary and
// linear slaves (CAM-37, CAM-39, CAM-81, CAM-82).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../core/trials.h"
#include "random.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

// The conditions of a trial; the rest is random.
struct Trial {
  bool wide = false;      // the slave's limits are so wide that it never lags behind a demand
  bool jumps = false;     // the master jumps
  bool measured = false;  // the master's position is measured by a coarse encoder
  bool ramps = false;     // offsets and factors are changed during the trial
  bool once = false;      // slave and master may not move against each other
};

Trial AnyTrial(Dice& dice) {
  Trial t;
  t.wide = dice.Coin();
  t.jumps = dice.Upto(5) == 0;
  t.measured = dice.Upto(5) == 0;
  t.ramps = dice.Upto(2) == 0;
  t.once = dice.Coin();
  return t;
}

Settings ClutchSettings(Dice& dice, const Trial& t) {
  Settings s;
  s.sync_mode = dice.Upto(2) != 0 || t.once ? ClutchMode::kRampPos : static_cast<ClutchMode>(dice.Upto(4));
  s.slave_absolute = dice.Coin();
  s.master_absolute = dice.Coin();
  s.sync_direction = dice.Upto(3) == 0 ? static_cast<ClutchDirection>(dice.Upto(2)) : ClutchDirection::kCurrent;
  s.sync_in_passed = dice.Upto(5) == 0 ? PassedSync::kRefuse : static_cast<PassedSync>(1 + dice.Upto(1));
  const double shortest = t.wide ? 100 : 5, longest = dice.Coin() ? 150 : 500;
  s.master_sync_in_distance = dice.Between(shortest, longest);
  s.master_sync_in_position = dice.Between(0, 359);
  s.master_sync_out_distance = dice.Between(shortest, longest);
  s.slave_sync_out_position = dice.Between(-30, 30);
  s.sync_in_time_s = dice.Between(0.2, 0.6);
  s.sync_out_time_s = dice.Between(0.2, 0.6);
  s.sync_velocity = 500;
  s.sync_acceleration = s.sync_deceleration = 5000;
  s.position_control = t.once ? PositionControl::kMasterDirection : PositionControl::kBoth;
  s.offset_mode_master = OffsetMode::kRampIn;
  s.offset_mode_slave = OffsetMode::kRampIn;
  s.scaling_mode_master = dice.Coin() ? ScalingMode::kRampAbsolute : ScalingMode::kRampRelative;
  s.scaling_mode_slave = s.scaling_mode_master;
  return s;
}

Machine MachineFor(Dice& dice, const Trial& t) {
  const auto kind = [&] { return dice.Coin() ? axis::AxisKind::kLinear : axis::AxisKind::kRotary; };
  const Settings s = ClutchSettings(dice, t);
  const axis::AxisKind master = kind(), slave = kind();
  Machine m = MachineOf({RandomCam(dice, "a", t.once || dice.Coin())}, s, master, slave);
  axis::AxisLimits& limits = m.axes[Bench::kKnife].limits;
  if (t.wide) {
    limits = {.velocity = 1e5, .acceleration = 1e7, .deceleration = {}, .jerk = 1e10, .lower = {}, .upper = {}};
  } else {
    limits.velocity = dice.Between(500, 5000);
    limits.acceleration = dice.Between(5000, 100000);
    limits.jerk = dice.Between(5e5, 5e6);
  }
  axis::AxisParams& web = m.axes[Bench::kWeb];
  if (t.jumps)
    web.limits = {.velocity = 1e5, .acceleration = 1e8, .deceleration = {}, .jerk = 0, .lower = {}, .upper = {}};
  if (t.measured) {
    m.flex_cams[0].source = axis::MasterSource::kActualValue;
    web.encoder.increments_per_unit = 50;
  }
  return m;
}

// Checks the invariants of each cycle.
class ClutchWatch {
 public:
  ClutchWatch(Bench& b, const Trial& trial)
      : b_(b), trial_(trial), settings_(b.machine.flex_cams[0].settings), smooth_(b) {
    b.each = [this] { Look(); };
    web_ = b.TheWeb();
    knife_ = b.Knife();
    module_ = b.Module();
  }
  void Look() {
    smooth_.Look();
    const Outputs& m = b_.Module();
    if (m.clutch != module_.clutch) ++entered[static_cast<std::size_t>(m.clutch)];
    const bool follows = m.state == ModuleState::kSync && module_.state == ModuleState::kSync;
    if (follows) {
      LookAtWaiting(m);
      LookAtStep();
      LookAtSense();
      LookAtPlace(m);
    }
    web_ = b_.TheWeb();
    knife_ = b_.Knife();
    distance_before_ = module_.clutch_distance;
    module_ = m;
  }
  void Expect() const {
    smooth_.ExpectSmooth();
    EXPECT_EQ(silent, 0) << "cycles of waiting without a reason";
    EXPECT_EQ(stepped, 0) << "cycles in which the slave was not where the clutch has it";
    EXPECT_GE(against, -1e-6) << "the slave moved against the master";
    EXPECT_LE(off_place, 1e-6) << "closed beside the promised position";
  }
  int silent = 0, stepped = 0;
  double against = 0, off_place = 0;
  // Coverage:
  std::array<int, 7> entered{};  // clutch phases
  int places = 0, senses = 0, curves = 0;

 private:
  bool Exact() const { return !trial_.jumps && !trial_.measured; }
  double Moved(const axis::Outputs& now, const axis::Outputs& before, std::size_t axis) const {
    const double turn = b_.machine.axes[axis].turn(), moved = now.set_position - before.set_position;
    return turn == 0 ? moved : moved - turn * std::round(moved / turn);
  }
  // CAM-82: every wait has its reason.
  void LookAtWaiting(const Outputs& m) {
    const bool waits = m.clutch == ClutchPhase::kWaitingIn || m.clutch == ClutchPhase::kWaitingOut;
    silent += waits && m.clutch_waits == ClutchWait::kNothing ? 1 : 0;
  }
  // CAM-39: the demands of the curve modes have no step, so a slave with wide limits follows them bit for bit.
  void LookAtStep() {
    const bool over_curves = settings_.sync_mode >= ClutchMode::kRampPos;
    if (!Exact() || !trial_.wide || !over_curves) return;
    ++curves;
    if (!b_.Knife().in_step) ++stepped;
  }
  // CAM-37.
  void LookAtSense() {
    if (!Exact() || !trial_.once || !trial_.wide) return;
    const double master = Moved(b_.TheWeb(), web_, Bench::kWeb), slave = Moved(b_.Knife(), knife_, Bench::kKnife);
    senses += slave != 0 ? 1 : 0;
    against = std::min(against, master == 0 ? -std::abs(slave) : std::copysign(1.0, master) * slave);
  }
  // CAM-81: closed in the cycle in which the master passes the promised position.
  void LookAtPlace(const Outputs& m) {
    const bool closes = module_.clutch == ClutchPhase::kClosing && m.clutch == ClutchPhase::kClosed;
    if (!closes || !Exact() || !trial_.wide || settings_.sync_mode != ClutchMode::kRampPos) return;
    if (module_.clutch_distance == 0) return;  // over time: the rest of an earlier change
    // The master has moved back behind the begin of the closing: that is undone, and it is in step as before.
    if (module_.clutch_distance > distance_before_) {
      off_place = std::max(off_place, Apart(b_.Knife().set_position, m.mp06_y_to_slave_position));
      return;
    }
    ++places;
    const double step = Moved(b_.TheWeb(), web_, Bench::kWeb);
    const double beyond = std::abs(step) - module_.clutch_distance;
    if (beyond < 0 || beyond > std::abs(step)) off_place = std::max(off_place, std::abs(beyond));
    off_place = std::max(off_place, Apart(b_.Knife().set_position, m.mp06_y_to_slave_position));
  }

  Bench& b_;
  Trial trial_;
  Settings settings_;
  Watch smooth_;
  axis::Outputs web_, knife_;
  double distance_before_ = 0;
  Outputs module_;
};

void DriveAnyHow(Dice& dice, Bench& b, const Trial& t) {
  if (t.jumps && dice.Coin()) {
    b.Give(Bench::kWeb, axis::MoveRelative{.distance = dice.Between(-60, 60), .velocity = 1e5});
    b.Run(2);
  }
  Drive(dice, b);
}

// On and off at any instant, several times in succession.
void GiveAny(Dice& dice, Bench& b, const Trial& t) {
  const int times = 1 + dice.Upto(3);
  bool on = dice.Coin();
  for (int i = 0; i < times; ++i, on = !on) {
    b.Tell(Control{.sync_cam = on});
    b.Run(dice.Coin() ? dice.Upto(3) : dice.Upto(120));
  }
  if (!t.ramps) return;
  if (dice.Upto(2) == 0) b.Tell(Control{.offset_master = dice.Between(-100, 100)});
  if (dice.Upto(4) == 0) b.Tell(Control{.scaling_master = dice.Between(0.4, 2.5)});
  if (dice.Upto(4) == 0) b.Tell(Control{.offset_slave = dice.Between(-20, 20)});
  if (dice.Upto(4) == 0) b.Tell(Control{.scaling_slave = dice.Between(0.5, 2)});
}

// With a steady master the command completes, or is refused with an error, or its wait has a reason (CAM-82).
void ExpectConclusion(Dice& dice, Bench& b, bool on) {
  b.Tell(Control{.sync_cam = !on});
  b.Step();
  const Ticket ticket = b.Tell(Control{.sync_cam = on});
  b.Web((dice.Coin() ? 1 : -1) * dice.Between(400, 800));
  const auto over = [&] { return b.last.contains(ticket) && IsFinal(b.Of(ticket)); };
  b.Until(over, 1200);
  const Outputs& m = b.Module();
  const bool on_its_way = m.clutch == ClutchPhase::kClosing || m.clutch == ClutchPhase::kOpening;
  const bool catches_up = m.clutch == ClutchPhase::kClosed && b.Knife().limited_by != LimitedBy::kNothing;
  EXPECT_TRUE(over() || on_its_way || catches_up || m.clutch_waits != ClutchWait::kNothing)
      << (on ? "closing" : "opening") << ": clutch " << int(m.clutch) << " state " << int(m.state);
}

TEST(Contract, HoldsForCommandsAtAnyInstant) {
  const int trials = Trials(1000), first = FirstTrial();
  std::array<int, 7> entered{};
  int places = 0, senses = 0, curves = 0;
  for (int trial = first; trial < first + trials; ++trial) {
    SCOPED_TRACE(trial);
    Dice dice(static_cast<unsigned>(trial));
    const Trial t = AnyTrial(dice);
    Bench b(MachineFor(dice, t));
    ClutchWatch watch(b, t);
    DriveAnyHow(dice, b, t);
    b.Run(dice.Upto(150));
    for (int i = 0; i < 6; ++i) {
      GiveAny(dice, b, t);
      if (dice.Coin()) DriveAnyHow(dice, b, t);
      b.Run(dice.Upto(dice.Coin() ? 100 : 500));
    }
    if (trial % 4 == 0) {
      ExpectConclusion(dice, b, true);
      ExpectConclusion(dice, b, false);
    }
    ASSERT_EQ(b.Module().error, ErrorId::kNone);
    watch.Expect();
    for (std::size_t i = 0; i < entered.size(); ++i) entered[i] += watch.entered[i];
    places += watch.places;
    senses += watch.senses;
    curves += watch.curves;
    if (testing::Test::HasFailure()) return;
  }
  // The trial covered:
  for (const ClutchPhase phase : {ClutchPhase::kWaitingIn, ClutchPhase::kClosing, ClutchPhase::kClosed,
                                  ClutchPhase::kWaitingOut, ClutchPhase::kOpening}) {
    EXPECT_GE(10 * entered[static_cast<std::size_t>(phase)], trials) << static_cast<int>(phase);
  }
  EXPECT_GE(40 * places, trials);
  EXPECT_GE(senses, trials);
  EXPECT_GE(curves, trials);
}

}  // namespace
}  // namespace takt::flexcam
