// Parameters of the workspace of a group from the machine file: the obstacles in the cell, the shapes of the
// mechanism's links and of its gripper, and their minimum distance.
//
//   workspace:
//     margin: 5
//     bounds: {lower: {z: -900}, upper: {z: -500}}
//     obstacles:
//       - {name: frame, box: {x: 40, y: 40, z: 600}, pose: {x: 500, z: -800}}
//       - {name: guard, mesh: {file: guard.stl}}
//     links:
//       - {link: upper_arm, capsule: {radius: 30}}
//       - {link: lower_arm, capsule: {radius: 8}}
//     gripper:
//       - {name: finger, cylinder: {radius: 10, height: 60}, pose: {z: -30}}
//     ignore: [[finger, lower_arm]]
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"

namespace takt::workspace {

// All shapes are centred at the origin of their pose.
struct BoxParams {
  double x = 0;  // [mm] edges
  double y = 0;
  double z = 0;
};

struct CylinderParams {
  double radius = 0;  // [mm]
  double height = 0;  // [mm] along Z
};

struct SphereParams {
  double radius = 0;  // [mm]
};

// A cylinder with a hemisphere on both ends.
struct CapsuleParams {
  double radius = 0;               // [mm]
  std::optional<double> length{};  // [mm] along Z, without the hemispheres; unset: along the link
};

struct MeshParams {
  std::string file;  // STL, relative to the machine file
  double scale = 1;  // [mm] per unit of the file
};

// One shape and its pose: an obstacle in the cell, or part of a link or gripper, with which it moves.
struct SolidParams {
  std::string name;  // for messages and `ignore`
  std::string link;  // links: its name, or the common beginning of the names of several
  std::optional<BoxParams> box{};
  std::optional<CylinderParams> cylinder{};
  std::optional<SphereParams> sphere{};
  std::optional<CapsuleParams> capsule{};
  std::optional<MeshParams> mesh{};
  kinematics::Pose pose{};
};

struct CornerParams {
  std::optional<double> x{};  // [mm]
  std::optional<double> y{};
  std::optional<double> z{};
};

struct BoundsParams {
  CornerParams lower;
  CornerParams upper;
};

// Positions are in the base frame of the mechanism.
struct WorkspaceParams {
  BoundsParams bounds;
  double margin = 5;        // [mm]
  double resolution = 0.5;  // [mm]
  std::vector<SolidParams> obstacles;
  std::vector<SolidParams> links;
  std::vector<SolidParams> gripper;
  std::vector<std::array<std::string, 2>> ignore;
  bool self_collisions = true;
};

void describe(Description<BoxParams>&);
void describe(Description<CylinderParams>&);
void describe(Description<SphereParams>&);
void describe(Description<CapsuleParams>&);
void describe(Description<MeshParams>&);
void describe(Description<SolidParams>&);
void describe(Description<CornerParams>&);
void describe(Description<BoundsParams>&);
void describe(Description<WorkspaceParams>&);

}  // namespace takt::workspace
