// Any serial chain of up to eight axes, as URDF describes it: the inverse is found step by step (Newton-Raphson with
// damped least squares) from where the axes are near. Positions of the axes in mm and rad.
//
// KDL has such a solver too. Its objects keep buffers and caches that change with every call, so that one cannot be
// shared or copied as plain data, and mixes mm with rad when it asks whether it is there; here all of it is a function
// of the arguments. KDL's is the yardstick in tests and benchmarks.
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
// (offset_arm.h), however its file puts its axes: tool = base * arm(zero + sign * joints) * flange.
struct ClosedForm {
  bool known = false;
  std::variant<SixAxis, OffsetArm> arm;
  Frame base;
  Frame flange;
  std::array<double, 6> zero{};  // rad
  std::array<double, 6> sign{};
};
// Finds it by the lines of the axes. Not known: the chain is of another kind.
ClosedForm Recognise(const Chain& chain);

struct Serial {
  Chain chain;
  std::array<Name, kMaxJoints> links{};  // what each axis moves, as URDF calls it
  ClosedForm closed{};
};

// The position found is the one that the axes given as near run into, on the same side of all singularities: where a
// step would lead to the other side, the answer is kSingular. kOutOfReach also when nothing was found within 100 steps.
// With fewer than six axes a pose must be one the chain can take; with more, the axes move as little as they can.
Reason Inverse(const Serial& serial, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept;

// What URDF says about the axes of a chain.
struct JointLimits {
  std::optional<double> lower;  // mm or rad
  std::optional<double> upper;
};
struct UrdfChain {
  Chain chain;
  std::array<JointLimits, kMaxJoints> limits;
  std::array<Name, kMaxJoints> links;
};

// The chain from link `base` to link `tip`; empty: from the root, to the only end. Nothing, and a sentence in `why`,
// when there is none. Not for the cycle.
std::optional<UrdfChain> ReadUrdf(const std::string& xml, const std::string& base, const std::string& tip,
                                  std::string& why);

// What URDF calls the parts of a chain.
struct UrdfNames {
  std::vector<std::string> joints;  // those of the axes, from the base to the tip
  std::string tip;                  // link
};

// The arguments are those of ReadUrdf, which must have read them.
UrdfNames ReadUrdfNames(const std::string& xml, const std::string& base, const std::string& tip);

// What a shape in a URDF is for.
enum class UrdfPurpose : std::uint8_t { kCollision, kVisual };

// A shape that URDF gives a link. Lengths in mm.
struct UrdfShape {
  enum class Kind : std::uint8_t { kBox, kCylinder, kSphere, kMesh };
  std::string link;      // as URDF calls it
  std::size_t axis = 0;  // the axis of the chain, counted from 1, whose link carries it; 0: the base carries it
  Kind kind = Kind::kBox;
  std::array<double, 3> size{};  // box: edges; cylinder: radius, length along Z; sphere: radius; mesh: mm for 1 in it
  std::string mesh;              // file, as URDF names it
  Frame pose;                    // of its middle, or of the mesh, on the link that carries it
};

// Those of all links that fixed joints alone connect with a link of the chain or with its base, on either side of it.
// The arguments are those of ReadUrdf, which must have read them.
std::vector<UrdfShape> ReadUrdfShapes(const std::string& xml, const std::string& base, const std::string& tip,
                                      UrdfPurpose purpose = UrdfPurpose::kCollision);

}  // namespace takt::kinematics
