// Configuration of the kinematics of a group of axes in a machine file: the mechanism and its dimensions.
//
//   kinematics: {delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}
//   kinematics: {scara: {first_arm: 325, second_arm: 275}, joints: [{}, {invert: true}, {}, {}]}
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/linear.h"

namespace takt::kinematics {

struct GantryParams {
  std::vector<Coordinate> axes;  // coordinate that each axis moves, in the order of the group
};

struct CoreXyParams {
  bool with_z = false;
  bool with_c = false;
};

struct ScaraParams {
  double first_arm = 0;   // [mm]
  double second_arm = 0;  // [mm]
  double height = 0;      // [mm] Z of the tool with the Z axis at 0
};

struct DeltaParams {
  double base_radius = 0;      // [mm]
  double platform_radius = 0;  // [mm]
  double upper_arm = 0;        // [mm]
  double lower_arm = 0;        // [mm]
  double rod_spacing = 0;      // [mm]
  double first_arm_deg = 0;    // [deg]
  bool rotary = false;
};

struct SixAxisParams {
  double a1 = 0;  // [mm] all
  double a2 = 0;
  double b = 0;
  double c1 = 0;
  double c2 = 0;
  double c3 = 0;
  double c4 = 0;
};

struct SerialParams {
  std::string urdf;  // file, relative to the machine file; or the text itself
  std::string base;  // link; empty: the root
  std::string tip;   // link; empty: the only end
};

// Count of an axis, where it differs from its mechanism's.
struct JointParams {
  double zero = 0;      // [u] reading of the axis where the mechanism's own angle or position is 0
  bool invert = false;  // the axis counts in the opposite sense
};

struct KinematicsParams {
  std::optional<GantryParams> gantry{};
  std::optional<CoreXyParams> core_xy{};
  std::optional<ScaraParams> scara{};
  std::optional<DeltaParams> delta{};
  std::optional<SixAxisParams> six_axis{};
  std::optional<SerialParams> serial{};
  std::vector<JointParams> joints;  // one per axis, or empty
};

void describe(Description<GantryParams>&);
void describe(Description<CoreXyParams>&);
void describe(Description<ScaraParams>&);
void describe(Description<DeltaParams>&);
void describe(Description<SixAxisParams>&);
void describe(Description<SerialParams>&);
void describe(Description<JointParams>&);
void describe(Description<KinematicsParams>&);

}  // namespace takt::kinematics
