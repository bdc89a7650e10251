// What a mechanism's axes are to its kinematics, and why there may be no answer.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"

namespace takt::kinematics {

inline constexpr std::size_t kMaxJoints = 8;

// One number an axis; those beyond the mechanism's number of axes are 0.
using Joints = std::array<double, kMaxJoints>;

struct JointMotion {
  Joints position{};
  Joints velocity{};
  Joints acceleration{};
};

enum class JointKind : std::uint8_t { kLinear, kRotary };

// Column i: the velocity of the tool (mm and rad) when only axis i moves, with 1 a second.
using Jacobian = std::array<KDL::Twist, kMaxJoints>;

// Why there is no answer.
enum class Reason : std::uint8_t {
  kNone,         // there is one
  kNotFinite,    // a number given is NaN or infinite
  kOutOfReach,   // no position of the axes leads there
  kOrientation,  // the place can be reached, but not turned so
  kSingular,     // the axes cannot move the tool in every direction there: speeds are without bound
  kAxisLimit,    // an axis would have to leave its range
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(Reason reason) noexcept;

// Which of several positions of the axes. kKeep: the one that the axes given as near are in.
enum class Shoulder : std::uint8_t { kKeep, kFront, kBack };
enum class Elbow : std::uint8_t { kKeep, kPositive, kNegative };
enum class Wrist : std::uint8_t { kKeep, kPositive, kNegative };

struct Configuration {
  Shoulder shoulder = Shoulder::kKeep;
  Elbow elbow = Elbow::kKeep;
  Wrist wrist = Wrist::kKeep;

  constexpr bool operator==(const Configuration&) const = default;
};

// `wanted`, with what it keeps taken from `present`.
constexpr Configuration Resolve(const Configuration& wanted, const Configuration& present) noexcept {
  return {wanted.shoulder == Shoulder::kKeep ? present.shoulder : wanted.shoulder,
          wanted.elbow == Elbow::kKeep ? present.elbow : wanted.elbow,
          wanted.wrist == Wrist::kKeep ? present.wrist : wanted.wrist};
}

// Nearer to a singularity than this there is no answer: the sine of the angle that is 0 or 180 degrees there.
inline constexpr double kSingularSine = 1e-6;
// How far a pose may be from what a mechanism of few axes can do at all and still count as that, in mm and rad.
inline constexpr double kSlack = 1e-9;

void describe(Enumeration<Reason>&);
void describe(Enumeration<Shoulder>&);
void describe(Enumeration<Elbow>&);
void describe(Enumeration<Wrist>&);
void describe(Description<Configuration>&);

}  // namespace takt::kinematics
