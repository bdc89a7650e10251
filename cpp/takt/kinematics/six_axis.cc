#include "takt/kinematics/six_axis.h"

#include <algorithm>

#include "takt/core/maths.h"
#include "takt/kinematics/angles.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

// Returns the distance [mm] of the wrist in front of axis 1.
double FrontOf(const SixAxis& arm, const Joints& joints) {
  const double forearm = joints[1] + joints[2] + arm.forearm_angle;
  return arm.lengths.a1 + arm.lengths.c2 * maths::Sin(joints[1]) + arm.forearm * maths::Sin(forearm);
}

}  // namespace

SixAxis MakeSixAxis(const SixAxisLengths& l) {
  SixAxis arm{
      .chain = {}, .lengths = l, .forearm = maths::Hypot(l.a2, l.c3), .forearm_angle = maths::Atan2(l.a2, l.c3)};
  const KDL::Vector y(0, 1, 0);
  const KDL::Vector z(0, 0, 1);
  Append(arm.chain, {Frame::Identity(), z, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(l.a1, l.b, l.c1)), y, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(0, 0, l.c2)), y, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(l.a2, 0, l.c3)), z, JointKind::kRotary});
  Append(arm.chain, {Frame::Identity(), y, JointKind::kRotary});
  Append(arm.chain, {Frame::Identity(), z, JointKind::kRotary});
  arm.chain.tool = Frame(KDL::Vector(0, 0, l.c4));
  return arm;
}

Configuration ConfigurationOf(const SixAxis& arm, const Joints& joints) noexcept {
  return {.shoulder = FrontOf(arm, joints) >= 0 ? Shoulder::kFront : Shoulder::kBack,
          .elbow = maths::Sin(joints[2] + arm.forearm_angle) >= 0 ? Elbow::kPositive : Elbow::kNegative,
          .wrist = maths::Sin(joints[4]) >= 0 ? Wrist::kPositive : Wrist::kNegative};
}

Reason Inverse(const SixAxis& arm, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept {
  const SixAxisLengths& l = arm.lengths;
  const KDL::Vector wrist = tool.p - tool.M.UnitZ() * l.c4;

  const double distance = maths::Hypot(wrist.x(), wrist.y());
  const double front_squared = (distance - std::abs(l.b)) * (distance + std::abs(l.b));
  if (!(front_squared >= 0)) return Reason::kOutOfReach;
  const double magnitude = std::sqrt(front_squared);
  if (magnitude < kSingularSine * arm.chain.length) return Reason::kSingular;
  const double front = configuration.shoulder == Shoulder::kFront ? magnitude : -magnitude;
  const double first = maths::Atan2(wrist.y(), wrist.x()) - maths::Atan2(l.b, front);

  // Side view, angles from Z to X.
  TwoLinks links;
  const Reason reason =
      Reach(l.c2, arm.forearm, wrist.z() - l.c1, front - l.a1, configuration.elbow == Elbow::kPositive, links);
  if (reason != Reason::kNone) return reason;

  const double third = links.elbow - arm.forearm_angle;
  const KDL::Rotation forearm = AboutZ(first) * AboutY(links.first + third);
  const KDL::Rotation turn = forearm.Inverse() * tool.M;
  const double sine = maths::Hypot(turn(0, 2), turn(1, 2));
  if (sine < kSingularSine) return Reason::kSingular;
  const double sign = configuration.wrist == Wrist::kPositive ? 1 : -1;

  // Axis 4 may be inaccurate; axes 5 and 6 compensate for that.
  const double fourth = maths::Atan2(sign * turn(1, 2), sign * turn(0, 2));
  const KDL::Rotation rest = AboutZ(-fourth) * turn;
  const std::array<double, 6> angles{
      first, links.first, third, fourth, maths::Atan2(rest(0, 2), rest(2, 2)), maths::Atan2(rest(1, 0), rest(1, 1))};
  for (std::size_t i = 0; i < angles.size(); ++i) joints[i] = NearestTurn(angles[i], near[i]);
  return Reason::kNone;
}

}  // namespace takt::kinematics
