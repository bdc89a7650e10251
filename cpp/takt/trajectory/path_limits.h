// Constraints on the motion along a path at one point of it, from the limits of coordinates and of the path itself.
//
// A coordinate q that depends on the arc length s has the velocity q' v and the acceleration q' a + q'' v². So with
// w = v², the acceleration limits at one point are straight lines over w, two for each coordinate (upper and lower).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "takt/core/describe_fwd.h"

namespace takt::trajectory {

inline constexpr std::size_t kPathCoordinates = 14;

// Largest velocity, acceleration and jerk of each coordinate; infinite: no limit.
struct CoordinateLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  struct One {
    double velocity = kNone;
    double acceleration = kNone;
    double jerk = kNone;
  };
  std::array<One, kPathCoordinates> of{};
  std::size_t count = 0;  // coordinates in use
};

// Limits along the path; all above 0 and finite.
struct AlongPath {
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;

  bool operator==(const AlongPath&) const = default;
};
// Returns the smaller one of each limit.
AlongPath Least(const AlongPath& a, const AlongPath& b) noexcept;

// Derivatives of each coordinate by the arc length; 0 where it does not depend on it.
struct PathSlopes {
  std::array<double, kPathCoordinates> first{};
  std::array<double, kPathCoordinates> second{};
};

// Shares of a coordinate's limits that the motion along the path may use; carriers of the path use the rest.
struct Left {
  double velocity = 1;
  double acceleration = 1;
  double jerk = 1;
};

struct PathPoint {
  double s = 0;  // [mm] arc length
  PathSlopes slopes;
  AlongPath limits;
  std::array<Left, kPathCoordinates> left{};
  // Second slopes halfway from the previous point; without them the second slopes are taken as linear in between.
  std::array<double, kPathCoordinates> middle{};
  bool has_middle = false;
  // Limits reserved at earlier points end here and are not propagated further (PathWindow): they were reserved for a
  // time that is over when the raw motion arrives.
  bool renewed = false;
};

// A cap on the magnitude of the acceleration that falls linearly with the squared speed.
struct AccelerationCap {
  double at_rest = CoordinateLimits::kNone;
  double fading = 0;  // decrease per squared speed
  double least = 0;   // lower bound of the cap
  double gentle = 1;  // share of the cap that is safe at any speed, not only at those of the fastest possible motion

  double At(double square) const noexcept { return std::max(least, at_rest - fading * square); }
  double Gentle(double square) const noexcept { return gentle * At(square); }
  bool operator==(const AccelerationCap&) const = default;
};
// Returns a cap that is below both for squared speeds from 0 to `square`.
AccelerationCap Least(const AccelerationCap& a, const AccelerationCap& b, double square) noexcept;

// Acceleration limits at one point of the path; those of coordinates are lines over the squared speed.
struct AccelerationBounds {
  std::size_t count = 0;
  std::array<double, kPathCoordinates> tilt{};   // slope of the acceleration along the path over the squared speed
  std::array<double, kPathCoordinates> reach{};  // acceleration at standstill, in both directions
  double acceleration = 0;                       // limit along the path
  double deceleration = 0;
  AccelerationCap strength;  // for acceleration and deceleration

  // Returns the least admissible acceleration (braking: negative). `full`: the deceleration limit along the path is
  // ignored.
  double Least(double square, bool full = false) const noexcept;
  // Returns the largest admissible acceleration.
  double Most(double square) const noexcept;
  // Returns a deceleration (positive) that is admissible whatever the motion did before.
  double Gentle(double square, bool full = false) const noexcept {
    return std::min(-Least(square, full), strength.Gentle(square));
  }
};

// Returns the bounds with `share` of each coordinate's acceleration limit; those along the path are at most what their
// jerk builds up within `build_up_s`.
AccelerationBounds BoundsAt(const PathPoint& point, const CoordinateLimits& limits, double build_up_s,
                            double share) noexcept;

// Returns the largest squared speed at this point that keeps the velocity limits and at which an admissible
// acceleration exists, with `share` of the coordinates' acceleration limits.
double SquareAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept;

// Returns a cap on the acceleration along the path (both signs) for squared speeds up to `square`, if it is built up
// and removed within `build_up_s`, from the jerk of the coordinates, q''' v³ + 3 q'' v a + q' j: a line below the exact
// curve. `third`: magnitude of each coordinate's third derivative. Scaled with its share `gentle` it also holds if the
// three terms add up and the speed grows during the build-up.
AccelerationCap AccelerationCapAt(const PathPoint& point, const std::array<double, kPathCoordinates>& third,
                                  const CoordinateLimits& limits, double square, double build_up_s) noexcept;

// Returns the largest squared speed, at most `highest`, from which an admissible acceleration leads to a squared speed
// of at most `later` at the distance `length` [mm] ahead; 0 if there is none.
double SquareBefore(const AccelerationBounds& bounds, double length, double later, double highest) noexcept;

// Returns the largest squared speed with which a joint (two points at the same arc length) can be passed: the
// accelerations of the coordinates step by no more than their jerk changes them within `time` [s], and by no more than
// half of their limits. 0: the first slopes differ, a stop is needed.
double JointSquare(const PathSlopes& before, const PathSlopes& after, const CoordinateLimits& limits,
                   double time) noexcept;

void describe(Description<AlongPath>&);

}  // namespace takt::trajectory
