// What limits of coordinates and of the way itself say about the motion along a path, at one place of it.
//
// A coordinate q that depends on the way s has the velocity q' v and the acceleration q' a + q'' v². So with w = v²,
// the limits of acceleration at one place are straight lines over w, one to either side of each coordinate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "takt/core/describe_fwd.h"

namespace takt::trajectory {

inline constexpr std::size_t kPathCoordinates = 14;

// Largest velocity, acceleration and jerk of each coordinate; infinite: without a limit.
struct CoordinateLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  struct One {
    double velocity = kNone;
    double acceleration = kNone;
    double jerk = kNone;
  };
  std::array<One, kPathCoordinates> of{};
  std::size_t count = 0;  // of coordinates in use
};

// Along the way; all above 0 and finite.
struct AlongPath {
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;

  bool operator==(const AlongPath&) const = default;
};
AlongPath Least(const AlongPath& a, const AlongPath& b) noexcept;

// How each coordinate changes with the way; 0 where it does not.
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
  double s = 0;  // along the way
  PathSlopes slopes;
  AlongPath limits;
  std::array<Left, kPathCoordinates> left{};
  // The second slopes halfway from the point before; without them they are taken for even.
  std::array<double, kPathCoordinates> middle{};
  bool has_middle = false;
  // Limits reserved at earlier points end here and are not spread any further (PathWindow): they were reserved for a
  // time that is over when the raw motion arrives.
  bool renewed = false;
};

// An acceleration that falls with the square of the speed.
struct AccelerationCap {
  double at_rest = CoordinateLimits::kNone;
  double fading = 0;  // per square of the speed
  double least = 0;   // it falls no further
  double gentle = 1;  // share of it that is good at any speed, not only at those of a motion as fast as may be

  double At(double square) const noexcept { return std::max(least, at_rest - fading * square); }
  double Gentle(double square) const noexcept { return gentle * At(square); }
  bool operator==(const AccelerationCap&) const = default;
};
// Beneath both up to a square of the speed.
AccelerationCap Least(const AccelerationCap& a, const AccelerationCap& b, double square) noexcept;

// The limits of acceleration of one place, those of coordinates as lines over the square of the speed.
struct AccelerationBounds {
  std::size_t count = 0;
  std::array<double, kPathCoordinates> tilt{};   // of the acceleration along the way, per square of the speed
  std::array<double, kPathCoordinates> reach{};  // at standstill, to both sides
  double acceleration = 0;                       // along the way
  double deceleration = 0;
  AccelerationCap strength;  // either way

  // `full`: the deceleration along the way does not count.
  double Least(double square, bool full = false) const noexcept;
  double Most(double square) const noexcept;
  // A deceleration that is good whatever the motion did before.
  double Gentle(double square, bool full = false) const noexcept {
    return std::min(-Least(square, full), strength.Gentle(square));
  }
};

// With `share` of each coordinate's acceleration; along the way no more than its jerk builds up within `build_up_s`.
AccelerationBounds BoundsAt(const PathPoint& point, const CoordinateLimits& limits, double build_up_s,
                            double share) noexcept;

// The largest square of the speed at this place: for velocities, and so that there is an acceleration within the
// bounds, with `share` of the coordinates' own.
double SquareAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept;

// The largest acceleration along the way, either way, that may be at speeds up to a square if it is built up and taken
// back within `build_up_s`: for the jerk of the coordinates, q''' v³ + 3 q'' v a + q' j. A line beneath it.
// `third`: how large the third derivative of each is. With its share
// `gentle` the three parts may come together, and the speed may grow while it builds up.
AccelerationCap AccelerationCapAt(const PathPoint& point, const std::array<double, kPathCoordinates>& third,
                                  const CoordinateLimits& limits, double square, double build_up_s) noexcept;

// The largest square of the speed up to `highest` from which an acceleration within the bounds leads to `later` at
// most, `length` further on.
double SquareBefore(const AccelerationBounds& bounds, double length, double later, double highest) noexcept;

// Whether two points at the same place can be passed without a stop, and how fast: the square of the speed at which the
// accelerations of the coordinates change by no more than their jerk makes them within `time`; 0: a stop is needed.
double JointSquare(const PathSlopes& before, const PathSlopes& after, const CoordinateLimits& limits,
                   double time) noexcept;

void describe(Description<AlongPath>&);

}  // namespace takt::trajectory
