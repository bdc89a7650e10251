#include "takt/kinematics/frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

// Least cosine of B; closer to the lock A is noise.
constexpr double kGimbalLock = 1e-12;

// Returns degrees in (-180, 180].
double Degrees(double angle) {
  const double degrees = angle / kDegree;
  return degrees <= -180 ? 180 : degrees;
}

Eigen::Matrix3d ToEigen(const KDL::Rotation& r) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data);
}

bool AllFinite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

Frame ToFrame(const Pose& pose) noexcept {
  return {RollPitchYaw(pose.a * kDegree, pose.b * kDegree, pose.c * kDegree), {pose.x, pose.y, pose.z}};
}

Pose ToPose(const Frame& frame) noexcept {
  const KDL::Rotation& r = frame.M;
  const double cos_b = maths::Hypot(r(2, 1), r(2, 2));
  const double a = cos_b < kGimbalLock ? 0 : maths::Atan2(r(2, 1), r(2, 2));
  const double b = maths::Atan2(-r(2, 0), cos_b);
  // C is the remaining turn once A is turned back: exact for any A.
  const auto [s, c] = maths::SinCos(a);
  const double rest = maths::Atan2(s * r(0, 2) - c * r(0, 1), c * r(1, 1) - s * r(1, 2));
  return {frame.p.x(), frame.p.y(), frame.p.z(), Degrees(a), Degrees(b), Degrees(rest)};
}

bool Finite(const Frame& frame) noexcept {
  return AllFinite(frame.M.data) && AllFinite(frame.p.data);
}

bool Finite(const MovingFrame& frame) noexcept {
  return Finite(frame.GetFrame()) && AllFinite(frame.p.v.data) && AllFinite(frame.p.dv.data) &&
         AllFinite(frame.M.w.data) && AllFinite(frame.M.dw.data);
}

GreatArc ArcBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept {
  const Eigen::Quaterniond turn(ToEigen(to * from.Inverse()));
  const double sine = turn.vec().norm();
  const double sign = turn.w() < 0 ? -1 : 1;
  GreatArc arc;
  arc.start = from;
  if (sine == 0) return arc;
  const Eigen::Vector3d axis = turn.vec() * (sign / sine);
  arc.axis = {axis.x(), axis.y(), axis.z()};
  arc.angle = 2 * maths::Atan2(sine, sign * turn.w());
  return arc;
}

KDL::Vector TurnBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept {
  const GreatArc arc = ArcBetween(from, to);
  return arc.axis * arc.angle;
}

KDL::RotationAcc Along(const GreatArc& arc, const Share& share) noexcept {
  return {About(arc.axis, arc.angle * share.value) * arc.start, arc.axis * (arc.angle * share.rate),
          arc.axis * (arc.angle * share.acceleration)};
}

void describe(Description<Pose>& d) {
  d.about(
      "A position and an orientation: rotated by A about X, then by B about Y, then by C about Z, all of them fixed "
      "axes.");
  d.defaulted<&Pose::x>(unit::mm, "Along X.");
  d.defaulted<&Pose::y>(unit::mm, "Along Y.");
  d.defaulted<&Pose::z>(unit::mm, "Along Z.");
  d.defaulted<&Pose::a>(unit::deg, "About X, first.");
  d.defaulted<&Pose::b>(unit::deg, "About Y, second.");
  d.defaulted<&Pose::c>(unit::deg, "About Z, last.");
}

}  // namespace takt::kinematics
