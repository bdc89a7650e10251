// GR-42: moves on what is carried along, beside the same moves at rest.
#include <iostream>

#include "belts.h"

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

}  // namespace
}  // namespace takt::group
