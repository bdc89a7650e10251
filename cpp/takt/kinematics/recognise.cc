// Articulated arms among serial chains, by the lines of their axes. With a spherical wrist: axes 2 and 3 parallel, axis
// 1 and axis 4 perpendicular to them, axes 4, 5 and 6 through one point and perpendicular to one another in turn. With
// an offset one: axes 2, 3 and 4 parallel, axis 1 and axis 5 perpendicular to them, axis 6 perpendicular to axis 5,
// which meets both its neighbours. The remaining unknowns, zero and sense of each axis, follow from the chain with its
// axes at 0. Ours; the form of the first kind itself is that of Brandstoetter, Angerer, Hofbaur: An Analytical Solution
// of the Inverse Kinematics Problem of Industrial Serial Manipulators with an Ortho-parallel Basis and a Spherical
// Wrist (2014).
#include <cmath>

#include "takt/core/maths.h"
#include "takt/kinematics/serial.h"

namespace takt::kinematics {

namespace {

// Files give angles with few digits: solutions are refined afterwards (solutions.cc).
constexpr double kAngle = 2e-3;  // [rad]
constexpr double kPart = 1e-3;   // share of the arm's length
constexpr int kTrials = 4;

struct Line {
  KDL::Vector point, along;
};

bool Parallel(const Line& a, const Line& b) {
  return (a.along * b.along).Norm() < kAngle;
}
bool Perpendicular(const Line& a, const Line& b) {
  return std::abs(KDL::dot(a.along, b.along)) < kAngle;
}

double Distance(const KDL::Vector& point, const Line& line) {
  return ((point - line.point) * line.along).Norm();
}

// Returns the point of `a` that is nearest to `b`. Requires: the lines are not parallel.
KDL::Vector Nearest(const Line& a, const Line& b) {
  const double cosine = KDL::dot(a.along, b.along);
  const KDL::Vector apart = b.point - a.point;
  const double along = (KDL::dot(apart, a.along) - cosine * KDL::dot(apart, b.along)) / (1 - cosine * cosine);
  return a.point + along * a.along;
}

Joints Counted(const ClosedForm& form, const Joints& joints) {
  Joints out{};
  for (std::size_t i = 0; i < form.zero.size(); ++i) out[i] = form.zero[i] + form.sign[i] * joints[i];
  return out;
}

const Chain& ArmOf(const ClosedForm& form) {
  return std::visit([](const auto& arm) -> const Chain& { return arm.chain; }, form.arm);
}

bool Agrees(const ClosedForm& form, const Chain& chain) {
  for (int trial = 1; trial <= kTrials; ++trial) {
    Joints joints{};
    for (std::size_t i = 0; i < chain.count; ++i) joints[i] = maths::Sin(trial * (1.3 + static_cast<double>(i)));
    const Frame own = form.base * Forward(ArmOf(form), Counted(form, joints)) * form.flange;
    const Frame wanted = Forward(chain, joints);
    if ((own.p - wanted.p).Norm() > 10 * kPart * chain.length) return false;
    if (ArcBetween(own.M, wanted.M).angle > 10 * kAngle) return false;
  }
  return true;
}

using Axes = std::array<Line, 6>;

// Z is axis 1, Y the direction of axis 2 (made perpendicular to Z), which lies in the plane of X and Y.
Frame BaseOf(const Axes& axes) {
  const KDL::Vector& z = axes[0].along;
  KDL::Vector y = axes[1].along - KDL::dot(axes[1].along, z) * z;
  y = y / y.Norm();
  return Frame(KDL::Rotation(y * z, y, z), axes[0].point + KDL::dot(axes[1].point - axes[0].point, z) * z);
}

double SenseOf(const Line& axis, const Line& of) {
  return KDL::dot(axis.along, of.along) > 0 ? 1 : -1;
}

bool WithSphericalWrist(const Axes& axes, double near, ClosedForm& form) {
  const KDL::Vector wrist = Nearest(axes[3], axes[4]);
  const bool spherical = Distance(wrist, axes[4]) < near && Distance(wrist, axes[5]) < near;
  const bool upright = Perpendicular(axes[0], axes[1]) && Parallel(axes[1], axes[2]) &&
                       Perpendicular(axes[2], axes[3]) && Perpendicular(axes[3], axes[4]) &&
                       Perpendicular(axes[4], axes[5]);
  if (!spherical || !upright) return false;
  form.base = BaseOf(axes);
  const auto seen = [&](const KDL::Vector& v) { return form.base.M.Inverse() * v; };
  const auto place = [&](const KDL::Vector& p) { return form.base.Inverse() * p; };
  const KDL::Vector second = place(axes[1].point), third = place(axes[2].point), center = place(wrist);
  const KDL::Vector upper = third - second, fore = center - third;
  const double c2 = maths::Hypot(upper.x(), upper.z());
  if (c2 < near) return false;
  const double lean = maths::Atan2(upper.x(), upper.z());
  const KDL::Vector fourth = seen(axes[3].along);
  const double turned = maths::Atan2(fourth.x(), fourth.z());
  const maths::SineCosine fore_turn = maths::SinCos(turned);
  const KDL::Vector forearm_x(fore_turn.cosine, 0, -fore_turn.sine), forearm_z(fore_turn.sine, 0, fore_turn.cosine);
  const SixAxisLengths lengths{.a1 = second.x(),
                               .a2 = KDL::dot(fore, forearm_x),
                               .b = center.y(),
                               .c1 = 0,
                               .c2 = c2,
                               .c3 = KDL::dot(fore, forearm_z),
                               .c4 = 0};
  if (maths::Hypot(lengths.a2, lengths.c3) < near) return false;
  const KDL::Vector fifth = seen(axes[4].along), sixth = seen(axes[5].along);
  const double roll = maths::Atan2(-KDL::dot(fifth, forearm_x), fifth.y());
  const maths::SineCosine of_roll = maths::SinCos(roll);
  const KDL::Vector bent = of_roll.cosine * forearm_x + KDL::Vector(0, of_roll.sine, 0);
  const double bend = maths::Atan2(KDL::dot(sixth, bent), KDL::dot(sixth, forearm_z));
  form.arm = MakeSixAxis(lengths);
  form.zero = {0, lean, turned - lean, roll, bend, 0};
  form.sign = {1, 1, SenseOf(axes[2], axes[1]), 1, 1, 1};
  return true;
}

bool WithOffsetWrist(const Axes& axes, double near, ClosedForm& form) {
  const bool upright = Perpendicular(axes[0], axes[1]) && Parallel(axes[1], axes[2]) && Parallel(axes[1], axes[3]) &&
                       Perpendicular(axes[3], axes[4]) && Perpendicular(axes[4], axes[5]);
  if (!upright) return false;
  const KDL::Vector bend = Nearest(axes[3], axes[4]), hand = Nearest(axes[4], axes[5]);
  if (Distance(bend, axes[4]) > near || Distance(hand, axes[5]) > near) return false;
  form.base = BaseOf(axes);
  const auto seen = [&](const KDL::Vector& v) { return form.base.M.Inverse() * v; };
  const auto place = [&](const KDL::Vector& p) { return form.base.Inverse() * p; };
  const KDL::Vector second = place(axes[1].point), third = place(axes[2].point), fourth = place(axes[3].point);
  const KDL::Vector upper = third - second, fore = fourth - third;
  const KDL::Vector fifth = seen(axes[4].along), sixth = seen(axes[5].along);
  const OffsetArmLengths lengths{.a1 = second.x(),
                                 .b = place(hand).y(),
                                 .c2 = maths::Hypot(upper.x(), upper.z()),
                                 .c3 = maths::Hypot(fore.x(), fore.z()),
                                 .c4 = KDL::dot(seen(hand - bend), fifth)};
  if (lengths.c2 < near || lengths.c3 < near) return false;
  const double lean = maths::Atan2(upper.x(), upper.z()), fore_lean = maths::Atan2(fore.x(), fore.z());
  const double sum = maths::Atan2(fifth.x(), fifth.z());
  const maths::SineCosine of_sum = maths::SinCos(sum);
  const KDL::Vector across(of_sum.cosine, 0, -of_sum.sine);
  form.arm = MakeOffsetArm(lengths);
  form.zero = {0, lean, fore_lean - lean, sum - fore_lean, maths::Atan2(-KDL::dot(sixth, across), sixth.y()), 0};
  form.sign = {1, 1, SenseOf(axes[2], axes[1]), SenseOf(axes[3], axes[1]), 1, 1};
  return true;
}

}  // namespace

ClosedForm Recognise(const Chain& chain) {
  ClosedForm form;
  if (chain.count != form.zero.size()) return form;
  Axes axes;
  Frame at = Frame::Identity();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (chain.links[i].kind != JointKind::kRotary) return form;
    at = at * chain.links[i].before;
    axes[i] = {at.p, at.M * chain.links[i].axis};
  }
  const double near = kPart * chain.length;
  if (!WithSphericalWrist(axes, near, form) && !WithOffsetWrist(axes, near, form)) return form;
  form.flange = (form.base * Forward(ArmOf(form), Counted(form, {}))).Inverse() * (at * chain.tool);
  form.known = Agrees(form, chain);
  return form;
}

}  // namespace takt::kinematics
