// A mechanism with its shapes and obstacles, ready for checks. Made from the machine file; not for use within the
// cycle.
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

// A part of a link or of the gripper. Its number is that of the scene.
struct Body {
  std::string name;
  std::size_t link = 0;
  Shape shape;
};

struct Cell {
  kinematics::Kinematics kinematics;
  BoundsParams bounds;
  KDL::Vector tool_centre;  // in the flange's frame: the point that must stay within the bounds
  double margin = 0;        // [mm]
  double resolution = 0;    // [mm]
  std::vector<Obstacle> obstacles;
  std::vector<Body> bodies;
  // The obstacles that a body must not meet, and the pairs of bodies that must not meet.
  std::vector<std::vector<std::size_t>> obstacles_of;
  std::vector<std::array<std::size_t, 2>> pairs;
  // pairs that are not checked, since they are too near with all axes at 0
  std::vector<std::array<std::size_t, 2>> near_at_rest;
  Scene scene;
};

struct MadeCell {
  std::optional<Cell> cell;
  std::string path;     // if there is no cell: key of the wrong parameter, "obstacles[2].mesh.file"; empty: all of them
  std::string problem;  // and the reason
};

// A part of a link or of the gripper.
struct Part {
  std::string name;
  std::size_t link = 0;
  const SolidParams* solid = nullptr;
};

// Returns all parts, those of links first; links that the mechanism does not have are left out.
std::vector<Part> PartsOf(const WorkspaceParams& params, const kinematics::Kinematics& kinematics);

// `folder`: base of relative file paths. Reads files.
MadeCell MakeCell(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder);

}  // namespace takt::workspace
