#include "takt/kinematics/delta.h"

#include "takt/core/maths.h"
#include "takt/kinematics/angles.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

using KDL::Vector;

// Relation between an arm's axis and its lower arm: the constraint is |lower| = lower_arm, lower = tool - knee.
struct Arm {
  Vector lower;      // from the knee to the platform, with all joints of the platform moved to the tool
  Vector along;      // d knee / d angle
  Vector inward;     // d along / d angle
  double lever = 0;  // lower · along, mm²: 0 where upper and lower arm are in line
};

// Sine and cosine of the angle of each arm, shared by knees and axes of the arms.
using Turns = std::array<maths::SineCosine, 3>;

Turns TurnsOf(const Joints& joints) {
  return {maths::SinCos(joints[0]), maths::SinCos(joints[1]), maths::SinCos(joints[2])};
}

Vector Knee(const Delta& delta, std::size_t i, const maths::SineCosine& turn) {
  const DeltaLengths& l = delta.lengths;
  const double radius = l.base_radius - l.platform_radius + l.upper_arm * turn.cosine;
  return delta.outward[i] * radius + Vector(0, 0, -l.upper_arm * turn.sine);
}

Arm ArmAt(const Delta& delta, std::size_t i, const maths::SineCosine& turn, const Vector& tool) {
  const double s = turn.sine * delta.lengths.upper_arm;
  const double c = turn.cosine * delta.lengths.upper_arm;
  Arm arm;
  arm.lower = tool - Knee(delta, i, turn);
  arm.along = delta.outward[i] * -s + Vector(0, 0, -c);
  arm.inward = delta.outward[i] * -c + Vector(0, 0, s);
  arm.lever = dot(arm.lower, arm.along);
  return arm;
}

using Arms = std::array<Arm, 3>;

Arms ArmsAt(const Delta& delta, const Turns& turns, const Vector& tool) {
  return {ArmAt(delta, 0, turns[0], tool), ArmAt(delta, 1, turns[1], tool), ArmAt(delta, 2, turns[2], tool)};
}

// Returns the volume spanned by the lower arms relative to a cube: below 0 with the platform hanging under the knees, 0
// where the arms cannot hold it.
double Spread(const Delta& delta, const Vector& first, const Vector& second, const Vector& third) {
  const double length = delta.lengths.lower_arm;
  return dot(first, second * third) / (length * length * length);
}

// Returns the velocity for which every arm has lower · v = rate.
Vector Meet(const Arms& arms, const std::array<double, 3>& rates) {
  const Vector a = arms[1].lower * arms[2].lower;
  const Vector b = arms[2].lower * arms[0].lower;
  const Vector c = arms[0].lower * arms[1].lower;
  return (a * rates[0] + b * rates[1] + c * rates[2]) / dot(arms[0].lower, a);
}

Reason ForwardPlace(const Delta& delta, const Turns& turns, Vector& tool) {
  const Vector third = Knee(delta, 2, turns[2]);
  const Vector a = Knee(delta, 0, turns[0]) - third;
  const Vector b = Knee(delta, 1, turns[1]) - third;
  const Vector normal = a * b;
  const double area = dot(normal, normal);
  const double length = delta.lengths.lower_arm;
  if (!(area > kSingularSine * kSingularSine * dot(a, a) * dot(b, b))) return Reason::kSingular;
  const Vector middle = (b * dot(a, a) - a * dot(b, b)) * normal / (2 * area);
  const double radius = middle.Norm();
  const double drop_squared = (length - radius) * (length + radius);
  if (!(drop_squared >= 0)) return Reason::kOutOfReach;
  tool = third + middle - normal * std::sqrt(drop_squared / area);
  const double spread = Spread(delta, tool - third - a, tool - third - b, tool - third);
  return spread < -kSingularSine ? Reason::kNone : Reason::kSingular;
}

}  // namespace

Delta MakeDelta(const DeltaLengths& lengths, double first_arm, bool rotary) {
  Delta delta{.lengths = lengths, .outward = {}, .rotary = rotary};
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = first_arm + static_cast<double>(i) * 2 * std::numbers::pi / 3;
    const auto [sine, cosine] = maths::SinCos(angle);
    delta.outward[i] = {cosine, sine, 0};
  }
  return delta;
}

Reason Forward(const Delta& delta, const Joints& joints, Frame& tool) noexcept {
  Vector place;
  if (const Reason reason = ForwardPlace(delta, TurnsOf(joints), place); reason != Reason::kNone) return reason;
  tool = Frame(AboutZ(joints[3]), place);
  return Reason::kNone;
}

Reason Forward(const Delta& delta, const JointMotion& motion, MovingFrame& tool) noexcept {
  Vector place;
  const Turns turns = TurnsOf(motion.position);
  if (const Reason reason = ForwardPlace(delta, turns, place); reason != Reason::kNone) return reason;
  const Arms arms = ArmsAt(delta, turns, place);
  std::array<double, 3> rates{};
  for (std::size_t i = 0; i < 3; ++i) rates[i] = arms[i].lever * motion.velocity[i];
  const Vector velocity = Meet(arms, rates);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector slip = velocity - arms[i].along * motion.velocity[i];
    rates[i] = arms[i].lever * motion.acceleration[i] +
               dot(arms[i].lower, arms[i].inward) * motion.velocity[i] * motion.velocity[i] - dot(slip, slip);
  }
  tool = MovingFrame(
      KDL::RotationAcc(AboutZ(motion.position[3]), {0, 0, motion.velocity[3]}, {0, 0, motion.acceleration[3]}),
      KDL::VectorAcc(place, velocity, Meet(arms, rates)));
  return Reason::kNone;
}

Reason JacobianAt(const Delta& delta, const Joints& joints, Jacobian& columns) noexcept {
  columns = {};
  Vector tool;
  const Turns turns = TurnsOf(joints);
  if (const Reason reason = ForwardPlace(delta, turns, tool); reason != Reason::kNone) return reason;
  const Arms arms = ArmsAt(delta, turns, tool);
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> rates{};
    rates[i] = arms[i].lever;
    columns[i].vel = Meet(arms, rates);
  }
  if (delta.rotary) columns[3].rot = {0, 0, 1};
  return Reason::kNone;
}

Reason Inverse(const Delta& delta, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept {
  if (!Upright(tool.M)) return Reason::kOrientation;
  const DeltaLengths& l = delta.lengths;
  std::array<Vector, 3> lower;
  for (std::size_t i = 0; i < 3; ++i) {
    // In the plane of the arm, from its axis to the joint on the platform.
    const double out = dot(tool.p, delta.outward[i]) + l.platform_radius - l.base_radius;
    const double down = -tool.p.z();
    const double aside = dot(tool.p, Vector(-delta.outward[i].y(), delta.outward[i].x(), 0));
    const double reach = l.lower_arm * l.lower_arm - aside * aside;
    if (!(reach >= 0)) return Reason::kOutOfReach;
    TwoLinks links;
    const Reason reason = Reach(l.upper_arm, std::sqrt(reach), out, down, true, links);
    if (reason != Reason::kNone) return reason;
    joints[i] = NearestTurn(links.first, near[i]);
    lower[i] = tool.p - Knee(delta, i, maths::SinCos(links.first));
  }
  const double spread = Spread(delta, lower[0], lower[1], lower[2]);
  if (std::abs(spread) < kSingularSine) return Reason::kSingular;
  if (!(spread < 0)) return Reason::kOutOfReach;
  if (delta.rotary) joints[3] = NearestTurn(AngleAboutZ(tool.M), near[3]);
  return Reason::kNone;
}

Reason SolveMotion(const Delta& delta, const MovingFrame& tool, JointMotion& motion) noexcept {
  if (!IsUprightMotion(tool)) return Reason::kOrientation;
  const Arms arms = ArmsAt(delta, TurnsOf(motion.position), tool.p.p);
  const double smallest = kSingularSine * delta.lengths.upper_arm * delta.lengths.lower_arm;
  for (std::size_t i = 0; i < 3; ++i) {
    const Arm& arm = arms[i];
    if (!(std::abs(arm.lever) >= smallest)) return Reason::kSingular;
    const double rate = dot(arm.lower, tool.p.v) / arm.lever;
    const Vector slip = tool.p.v - arm.along * rate;
    motion.velocity[i] = rate;
    motion.acceleration[i] =
        (dot(slip, slip) + dot(arm.lower, tool.p.dv) - dot(arm.lower, arm.inward) * rate * rate) / arm.lever;
  }
  motion.velocity[3] = delta.rotary ? tool.M.w.z() : 0;
  motion.acceleration[3] = delta.rotary ? tool.M.dw.z() : 0;
  return Reason::kNone;
}

}  // namespace takt::kinematics
