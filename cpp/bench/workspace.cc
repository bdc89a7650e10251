// GR-13: what it costs to check a path before it starts.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "takt/workspace/checker.h"

namespace takt::workspace {
namespace {

using kinematics::Frame;
using kinematics::Joints;
using kinematics::Kinematics;

Kinematics Delta() {
  const kinematics::DeltaParams delta{
      .base_radius = 200, .platform_radius = 45, .upper_arm = 235, .lower_arm = 800, .rod_spacing = 80, .rotary = true};
  return *kinematics::Make({.delta = delta, .joints = {}}).kinematics;
}

// 300 mm across at the height of the belt, one position a millimetre.
std::vector<Sample> Path(const Kinematics& delta) {
  std::vector<Sample> path;
  Joints near{40, 40, 40};
  for (int i = 0; i <= 300; ++i) {
    Sample sample{static_cast<double>(i), near};
    const Frame tool(KDL::Vector(i - 150.0, 40, -850));
    if (Inverse(delta, tool, {}, near, sample.joints) != kinematics::Reason::kNone) std::abort();
    near = sample.joints;
    path.push_back(sample);
  }
  return path;
}

SolidParams Named(const std::string& name, const kinematics::Pose& pose) {
  return {.name = name, .link = {}, .pose = pose};
}

// Ten obstacles: a belt, posts of the frame, boxes beside the path.
WorkspaceParams Cell(bool self_collisions) {
  WorkspaceParams cell;
  cell.self_collisions = self_collisions;
  cell.obstacles.push_back(Named("belt", {.z = -985}));
  cell.obstacles.back().box = BoxParams{1500, 300, 100};
  for (int i = 0; i < 4; ++i) {
    cell.obstacles.push_back(Named("post", {.x = i % 2 ? 600.0 : -600.0, .y = i < 2 ? 600.0 : -600.0, .z = -600}));
    cell.obstacles.back().cylinder = CylinderParams{40, 1200};
  }
  for (int i = 0; i < 5; ++i) {
    cell.obstacles.push_back(Named("box", {.x = 100.0 * i - 200, .y = 250, .z = -900, .c = 20.0 * i}));
    cell.obstacles.back().box = BoxParams{60, 60, 80};
  }
  SolidParams upper{.name = "", .link = "upper_arm"};
  upper.capsule = CapsuleParams{.radius = 25};
  SolidParams lower{.name = "", .link = "lower_arm"};
  lower.capsule = CapsuleParams{.radius = 8};
  SolidParams platform{.name = "", .link = "platform"};
  platform.cylinder = CylinderParams{60, 20};
  cell.links = {upper, lower, platform};
  cell.gripper.push_back(Named("cup", {.z = -40}));
  cell.gripper.back().cylinder = CylinderParams{15, 60};
  return cell;
}

void Check(benchmark::State& state, const WorkspaceParams& cell) {
  const Kinematics delta = Delta();
  const std::vector<Sample> path = Path(delta);
  Checker checker = *Make(cell, delta).checker;
  for (auto _ : state) {
    const std::optional<Finding> found = checker.Check(path);
    if (found) state.SkipWithError(checker.Describe(*found).c_str());
  }
}

void Obstacles(benchmark::State& state) {
  Check(state, Cell(false));
}
void ObstaclesAndItself(benchmark::State& state) {
  Check(state, Cell(true));
}

// The boxes become balls of some 5000 triangles each.
void Meshes(benchmark::State& state) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "takt_bench_ball.stl";
  {
    std::ofstream text(file);
    text << "solid\n";
    const auto vertex = [&](int i, int k) {
      const double a = std::numbers::pi * i / 50;
      const double b = std::numbers::pi * k / 50;
      text << "vertex " << std::sin(b) * std::cos(a) << ' ' << std::sin(b) * std::sin(a) << ' ' << std::cos(b) << '\n';
    };
    for (int i = 0; i < 100; ++i) {
      for (int k = 0; k < 50; ++k) {
        text << "facet\n";
        vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1);
        text << "endfacet\n";
      }
    }
  }
  WorkspaceParams cell = Cell(false);
  for (SolidParams& solid : cell.obstacles) {
    if (solid.name != "box") continue;
    solid.box.reset();
    solid.mesh = MeshParams{file.string(), 40};
  }
  Check(state, cell);
  std::filesystem::remove(file);
}

BENCHMARK(Obstacles)->Name("DeltaPath300mmTenObstacles")->Unit(benchmark::kMicrosecond);
BENCHMARK(ObstaclesAndItself)->Name("DeltaPath300mmTenObstaclesAndItself")->Unit(benchmark::kMicrosecond);
BENCHMARK(Meshes)->Name("DeltaPath300mmFiveMeshes")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace takt::workspace
