// PP-44, CV-43: products at random on belts that change their speed. The tool is never low over the belt except
// straight over its workpiece and within the work range, and every product is accounted for. No pick is given up on its
// way down if the range of the belt's speed was stated; where it was not, some are, and the rest still holds. TAKT_LONG
// in the environment: 10,000 products instead of 300.
#include <iostream>
#include <random>

#include "../core/trials.h"
#include "cell.h"

namespace takt::pickplace {
namespace {

constexpr double kTop = 10;   // [mm] of products above the belt
constexpr double kRise = 25;  // [mm] of the way down that is straight except for its rounding
constexpr double kRounding = 10;

struct Point {
  double x = 0, y = 0, z = 0;
};

// A cell with one belt, at random.
struct Given {
  CellBelt belt;
  Settings settings;
  std::function<Rig()> machine;
  Point start;
  double gap_s = 0;  // mean time between products
};

using group::Uniform;

Given AtRandom(bool says_how_fast, std::mt19937_64& random) {
  Given made;
  Settings& s = made.settings;
  s = Fast();
  const bool delta = Uniform(random, 0, 1) < 0.5;
  if (delta) {
    made.machine = group::DeltaRobot;
    made.belt.params.origin = {-300, -80, -910, 0, 0, 0};
    made.start = {0, 0, -850};
    s.path_velocity = 3000;
    s.path_acceleration = s.path_deceleration = 30000;
    s.path_jerk = 1.5e6;
    s.x_target = 0;
    s.y_target = 120;
    s.z_target = -890;
  } else {
    made.machine = [] { return group::Gantry(); };
    made.belt.params.origin = {-300, 200, -60, 0, 0, 0};
    made.start = {0, 0, 50};
    s.x_target = Uniform(random, -200, 200);
    s.y_target = -50;
    s.z_target = -20;
  }
  s.tracking_mode = TrackingMode::kBelt1ToStatic;
  s.z_start_distance = kRise;
  s.blending_radius = kRounding;
  s.path_mode = Uniform(random, 0, 1) < 0.5 ? PathMode::kLinear : PathMode::kElliptical;
  s.z_elliptical = 15;
  s.workpiece_rule = static_cast<WorkpieceRule>(std::uniform_int_distribution<int>(0, 2)(random));
  CellBelt& belt = made.belt;
  const Pose& origin = belt.params.origin;
  belt.params.name = belt.params.axis = "belt";
  belt.params.lower_limit = 100;
  belt.params.upper_limit = 500;
  belt.settings = {.park_x = origin.x + 250,
                   .park_y = origin.y,
                   .park_z = origin.z + 60,
                   .z_distance = kRise,
                   .sync_time = std::round(Uniform(random, 0, 60)) * 0.001,
                   .lower_limit = 120,
                   .upper_limit = 480};
  // Uniform between a tenth and nearly twice of it.
  const double speed = Uniform(random, 30, delta ? 350 : 200);
  struct Swing {
    double share, pace, phase;
  };
  std::array<Swing, 2> swings{};
  for (Swing& swing : swings) swing = {Uniform(random, 0, 0.45), Uniform(random, 0.5, 4), Uniform(random, 0, 6)};
  belt.travel = [=](double t) {
    KinematicState x{speed * t, speed, 0};
    for (const Swing& w : swings) {
      x.position -= speed * w.share / w.pace * std::cos(w.pace * t + w.phase);
      x.velocity += speed * w.share * std::sin(w.pace * t + w.phase);
      x.acceleration += speed * w.share * w.pace * std::cos(w.pace * t + w.phase);
    }
    return x;
  };
  if (says_how_fast) belt.settings.highest_speed = speed * (1 + swings[0].share + swings[1].share);
  made.gap_s = Uniform(random, 0.2, 1.5) * (delta ? 0.6 : 1.2);
  return made;
}

struct Figures {
  std::uint32_t products = 0, picked = 0, too_late = 0, interrupted = 0, refused = 0, there = 0;
  std::uint32_t given_up_low = 0;  // on the straight way down
  // With the tool low over the belt:
  double furthest = 0;  // [mm] beyond the range
  double beside = 0;    // [mm] to the side of its workpiece
};

class RandomRun {
 public:
  RandomRun(Given made, std::mt19937_64& random)
      : gap_s_(made.gap_s), random_(random), cell_(made.settings, {made.belt}, made.machine()) {
    cell_.Start({made.start.x, made.start.y, made.start.z, 0, 0, 0});
    cell_.Execute();
    cell_.Step();
  }

  void Until(std::uint32_t products, Figures& figures) {
    const auto& counters = cell_.state.counters;
    double next_s = 0;
    std::uint32_t put = 0;
    for (int i = 0; put < products || belt().count > 0 || belt().lost > cell_.state.lost_before[0]; ++i) {
      ASSERT_LT(i, 3'000'000);
      const double now_s = i * 0.001;
      if (put < products && now_s >= next_s && belt().count < conveyor::kObjects) {
        next_s = now_s + std::exponential_distribution<double>(1 / gap_s_)(random_);
        cell_.Put(0, {Uniform(random_, -20, 100), Uniform(random_, -40, 40), kTop, 0, 0, 0});
        ++put;
      }
      Step(figures);
      if (testing::Test::HasFailure()) return;
      ASSERT_NE(cell_.state.state, PickPlaceState::kError) << static_cast<int>(cell_.state.error);
      const std::uint32_t uncounted = belt().lost - cell_.state.lost_before[0];  // until the next cycle
      ASSERT_EQ(put, counters.picked + counters.missed + belt().count + uncounted);
    }
    EXPECT_EQ(counters.missed, counters.too_late + counters.interrupted + counters.refused);
    figures.products += put;
    figures.picked += counters.picked;
    figures.too_late += counters.too_late;
    figures.interrupted += counters.interrupted;
    figures.refused += counters.refused;
    figures.there += belt().count;
  }

 private:
  conveyor::State& belt() { return cell_.belt_states[0]; }
  const BeltSettings& range() const { return cell_.state.belts[0]; }

  void Step(Figures& figures) {
    const std::uint32_t picked = cell_.state.counters.picked;
    cell_.rig.trace.clear();
    cell_.outs.clear();
    cell_.Step();
    const KDL::Vector tool = cell_.tool();
    const Order& order = cell_.state.orders[0];
    const std::uint32_t bound = cell_.state.order_count > 0 ? order.workpiece : 0;
    const double surface = cell_.belts[0].params.origin.z;
    // From other workpieces, picked or given up, it has to go up first.
    const conveyor::Object* mine = bound != 0 ? conveyor::Find(belt(), bound) : nullptr;
    if (mine && !low_) last_ = *mine;
    const conveyor::Object& at = last_;
    const KDL::Vector place = conveyor::PoseOf(cell_.belts[0].params, belt(), at).GetFrame().p;
    const KDL::Vector off = tool - place;
    const bool over = std::abs(tool.y() - cell_.belts[0].params.origin.y) < kHalfWidth;
    const bool picks = cell_.state.counters.picked > picked;
    const long stayed = on_;
    if (picks) lowers_ = false;
    const double height = tool.z() - surface - kTop;
    // Below the rounding it is straight over its workpiece.
    low_ = over && height < kRise - kRounding - 1e-3;
    if (low_) {
      ASSERT_GE(height, -kOnWorkpiece);
      ASSERT_LT(std::hypot(off.x(), off.y()), kBeside);
      figures.beside = std::max(figures.beside, std::hypot(off.x(), off.y()));
      const double along = conveyor::PlaceOf(cell_.belts[0].params, belt(), at);
      ASSERT_GE(along, range().lower_limit);
      figures.furthest = std::max(figures.furthest, along - range().upper_limit);
    }
    if (bound != before_) {
      if (lowers_) ++figures.given_up_low;
      lowers_ = false;
      on_ = 0;
    }
    if (picks) {
      ASSERT_GE(stayed, std::max(1L, std::lround(range().sync_time / 0.001)));
    }
    if (mine && low_) lowers_ = true;
    if (mine && off.Norm() < kOnWorkpiece) ++on_;
    before_ = bound;
    Lose();
  }

  // Removes workpieces beyond the range as a belt's own cycle does.
  void Lose() {
    for (std::uint32_t i = belt().count; i-- > 0;) {
      const conveyor::Object& object = belt().objects[i];
      if (object.state != conveyor::ObjectState::kVisible) continue;
      if (conveyor::PlaceOf(cell_.belts[0].params, belt(), object) <= *cell_.belts[0].params.upper_limit) continue;
      conveyor::Lose(object.number, belt());
    }
  }

  double gap_s_;
  std::mt19937_64& random_;
  Cell cell_;
  conveyor::Object last_;
  std::uint32_t before_ = 0;
  bool lowers_ = false, low_ = false;
  long on_ = 0;
};

Figures RunCells(bool says_how_fast) {
  const int cells = Trials(12, 30);
  Figures figures;
  for (int seed = 1; seed <= cells && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    RandomRun run(AtRandom(says_how_fast, random), random);
    run.Until(25, figures);
  }
  std::cout << figures.products << " products: " << figures.picked << " picked, " << figures.too_late << " too late, "
            << figures.interrupted << " interrupted, " << figures.refused << " refused, " << figures.there
            << " still there; " << figures.given_up_low << " given up on the way down; low over the belt "
            << figures.furthest << " mm beyond the range and " << figures.beside << " mm beside a workpiece at most\n";
  EXPECT_EQ(figures.products, figures.picked + figures.too_late + figures.interrupted + figures.refused);
  EXPECT_GT(figures.too_late, 0u);
  EXPECT_EQ(figures.furthest, 0);
  return figures;
}

TEST(Reach, ProductsAtRandom) {
  const Figures figures = RunCells(true);
  EXPECT_EQ(figures.given_up_low, 0u);
  EXPECT_GT(figures.picked, figures.products / 4);
}

TEST(Reach, FasterThanExpected) {
  const Figures figures = RunCells(false);
  EXPECT_LE(figures.given_up_low, figures.products / 500);
  EXPECT_GT(figures.picked, figures.products / 2);
}

}  // namespace
}  // namespace takt::pickplace
