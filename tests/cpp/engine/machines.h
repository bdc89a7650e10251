// Machines for the tests of this folder.
#pragma once

#include <string>

#include "takt/engine/components.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"

namespace takt::engine {

// Linear and rotary axes, all three kinds of drives, an absolute encoder, a follower, a cam module, a group, belts, a
// pose, tracks, switches and a realistic servo.
inline const char* kFullMachine = R"(
name: full
cycle: {period_s: 0.001}
lcm: {axis_rate_hz: 1000}
axes:
  - name: y2
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    follows: {axis: y1, ratio: -1}
  - name: y1
    limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -500, upper: 500}
    supervision: {deviation_moving: 5, in_position: 0.05}
  - name: c
    unit: deg
    kind: rotary
    limits: {velocity: 3600, acceleration: 36000, jerk: 0}
    drive: {mode: cyclic_velocity}
    loop: {kp: 0.05, velocity_at_10v: 4000}
  - name: z
    limits: {velocity: 200, acceleration: 2000, jerk: 20000}
    encoder: {type: absolute_ssi, increments_per_unit: 2000, ssi_bits: 25, coding: gray}
    drive: {mode: analog}
    loop: {kp: 0.05, velocity_at_10v: 300}
  - name: knife
    limits: {velocity: 5000, acceleration: 100000, jerk: 10000000}
  - name: left
    limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -300, upper: 300}
  - name: right
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
groups:
  - name: portal
    axes: [left, right]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 300, acceleration: 3000, jerk: 60000}
paths:
  - name: round
    elements:
      - {shape: line, to: {x: 50, y: 0, z: 0}}
      - {shape: arc, via_x: 75, via_y: 25, via_z: 0, to: {x: 50, y: 50, z: 0}}
      - {shape: spline, points: [{x: 30, y: 60, z: 0}, {x: 0, y: 50, z: 0}]}
cams:
  - name: hill
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 180, y: 20, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
  - name: valley
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 180, y: -9, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
flex_cams:
  - name: cutter
    slave: knife
    master: c
    source: actual_value
    cams: [hill, valley]
    settings: {sync_mode: ramp_time, sync_in_time_s: 0.1, calculate_bounds: true, master_filter_s: 0.01,
               offset_mode_master: ramp_in, scaling_mode_slave: ramp_absolute, position_control: master_direction}
belts:
  - {name: infeed, axis: y1, origin: {x: 100, c: 30}, upper_limit: 250}
  - {name: table, kind: turning, axis: c, source: actual_value, filter_s: 0.01, lower_limit: -90, upper_limit: 3600}
poses:
  - {name: mover, goes_on_s: 0.2}
tracks:
  - {name: main, part: floor, elements: [{from: {x: 1000, y: 1000}, to: {x: 1300, y: 1000}}]}
  - {name: branch, part: floor, starts_from: [main]}
coordinate_systems: [{name: plane}]
parts:
  - {name: floor, columns: 16, rows: 16, positions: [{coordinate_system: plane, x: -240}, {coordinate_system: plane}]}
  - {name: drawer, positions: [{coordinate_system: plane, x: 4800}, {coordinate_system: plane, x: 4800, y: 100}]}
simulation:
  servos:
    - axis: z
      drive: {velocity_at_10v: 300}
      mechanics: {coulomb_friction: 0.5, viscous_friction: 0.001, backlash: 0.02, inertia: 0.001}
      switches: {limit_positive: {from: 90}}
      encoder: {type: absolute, increments_per_unit: 2000, ssi_bits: 25, coding: gray, noise_counts: 0.5}
)";

inline Machine FullMachine() {
  LoadResult loaded = LoadMachine(kFullMachine, "full.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

inline std::size_t AxisNamed(const Machine& machine, std::string_view name) {
  std::size_t i = 0;
  while (machine.axes[i].name != name) ++i;
  return i;
}

inline Command ToAxis(const Machine& machine, std::string_view name, const axis::Command& body) {
  Command command;
  command.target = static_cast<std::uint32_t>(AxisNamed(machine, name) + 1);
  command.body = body;
  return command;
}

inline Command ToModule(const Machine& machine, const flexcam::Command& body) {
  Command command;
  command.target = static_cast<std::uint32_t>(machine.axes.size() + 1);
  command.body = body;
  return command;
}

// To the first group.
inline Command ToGroup(const Machine& machine, const group::Command& body) {
  Command command;
  command.target = static_cast<std::uint32_t>(machine.axes.size() + machine.flex_cams.size() + 1);
  command.body = body;
  return command;
}

// To a belt of the machine.
inline Command ToBelt(const Machine& machine, std::size_t index, const conveyor::Command& body) {
  Command command;
  command.target =
      static_cast<std::uint32_t>(machine.axes.size() + machine.flex_cams.size() + machine.groups.size() + index + 1);
  command.body = body;
  return command;
}

inline Command ToTrack(const Machine& machine, std::string_view name, const track::Command& body) {
  return {.target = FindComponent(machine, name).value() + 1, .body = body};
}

inline Command ToPart(const Machine& machine, std::string_view name, const part::Command& body) {
  return {.target = FindComponent(machine, name).value() + 1, .body = body};
}

// To the first pose.
inline Command ToPose(const Machine& machine, const conveyor::PoseCommand& body) {
  Command command = ToBelt(machine, machine.belts.size(), {});
  command.body = body;
  return command;
}

// Commands for every axis, spread over the first seconds.
inline std::vector<std::pair<std::uint64_t, Command>> Scenario(const Machine& m) {
  using namespace axis;
  std::vector<std::pair<std::uint64_t, Command>> commands;
  for (const AxisParams& a : m.axes) commands.push_back({5, ToAxis(m, a.name, Power{})});
  commands.push_back({300, ToAxis(m, "y1", MoveAbsolute{.position = 200})});
  commands.push_back({300, ToAxis(m, "y1", MoveAbsolute{.position = 300, .buffer_mode = BufferMode::kBlendingNext})});
  commands.push_back({310, ToAxis(m, "c", MoveVelocity{.velocity = 3000})});
  commands.push_back({320, ToAxis(m, "z", MoveRelative{.distance = 50})});
  commands.push_back({500, ToAxis(m, "y1", MoveAbsolute{.position = -100})});
  commands.push_back({900, ToAxis(m, "z", Jog{.forward = true, .velocity = 100})});
  GearIn gear;
  gear.master = Name::Of("y1");
  gear.ratio_numerator = 2;
  commands.push_back({1200, ToAxis(m, "c", gear)});
  commands.push_back({1210, ToAxis(m, "c", PhasingRelative{.phase_shift = 3})});
  commands.push_back({1500, ToAxis(m, "c", Halt{})});
  commands.push_back({2000, ToAxis(m, "z", Reset{})});
  commands.push_back({2100, ToAxis(m, "c", MoveAbsolute{.position = 90, .direction = Direction::kPositive})});
  commands.push_back({2120, ToAxis(m, "c", SetOverride{.velocity_factor = 0})});
  commands.push_back({2150, ToAxis(m, "c", SetOverride{.acceleration_factor = 0.1, .jerk_factor = 0.1})});
  commands.push_back({2300, ToAxis(m, "z", StepDirect{.set_position = 1})});
  commands.push_back({2310, ToAxis(m, "z", SetPosition{.position = 2})});
  commands.push_back({2500, ToAxis(m, "y1", Stop{})});
  const auto to_group = [&](std::uint64_t cycle, const group::Command& body) {
    commands.push_back({cycle, ToGroup(m, body)});
  };
  to_group(310, group::Enable{});
  to_group(320, group::MoveDirectAbsolute{.a1 = 10, .a2 = -20});
  to_group(321, group::MovePath{.path = Name::Of("round"),
                                .buffer_mode = BufferMode::kBuffered,
                                .transition_mode = group::TransitionMode::kMaxCornerDeviation,
                                .transition_parameter = 1});
  to_group(322, group::MoveLinearRelative{.x = 100, .y = 5, .buffer_mode = BufferMode::kBlendingNext});
  to_group(700, group::Interrupt{});
  to_group(900, group::Continue{});
  to_group(1000, group::SetOverride{.velocity_factor = 0.3});
  to_group(1400, group::MoveLinearAbsolute{.x = 400});  // beyond the SW limit
  to_group(1410, group::MovePathSynchronized{.path = Name::Of("round"), .master = Name::Of("y1"), .ratio = -1});
  to_group(2100, group::Stop{});
  to_group(2600, group::Disable{});
  for (std::uint32_t i = 0; i < 33; ++i) {
    commands.push_back({340 + 10 * i, ToBelt(m, i % 3 == 0 ? 0 : 1, conveyor::Detect{.recorded_position = 10.0 * i})});
  }
  for (std::uint32_t i = 0; i < 12; ++i) commands.push_back({400 + 20 * i, ToBelt(m, 1, conveyor::Locate{.x = 80})});
  commands.push_back({650, ToBelt(m, 1, conveyor::TakeObject{3})});
  commands.push_back({660, ToBelt(m, 1, conveyor::RemoveObject{3})});
  commands.push_back({2400, ToBelt(m, 1, conveyor::ClearObjects{})});
  commands.push_back({355, ToTrack(m, "main", track::Enable{})});
  commands.push_back({420, ToTrack(m, "main", track::Disable{})});
  commands.push_back({460, ToTrack(m, "branch", track::AppendLine{1400, 1100, 1400, 1300, Name::Of("floor")})});
  commands.push_back({470, ToTrack(m, "branch", track::EndAtTrack{Name::Of("main")})});
  commands.push_back({2400, ToTrack(m, "branch", track::Clear{})});
  for (std::uint32_t i = 0; i < 6; ++i) {
    commands.push_back({500 + 300 * i, ToPart(m, "drawer", part::ActivatePosition{2 - i % 2})});
    commands.push_back({600 + 300 * i, ToPart(m, "floor", part::ActivatePosition{2 - i % 2})});
  }
  commands.push_back({350, ToPose(m, conveyor::SetPose{.x = 5, .vx = 10, .wy = 3})});
  using flexcam::Control;
  commands.push_back({6, ToModule(m, Control{.regulator_on = true})});
  commands.push_back({330, ToModule(m, Control{.sync_cam = true, .cam_table = 2u})});
  commands.push_back({600, ToModule(m, Control{.offset_master = 30.0, .scaling_slave = 0.5})});
  // A cam that is made at run time if there is a builder.
  cam::AddCamPoints points{.cam = Name::Of("made"), .first = 0, .points = {}};
  for (const double x : {0.0, 90.0, 360.0}) points.points.Add({x, x == 90 ? 12.5 : 0, 0, 0});
  commands.push_back({610, {.body = MachineCommand(cam::BeginCam{.name = Name::Of("made"), .cyclic = true})}});
  commands.push_back({611, {.body = MachineCommand(points)}});
  commands.push_back({612, {.body = MachineCommand(cam::BuildCam{Name::Of("made"), 3})}});
  commands.push_back({690, ToModule(m, flexcam::SetCam{1, Name::Of("made")})});
  commands.push_back({700, ToModule(m, flexcam::ChangeCam{1, flexcam::ChangeWhen::kCamPosition, 20,
                                                          flexcam::ChangeAlign::kVelocity})});
  commands.push_back({800, ToModule(m, flexcam::Configure{.sync_mode = flexcam::ClutchMode::kRampPos})});
  commands.push_back({1000, ToModule(m, Control{.sync_cam = false})});
  commands.push_back({1100, ToModule(m, Control{.sync_cam = true})});
  return commands;
}

}  // namespace takt::engine
