// Any serial chain of up to eight axes, as URDF describes it: the inverse is found iteratively (Newton-Raphson with
// damped least squares) from the axes given as `near`. Positions of the axes in mm and rad.
//
// KDL has a solver for this, too. Its objects keep buffers and caches that change with every call, so they cannot be
// shared or copied as plain data, and it mixes mm with rad in its stopping criterion; here everything is a function of
// the arguments. KDL's solver is the reference in tests and benchmarks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "takt/core/name.h"
#include "takt/kinematics/chain.h"
#include "takt/kinematics/offset_arm.h"
#include "takt/kinematics/six_axis.h"

namespace takt::kinematics {

// A chain with the geometry of an articulated arm with a spherical wrist (six_axis.h) or with an offset one
// (offset_arm.h), however its file places its axes: tool = base * arm(zero + sign * joints) * flange.
struct ClosedForm {
  bool known = false;
  std::variant<SixAxis, OffsetArm> arm;
  Frame base;
  Frame flange;
  std::array<double, 6> zero{};  // [rad]
  std::array<double, 6> sign{};
};
// Finds the closed form from the lines of the axes. `known` is false if the chain is of another kind.
ClosedForm Recognise(const Chain& chain);

struct Serial {
  Chain chain;
  std::array<Name, kMaxJoints> links{};  // name in URDF of the link that each axis moves
  ClosedForm closed{};
};

// Returns the position to which the iteration from `near` converges, on the same side of all singularities: kSingular
// if it lies on the other side (with other than six axes that is only checked if no rotary axis moves by 0.5 rad or
// more). kOutOfReach also if nothing was found within 100 steps. With fewer than six axes the chain must be able to
// take the pose; with more, the axes move as little as possible.
Reason Inverse(const Serial& serial, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept;

// Limits of an axis of a chain in URDF.
struct JointLimits {
  std::optional<double> lower;  // [mm] or [rad]
  std::optional<double> upper;
};
struct UrdfChain {
  Chain chain;
  std::array<JointLimits, kMaxJoints> limits;
  std::array<Name, kMaxJoints> links;
};

// Returns the chain from link `base` to link `tip`; empty: from the root, to the only end. Nothing, with a sentence in
// `why`, if there is none. Not for the cycle.
std::optional<UrdfChain> ReadUrdf(const std::string& xml, const std::string& base, const std::string& tip,
                                  std::string& why);

// Names in URDF of the parts of a chain.
struct UrdfNames {
  std::vector<std::string> joints;  // joints of the axes, from the base to the tip
  std::string tip;                  // link
};

// Requires: ReadUrdf has succeeded with these arguments.
UrdfNames ReadUrdfNames(const std::string& xml, const std::string& base, const std::string& tip);

// Purpose of a shape in a URDF.
enum class UrdfPurpose : std::uint8_t { kCollision, kVisual };

// A shape of a link in a URDF. Lengths in mm.
struct UrdfShape {
  enum class Kind : std::uint8_t { kBox, kCylinder, kSphere, kMesh };
  std::string link;      // name in URDF
  std::size_t axis = 0;  // number of the axis of the chain, from 1, whose link carries it; 0: the base
  Kind kind = Kind::kBox;
  std::array<double, 3> size{};  // box: edges; cylinder: radius, length along Z; sphere: radius; mesh: mm per unit
  std::string mesh;              // file name in URDF
  Frame pose;                    // of its centre, or of the mesh, on the link that carries it
};

// Returns the shapes of all links that are connected by fixed joints only with a link of the chain or with its base, on
// either side. Requires: ReadUrdf has succeeded with these arguments.
std::vector<UrdfShape> ReadUrdfShapes(const std::string& xml, const std::string& base, const std::string& tip,
                                      UrdfPurpose purpose = UrdfPurpose::kCollision);

}  // namespace takt::kinematics
