// Any serial chain of up to eight axes, as URDF describes it: the inverse is found step by step (Newton-Raphson with
// damped least squares) from where the axes are near. Positions of the axes in mm and rad.
//
// KDL has such a solver too. Its objects keep buffers and caches that change with every call, so that one cannot be
// shared or copied as plain data, and mixes mm with rad when it asks whether it is there; here all of it is a function
// of the arguments. KDL's is the yardstick in tests and benchmarks.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "takt/core/name.h"
#include "takt/kinematics/chain.h"

namespace takt::kinematics {

struct Serial {
  Chain chain;
  std::array<Name, kMaxJoints> links{};  // what each axis moves, as URDF calls it
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

}  // namespace takt::kinematics
