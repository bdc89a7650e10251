// Without a limit of jerk, 1 u at 1 u/s with 1 u/s² takes 2 s. Function blocks move an axis there, too.
#include <cstdio>
#include <takt/msgs/axis_state.hpp>

#include "takt/engine/load.h"
#include "takt/kinematics/kinematics.h"
#include "takt/plcopen/blocks.h"
#include "takt/trajectory/planner.h"
#include "takt/workspace/checker.h"

// Where the axis is after a move by function blocks; -1: the machine is not understood.
double Move() {
  const char* text =
      "name: one\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 0}, encoder: {increments_per_unit: "
      "1000}}]";
  takt::engine::LoadResult loaded = takt::engine::LoadMachine(text, "one.yaml");
  if (!loaded.machine) return -1;
  takt::engine::Engine engine(*loaded.machine);
  takt::plcopen::Program program(engine);
  takt::plcopen::MC_Power power(program.Axis("x"));
  takt::plcopen::MC_MoveAbsolute move(program.Axis("x"));
  power.Enable = true;
  move.position = 1;
  for (int i = 0; i < 10000 && !move.Done(); ++i) {
    program.Update();
    power();
    move.Execute = power.Status();
    move();
    engine.RunCycle();
  }
  return program.Axis("x").outputs().set_position;
}

// How far the level arms of a Delta reach down: lower arms of 650 with 390 sideways.
double Reach(const takt::kinematics::Kinematics& delta) {
  takt::kinematics::Frame tool;
  if (takt::kinematics::Forward(delta, {}, tool) != takt::kinematics::Reason::kNone) return 0;
  return -tool.p.z();
}

// Whether it would hit a box in front of its platform.
const char* Free(const takt::kinematics::Kinematics& delta) {
  takt::workspace::WorkspaceParams cell;
  cell.obstacles.push_back({.name = "box", .link = {}, .box = takt::workspace::BoxParams{50, 50, 50}});
  cell.obstacles.back().pose.z = -700;
  cell.gripper.push_back({.name = "cup", .link = {}, .sphere = takt::workspace::SphereParams{20}});
  takt::workspace::MakeResult made = takt::workspace::Make(cell, delta);
  const takt::workspace::Sample path[] = {{0, {}}, {100, {60, 60, 60}}};
  return made.checker->Check(path) ? "met" : "free";
}

int main() {
  takt::trajectory::Planner planner;
  takt::trajectory::Profile profile;
  const takt::trajectory::Limits limits{.velocity = 1, .acceleration = 1, .deceleration = 1, .jerk = 0};
  const takt::Status status = planner.ToPosition({}, 1.0, 0.0, limits, profile);
  const takt::msgs::axis_state message{};
  const takt::kinematics::MakeResult delta =
      takt::kinematics::Make({.delta = takt::kinematics::DeltaParams{200, 45, 235, 650}, .joints = {}});
  std::printf("%.1f s, %s, at %.1f, %.1f mm, %s\n", profile.duration(),
              message.getEncodedSize() > 0 ? "message" : "nothing", Move(), Reach(*delta.kinematics),
              Free(*delta.kinematics));
  return status.ok() ? 0 : 1;
}
