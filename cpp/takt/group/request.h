// A checked move of a group.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/group/commands.h"
#include "takt/group/params.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/path_limits.h"

namespace takt::group {

enum class MoveKind : std::uint8_t { kNone, kLinear, kCircular, kDirect, kPath, kArch, kJog };

// Target on a carrier: its pose when recorded, and the travel of the carrier then.
struct CarriedTarget {
  std::uint32_t carrier = 0;  // number; 0: none, at rest in the MCS
  double from = 0;            // [mm or rad] travel of the carrier at which it was recorded
  kinematics::Pose lies;      // pose relative to the origin of the carrier
  bool has_origin = false;    // instead of the carrier's own:
  kinematics::Pose origin;    // in the MCS

  bool operator==(const CarriedTarget&) const = default;
};

// Six coordinates of the tool, then those of the axes; NaN: not given.
inline constexpr std::size_t kToolNumbers = 6;
using Numbers = std::array<double, kToolNumbers + kMaxAxes>;
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Request {
  Ticket ticket = 0;
  MoveKind kind = MoveKind::kNone;
  bool relative = false;
  CoordinateSystem system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 0;   // index
  kinematics::Pose frame;  // pose of that coordinate system in the MCS when the command was given
  CarriedTarget cargo;     // instead of `frame`: the target of that system, if it moves
  Numbers to{};
  path::Circle circle;
  std::uint32_t path = 0;    // index among the paths of the machine
  std::uint32_t master = 0;  // index + 1 of the axis that the path follows; 0: it runs by time
  double height = 0;         // [mm] of an arch
  double ratio = 1;          // [mm/u] path per master
  trajectory::AlongPath limits;
  kinematics::Configuration configuration{};  // direct moves to a pose; kKeep: any
  double velocity_factor = 1;                 // direct moves: of the axes' limits; jogs: of the speeds in `to`
  double acceleration_factor = 1;
  double jerk_factor = 1;
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
  JogSystem jog_system = JogSystem::kMcs;  // jogs; their numbers are velocities
  double most_s = kNoLimit;                // [s] longest duration of a jog at these velocities ...
  ErrorId border = ErrorId::kNone;         // ... because of this obstacle

  bool blends() const noexcept { return buffer_mode >= BufferMode::kBlendingLow; }
};

void describe(Enumeration<MoveKind>&);
void describe(Description<CarriedTarget>&);
void describe(Description<Request>&);

}  // namespace takt::group
