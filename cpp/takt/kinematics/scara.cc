#include "takt/kinematics/scara.h"

#include "takt/core/maths.h"
#include "takt/kinematics/angles.h"

namespace takt::kinematics {

Scara MakeScara(double first_arm, double second_arm, double height) {
  Scara scara{.chain = {}, .first_arm = first_arm, .second_arm = second_arm, .height = height};
  const KDL::Vector z(0, 0, 1);
  Append(scara.chain, {Frame::Identity(), z, JointKind::kRotary});
  Append(scara.chain, {Frame(KDL::Vector(first_arm, 0, 0)), z, JointKind::kRotary});
  Append(scara.chain, {Frame(KDL::Vector(second_arm, 0, height)), z, JointKind::kLinear});
  Append(scara.chain, {Frame::Identity(), z, JointKind::kRotary});
  return scara;
}

Configuration ConfigurationOf(const Scara&, const Joints& joints) noexcept {
  return {.shoulder = Shoulder::kKeep,
          .elbow = maths::Sin(joints[1]) >= 0 ? Elbow::kPositive : Elbow::kNegative,
          .wrist = Wrist::kKeep};
}

Reason Inverse(const Scara& scara, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept {
  if (!Upright(tool.M)) return Reason::kOrientation;
  TwoLinks arms;
  const Reason reason =
      Reach(scara.first_arm, scara.second_arm, tool.p.x(), tool.p.y(), configuration.elbow == Elbow::kPositive, arms);
  if (reason != Reason::kNone) return reason;
  joints[0] = NearestTurn(arms.first, near[0]);
  joints[1] = NearestTurn(arms.elbow, near[1]);
  joints[2] = tool.p.z() - scara.height;
  joints[3] = NearestTurn(AngleAboutZ(tool.M) - joints[0] - joints[1], near[3]);
  return Reason::kNone;
}

}  // namespace takt::kinematics
