#include "takt/kinematics/serial.h"

#include <Eigen/Dense>
#include <cmath>

#include "takt/kinematics/twist.h"

namespace takt::kinematics {
namespace {

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostColumns, kMostColumns>;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostColumns>;

constexpr int kSteps = 100;
// Scaled error below which it is rounding.
constexpr double kArrived = 1e-13;
// Rounding of long chains; accepted when no step reduces the error.
constexpr double kGoodEnough = 2e-12;
// Largest displacement of an axis in a step [rad, or shares of the length], so that the first steps do not swing the
// arm about.
constexpr double kLongestStep = 0.5;
// Keeps the equations solvable in singular positions; too small to slow down the last steps.
constexpr double kLeastDamping = 1e-12;
// Axes that moved less than this did so along a path: they stay on their side of every singularity.
constexpr double kAlongPath = 0.5;
// Least ratio of the smallest to the largest pivot.
constexpr double kSingularPivot = 1e-6;

Columns ScaledJacobian(const Chain& chain, const Joints& joints) {
  const Jacobian jacobian = JacobianAt(chain, joints);
  Columns columns(6, static_cast<int>(chain.count));
  for (std::size_t i = 0; i < chain.count; ++i) {
    const double unit = chain.links[i].kind == JointKind::kLinear ? chain.length : 1;
    columns.col(static_cast<int>(i)) = Scaled(jacobian[i], chain.length) * unit;
  }
  return columns;
}

Six ErrorOf(const Chain& chain, const Joints& joints, const Frame& tool) {
  const Frame present = Forward(chain, joints);
  return Scaled({tool.p - present.p, TurnBetween(present.M, tool.M)}, chain.length);
}

// Newton-Raphson with damping that vanishes with the error, so that the last steps are exact.
bool Approach(const Chain& chain, const Frame& tool, Joints& joints) {
  const auto axes = static_cast<int>(chain.count);
  Six error = ErrorOf(chain, joints, tool);
  double size = error.norm();
  double boost = 1;
  for (int step = 0; step < kSteps && size > kArrived; ++step) {
    const Columns jacobian = ScaledJacobian(chain, joints);
    Square normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += boost * size * size + kLeastDamping;
    Column move = normal.llt().solve(jacobian.transpose() * error);
    const double largest = move.cwiseAbs().maxCoeff();
    if (largest > kLongestStep) move *= kLongestStep / largest;
    Joints next = joints;
    for (int i = 0; i < axes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      next[k] += move(i) * (chain.links[k].kind == JointKind::kLinear ? chain.length : 1);
    }
    const Six next_error = ErrorOf(chain, next, tool);
    const double next_size = next_error.norm();
    if (next_size < size) {
      joints = next;
      error = next_error;
      size = next_size;
      boost = std::max(boost * 0.5, 1e-3);
    } else if (size <= kGoodEnough) {
      break;
    } else {
      boost = boost * 8 + kLeastDamping / (size * size);
    }
  }
  return size <= kGoodEnough;
}

// Returns a positive number if two positions are on the same side of all singularities, 0 if one of them is singular.
// Seen from the tool, so that turning the whole arm does not matter.
double SameSide(const Chain& chain, const Joints& from, const Joints& to) {
  const auto seen_from_tool = [&](const Joints& joints) {
    const KDL::Rotation back = Forward(chain, joints).M.Inverse();
    const Jacobian jacobian = JacobianAt(chain, joints);
    Columns columns(6, static_cast<int>(chain.count));
    for (std::size_t i = 0; i < chain.count; ++i)
      columns.col(static_cast<int>(i)) = Scaled(back * jacobian[i], chain.length).normalized();
    return columns;
  };
  const Columns a = seen_from_tool(from);
  const Columns b = seen_from_tool(to);
  if (chain.count > 6) return Square(a * b.transpose()).determinant();
  if (chain.count == 6) return Square(a).determinant() * Square(b).determinant();
  return Square(a.transpose() * b).determinant();
}

bool Singular(const Chain& chain, const Joints& joints) {
  const Columns jacobian = ScaledJacobian(chain, joints);
  Eigen::ColPivHouseholderQR<Square> qr;
  qr.setThreshold(kSingularPivot);
  qr.compute(chain.count > 6 ? Square(jacobian.transpose()) : Square(jacobian));
  return qr.rank() < std::min<Eigen::Index>(6, jacobian.cols());
}

double DisplacementBound(const Chain& chain, const Joints& from, const Joints& to) {
  double largest = 0;
  for (std::size_t i = 0; i < chain.count; ++i) {
    if (chain.links[i].kind == JointKind::kRotary) largest = std::max(largest, std::abs(to[i] - from[i]));
  }
  return largest;
}

}  // namespace

Reason Inverse(const Serial& serial, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept {
  const Chain& chain = serial.chain;
  joints = near;
  if (!Approach(chain, tool, joints)) {
    // A stretched arm does not determine the side to which it bends.
    if (!Singular(chain, near)) return Reason::kOutOfReach;
    joints = near;
    for (std::size_t i = 0; i < chain.count; ++i) {
      if (chain.links[i].kind == JointKind::kRotary) joints[i] += i % 2 == 0 ? 0.1 : 0.15;
    }
    if (!Approach(chain, tool, joints)) return Reason::kOutOfReach;
  }
  if (Singular(chain, joints)) return Reason::kSingular;
  const bool comparable = chain.count == 6 || DisplacementBound(chain, near, joints) < kAlongPath;
  if (comparable && !Singular(chain, near) && SameSide(chain, near, joints) < 0) return Reason::kSingular;
  return Reason::kNone;
}

}  // namespace takt::kinematics
