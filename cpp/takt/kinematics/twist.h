// Twists of chains as columns of matrices: in one unit, with a fixed capacity for the largest chain, without
// allocating.
#pragma once

#include <Eigen/Core>
#include <kdl/frames.hpp>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

inline constexpr int kMostColumns = static_cast<int>(kMaxJoints);
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostColumns, 1>;
using Six = Eigen::Matrix<double, 6, 1>;

// Returns the twist with its velocity divided by this length [mm], which makes it comparable to the angular velocity.
inline Six Scaled(const KDL::Twist& twist, double length) {
  Six six;
  for (int i = 0; i < 3; ++i) {
    six(i) = twist.vel(i) / length;
    six(i + 3) = twist.rot(i);
  }
  return six;
}

}  // namespace takt::kinematics
