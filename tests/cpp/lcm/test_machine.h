// A small machine and networks for the tests of this folder.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "takt/engine/machine.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {

constexpr std::int64_t kRunId = 4711;

inline engine::Machine TestMachine(int axes = 2) {
  engine::Machine machine;
  machine.name = "test";
  machine.lcm.dead_man_s = 0.25;
  for (int i = 0; i < axes; ++i) {
    axis::AxisParams axis;
    axis.name = std::string(1, static_cast<char>('x' + i));
    axis.limits.velocity = 100;
    axis.limits.acceleration = 1000;
    axis.limits.jerk = 20000;
    machine.axes.push_back(axis);
  }
  return machine;
}

// With a module "cutter": y is the slave of x.
inline engine::Machine WithModule(engine::Machine machine) {
  cam::CamParams cam;
  cam.name = "line";
  cam.points = {{0, 0, 1.0, {}}, {100, 100, 1.0, {}}};
  machine.cams = {cam};
  flexcam::FlexCamParams module;
  module.name = "cutter";
  module.slave = "y";
  module.master = "x";
  module.cams = {"line"};
  machine.flex_cams = {module};
  return machine;
}

// With x and y as a group "portal".
inline engine::Machine WithGroup(engine::Machine machine) {
  group::GroupParams group;
  group.name = "portal";
  group.axes = {"x", "y"};
  group.kinematics.emplace().gantry =
      kinematics::GantryParams{{kinematics::Coordinate::kX, kinematics::Coordinate::kY}};
  group.path = {.velocity = 100, .acceleration = 1000, .deceleration = {}, .jerk = 20000};
  machine.groups = {group};
  return machine;
}

// With a belt "infeed" on x, and a pose "mover".
inline engine::Machine WithBelt(engine::Machine machine) {
  conveyor::BeltParams belt;
  belt.name = "infeed";
  belt.axis = "x";
  machine.belts = {belt};
  machine.poses = {{.name = "mover"}};
  return machine;
}

// With a pick and place module "picker" that moves its group.
inline engine::Machine WithPicker(engine::Machine machine) {
  pickplace::PickPlaceParams picker;
  picker.name = "picker";
  picker.group = machine.groups[0].name;
  picker.belts.resize(1);
  picker.belts[0].belt = "infeed";
  machine.pick_and_place = {picker};
  return machine;
}

// With a planar mover "shuttle".
inline engine::Machine WithMover(engine::Machine machine) {
  machine.movers = {{.name = "shuttle"}};
  return machine;
}

// With a track "loop".
inline engine::Machine WithTrack(engine::Machine machine) {
  machine.tracks.resize(1);
  machine.tracks[0].name = "loop";
  return machine;
}

// With a group of movers "cell" and an environment "floor".
inline engine::Machine WithGround(engine::Machine machine) {
  machine.planar_groups = {{.name = "cell", .movers = {}, .tracks = {}}};
  machine.environments = {{.name = "floor", .stators = {}}};
  return machine;
}

// With a coordinate system "plane" and a part "lift" in it.
inline engine::Machine WithPart(engine::Machine machine) {
  machine.coordinate_systems.resize(1);
  machine.coordinate_systems[0].name = "plane";
  machine.parts.resize(1);
  machine.parts[0].name = "lift";
  return machine;
}

inline msgs::command Command(std::int64_t id, const std::string& target, const std::string& verb,
                             const std::string& arguments = "") {
  msgs::command m{};
  m.run_id = kRunId;
  m.client = "test";
  m.session = 1;
  m.id = id;
  m.target = target;
  m.verb = verb;
  m.arguments = arguments;
  return m;
}

// Private to this process; removed with this object.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& name)
      : path((std::filesystem::temp_directory_path() / (name + std::to_string(getpid()))).string()) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

// Returns an LCM network that no other test uses; its port is below the ephemeral ports of systems.
inline std::string NewUrl() {
  static int port = 10'000 + getpid() % 500 * 4;
  return "udpm://239.255.76.67:" + std::to_string(port++) + "?ttl=0";
}

}  // namespace takt::lcm
