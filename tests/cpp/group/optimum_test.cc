// GR-23: moves of mechanisms beside the least time there is for them, which a tool of tests has found knowing the path
// of every joint (tests/tools/path_mechanisms.py).
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

using nlohmann::json;

struct Known {
  Rig rig;
  json path;

  // The tool where the table has its joints at this share of the path.
  kinematics::Pose At(double share) {
    const std::size_t row = static_cast<std::size_t>(std::lround(share * static_cast<double>(path["s"].size() - 1)));
    kinematics::Joints joints{};
    for (std::size_t k = 0; k < rig.kinematics->count; ++k) joints[k] = path["q"][k][row];
    Frame flange;
    EXPECT_EQ(kinematics::Forward(*rig.kinematics, joints, flange), kinematics::Reason::kNone);
    return kinematics::ToPose(flange);
  }
};

Known Load(const std::string& name) {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/data/path_optimum_joints.json");
  for (const json& p : json::parse(file)) {
    if (p["name"] != name) continue;
    GroupParams group;
    group.name = "group";
    KinematicsParams mechanism;
    const json& m = p["mechanism"];
    if (m.contains("delta")) {
      const json& d = m["delta"];
      mechanism.delta = {.base_radius = d["base_radius"],
                         .platform_radius = d["platform_radius"],
                         .upper_arm = d["upper_arm"],
                         .lower_arm = d["lower_arm"]};
    } else {
      const json& s = m["scara"];
      mechanism.scara = {.first_arm = s["first_arm"], .second_arm = s["second_arm"], .height = s.value("height", 0.0)};
    }
    group.kinematics = mechanism;
    const json& along = p["path"];
    group.path = {.velocity = along["velocity"],
                  .acceleration = along["acceleration"],
                  .deceleration = along["deceleration"],
                  .jerk = along["jerk"]};
    std::vector<axis::AxisParams> axes;
    for (const json& joint : p["joints"]) {
      group.axes.push_back("a" + std::to_string(axes.size()));
      axes.push_back(AxisOf(group.axes.back(), joint["velocity"], joint["acceleration"], joint["jerk"]));
    }
    return {Rig(group, axes), p};
  }
  throw std::runtime_error("no such path: " + name);
}

// From rest to rest, s.
double Time(Known& known, const std::vector<Command>& moves) {
  Rig& rig = known.rig;
  rig.StartAt(known.At(0));
  rig.Step();
  rig.trace.clear();
  Ticket last = 0;
  for (const Command& move : moves) last = rig.Give(move);
  EXPECT_TRUE(rig.RunToEnd(last));
  EXPECT_TRUE(rig.lives[last].done);
  ExpectSmooth(rig);
  ExpectAt(ToolOf(rig), known.At(1));
  const auto moving = [&](const Sample& sample) { return sample.out.path_velocity > 0; };
  return static_cast<double>(std::ranges::count_if(rig.trace, moving)) * rig.cycle.period_s;
}

void ExpectNear(const std::string& name, double time, double optimum, double most) {
  std::cout << name << ": " << time << " s, least " << optimum << " s, ratio " << time / optimum << "\n";
  EXPECT_GE(time, optimum) << name;
  EXPECT_LE(time, most * optimum) << name;
}

TEST(Optimum, OfLines) {
  for (const auto& [name, most] : {std::pair{"delta line", 1.05}, std::pair{"scara line", 1.12}}) {
    Known known = Load(name);
    const Pose to = known.At(1);
    const double time = Time(known, {MoveLinearAbsolute{.x = to.x, .y = to.y, .z = to.z, .c = to.c}});
    ExpectNear(name, time, known.path["optimum_s"], most);
  }
}

// All the way round, by points of the table.
TEST(Optimum, OfCircles) {
  for (const auto& [name, most] : {std::pair{"delta circle", 1.06}, std::pair{"scara circle", 1.17}}) {
    Known known = Load(name);
    const auto half = [&](double from) {
      const Pose via = known.At(from + 0.25), to = known.At(from + 0.5);
      MoveCircularAbsolute move{.circ_mode = path::CircMode::kBorder};
      move.aux_x = via.x;
      move.aux_y = via.y;
      move.aux_z = via.z;
      move.x = to.x;
      move.y = to.y;
      move.z = to.z;
      return move;
    };
    MoveCircularAbsolute first = half(0), second = half(0.5);
    second.buffer_mode = BufferMode::kBlendingHigh;
    ExpectNear(name, Time(known, {first, second}), known.path["optimum_s"], most);
  }
}

}  // namespace
}  // namespace takt::group
