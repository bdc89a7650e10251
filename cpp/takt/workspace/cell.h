// A mechanism with its shapes among its obstacles, ready to be asked. Made from the machine file; not for the cycle.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/kinematics/links.h"
#include "takt/workspace/params.h"
#include "takt/workspace/scene.h"
#include "takt/workspace/shape.h"

namespace takt::workspace {

struct Obstacle {
  std::string name;
  Shape shape;
};

// Part of a link or of the gripper. Its number is that of the scene.
struct Body {
  std::string name;
  std::size_t link = 0;
  Shape shape;
};

struct Cell {
  kinematics::Kinematics kinematics;
  BoundsParams bounds;
  KDL::Vector tool_centre;  // on the flange: what stays within them
  double margin = 0;        // mm
  double resolution = 0;    // mm
  std::vector<Obstacle> obstacles;
  std::vector<Body> bodies;
  // Which obstacles a body must not meet, and which bodies one another.
  std::vector<std::vector<std::size_t>> obstacles_of;
  std::vector<std::array<std::size_t, 2>> pairs;
  std::vector<std::array<std::size_t, 2>> near_at_rest;  // left out, since they are too near with all axes at 0
  Scene scene;
};

struct MadeCell {
  std::optional<Cell> cell;
  std::string path;     // without: which key of the parameters is wrong, "obstacles[2].mesh.file"; empty: all of them
  std::string problem;  // and why
};

// Where a part of a link or of the gripper belongs.
struct Part {
  std::string name;
  std::size_t link = 0;
  const SolidParams* solid = nullptr;
};

// Of all parts, links first; links that the mechanism does not have are left out.
std::vector<Part> PartsOf(const WorkspaceParams& params, const kinematics::Kinematics& kinematics);

MadeCell MakeCell(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder);

}  // namespace takt::workspace
