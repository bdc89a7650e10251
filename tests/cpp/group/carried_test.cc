// GR-42: moves on what is carried along, beside the same moves at rest.
#include <iostream>

#include "belts.h"
#include "takt/trajectory/planner.h"

namespace takt::group {
namespace {

// From place to place on a belt that goes through the middle of the way, in step before and behind, s.
double TimeOnBelt(Rig rig, Pose belt, double speed, const std::vector<KDL::Vector>& places) {
  const Frame frame = kinematics::ToFrame(belt);
  const KDL::Vector begin = frame * KDL::Vector(-std::copysign(0.2 * std::abs(speed), speed), 0, 0);
  belt = {begin.x(), begin.y(), begin.z(), belt.a, belt.b, belt.c};
  rig.StartAt(belt);
  const auto belts = Put(rig, {BeltAt("belt", belt, [=](double t) { return Steady(t, speed); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt"), .recorded_position = 0.0}));
  EXPECT_TRUE(rig.RunToEnd(rig.Give(Line(0, 0, 0, 1)), 2));
  rig.trace.clear();
  Ticket last = 0;
  for (const KDL::Vector& to : places) {
    const bool first = last == 0;
    last = rig.Give(
        Line(to.x(), to.y(), to.z(), 1, first ? BufferMode::kBuffered : BufferMode::kBlendingNext, first ? 0 : 10));
  }
  EXPECT_TRUE(rig.RunToEnd(last, 5));
  EXPECT_TRUE(rig.lives[last].done) << static_cast<int>(rig.lives[last].error_id);
  ExpectSmooth(rig);
  const auto moves = [](const Sample& sample) { return sample.out.path_velocity > 0; };
  return static_cast<double>(std::ranges::count_if(rig.trace, moves)) * rig.cycle.period_s;
}

struct Robot {
  std::string name;
  std::function<Rig()> make;
  Pose belt;
  std::vector<double> speeds;  // mm/s
};

// GR-42: a belt at constant speed takes nothing from accelerations: a move on it takes as long as on one that stands.
// Only along a belt at two thirds of its axis' speed the velocity that is left makes it longer.
TEST(Carried, TakesAsLongAsAtRest) {
  const std::vector<std::pair<std::string, std::vector<KDL::Vector>>> moves = {
      {"lift", {{0, 0, 25}}},   {"along", {{60, 0, 0}}},    {"back", {{-60, 0, 0}}},
      {"across", {{0, 60, 0}}}, {"aslant", {{40, 40, 20}}}, {"lift and over", {{0, 0, 25}, {0, 80, 25}, {0, 80, 0}}},
  };
  const std::vector<Robot> robots = {
      {"gantry", [] { return Gantry(); }, {}, {100, -300, 500, 1000, -1000}},
      {"Delta", DeltaRobot, {0, 0, -900}, {100, -300, 500, 1000}},
      {"SCARA", ScaraRobot, {400, 0, 0, 0, 0, 90}, {100, -200, 300}},
  };
  for (const Robot& robot : robots) {
    for (const auto& [name, places] : moves) {
      const double rest = TimeOnBelt(robot.make(), robot.belt, 0, places);
      for (const double speed : robot.speeds) {
        SCOPED_TRACE(testing::Message() << robot.name << ", " << name << " at " << speed << " mm/s");
        const double time = TimeOnBelt(robot.make(), robot.belt, speed, places);
        std::cout << robot.name << ", " << name << " at " << speed << " mm/s: " << time / rest
                  << " of the time at rest\n";
        const bool fast = robot.name == "gantry" && std::abs(speed) == 1000 && (name == "along" || name == "back");
        EXPECT_LE(time, (fast ? 1.2 : places.size() > 1 ? 1.03 : 1.02) * rest);
      }
    }
  }
}

// The least time [s] in which an axis gets from rest to a place that is `way` ahead and moves with `speed`, seen from
// there: the profile is Ruckig's.
double LeastTime(double way, double speed, const trajectory::Limits& axis) {
  trajectory::Planner planner;
  trajectory::Profile profile;
  const trajectory::Bounds bounds = {axis.acceleration, axis.acceleration, axis.jerk};
  EXPECT_FALSE(planner.ToPosition({-way, -speed, 0}, 0, axis.velocity + std::abs(speed), bounds, profile).failed());
  return profile.duration();
}

// GR-42: reaching a place on a belt from rest, beside the least time of its axes.
TEST(Carried, GetsOntoABeltFromRestNearlyAsFastAsItsAxes) {
  const trajectory::Limits axis = {1500, 10000, 10000, 500000};
  double sum = 0;
  int count = 0;
  for (const double speed : {50.0, -150.0, 300.0}) {
    for (const auto& [dx, dy] : {std::pair{0.0, 20.0},
                                 {0.0, 50.0},
                                 {0.0, 200.0},
                                 {50.0, 0.0},
                                 {200.0, 0.0},
                                 {-200.0, 0.0},
                                 {100.0, 100.0},
                                 {-50.0, 150.0}}) {
      SCOPED_TRACE(testing::Message() << dx << ", " << dy << " on a belt at " << speed << " mm/s");
      KinematicsParams gantry;
      gantry.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
      const PathLimits free{.velocity = 4000, .acceleration = 60000, .deceleration = {}, .jerk = 3e6};
      Rig rig = Machine(gantry, {"x", "y", "z"}, {}, free);
      rig.params.tracking.board = true;
      rig.StartAt({});
      const auto belts = Put(rig, {BeltAt("belt", {}, [speed = speed](double t) { return Steady(t, speed); })});
      const double now = static_cast<double>(rig.cycle.count) * rig.cycle.period_s * speed;
      rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt"), .recorded_position = now}));
      rig.trace.clear();
      const Ticket move = rig.Give(Line(dx, dy, 0, 1));
      EXPECT_TRUE(rig.RunToEnd(move, 5));
      EXPECT_TRUE(rig.lives[move].done);
      ExpectSmooth(rig);
      const double time = static_cast<double>(rig.trace.size()) * rig.cycle.period_s;
      const double least = std::max(LeastTime(dx, speed, axis), LeastTime(dy, 0, axis));
      std::cout << dx << ", " << dy << " on a belt at " << speed << " mm/s: " << time / least << " of the least time\n";
      EXPECT_LE(time, 1.3 * least);
      sum += time / least;
      ++count;
    }
  }
  EXPECT_LE(sum / count, 1.12);
}

}  // namespace
}  // namespace takt::group
