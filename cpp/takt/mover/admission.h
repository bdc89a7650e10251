// Admission of commands: what the execution of all commands has in common. Each family of commands has a file of its
// own: power.cc, moves.cc, by_coordinate.cc, on_tracks.cc, gear.cc, setpoints.cc, buffer.cc, membership.cc,
// formation.cc, routes.cc.
#pragma once

#include <algorithm>
#include <optional>

#include "takt/mover/run.h"
#include "takt/planar/send.h"

namespace takt::mover {

// Context of a command under admission.
struct CommandContext {
  const Context& c;
  Ticket ticket;
  State& s;
};

// Result of the admission of a command.
struct AdmissionResult {
  Status status;
  double value = 0;     // [s] planned duration; if refused: the value that the error reports
  bool goes_on = true;  // the command stays in progress after admission
  bool waits = false;   // accepted, but not active yet
  ObjectInfo object{};  // the obstacle, or the object that the error names; none if empty
};

inline AdmissionResult Refused(ErrorId error, const ObjectInfo& object = {}, double value = 0) noexcept {
  return {.status = Status::Failed(error), .value = value, .object = object};
}
inline AdmissionResult Refused(const planar::Verdict& why) noexcept {
  return Refused(why.error, why.object, why.value);
}
inline AdmissionResult RefusedGap(double least) noexcept {
  return {.status = Status::Failed(ErrorId::kGapTooSmall), .value = least, .object = {}};
}
inline AdmissionResult Done() noexcept {
  return {Status::Ok(), 0, false};
}

// Assigns the slot to the command; the command that held it is aborted.
inline void Take(const CommandContext& g, Slot slot) noexcept {
  End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, g.s);
  g.s.tickets[slot] = g.ticket;
  g.s.begun[slot] = g.c.cycle.count;
}

// Returns kMoverDisabled or kCommandMode if the mover does not accept `ask` now; else kNone.
inline ErrorId Diagnose(const State& s, Ask ask) noexcept {
  if (s.state != planar::ObjectState::kEnabled) return ErrorId::kMoverDisabled;
  return Accepts(s.mode, ask) ? ErrorId::kNone : ErrorId::kCommandMode;
}

// Returns the dynamics of a command: unset values are the standard ones, all are clamped to the maximum. `limited_by`:
// the first value that was reduced.
template <typename Move, typename Params>
trajectory::Limits LimitsOf(const Move& m, const Params& params, LimitedBy& limited_by) noexcept {
  const trajectory::Limits standard = StandardOf(params);
  const trajectory::Limits most = params.maximum.limits();
  limited_by = LimitedBy::kNothing;
  const auto take = [&](const std::optional<double>& given, double otherwise, double maximum, LimitedBy what) {
    const double wanted = given.value_or(otherwise);
    if (wanted > maximum && limited_by == LimitedBy::kNothing) limited_by = what;
    return std::min(wanted, maximum);
  };
  return {take(m.velocity, standard.velocity, most.velocity, LimitedBy::kVelocity),
          take(m.acceleration, standard.acceleration, most.acceleration, LimitedBy::kAcceleration),
          take(m.deceleration, standard.deceleration, most.deceleration, LimitedBy::kAcceleration),
          take(m.jerk, standard.jerk, most.jerk, LimitedBy::kJerk)};
}

// Returns the pace along tracks with these limits; as vectors in the plane, acceleration and jerk are bounded by the
// mover's maxima.
inline planar::Pace PaceOf(const MoverParams& params, const trajectory::Limits& limits,
                           DynamicsReduction reduction = DynamicsReduction::kAccelerationLimitedVelocity) noexcept {
  const trajectory::Limits most = params.xy.maximum.limits();
  const double acceleration = std::max(most.acceleration, most.deceleration);
  const double lateral = reduction == DynamicsReduction::kNone ? acceleration : params.lateral();
  return {limits, lateral, acceleration, most.jerk};
}

// Executes or refuses a command and reports the result; returns true if it was accepted. With `in_the_way`, a command
// that is blocked only by another mover or by a track that is Moving is neither refused nor reported: the state is
// unchanged, and `in_the_way` receives the obstacle.
bool Begin(const Context& c, Ticket ticket, const Command& command, State& s,
           ObjectInfo* in_the_way = nullptr) noexcept;

// AskRoute returns why the mover may not move along these tracks now, kNone if it may; TakeRoute then counts it as
// moving on them and reserves them.
planar::Verdict AskRoute(const Context& c, const planar::Route& route) noexcept;
void TakeRoute(const Context& c, const planar::Route& route) noexcept;
// Returns the smallest gap [mm] at which this mover and the movers that are now on the tracks of its route do not
// touch, at the final angle of its rotation in progress. Checked at its position, at the ends of the tracks and, for
// gaps above `wanted`, in all bends of its route.
double LeastGap(const Context& c, const State& s, const planar::Rider& rider, double wanted) noexcept;
// Refuses a move because of the area that it would cover; kOffStators names the part that the mover would leave.
inline AdmissionResult RefusedThere(const State& s, ErrorId why) noexcept {
  const bool leaves = why == ErrorId::kOffStators && s.part != planar::kNoPart;
  return Refused(why, leaves ? ObjectAt(ObjectKind::kPart, s.part) : ObjectInfo{});
}
// Returns true if the part is moving, or not at its commanded position.
inline bool IsPartMoving(const Context& c, std::uint32_t part) noexcept {
  const planar::PartNow& now = c.streets.parts->now[part];
  return now.away || now.position != now.commanded;
}
// Returns the part whose motion a move on tracks has to wait for before it can begin; kNoPart: none, or it is not
// moving.
std::uint32_t PartAwaited(const Context& c, const Command& command, const State& s) noexcept;
// Computes route and target of `command` and writes them into `rider`; the dynamics are not set.
planar::Verdict ComputeRoute(const Context& c, const MoveOnTrack& command, const State& s,
                             planar::Rider& rider) noexcept;
planar::Way ReachableInterval(TurnDirection direction) noexcept;
// Moves X and Y in the plane, whatever the command mode.
AdmissionResult MoveTo(const CommandContext& g, const MoveToPosition& command) noexcept;
// A move of a mover along its route: `move` is in the coordinate system of the mover, and nothing is reported.
AdmissionResult MoveAlong(const Context& c, const MoveToPosition& move, State& s) noexcept;
// Turns C if the command mode accepts `ask`.
AdmissionResult Turn(const CommandContext& g, const MoveC& command, Ask ask) noexcept;

AdmissionResult CarryOut(const CommandContext& g, const Enable& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const Disable& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const Reset& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const Halt& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const SetPosition& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveToPosition& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveZ& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveA& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveB& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveC& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveX& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveY& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeX& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeY& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeC& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityX& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityY& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityC& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltX& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltY& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltZ& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltA& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltB& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltC& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const HaltOnTrack& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const JoinTrack& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const LeaveTrack& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const MoveOnTrack& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const AdoptTrackOrientation& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const GearInPosOnTrack& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const GearInPosOnTrackWithMasterMover& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const StartExternalSetpointGeneration& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const SetExternalSetpoint& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const StopExternalSetpointGeneration& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const Wait& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const Release& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const AddToGroup& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const RemoveFromGroup& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const JoinFormation& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const LeaveFormation& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const SetRoute& command) noexcept;
AdmissionResult CarryOut(const CommandContext& g, const ContinueRoute& command) noexcept;

}  // namespace takt::mover
