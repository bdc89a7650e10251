// A command as the axis keeps it: checked, unset values filled in, small and plain, so that it can be buffered and
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
  kGuided,  // set points come from another component of the machine, not from a command
};

struct Request {
  Ticket ticket = 0;
  double value = 0;  // position or distance [u], torque [Nm], delay of a stream [s]
  // The four limits of the command, at most the axis' own. Velocity moves: velocity without its sign (SenseOf).
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  double torque_ramp = 0;   // [Nm/s] of torque control; 0: unlimited
  double end_velocity = 0;  // [u/s] of continuous moves, in the sense of travel
  double timeout_s = 0;     // [s] of streams
  double lease_s = 0;       // [s] > 0: dead man's lease of a level-sensitive command
  std::int32_t key = 0;     // of streams
  RequestKind kind = RequestKind::kNone;
  Direction direction = Direction::kShortest;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool enable = false;   // power
  bool hold = false;     // stop
  bool update = false;   // changes the command of its kind in control (MC's ContinuousUpdate; AX-111)
  bool forward = false;  // jog
  bool backward = false;

  // For kinds of commands that need more.
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
  // Passes its position with `end_velocity` and keeps that.
  bool continuous() const {
    return kind == RequestKind::kMoveContinuousAbsolute || kind == RequestKind::kMoveContinuousRelative;
  }
  bool blends() const { return buffer_mode >= BufferMode::kBlendingLow; }
};

// The rules for each kind of command (second table 8.3 of the GT-775x manual), and the state that it puts the axis in.
struct RequestRules {
  RequestKind kind;
  bool may_be_buffered;
  bool may_be_blended;   // with the move before it
  bool may_be_followed;  // by a buffered command
  PlcState state;        // power: while switching off in motion
};
const RequestRules& RulesOf(RequestKind kind) noexcept;

// Checks a command and turns it into a request. Commands that do not take control of the axis (settings, probes,
// superimposed motions) are checked in the same way and leave kind kNone.
//
// Returns kParameter if a value is not finite, out of its range or beyond the axis' limits (AX-06), or if the command
// does not have the buffer mode. `why`, if given, then says what was wrong.
struct Refusal {
  const char* field = "";
  double found = 0;
  double low = 0;
  double high = 0;
};
Status MakeRequest(const Command& command, const AxisParams& params, Request& out, Refusal* why = nullptr) noexcept;
// Returns the same as a sentence for users; empty if the arguments are valid. Not for use in the cycle.
std::string Diagnose(const Command& command, const AxisParams& params);

void describe(Enumeration<RequestKind>&);
void describe(Description<Request>&);

}  // namespace takt::axis
