// The kinematics of a group of axes: from positions of the axes to the pose of the tool and back, with velocities and
// accelerations.
//
// Axes count in their own units here: mm, or deg for axes that turn, with the zero and the sense the machine file gives
// them. The tool is a frame in mm; velocities of turning are in rad/s there. Everything but Make is for the cycle: it
// allocates nothing, keeps nothing, and never answers NaN or infinity.
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

// From an axis' own numbers to the mechanism's: (position - zero) * factor.
struct JointScale {
  double zero = 0;    // u
  double factor = 1;  // mm or rad per u; negative: the axis counts the other way round
};

// Where an axis may be, its ends included; without any: everywhere.
struct JointRange {
  double lower = -std::numeric_limits<double>::infinity();  // u
  double upper = std::numeric_limits<double>::infinity();   // u
};

struct Kinematics {
  Mechanism mechanism;
  std::size_t count = 0;  // of axes
  std::array<JointKind, kMaxJoints> kinds{};
  std::array<JointScale, kMaxJoints> scales{};
  // From URDF; else free. The SW limits of the axes, which change at run time, are not in here.
  std::array<JointRange, kMaxJoints> ranges{};
};

struct MakeResult {
  std::optional<Kinematics> kinematics;
  std::string path;     // without: which key of the parameters is wrong, "serial.urdf"; empty: all of them
  std::string problem;  // and why
};

// A URDF may be given as the text itself, which begins with <, instead of its file.
bool IsUrdfText(std::string_view urdf) noexcept;

// Checks the text of a URDF file, which must be UTF-8, and removes its byte order mark. Returns the first byte that is
// refused; nothing: none.
std::optional<Problem> CheckUrdfFile(std::string& text, std::string_view file);

// `folder`: where paths of files begin. Reads files and allocates.
MakeResult Make(const KinematicsParams& params, std::string_view folder = ".");

// Positions of the axes in the mechanism's own numbers, mm and rad.
Joints ToMechanism(const Kinematics& kinematics, const Joints& joints) noexcept;
// And the other way round.
Joints ToAxes(const Kinematics& k, const Joints& joints) noexcept;

// Where the tool is. kOutOfReach, kSingular: no such position (Delta). The result is of use with kNone only.
Reason Forward(const Kinematics& kinematics, const Joints& joints, Frame& tool) noexcept;
// The same with its motion.
Reason Forward(const Kinematics& kinematics, const JointMotion& motion, MovingFrame& tool) noexcept;

// Which of several positions of the axes this one is; kKeep for what the mechanism has no choice of.
Configuration ConfigurationOf(const Kinematics& kinematics, const Joints& joints) noexcept;

// Where the axes must be. What `wanted` keeps is as in `near`; an axis that turns comes as near to `near` as whole
// turns take it, so that a path followed point by point never jumps, and is refused (kAxisLimit) rather than turned
// back. For targets out of nowhere (`near` is NaN, or another branch than its own is wanted) axes come as near as can
// be to the middle of their range, or to 0 without one.
Reason Inverse(const Kinematics& kinematics, const Frame& tool, const Configuration& wanted, const Joints& near,
               Joints& joints) noexcept;
// The same with velocities and accelerations of the axes. Nothing is said about their limits.
Reason Inverse(const Kinematics& kinematics, const MovingFrame& tool, const Configuration& wanted, const Joints& near,
               JointMotion& motion) noexcept;

// Columns per unit of the axis: mm and rad of the tool per mm or per deg.
Reason JacobianAt(const Kinematics& kinematics, const Joints& joints, Jacobian& columns) noexcept;

}  // namespace takt::kinematics
