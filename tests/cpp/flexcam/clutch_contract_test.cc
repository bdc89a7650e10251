// The contract of the clutch (clutch.h), in isolation: any master, any instant, every mode (CAM-81, CAM-82).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench.h"
#include "dice.h"
#include "takt/cam/build.h"
#include "takt/flexcam/clutch.h"

namespace takt::flexcam {
namespace {

constexpr double kPeriod = 0.001;

// A master that changes its velocity at random, reverses, rests, jumps, and may be measured with noise.
class Master {
 public:
  Master(Dice& dice, bool noisy) : dice_(dice), noisy_(noisy) { exact_.position = dice.Between(-400, 400); }

  void Aim(double velocity) { aim_ = velocity; }
  void Jump(double distance) { exact_.position += distance; }
  KinematicState Step() {
    const double most = 4000 * kPeriod;
    const double change = std::clamp(aim_ - exact_.velocity, -most, most);
    exact_.acceleration = change / kPeriod;
    exact_.position += kPeriod * (exact_.velocity + 0.5 * change);
    exact_.velocity += change;
    KinematicState seen = exact_;
    if (noisy_) {
      seen.position += dice_.Between(-0.004, 0.004);
      seen.velocity += dice_.Between(-1, 1);
    }
    return seen;
  }
  const KinematicState& exact() const { return exact_; }

 private:
  Dice& dice_;
  bool noisy_;
  double aim_ = 0;
  KinematicState exact_;
};

// The clutch on a cam that rises and falls, with a slave that follows every demand.
class Rig {
 public:
  Rig(Dice& dice, const Settings& given, bool noisy, double turn)
      : settings(given),
        noisy_(noisy),
        turn_(turn),
        table_(cam::Build(UpAndDown("hill", 50)).table.value()),
        master(dice, noisy) {
    slave.limits = {.velocity = 1e7, .acceleration = 1e10, .deceleration = {}, .jerk = 1e14, .lower = {}, .upper = {}};
    now_ = before_ = master.Step();
    Lay(table_, now_.position, now_.position, false, way.profiler);
    own = {dice.Between(-60, 60), 0, 0};
    wanted_ = Wanted(now_);
  }

  Status Step() {
    before_ = now_;
    now_ = master.Step();
    ++cycle_.count;
    const KinematicState wanted = Wanted(now_);
    const ClutchContext c = Context();
    if (close_) BeginClosing(c, state);
    if (open_) BeginOpening(c, state);
    close_ = open_ = false;
    const ClutchState earlier = state;
    KinematicState demand = {own.position, 0, 0};
    const Status status = StepClutch(c, wanted, way, state, demand);
    wanted_ = Wanted(now_);
    Check(earlier, demand);
    at_rest_ = demand.velocity == 0 && demand.acceleration == 0;
    own = demand;
    return status;
  }
  void Close() { close_ = true; }
  void Open() { open_ = true; }
  // Returns true if the demand is that of the cam, within rounding.
  bool OnCam() const { return std::abs(own.position - wanted_.position) < 1e-9; }
  double MasterAt() const { return now_.position; }

  Settings settings;
  axis::AxisParams slave;
  ClutchState state;
  Way way;
  KinematicState own;

 private:
  ClutchContext Context() {
    return {.cycle = cycle_,
            .planner = planner_,
            .settings = settings,
            .slave = slave,
            .table = table_,
            .master_turn = turn_,
            .measured = noisy_,
            .master = now_,
            .master_before = before_,
            .own_before = own,
            .wanted_before = wanted_,
            .in_step = true,
            .at_rest = at_rest_};
  }
  KinematicState Wanted(const KinematicState& m) const {
    const ProfilerValue y = ValueAt(table_, way.profiler, m.position);
    const KinematicState on_y = {y.y, y.dy * m.velocity, y.ddy * m.velocity * m.velocity + y.dy * m.acceleration};
    return Convert(way.to_slave, cycle_, on_y);
  }
  void Check(const ClutchState& earlier, const KinematicState& demand) {
    const double largest = std::abs(now_.position - before_.position);
    if (state.curve_count > earlier.curve_count) {  // a curve has begun: as long as requested, and within the limits
      const ClutchCurve& curve = state.curves[state.curve_count - 1];
      const double asked = curve.closes ? settings.master_sync_in_distance : settings.master_sync_out_distance;
      EXPECT_NEAR(curve.over.length, asked, 1e-9 * asked);
      EXPECT_GE(curve.fastest, std::abs(now_.velocity));
      if (curve.closes) {
        EXPECT_NEAR(EndOf(curve), state.place, 1e-6);
        const double away = (state.place - settings.master_sync_in_position) / (turn_ > 0 ? turn_ : 360);
        if (settings.sync_in_passed != PassedSync::kHere || turn_ > 0) {
          EXPECT_NEAR(away, std::round(away), 1e-9);
        }
      }
    }
    if (earlier.phase == ClutchPhase::kClosing && state.phase == ClutchPhase::kClosed &&
        earlier.mode == ClutchMode::kRampPos) {  // CAM-32: closed in the cycle that passes the promised position
      const ClutchCurve& curve = earlier.curves[earlier.curve_count > 0 ? earlier.curve_count - 1 : 0];
      EXPECT_LE(On(curve, now_.position) - curve.over.length, largest + 1e-9);
      EXPECT_NEAR(demand.position, wanted_.position, 1e-6);
    }
    // No step: the slope of any curve here for the master's displacement, and more for curves over time.
    const double bound = 40 * largest + 60 * 1.9 / 0.2 * kPeriod + 0.5;
    if (state.mode != ClutchMode::kAbsolute && state.mode != ClutchMode::kRelative) {
      EXPECT_LE(std::abs(demand.position - own.position), bound);
    }
  }

  bool noisy_;
  double turn_;
  cam::Table table_;

 public:
  Master master;

 private:
  trajectory::Planner planner_;
  Cycle cycle_{10, kPeriod};
  KinematicState now_, before_, wanted_;
  bool at_rest_ = true, close_ = false, open_ = false;
};

Settings AnyClutch(Dice& dice) {
  Settings s;
  s.sync_mode = static_cast<ClutchMode>(dice.Upto(4));
  if (dice.Coin()) s.sync_mode = ClutchMode::kRampPos;
  s.sync_direction = ClutchDirection::kCurrent;
  s.slave_absolute = true;
  s.sync_in_passed = PassedSync::kNextCycle;
  s.master_sync_in_distance = dice.Between(20, 500);
  s.master_sync_in_position = dice.Between(-500, 500);
  s.master_sync_out_distance = dice.Between(20, 500);
  s.slave_sync_out_position = dice.Between(-30, 30);
  s.sync_in_time_s = dice.Between(0.2, 0.6);
  s.sync_out_time_s = dice.Between(0.2, 0.6);
  s.sync_velocity = 200;
  return s;
}

// CAM-81, CAM-82: after any motion of the master, it closes as the master continues, and opens likewise.
TEST(Contract, ClosesAndOpensWhicheverWayTheMasterGoesOn) {
  const int trials = std::getenv("TAKT_LONG") != nullptr ? 100'000 : 600;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    Dice dice(static_cast<unsigned>(trial));
    const bool noisy = dice.Upto(3) == 0;
    Rig rig(dice, AnyClutch(dice), noisy, dice.Coin() ? 360 : 0);
    const auto wander = [&](int times) {
      for (int i = 0; i < times; ++i) {
        rig.master.Aim(dice.Upto(3) == 0 ? 0 : dice.Between(-1500, 1500));
        if (dice.Upto(9) == 0) rig.master.Jump(dice.Between(-30, 30));
        for (int k = dice.Upto(300); k > 0; --k) rig.Step();
      }
    };
    const auto until = [&](ClutchPhase phase) {
      rig.master.Aim((dice.Coin() ? 1 : -1) * dice.Between(400, 1500));
      for (int k = 0; k < 20'000 && rig.state.phase != phase; ++k) {
        const Status status = rig.Step();
        EXPECT_TRUE(status.ok()) << static_cast<int>(status.error);
      }
      EXPECT_EQ(rig.state.phase, phase) << "waits for " << static_cast<int>(rig.state.waits);
    };
    wander(2);
    rig.Close();
    wander(3);
    until(ClutchPhase::kClosed);
    for (int k = 0; k < 20; ++k) {
      rig.Step();
      EXPECT_TRUE(rig.OnCam());
    }
    rig.Open();
    wander(3);
    until(ClutchPhase::kOpen);
    const bool freezes =
        rig.settings.sync_mode == ClutchMode::kAbsolute || rig.settings.sync_mode == ClutchMode::kRelative;
    if (!freezes) {
      EXPECT_NEAR(rig.own.position, rig.settings.slave_sync_out_position, 1e-9);
    }
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace takt::flexcam
