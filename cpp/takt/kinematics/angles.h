// Plane geometry shared by several mechanisms.
#pragma once

#include <cmath>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/kinematics/joints.h"

namespace takt::kinematics {

// Returns `angle` plus the number of whole turns that brings it nearest to `near` [rad].
inline double NearestTurn(double angle, double near) noexcept {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle + kTurn * std::round((near - angle) / kTurn);
}

// Two links in a plane that reach the point (x, y) from the origin: `first` is the angle from the x axis to the first
// link, `elbow` from the first link to the second [rad], positive from x to y.
struct TwoLinks {
  double first = 0;
  double elbow = 0;
};

// Computes the angles. Lengths in [mm], both above 0. `positive`: the sign of the elbow.
inline Reason Reach(double first_length, double second_length, double x, double y, bool positive,
                    TwoLinks& out) noexcept {
  const double distance = maths::Hypot(x, y);
  const double longest = first_length + second_length;
  const double shortest = std::abs(first_length - second_length);
  // Keeps differences of nearly equal lengths exact: 1 - cos and 1 + cos of the elbow, times `scale`.
  const double scale = 2 * first_length * second_length;
  const double less = (longest - distance) * (longest + distance);
  const double more = (distance - shortest) * (distance + shortest);
  if (!(less >= 0 && more >= 0)) return Reason::kOutOfReach;
  const double sine = std::sqrt(less * more) / scale;
  if (sine < kSingularSine) return Reason::kSingular;
  const double cosine = (more - less) / (2 * scale);
  out.elbow = maths::Atan2(positive ? sine : -sine, cosine);
  out.first =
      maths::Atan2(y, x) - maths::Atan2(second_length * maths::Sin(out.elbow), first_length + second_length * cosine);
  return Reason::kNone;
}

// Returns true if Z of the orientation is Z of the frame: for mechanisms without axes to tilt with.
inline bool Upright(const KDL::Rotation& r) noexcept {
  return std::abs(r(0, 2)) <= kSlack && std::abs(r(1, 2)) <= kSlack && r(2, 2) > 0;
}

// Returns true if the frame turns about Z only, except for rounding.
inline bool IsUprightMotion(const MovingFrame& frame) noexcept {
  const auto small = [](const KDL::Vector& v) {
    const double slack = kSlack * (1 + std::abs(v.z()));
    return std::abs(v.x()) <= slack && std::abs(v.y()) <= slack;
  };
  return small(frame.M.w) && small(frame.M.dw);
}

// Returns the angle about Z of an upright orientation [rad].
inline double AngleAboutZ(const KDL::Rotation& r) noexcept {
  return maths::Atan2(r(1, 0), r(0, 0));
}

}  // namespace takt::kinematics
