// Mechanisms whose axes move the tool along X, Y, Z and turn it about Z, each coordinate a sum of axes: gantries, and
// gantries whose X and Y are driven by two crossed belts (CoreXY, H-bot). Positions of the axes in mm and rad.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

enum class Coordinate : std::uint8_t { kX, kY, kZ, kC };

struct Linear {
  std::size_t count = 0;
  std::array<bool, 4> moves{};                       // true for X, Y, Z, C if the coordinate can change
  std::array<std::array<double, 4>, 4> to_tool{};    // [coordinate][axis]
  std::array<std::array<double, 4>, 4> to_joints{};  // [axis][coordinate]
  std::array<JointKind, 4> kinds{};
};

// One axis per coordinate, in this order; none twice.
Linear MakeGantry(const std::vector<Coordinate>& axes);
// Two belt motors: X is half the sum of their positions, Y half the difference. Z and C follow, if there are any.
Linear MakeCoreXy(bool with_z, bool with_c);

Reason Forward(const Linear& linear, const Joints& joints, Frame& tool) noexcept;
Reason Forward(const Linear& linear, const JointMotion& motion, MovingFrame& tool) noexcept;
Jacobian JacobianAt(const Linear& linear, const Joints& joints) noexcept;
// A coordinate that cannot change must be 0 in the pose, except for C, which is then ignored.
Reason Inverse(const Linear& linear, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept;
Reason SolveMotion(const Linear& linear, const MovingFrame& tool, JointMotion& motion) noexcept;

void describe(Enumeration<Coordinate>&);

}  // namespace takt::kinematics
