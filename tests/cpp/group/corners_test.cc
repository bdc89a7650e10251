// GR-40, GR-41: sharp corners. Rounded within a bound or passed with a stop, whichever is quicker; within all limits.
#include <array>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>

#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

constexpr double kSlack_s = 0.0015;  // a cycle, and rounding

using Corners = std::vector<KDL::Vector>;

enum class Given : std::uint8_t { kMoves, kPath };

PathTable PathOf(const Corners& corners) {
  PathTable table;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    PathPiece piece;
    piece.to.x = corners[i].x();
    piece.to.y = corners[i].y();
    piece.to.z = corners[i].z();
    table.pieces.push_back(piece);
  }
  return table;
}

// Legs of 0.1 to 100 mm, turns up to `most_turn` deg.
Corners RandomCorners(std::mt19937_64& random, const KDL::Vector& from, double longest, double most_turn) {
  Corners corners{from};
  KDL::Vector direction(1, 0, 0);
  const int legs = static_cast<int>(Uniform(random, 3, 10));
  for (int i = 0; i < legs; ++i) {
    if (i > 0) {
      KDL::Vector side(Uniform(random, -1, 1), Uniform(random, -1, 1), Uniform(random, -1, 1));
      side = side - KDL::dot(side, direction) * direction;
      side.Normalize();
      const double turn = Uniform(random, 0, most_turn) * std::numbers::pi / 180;
      direction = std::cos(turn) * direction + std::sin(turn) * side;
      direction.Normalize();
    }
    corners.push_back(corners.back() + std::exp(Uniform(random, std::log(0.1), std::log(longest))) * direction);
  }
  return corners;
}

Corners Stairs(const KDL::Vector& from, double step, int count, double turn = 90) {
  Corners corners{from};
  const double angle = turn * std::numbers::pi / 180;
  for (int i = 0; i < count; ++i) {
    const KDL::Vector way =
        i % 2 == 0 ? KDL::Vector(step, 0, 0) : KDL::Vector(step * std::cos(angle), step * std::sin(angle), 0);
    corners.push_back(corners.back() + way);
  }
  return corners;
}

struct Went {
  double time = 0;
  double velocity = 0, acceleration = 0, jerk = 0;  // along the path, shares of its limits
  double off = 0;                                   // mm from the lines
};

// Goes along all corners; `transition` kNone: with stops.
Went GoAlong(const std::function<Rig(std::vector<PathTable>)>& make, const Corners& corners, Given given,
             TransitionMode transition, double parameter) {
  Rig rig = make({PathOf(corners)});
  const KDL::Vector& from = corners.front();
  rig.StartAt({from.x(), from.y(), from.z(), 0, 0, 0});
  rig.Step();
  rig.trace = {rig.trace.back()};
  Ticket last = 0;
  if (given == Given::kPath) {
    last = rig.Give(MovePath{.path = 0, .transition_mode = transition, .transition_parameter = parameter});
  } else {
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const bool blends = i > 1 && transition != TransitionMode::kNone;
      last = rig.Give(MoveLinearAbsolute{.x = corners[i].x(),
                                         .y = corners[i].y(),
                                         .z = corners[i].z(),
                                         .buffer_mode = blends ? BufferMode::kBlendingHigh : BufferMode::kBuffered,
                                         .transition_mode = blends ? transition : TransitionMode::kNone,
                                         .transition_parameter = blends ? parameter : 0});
    }
  }
  EXPECT_TRUE(rig.RunToEnd(last, 120));
  EXPECT_TRUE(rig.lives[last].done);
  ExpectSmooth(rig);
  EXPECT_LE((ToolOf(rig).p - corners.back()).Norm(), 1e-6);
  const PathLimits& limits = rig.params.path;
  Went went;
  went.time = static_cast<double>(rig.trace.size()) * rig.cycle.period_s;
  double before = 0;
  for (const Sample& sample : rig.trace) {
    went.velocity = std::max(went.velocity, sample.out.path_velocity / limits.velocity);
    went.acceleration = std::max(went.acceleration, std::abs(sample.out.path_acceleration) / limits.acceleration);
    const double jerk = std::abs(sample.out.path_acceleration - before) / rig.cycle.period_s;
    went.jerk = std::max(went.jerk, jerk / limits.jerk);
    before = sample.out.path_acceleration;
    double off = 1e99;
    const KDL::Vector p = ToolOf(rig, sample).p;
    for (std::size_t i = 1; i < corners.size(); ++i) off = std::min(off, FromLine(p, corners[i - 1], corners[i]));
    went.off = std::max(went.off, off);
  }
  return went;
}

void ExpectWithinLimits(const Went& went) {
  EXPECT_LE(went.velocity, 1 + 1e-6);
  EXPECT_LE(went.acceleration, 1 + 1e-6);
  EXPECT_LE(went.jerk, 1 + 1e-6);
}

Rig FlatBed(std::vector<PathTable> paths) {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
  return Machine(k, {"x", "y", "z"}, {500, 5000, 100000},
                 {.velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000}, std::move(paths));
}
// With axes that are weaker than the path.
Rig WeakFlatBed(std::vector<PathTable> paths) {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
  return Machine(k, {"x", "y", "z"}, {300, 3000, 40000},
                 {.velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000}, std::move(paths));
}
Rig FastGantry(std::vector<PathTable> paths) {
  return Gantry(std::move(paths));
}

TEST(Corners, OfStairsAreNeverSlowerThanStops) {
  double worst = 0;
  for (const double turn : {60.0, 90.0, 150.0}) {
    for (const double step : {2.0, 8.0, 30.0}) {
      const Corners corners = Stairs({0, 0, 0}, step, 9, turn);
      const double stops = GoAlong(FlatBed, corners, Given::kPath, TransitionMode::kNone, 0).time;
      for (const double deviation : {0.02, 0.1, 0.5, 2.0}) {
        SCOPED_TRACE(testing::Message() << turn << " deg, " << step << " mm, within " << deviation << " mm");
        const Went went = GoAlong(FlatBed, corners, Given::kPath, TransitionMode::kMaxCornerDeviation, deviation);
        ExpectWithinLimits(went);
        EXPECT_LE(went.off, deviation + 1e-3);
        EXPECT_LE(went.time, stops + kSlack_s);
        worst = std::max(worst, went.time / stops);
      }
    }
  }
  std::cout << "stairs: rounded at worst " << worst << " times as long as with stops\n";
}

// The same path one element at a time, and as a path of the machine.
TEST(Corners, OfRandomPolylinesKeepEveryLimit) {
  double slowest = 0, sum = 0;
  const int count = std::getenv("TAKT_LONG") ? 3000 : 40;
  for (int seed = 0; seed < count; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double longest = std::array{5.0, 20.0, 100.0}[random() % 3];
    const double turn = std::array{60.0, 120.0, 180.0}[random() % 3];
    const Corners corners = RandomCorners(random, {0, 0, 0}, longest, turn);
    const double deviation = std::exp(Uniform(random, std::log(0.005), std::log(3)));
    const auto make = std::array{FlatBed, WeakFlatBed, FastGantry}[random() % 3];
    const Given given = random() % 2 ? Given::kMoves : Given::kPath;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", within " << deviation << " mm");
    const double stops = GoAlong(make, corners, given, TransitionMode::kNone, 0).time;
    const Went went = GoAlong(make, corners, given, TransitionMode::kMaxCornerDeviation, deviation);
    ExpectWithinLimits(went);
    EXPECT_LE(went.off, deviation + 1e-3);
    EXPECT_LE(went.time, stops + kSlack_s);
    slowest = std::max(slowest, went.time / stops);
    sum += went.time / stops;
  }
  std::cout << "polylines: " << sum / count << " of the time with stops, at worst " << slowest << "\n";
}

// Up, across, down: as rounded as may be, on every mechanism that carries a tool so.
TEST(Corners, OfPickPathsAreNeverSlowerThanStops) {
  const auto delta = [](std::vector<PathTable> paths) {
    KinematicsParams k;
    k.delta = {.base_radius = 200, .platform_radius = 45, .upper_arm = 235, .lower_arm = 800};
    return Machine(k, {"a1", "a2", "a3"}, {800, 20000, 1e6},
                   {.velocity = 4000, .acceleration = 60000, .deceleration = {}, .jerk = 3e6}, std::move(paths));
  };
  const std::function<Rig(std::vector<PathTable>)> makes[] = {FastGantry, delta};
  for (const auto& make : makes) {
    const Corners corners = {{0, -140, -860}, {0, -140, -830}, {0, 140, -830}, {0, 140, -860}};
    const double stops = GoAlong(make, corners, Given::kMoves, TransitionMode::kNone, 0).time;
    for (const double radius : {0.3, 1.0, 3.0, 9.0, 15.0}) {
      const Went went = GoAlong(make, corners, Given::kMoves, TransitionMode::kCornerDistance, radius);
      SCOPED_TRACE(radius);
      EXPECT_LE(went.time, stops + kSlack_s);
      std::cout << radius << " mm: " << went.time << " s, with stops " << stops << " s\n";
    }
  }
}

}  // namespace
}  // namespace takt::group
