#include "takt/kinematics/offset_arm.h"

#include "takt/core/maths.h"
#include "takt/kinematics/angles.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {

OffsetArm MakeOffsetArm(const OffsetArmLengths& l) {
  OffsetArm arm{.chain = {}, .lengths = l};
  const KDL::Vector y(0, 1, 0);
  const KDL::Vector z(0, 0, 1);
  Append(arm.chain, {Frame::Identity(), z, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(l.a1, l.b, 0)), y, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(0, 0, l.c2)), y, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(0, 0, l.c3)), y, JointKind::kRotary});
  Append(arm.chain, {Frame::Identity(), z, JointKind::kRotary});
  Append(arm.chain, {Frame(KDL::Vector(0, 0, l.c4)), y, JointKind::kRotary});
  return arm;
}

Configuration ConfigurationOf(const OffsetArm& arm, const Joints& joints) noexcept {
  const OffsetArmLengths& l = arm.lengths;
  const double second = joints[1], third = second + joints[2], fourth = third + joints[3];
  const double front = l.a1 + l.c2 * maths::Sin(second) + l.c3 * maths::Sin(third) + l.c4 * maths::Sin(fourth);
  return {.shoulder = front >= 0 ? Shoulder::kFront : Shoulder::kBack,
          .elbow = maths::Sin(joints[2]) >= 0 ? Elbow::kPositive : Elbow::kNegative,
          .wrist = maths::Sin(joints[4]) >= 0 ? Wrist::kPositive : Wrist::kNegative};
}

Reason Inverse(const OffsetArm& arm, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept {
  const OffsetArmLengths& l = arm.lengths;
  const double distance = maths::Hypot(tool.p.x(), tool.p.y());
  const double front_squared = (distance - std::abs(l.b)) * (distance + std::abs(l.b));
  if (!(front_squared >= 0)) return Reason::kOutOfReach;
  const double magnitude = std::sqrt(front_squared);
  if (magnitude < kSingularSine * arm.chain.length) return Reason::kSingular;
  const double front = configuration.shoulder == Shoulder::kFront ? magnitude : -magnitude;
  const double first = maths::Atan2(tool.p.y(), tool.p.x()) - maths::Atan2(l.b, front);

  const KDL::Rotation turn = AboutZ(-first) * tool.M;
  if (maths::Hypot(turn(0, 1), turn(2, 1)) < kSingularSine) return Reason::kSingular;
  const double sign = configuration.wrist == Wrist::kPositive ? 1 : -1;
  const double sum = maths::Atan2(sign * turn(2, 1), -sign * turn(0, 1));
  // The sum may be inaccurate; axes 5 and 6 compensate for that.
  const KDL::Rotation rest = AboutY(-sum) * turn;
  const double fifth = maths::Atan2(-rest(0, 1), rest(1, 1));
  const double sixth = maths::Atan2(-rest(2, 0), rest(2, 2));

  // Side view, angles from Z to X.
  const maths::SineCosine hand = maths::SinCos(sum);
  TwoLinks links;
  const Reason reason = Reach(l.c2, l.c3, tool.p.z() - l.c4 * hand.cosine, front - l.a1 - l.c4 * hand.sine,
                              configuration.elbow == Elbow::kPositive, links);
  if (reason != Reason::kNone) return reason;
  const std::array<double, 6> angles{first, links.first, links.elbow, sum - links.first - links.elbow, fifth, sixth};
  for (std::size_t i = 0; i < angles.size(); ++i) joints[i] = NearestTurn(angles[i], near[i]);
  return Reason::kNone;
}

}  // namespace takt::kinematics
