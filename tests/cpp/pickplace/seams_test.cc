// PP-60, PP-61: modules, belts and operators at random. Nothing moves towards a limit switch that is on; a tool that is
// low over a belt is at rest relative to it, on its workpiece or on the way up, and within the range where the belt's
// changes of speed were stated. TAKT_LONG in the environment: 2,000 runs instead of 40.
#include <iostream>
#include <optional>
#include <random>

#include "../core/trials.h"
#include "cell.h"

namespace takt::pickplace {
namespace {

using M = PickPlaceState;

constexpr double kSeamY = 200, kSeamZ = -50, kUpFrom = 25, kRound = 10;
constexpr double kLower = 100, kUpper = 500;   // [mm] range
constexpr double kLow = kUpFrom - kRound - 1;  // [mm] over workpieces
constexpr double kBeltChange = 3000;           // [mm/s²] at most
// [mm] Braking distance of a motion that turns towards a switch, as belts and interrupts cause it: its acceleration is
// reduced within the jerk of its axis first.
constexpr double kSlip = 3;
constexpr double kStill = 3;  // [mm/s] relative to the belt

// A belt that runs at one speed after another, with ramps whose acceleration is a smooth hump.
class Travel {
 public:
  explicit Travel(std::mt19937_64& random) {
    double t = 0, place = 0, speed = 0;
    std::uniform_real_distribution<double> any(-0.5, 1), wait(0.2, 1.5), ramp(0.2, 0.6);
    while (t < 60) {
      const double to = any(random) < 0 ? -100 * any(random) * any(random) : std::max(0.0, 250 * any(random));
      const double takes = std::max(ramp(random), 1.9 * std::abs(to - speed) / kBeltChange);
      pieces_.push_back({t, place, speed, to - speed, takes});
      const double holds = wait(random);
      place += speed * takes + (to - speed) * takes / 2 + to * holds;
      speed = to;
      t += takes + holds;
    }
  }
  KinematicState operator()(double t) const {
    std::size_t i = 0;
    while (i + 1 < pieces_.size() && pieces_[i + 1].t <= t) ++i;
    const Piece& p = pieces_[i];
    const double x = std::min((t - p.t) / p.takes, 1.0), rest = std::max(0.0, t - p.t - p.takes);
    return {p.place + p.speed * (t - p.t) + p.change * (p.takes * x * x * x * (1 - 0.5 * x) + rest),
            p.speed + p.change * x * x * (3 - 2 * x), p.change / p.takes * 6 * x * (1 - x)};
  }

 private:
  struct Piece {
    double t, place, speed, change, takes;
  };
  std::vector<Piece> pieces_;
};

struct SeamFigures {
  long picked = 0, placed = 0, low = 0, stops_low = 0, refused = 0, closed = 0, errors = 0;
  double fastest = 0;   // [mm/s] relative to the belt, when low
  double furthest = 0;  // [mm] beyond the range, when low
};

class SeamsRun {
 public:
  SeamsRun(std::uint64_t seed, SeamFigures& figures)
      : random_(seed), says_how_(seed % 2 == 0), figures_(figures), cell_(SettingsFor(), {BeltFor()}) {
    cell_.Start({0, 0, 50, 0, 0, 0});
  }

  void Run(int cycles) {
    for (int i = 0; i < cycles && !testing::Test::HasFailure(); ++i) {
      if (i % 400 == 0) cell_.Put(0, {Pick(kLower - 60, kLower + 60), Pick(-30, 30), 0, 0, 0, 0});
      Operate();
      cell_.rig.trace.clear();
      cell_.outs.clear();
      cell_.Step();
      Lose();
      WatchSwitches();
      WatchHeight();
    }
    figures_.picked += cell_.state.counters.picked;
    figures_.placed += cell_.state.counters.placed;
  }

 private:
  double Pick(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  bool Chance(double share) { return Pick(0, 1) < share; }

  Settings SettingsFor() {
    Settings s = Fast();
    s.tracking_mode = TrackingMode::kBelt1ToStatic;
    s.x_target = Pick(-100, 300);
    s.y_target = -100;
    s.z_target = -20;
    s.z_start_distance = kUpFrom;
    s.blending_radius = kRound;
    s.path_mode = Chance(0.5) ? PathMode::kLinear : PathMode::kElliptical;
    s.z_elliptical = 20;
    s.path_acceleration = s.path_deceleration = Pick(4000, 16000);
    return s;
  }
  CellBelt BeltFor() {
    CellBelt belt;
    belt.params.name = belt.params.axis = "belt";
    belt.params.origin = {0, kSeamY, kSeamZ, 0, 0, 0};
    belt.params.lower_limit = kLower;
    belt.params.upper_limit = kUpper;
    belt.settings = {.park_x = 300,
                     .park_y = kSeamY,
                     .park_z = 30,
                     .z_distance = kUpFrom,
                     .sync_time = Pick(0, 0.1),
                     .sudden_acceleration = says_how_ ? kBeltChange : 0};
    belt.travel = Travel(random_);
    return belt;
  }

  void Lose() {
    conveyor::State& belt = cell_.belt_states[0];
    for (std::uint32_t i = belt.count; i-- > 0;) {
      const conveyor::Object& object = belt.objects[i];
      const double along = conveyor::PlaceOf(cell_.belts[0].params, belt, object);
      if (object.state != conveyor::ObjectState::kVisible || (along <= kUpper && along >= kLower - 200)) continue;
      conveyor::Lose(object.number, belt);
    }
  }

  // Actions of an operator at the panel, of a switch or of a drive.
  void Operate() {
    if (cell_.state.state == M::kError && Chance(0.01)) {
      cell_.Give(Control{.reset_error = true});
      cell_.Give(Control{.reset_error = false});
      ++figures_.errors;
    }
    if (cell_.state.state == M::kReady && Chance(0.02)) cell_.Execute();
    if (release_in_ > 0 && --release_in_ == 0) {
      Control off{.enable = true, .path_stop = false, .path_halt = false, .stop_all = false, .path_interrupt = false};
      off.hw_limit_positive = off.hw_limit_negative = std::array<bool, kAllAxes>{};
      cell_.Give(off);
      cell_.Give(Jog{});
    }
    if (!Chance(0.002)) return;
    const bool on = Chance(0.8);
    release_in_ = std::uniform_int_distribution<int>(20, 800)(random_);
    switch (std::uniform_int_distribution<int>(0, 9)(random_)) {
      case 0:
        return static_cast<void>(cell_.Give(Control{.path_stop = on}));
      case 1:
        return static_cast<void>(cell_.Give(Control{.path_halt = on}));
      case 2:
        return static_cast<void>(cell_.Give(Control{.path_interrupt = on}));
      case 3:
        if (on) Excuse();
        return static_cast<void>(cell_.Give(Control{.stop_all = on}));
      case 4:
        return static_cast<void>(cell_.Give(Control{.enable = !on}));
      case 5:
        cell_.Give(Control{.abort = true});
        return static_cast<void>(cell_.Give(Control{.abort = false}));
      case 6: {
        std::array<bool, kAllAxes> positive{}, negative{};
        const std::array<std::size_t, 4> axes = {0, 1, kFirstReal, kFirstReal + 1};  // X, Y, A1, A2
        if (on) {
          (Chance(0.5) ? positive : negative)[axes[std::uniform_int_distribution<std::size_t>(0, 3)(random_)]] = true;
          Excuse();
        }
        return static_cast<void>(
            cell_.Give(Control{.enable_hw_limit = true, .hw_limit_positive = positive, .hw_limit_negative = negative}));
      }
      case 7:
        if (!Chance(0.3)) return;
        Excuse();
        return axis::Fail(cell_.rig.AxisContext(2), ErrorId::kSoftLimitPositive, false, cell_.rig.states[2]);
      case 8:
        cell_.Give(Control{.select_axis = static_cast<SelectAxis>(std::uniform_int_distribution<int>(1, 3)(random_))});
        return static_cast<void>(cell_.Give(Jog{.positive = on, .negative = !on && Chance(0.5)}));
      default:
        return static_cast<void>(cell_.Give(Jog{}));
    }
  }
  // Where each axis stops by itself nothing rises: from there the tool goes up before anything else.
  void Excuse() { excused_ = true; }

  void WatchSwitches() {
    const std::array<std::pair<std::size_t, std::size_t>, 4> axes = {
        {{0, 0}, {1, 1}, {kFirstReal, 0}, {kFirstReal + 1, 1}}};
    for (std::size_t n = 0; n < axes.size(); ++n) {
      const KinematicState& set = cell_.rig.states[axes[n].second].setpoint;
      const double v = set.velocity;
      for (const int sense : {1, -1}) {
        const auto& inputs = sense > 0 ? cell_.state.inputs.hw_limit_positive : cell_.state.inputs.hw_limit_negative;
        const bool closed = cell_.state.inputs.enable && cell_.state.inputs.enable_hw_limit && inputs[axes[n].first];
        std::optional<double>& place = rested_[2 * n + (sense > 0 ? 1 : 0)];
        if (!closed) place.reset();
        if (closed) ++figures_.closed;
        // Once it no longer moves towards the switch it comes no closer; a motion with an acceleration cannot be braked
        // at once.
        if (place) {
          place = std::min(*place, sense * set.position);
          ASSERT_LE(sense * set.position - *place, kSlip)
              << "axis " << axes[n].second << ", state " << static_cast<int>(cell_.state.state);
        }
        if (closed && !place && sense * v <= 1e-6 && sense * set.acceleration <= 1e-6) place = sense * set.position;
      }
    }
  }

  void WatchHeight() {
    const KDL::Vector tool = cell_.tool();
    const double height = tool.z() - kSeamZ;
    const bool over = std::abs(tool.y() - kSeamY) < kHalfWidth;
    const auto speed = [&](std::size_t k) { return cell_.rig.states[k].setpoint.velocity; };
    const bool jogs = cell_.state.state == M::kJogPos || cell_.state.state == M::kJogNeg;
    if (jogs || cell_.state.state == M::kService) Excuse();  // by hand it may move anywhere
    const group::GroupState state = cell_.rig.state.state;
    const bool alone = state == group::GroupState::kDisabled || state == group::GroupState::kErrorStop;
    if (alone) Excuse();  // each axis, or the group for a fault of one
    if (!over || height > kUpFrom - kRound) {
      if (!jogs && !alone && cell_.state.state != M::kError && !cell_.state.inputs.stop_all) excused_ = false;
      was_over_ = over;
      return;
    }
    if (height > kLow) return;
    // Jogged down beside the belt it comes from there: the width of belts is not known.
    if (!was_over_) Excuse();
    was_over_ = true;
    ++figures_.low;
    if (excused_) return;
    const double against = std::hypot(speed(0) - cell_.belt_states[0].travel.velocity, speed(1));
    figures_.fastest = std::max(figures_.fastest, against);
    ASSERT_LE(against, kStill) << "height " << height << ", state " << static_cast<int>(cell_.state.state);
    if (!says_how_) return;
    figures_.furthest = std::max({figures_.furthest, tool.x() - kUpper, kLower - tool.x()});
    ASSERT_LE(figures_.furthest, 0) << "height " << height;
  }

  std::mt19937_64 random_;
  bool says_how_;
  SeamFigures& figures_;
  Cell cell_;
  bool excused_ = false, was_over_ = false;
  int release_in_ = 0;
  std::array<std::optional<double>, 8> rested_{};  // the least so far, seen towards the switch
};

TEST(Seams, SwitchesAndHeightsAtRandom) {
  SeamFigures figures;
  const int runs = Trials(40, 50);
  for (int seed = 1; seed <= runs && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    SeamsRun run(static_cast<std::uint64_t>(seed), figures);
    run.Run(8000);
  }
  std::cout << figures.picked << " picked, " << figures.placed << " placed, " << figures.errors << " errors, low for "
            << figures.low << " cycles, at most " << figures.fastest << " mm/s against the belt and "
            << figures.furthest << " mm beyond the range; switches on for " << figures.closed << " cycles\n";
  EXPECT_GT(figures.picked, runs / 2);
  EXPECT_GT(figures.low, 100 * runs) << "a test that cannot fail";
  EXPECT_GT(figures.closed, 100 * runs) << "a test that cannot fail";
}

}  // namespace
}  // namespace takt::pickplace
