// Twists of chains as columns of matrices: in one unit, as large as a chain may be, without allocating.
#pragma once

#include <Eigen/Core>
#include <kdl/frames.hpp>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

inline constexpr int kMostColumns = static_cast<int>(kMaxJoints);
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostColumns, 1>;
using Six = Eigen::Matrix<double, 6, 1>;

// Its velocity in parts of this length, mm, which makes it comparable to its turning.
inline Six Scaled(const KDL::Twist& twist, double length) {
  Six six;
  for (int i = 0; i < 3; ++i) {
    six(i) = twist.vel(i) / length;
    six(i + 3) = twist.rot(i);
  }
  return six;
}

}  // namespace takt::kinematics
