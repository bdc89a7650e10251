#include "takt/kinematics/chain.h"

#include <Eigen/Dense>
#include <cmath>

#include "takt/kinematics/rotations.h"
#include "takt/kinematics/twist.h"

namespace takt::kinematics {
namespace {

using Tall = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostColumns, kMostColumns>;

// Below the closed forms' kSingularSine: poses that they accept are not refused here.
constexpr double kRankThreshold = 1e-7;
// Largest relative residual of a motion that few axes cannot follow exactly.
constexpr double kResidual = 1e-8;

// Solves J x = y: exactly, or in the least-squares sense with few axes, or with the smallest x with many.
class Solver {
 public:
  Solver(const Chain& chain, const Joints& joints) : length_(chain.length), axes_(static_cast<int>(chain.count)) {
    const Jacobian columns = JacobianAt(chain, joints);
    jacobian_.resize(6, axes_);
    for (int i = 0; i < axes_; ++i) jacobian_.col(i) = Scaled(columns[static_cast<std::size_t>(i)], length_);
    qr_.setThreshold(kRankThreshold);
    qr_.compute(wide() ? Tall(jacobian_.transpose()) : jacobian_);
  }

  bool singular() const { return qr_.rank() < std::min(6, axes_); }

  Reason Solve(const KDL::Twist& twist, Joints& out) const {
    const Six wanted = Scaled(twist, length_);
    Column x(axes_);
    if (wide()) {
      x.setZero();
      const Six permuted = qr_.colsPermutation().transpose() * wanted;
      x.head<6>() = qr_.matrixQR().topLeftCorner<6, 6>().triangularView<Eigen::Upper>().transpose().solve(permuted);
      x.applyOnTheLeft(qr_.householderQ());
    } else {
      x = qr_.solve(wanted);
      if ((jacobian_ * x - wanted).norm() > kResidual * (wanted.norm() + kSlack)) return Reason::kOrientation;
    }
    for (int i = 0; i < axes_; ++i) out[static_cast<std::size_t>(i)] = x(i);
    return Reason::kNone;
  }

 private:
  bool wide() const { return axes_ > 6; }

  double length_;
  int axes_;
  Tall jacobian_;
  Eigen::ColPivHouseholderQR<Tall> qr_;
};

}  // namespace

void Append(Chain& chain, const Link& link) {
  const bool first = chain.count == 0;
  chain.links[chain.count++] = link;
  chain.length = (first ? 0 : chain.length) + link.before.p.Norm();
  if (chain.length == 0) chain.length = 1;
}

Frame Forward(const Chain& chain, const Joints& joints) noexcept {
  Frame frame;
  for (std::size_t i = 0; i < chain.count; ++i) {
    const Link& link = chain.links[i];
    frame = frame * link.before;
    if (link.kind == JointKind::kLinear) {
      frame.p += frame.M * (link.axis * joints[i]);
    } else {
      frame.M = frame.M * About(link.axis, joints[i]);
    }
  }
  return frame * chain.tool;
}

MovingFrame Forward(const Chain& chain, const JointMotion& motion) noexcept {
  MovingFrame frame(Frame::Identity());
  for (std::size_t i = 0; i < chain.count; ++i) {
    const Link& link = chain.links[i];
    const KDL::Vector v = link.axis * motion.velocity[i];
    const KDL::Vector a = link.axis * motion.acceleration[i];
    MovingFrame joint(Frame::Identity());
    if (link.kind == JointKind::kLinear) {
      joint.p = KDL::VectorAcc(link.axis * motion.position[i], v, a);
    } else {
      joint.M = KDL::RotationAcc(About(link.axis, motion.position[i]), v, a);
    }
    frame = frame * link.before * joint;
  }
  return frame * chain.tool;
}

Jacobian JacobianAt(const Chain& chain, const Joints& joints) noexcept {
  Jacobian columns{};
  Frame frame;
  std::array<KDL::Vector, kMaxJoints> origins;
  for (std::size_t i = 0; i < chain.count; ++i) {
    const Link& link = chain.links[i];
    frame = frame * link.before;
    const KDL::Vector axis = frame.M * link.axis;
    origins[i] = frame.p;
    if (link.kind == JointKind::kLinear) {
      columns[i].vel = axis;
      frame.p += axis * joints[i];
    } else {
      columns[i].rot = axis;
      frame.M = frame.M * About(link.axis, joints[i]);
    }
  }
  const KDL::Vector tool = frame * chain.tool.p;
  for (std::size_t i = 0; i < chain.count; ++i) {
    if (chain.links[i].kind == JointKind::kRotary) columns[i].vel = columns[i].rot * (tool - origins[i]);
  }
  return columns;
}

Reason SolveMotion(const Chain& chain, const MovingFrame& tool, JointMotion& motion) noexcept {
  const Solver solver(chain, motion.position);
  if (solver.singular()) return Reason::kSingular;
  if (const Reason reason = solver.Solve(tool.GetTwist(), motion.velocity); reason != Reason::kNone) return reason;
  // Acceleration of the tool due to the speeds of the axes alone.
  motion.acceleration = {};
  const KDL::Twist bias = Forward(chain, motion).GetAccTwist();
  return solver.Solve(tool.GetAccTwist() - bias, motion.acceleration);
}

}  // namespace takt::kinematics
