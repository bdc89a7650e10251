// Groups of every kind of mechanism, with drives as they have them.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "rig.h"

namespace takt::group {

using kinematics::Coordinate;
using kinematics::KinematicsParams;
using kinematics::Pose;

// What each axis can do: speed, acceleration, jerk.
struct AxisCapability {
  double velocity = 1500, acceleration = 10000, jerk = 500000;
};

inline Rig Machine(KinematicsParams mechanism, std::vector<std::string> names, AxisCapability strength, PathLimits path,
                   std::vector<PathTable> paths = {}, const Pose& base = {}, const Pose& tool = {}) {
  GroupParams p;
  p.name = "group";
  p.axes = names;
  p.kinematics = std::move(mechanism);
  p.path = path;
  p.base = base;
  p.tool = tool;
  std::vector<axis::AxisParams> axes;
  for (const std::string& name : names) {
    axes.push_back(AxisOf(name, strength.velocity, strength.acceleration, strength.jerk));
  }
  return Rig(std::move(p), std::move(axes), std::move(paths));
}

inline constexpr PathLimits kGantryPath{.velocity = 1000, .acceleration = 8000, .deceleration = {}, .jerk = 400000};

// A gantry of X, Y, Z.
inline Rig Gantry(std::vector<PathTable> paths = {}, const Pose& base = {}, const Pose& tool = {}) {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
  return Machine(k, {"x", "y", "z"}, {}, kGantryPath, std::move(paths), base, tool);
}
// And what goes along: an axis that the kinematics does not know.
inline Rig GantryWithAuxiliary() {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
  return Machine(k, {"x", "y", "z", "u"}, {}, kGantryPath);
}
inline Rig GantryWithC() {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ, Coordinate::kC};
  return Machine(k, {"x", "y", "z", "c"}, {}, kGantryPath);
}
inline Rig CoreXy() {
  KinematicsParams k;
  k.core_xy = {.with_z = true, .with_c = false};
  return Machine(k, {"left", "right", "z"}, {}, kGantryPath);
}
inline Rig ScaraRobot() {
  KinematicsParams k;
  k.scara = {.first_arm = 325, .second_arm = 275, .height = 0};
  return Machine(k, {"a1", "a2", "z", "c"}, {600, 6000, 200000},
                 {.velocity = 2000, .acceleration = 20000, .deceleration = {}, .jerk = 600000});
}
// A Delta with the lengths of a FlexPicker (ABB IRB 340), fast axes.
inline Rig DeltaRobot() {
  KinematicsParams k;
  k.delta = {.base_radius = 200, .platform_radius = 45, .upper_arm = 235, .lower_arm = 800};
  return Machine(k, {"a1", "a2", "a3"}, {800, 20000, 1e6},
                 {.velocity = 4000, .acceleration = 60000, .deceleration = {}, .jerk = 3e6});
}
// An arm with the lengths of a small robot (KUKA KR 6).
inline Rig SixAxisRobot(const Pose& tool = {}) {
  KinematicsParams k;
  k.six_axis = {.a1 = 25, .a2 = -35, .b = 0, .c1 = 400, .c2 = 455, .c3 = 420, .c4 = 80};
  return Machine(k, {"a1", "a2", "a3", "a4", "a5", "a6"}, {300, 3000, 100000},
                 {.velocity = 1000, .acceleration = 8000, .deceleration = {}, .jerk = 300000}, {}, {}, tool);
}

// A mechanism and where its tool may well be.
struct Kind {
  std::string name;
  std::function<Rig()> make;
  std::function<Pose(std::mt19937_64&)> place;
};

inline double Uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline std::vector<Kind> Kinds() {
  const auto box = [](double x, double y, double low, double high, double turn) {
    return [=](std::mt19937_64& r) {
      return Pose{Uniform(r, -x, x), Uniform(r, -y, y), Uniform(r, low, high), 0, 0, Uniform(r, -turn, turn)};
    };
  };
  const auto ring = [](std::mt19937_64& r) {  // a quarter before the arm
    const double angle = Uniform(r, -0.7, 0.7), radius = Uniform(r, 300, 500);
    return Pose{radius * std::cos(angle), radius * std::sin(angle), Uniform(r, -100, 0), 0, 0, Uniform(r, -80, 80)};
  };
  const auto before = [](std::mt19937_64& r) {
    return Pose{Uniform(r, 350, 600), Uniform(r, -250, 250),         Uniform(r, 350, 650),
                Uniform(r, -20, 20),  90 + Uniform(r, -25, 25) - 25, Uniform(r, -20, 20)};
  };
  return {{"gantry", [] { return Gantry(); }, box(300, 300, -200, 200, 0)},
          {"gantry with C", GantryWithC, box(300, 300, -200, 200, 90)},
          {"CoreXY", CoreXy, box(300, 300, -200, 200, 0)},
          {"SCARA", ScaraRobot, ring},
          {"Delta", DeltaRobot, box(200, 200, -950, -800, 0)},
          {"six axes", [] { return SixAxisRobot(); }, before}};
}

}  // namespace takt::group
