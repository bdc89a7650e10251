// Commands as they arrive: what carrying them out has in common. Each family has a file of its own beside this one:
// power.cc, moves.cc, by_coordinate.cc, on_tracks.cc, gear.cc, setpoints.cc, buffer.cc, membership.cc, formation.cc,
// routes.cc.
#pragma once

#include <algorithm>
#include <optional>

#include "takt/mover/run.h"
#include "takt/planar/send.h"

namespace takt::mover {

// A command that has arrived.
struct CommandContext {
  const Context& c;
  Ticket ticket;
  State& s;
};

// What becomes of it.
struct AdmissionResult {
  Status status;
  double value = 0;     // s that it takes, as planned; refused: what the error says of it
  bool goes_on = true;  // it is done later
  bool waits = false;   // and does nothing yet
  ObjectInfo object{};  // that is in the way
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

// The command gets this slot; who had it is aborted.
inline void Take(const CommandContext& g, Slot slot) noexcept {
  End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, g.s);
  g.s.tickets[slot] = g.ticket;
  g.s.begun[slot] = g.c.cycle.count;
}

// Why the mover does not do this now.
inline ErrorId Diagnose(const State& s, Ask ask) noexcept {
  if (s.state != planar::ObjectState::kEnabled) return ErrorId::kMoverDisabled;
  return Accepts(s.mode, ask) ? ErrorId::kNone : ErrorId::kCommandMode;
}

// Dynamics of a command, no more than the maximum.
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

// Along tracks with these limits; as vectors in the plane acceleration and jerk keep the mover's maxima.
inline planar::Pace PaceOf(const MoverParams& params, const trajectory::Limits& limits,
                           DynamicsReduction reduction = DynamicsReduction::kAccelerationLimitedVelocity) noexcept {
  const trajectory::Limits most = params.xy.maximum.limits();
  const double acceleration = std::max(most.acceleration, most.deceleration);
  const double lateral = reduction == DynamicsReduction::kNone ? acceleration : params.lateral();
  return {limits, lateral, acceleration, most.jerk};
}

// Carries it out, or refuses it; reports either way. Whether it was accepted. With `in_the_way`, one that only another
// mover or a track that is Moving is in the way of is not refused: nothing has happened, and this is what it was.
bool Begin(const Context& c, Ticket ticket, const Command& command, State& s,
           ObjectInfo* in_the_way = nullptr) noexcept;

// Whether a mover may go along these tracks now; and then it does.
planar::Verdict AskRoute(const Context& c, const planar::Route& route) noexcept;
void TakeRoute(const Context& c, const planar::Route& route) noexcept;
// The least gap, mm, at which it and those that are on its route now would not touch, turned as it will be, anywhere on
// its way. No less than `wanted` if that is enough in all bends.
double LeastGap(const Context& c, const State& s, const planar::Rider& rider, double wanted) noexcept;
// The mover must not cover what a move would cover; the part that it would leave is named.
inline AdmissionResult RefusedThere(const State& s, ErrorId why) noexcept {
  const bool leaves = why == ErrorId::kOffStators && s.part != planar::kNoPart;
  return Refused(why, leaves ? ObjectAt(ObjectKind::kPart, s.part) : ObjectInfo{});
}
// A part that is not where it is to be.
inline bool IsOnItsWay(const Context& c, std::uint32_t part) noexcept {
  const planar::PartNow& now = c.streets.parts->now[part];
  return now.away || now.position != now.commanded;
}
// The part that a move has to wait for before it can begin; kNoPart: none, or it is not on its way.
std::uint32_t PartAwaited(const Context& c, const Command& command, const State& s) noexcept;
// Sends a mover on its way as `command` asks; not yet with its dynamics.
planar::Verdict FindWay(const Context& c, const MoveOnTrack& command, const State& s, planar::Rider& rider) noexcept;
planar::Way WayOf(TurnDirection direction) noexcept;
// A move of X and Y in the plane, whatever the mode.
AdmissionResult MoveTo(const CommandContext& g, const MoveToPosition& command) noexcept;
// As a mover on a route moves on: its coordinate system is that where it is, and nothing is reported.
AdmissionResult MoveAlong(const Context& c, const MoveToPosition& move, State& s) noexcept;
// One of C, if it may do what `ask` says.
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
