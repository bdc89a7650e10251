// A command as the axis keeps it: checked, its unset values filled in, small and plain, so that it can be buffered and
// hashed.
#pragma once

#include <string>

#include "takt/axis/commands.h"
#include "takt/axis/coupling_request.h"
#include "takt/axis/homing_request.h"
#include "takt/axis/params.h"
#include "takt/axis/state_table.h"
#include "takt/axis/table_request.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::axis {

enum class RequestKind : std::uint8_t {
  kNone,
  kPower,
  kMoveAbsolute,
  kMoveRelative,
  kMoveAdditive,
  kMoveVelocity,
  kHalt,
  kStop,
  kJog,
  kMoveContinuousAbsolute,
  kMoveContinuousRelative,
  kInch,
  kTorqueControl,
  kGearIn,
  kGearInPos,
  kCombineAxes,
  kCamIn,
  kPositionProfile,
  kVelocityProfile,
  kAccelerationProfile,
  kLetGo,  // MC_GearOut, MC_CamOut
  kStepAbsSwitch,
  kStepLimitSwitch,
  kStepBlock,
  kStepRefPulse,
  kStepDistanceCoded,
  kStepDirect,
  kStepAbsolute,
  kFinishHoming,
  kTouch,
  kStream,
  kGuided,  // by another component of the machine, not by a command
};

struct Request {
  Ticket ticket = 0;
  double value = 0;     // position, distance; velocity moves: the signed velocity is velocity * sense
  double velocity = 0;  // [u/s] the four limits of the command, never beyond the axis' own
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  double torque_ramp = 0;   // [Nm/s] of torque control; 0: at once
  double end_velocity = 0;  // [u/s] of continuous moves, in the sense of travel
  double timeout_s = 0;     // [s] of streams
  double lease_s = 0;       // > 0: level-sensitive command under a dead man's lease
  std::int32_t key = 0;     // of streams
  RequestKind kind = RequestKind::kNone;
  Direction direction = Direction::kShortest;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool enable = false;   // power
  bool hold = false;     // stop
  bool update = false;   // changes the command of its kind that is in control (MC's ContinuousUpdate; AX-111)
  bool forward = false;  // jog
  bool backward = false;

  // Of the groups of commands that need more.
  CouplingRequest coupling;
  TableRequest table;
  HomingRequest homing;

  trajectory::Limits limits() const { return {velocity, acceleration, deceleration, jerk}; }
  bool positions() const {
    return kind == RequestKind::kMoveAbsolute || kind == RequestKind::kMoveContinuousAbsolute ||
           kind == RequestKind::kTouch || by_distance();
  }
  bool by_distance() const {
    return kind == RequestKind::kMoveRelative || kind == RequestKind::kMoveAdditive || kind == RequestKind::kInch ||
           kind == RequestKind::kMoveContinuousRelative;
  }
  // Goes on with `end_velocity` from its position.
  bool continuous() const {
    return kind == RequestKind::kMoveContinuousAbsolute || kind == RequestKind::kMoveContinuousRelative;
  }
  bool blends() const { return buffer_mode >= BufferMode::kBlendingLow; }
};

// What the second table 8.3 of the GT-775x manual says of each command, and the state it puts the axis in.
struct RequestRules {
  RequestKind kind;
  bool may_be_buffered;
  bool may_be_blended;   // into the move before it
  bool may_be_followed;  // by a buffered command
  PlcState state;        // power: while switching off in motion
};
const RequestRules& RulesOf(RequestKind kind) noexcept;

// Commands that do not take control of the axis (settings, probes, what comes on top of a motion) are checked likewise
// and leave kind kNone.
//
// kParameter where a value is not finite, out of its range, beyond the axis' limits (AX-06) or the buffer mode is not
// one of the command's. `why`, where given, says what was wrong.
struct Refusal {
  const char* field = "";
  double found = 0;
  double low = 0;
  double high = 0;
};
Status MakeRequest(const Command& command, const AxisParams& params, Request& out, Refusal* why = nullptr) noexcept;
// The same as a sentence for people; empty: the arguments are fine. Not for the cycle.
std::string Diagnose(const Command& command, const AxisParams& params);

void describe(Enumeration<RequestKind>&);
void describe(Description<Request>&);

}  // namespace takt::axis
