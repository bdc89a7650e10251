// Axes of a mechanism as seen by its kinematics, and the reasons for which there may be no solution.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"

namespace takt::kinematics {

inline constexpr std::size_t kMaxJoints = 8;

// One number per axis; entries beyond the mechanism's number of axes are 0.
using Joints = std::array<double, kMaxJoints>;

struct JointMotion {
  Joints position{};
  Joints velocity{};
  Joints acceleration{};
};

enum class JointKind : std::uint8_t { kLinear, kRotary };

// Column i: the velocity of the tool (mm and rad per second) when only axis i moves, with 1 per second.
using Jacobian = std::array<KDL::Twist, kMaxJoints>;

// Why there is no solution.
enum class Reason : std::uint8_t {
  kNone,         // there is one
  kNotFinite,    // a given number is NaN or infinite
  kOutOfReach,   // no position of the axes reaches the position
  kOrientation,  // the position can be reached, but not with this orientation
  kSingular,     // the axes cannot move the tool in every direction there: axis speeds are unbounded
  kAxisLimit,    // an axis would have to leave its range
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(Reason reason) noexcept;

// Choice between several positions of the axes. kKeep: that of the axes given as `near`.
enum class Shoulder : std::uint8_t { kKeep, kFront, kBack };
enum class Elbow : std::uint8_t { kKeep, kPositive, kNegative };
enum class Wrist : std::uint8_t { kKeep, kPositive, kNegative };

struct Configuration {
  Shoulder shoulder = Shoulder::kKeep;
  Elbow elbow = Elbow::kKeep;
  Wrist wrist = Wrist::kKeep;

  constexpr bool operator==(const Configuration&) const = default;
};

// Returns `wanted`, with kKeep replaced by the value of `present`.
constexpr Configuration Resolve(const Configuration& wanted, const Configuration& present) noexcept {
  return {wanted.shoulder == Shoulder::kKeep ? present.shoulder : wanted.shoulder,
          wanted.elbow == Elbow::kKeep ? present.elbow : wanted.elbow,
          wanted.wrist == Wrist::kKeep ? present.wrist : wanted.wrist};
}

// Least distance to a singularity with a solution: the sine of the angle that is 0 or 180 degrees in the singularity.
inline constexpr double kSingularSine = 1e-6;
// Largest deviation of a pose from those that a mechanism of few axes can reach, in mm and rad.
inline constexpr double kSlack = 1e-9;

void describe(Enumeration<Reason>&);
void describe(Enumeration<Shoulder>&);
void describe(Enumeration<Elbow>&);
void describe(Enumeration<Wrist>&);
void describe(Description<Configuration>&);

}  // namespace takt::kinematics
