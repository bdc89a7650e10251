// The kinematics of a group of axes: from positions of the axes to the pose of the tool and back, with velocities and
// accelerations.
//
// Axes count in their own units here: mm, or deg for rotary axes, with the zero and the sense given by the machine
// file. The tool is a frame in mm; its angular velocities are in rad/s. Everything but Make is for the cycle: it does
// not allocate, keeps no state, and never returns NaN or infinity.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "takt/core/problem.h"
#include "takt/kinematics/delta.h"
#include "takt/kinematics/joints.h"
#include "takt/kinematics/linear.h"
#include "takt/kinematics/params.h"
#include "takt/kinematics/scara.h"
#include "takt/kinematics/serial.h"
#include "takt/kinematics/six_axis.h"

namespace takt::kinematics {

using Mechanism = std::variant<Linear, Scara, Delta, SixAxis, Serial>;

// From an axis' own count to the mechanism's: (position - zero) * factor.
struct JointScale {
  double zero = 0;    // [u]
  double factor = 1;  // [mm/u] or [rad/u]; negative: the axis counts in the opposite sense
};

// Range of an axis, including its ends; by default unlimited.
struct JointRange {
  double lower = -std::numeric_limits<double>::infinity();  // [u]
  double upper = std::numeric_limits<double>::infinity();   // [u]
};

struct Kinematics {
  Mechanism mechanism;
  std::size_t count = 0;  // number of axes
  std::array<JointKind, kMaxJoints> kinds{};
  std::array<JointScale, kMaxJoints> scales{};
  // From URDF; else unlimited. The SW limits of the axes, which change at run time, are not included.
  std::array<JointRange, kMaxJoints> ranges{};
};

struct MakeResult {
  std::optional<Kinematics> kinematics;
  std::string path;     // if there are none: key of the parameters that is wrong, "serial.urdf"; empty: all of them
  std::string problem;  // why it is wrong
};

// Returns true if `urdf` is the text of a URDF, which begins with <, rather than its file.
bool IsUrdfText(std::string_view urdf) noexcept;

// Checks the text of a URDF file, which must be UTF-8, and removes its byte order mark. Returns the problem of the
// first byte that is refused; nothing if there is none.
std::optional<Problem> CheckUrdfFile(std::string& text, std::string_view file);

// `folder`: base of relative file paths. Reads files and allocates.
MakeResult Make(const KinematicsParams& params, std::string_view folder = ".");

// Returns positions of the axes in the mechanism's own count, mm and rad.
Joints ToMechanism(const Kinematics& kinematics, const Joints& joints) noexcept;
// The inverse of ToMechanism.
Joints ToAxes(const Kinematics& k, const Joints& joints) noexcept;

// Computes the pose of the tool. kOutOfReach, kSingular: there is no such position (Delta). The result is valid with
// kNone only.
Reason Forward(const Kinematics& kinematics, const Joints& joints, Frame& tool) noexcept;
// The same with its motion.
Reason Forward(const Kinematics& kinematics, const JointMotion& motion, MovingFrame& tool) noexcept;

// Returns the configuration of these positions of the axes; kKeep where the mechanism has no choice.
Configuration ConfigurationOf(const Kinematics& kinematics, const Joints& joints) noexcept;

// Computes the positions of the axes. kKeep in `wanted`: as in `near`. A rotary axis comes as near to `near` as whole
// turns allow, so that a path followed point by point never jumps; it is refused (kAxisLimit) rather than turned back.
// For targets without a history (`near` is NaN, or another branch than its own is wanted) axes come as near as possible
// to the middle of their range, or to 0 without one.
Reason Inverse(const Kinematics& kinematics, const Frame& tool, const Configuration& wanted, const Joints& near,
               Joints& joints) noexcept;
// The same with velocities and accelerations of the axes. Their limits are not checked.
Reason Inverse(const Kinematics& kinematics, const MovingFrame& tool, const Configuration& wanted, const Joints& near,
               JointMotion& motion) noexcept;

// Columns per unit of the axis: mm and rad of the tool per mm or per deg.
Reason JacobianAt(const Kinematics& kinematics, const Joints& joints, Jacobian& columns) noexcept;

}  // namespace takt::kinematics
