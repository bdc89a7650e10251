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

// Something that lies on a carrier: its place then, and the carrier's travel since.
struct CarriedTarget {
  std::uint32_t carrier = 0;  // its number; 0: none, it stands in the MCS
  double from = 0;            // travel at which it lay there
  kinematics::Pose lies;      // seen from the carrier's origin
  bool has_origin = false;    // another one than that of the carrier itself:
  kinematics::Pose origin;    // in the MCS

  bool operator==(const CarriedTarget&) const = default;
};

// Six numbers of the tool, then those of the axes; NaN: not given.
inline constexpr std::size_t kToolNumbers = 6;
using Numbers = std::array<double, kToolNumbers + kMaxAxes>;
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Request {
  Ticket ticket = 0;
  MoveKind kind = MoveKind::kNone;
  bool relative = false;
  CoordinateSystem system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 0;   // from 0
  kinematics::Pose frame;  // where that coordinate system was in the MCS when the command was given
  CarriedTarget cargo;     // or what it is that of, if that moves
  Numbers to{};
  path::Circle circle;
  std::uint32_t path = 0;    // index of the machine's
  std::uint32_t master = 0;  // axis + 1 that gives the way along the path; 0: time does
  double height = 0;         // mm, of an arch
  double ratio = 1;          // mm per u of it
  trajectory::AlongPath limits;
  kinematics::Configuration configuration{};  // direct moves to a pose; kKeep: any
  double velocity_factor = 1;                 // direct moves: of the axes' limits; jogs: of the speeds in `to`
  double acceleration_factor = 1;
  double jerk_factor = 1;
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
  JogSystem jog_system = JogSystem::kMcs;  // a jog's; its numbers are speeds
  double most_s = kNoLimit;                // a jog goes on for so long at most at these speeds, ...
  ErrorId border = ErrorId::kNone;         // ... because this is in the way

  bool blends() const noexcept { return buffer_mode >= BufferMode::kBlendingLow; }
};

void describe(Enumeration<MoveKind>&);
void describe(Description<CarriedTarget>&);
void describe(Description<Request>&);

}  // namespace takt::group
