#include "takt/mover/admission.h"

#include <type_traits>
#include <variant>

#include "takt/core/in_range.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

// Returns true if the command now controls X and Y; relative external set points do not.
bool TookOver(Ticket ticket, const State& s) {
  const bool alone = s.external.mode == SetpointMode::kAbsolute;
  const auto has = [&](Slot slot) { return s.tickets[slot] == ticket; };
  return ticket != 0 && (has(kPlane) || has(kMoveX) || has(kMoveY) || has(kHaltOnTrack) || (alone && has(kExternal)));
}

bool HasGoodNumbers(const Command& command) {
  return std::visit([](const auto& body) { return InRange(body); }, command);
}

ErrorId WhyNotBuffered(const Command& command, const State& s) {
  if (!HasGoodNumbers(command)) return ErrorId::kParameter;
  return s.state == planar::ObjectState::kEnabled ? ErrorId::kNone : ErrorId::kMoverDisabled;
}

// Records which limit of a command with dynamics was reduced.
void NoteLimit(Ticket ticket, const Command& command, State& s) {
  const bool has = std::visit(
      [](const auto& body) {
        return requires {
          body.jerk;
        };
      },
      command);
  Record* record = has && ticket != 0 ? s.history.Find(ticket) : nullptr;
  if (record) record->limited_by = s.limited_by;
}

// Returns true if the command was refused because of an obstacle that may leave: a mover or a track, not a border.
bool MayBeGone(const AdmissionResult& answer) {
  const ObjectKind kind = answer.object.kind;
  return answer.status.error == ErrorId::kCollision && (kind == ObjectKind::kMover || kind == ObjectKind::kTrack);
}

// Returns true if the group of the mover lets the command wait for its area instead of refusing it.
bool MayWait(const Context& c, const Command& command) {
  const std::uint32_t group = c.grounds.Watching(c.grounds.group_of_mover[c.index]);
  if (group == 0 || !c.grounds.grounds[group - 1].waits) return false;
  return std::visit(
      []<typename T>(const T&) {
        return kIsOneOf<T, MoveToPosition, MoveX, MoveY, MoveRelativeX, MoveRelativeY, MoveOnTrack, JoinTrack,
                        LeaveTrack>;
      },
      command);
}

// Commands that a mover accepts even while its part is moving; all others would move it.
template <typename T>
constexpr bool kAlways = kIsOneOf<T, Enable, Disable, Reset, Halt, HaltX, HaltY, HaltZ, HaltA, HaltB, HaltC,
                                  HaltOnTrack, StopExternalSetpointGeneration, Wait, Release>;

// Calls `what` with the parameters that the terms of the command (TermsOf) give.
template <typename What>
AdmissionResult AskFor(const Context& c, Ticket ticket, const Command& command, State& s, const What& what) {
  if (!HasGoodNumbers(command)) return Refused(ErrorId::kParameter);
  const Terms terms = TermsOf(c, command, s);
  if (terms.error != ErrorId::kNone) return Refused(terms.error, terms.object);
  const Context within = With(c, terms.params);
  const LimitedBy limited_by = s.limited_by;
  const AdmissionResult answer = what(CommandContext{within, ticket, s});
  if (answer.status.failed()) {
    s.limited_by = limited_by;  // unchanged by a refused command
  } else if (terms.sets) {
    s.formation.whole = terms.whole;
  }
  return answer;
}

AdmissionResult AskFor(const Context& c, Ticket ticket, const Command& command, State& s) {
  return AskFor(c, ticket, command, s, [&](const CommandContext& given) {
    return std::visit(
        [&]<typename T>(const T& body) {
          return !kAlways<T> && IsAway(c, s) ? Refused(ErrorId::kPartDisabled) : CarryOut(given, body);
        },
        command);
  });
}

}  // namespace

AdmissionResult MoveAlong(const Context& c, const MoveToPosition& move, State& s) noexcept {
  return AskFor(c, 0, move, s, [&](const CommandContext& given) {
    if (const ErrorId why = Diagnose(s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
    return IsAway(c, s) ? Refused(ErrorId::kPartDisabled) : MoveTo(given, move);
  });
}

bool Begin(const Context& c, Ticket ticket, const Command& command, State& s, ObjectInfo* in_the_way) noexcept {
  const AdmissionResult answer = AskFor(c, ticket, command, s);
  if (in_the_way && MayBeGone(answer)) {
    *in_the_way = answer.object;
    return false;
  }
  if (answer.status.failed()) {
    const bool by_mode = answer.status.error == ErrorId::kCommandMode;
    const double value = by_mode ? static_cast<double>(s.mode) : answer.value;
    Report(c, ticket, FeedbackState::kError, answer.status.error, value, s, answer.object);
    return false;
  }
  NoteLimit(ticket, command, s);
  Report(c, ticket, answer.waits ? FeedbackState::kBusy : FeedbackState::kActive, ErrorId::kNone, answer.value, s);
  if (!answer.goes_on) Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, 0, s);
  return true;
}

void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  if (ticket != 0 && !std::holds_alternative<SetExternalSetpoint>(command)) {
    s.history.Begin(ticket, c.cycle.count, static_cast<std::uint8_t>(command.index()));
  }
  if (IsBuffered(command)) {
    ErrorId why = WhyNotBuffered(command, s);
    if (why == ErrorId::kNone && !Push(ticket, command, s.buffer)) why = ErrorId::kBufferFull;
    const bool waits = why == ErrorId::kNone;
    Report(c, ticket, waits ? FeedbackState::kBusy : FeedbackState::kError, why, 0, s);  // at once: clients wait for it
    return;
  }
  ObjectInfo in_the_way;
  if (!Begin(c, ticket, command, s, MayWait(c, command) ? &in_the_way : nullptr)) {
    if (in_the_way) WaitInTurn(c, ticket, command, in_the_way, s);
    return;
  }
  GoBeside(ticket, s);
  if (!TookOver(ticket, s)) return;
  End(c, kRoute, FeedbackState::kAborted, ErrorId::kNone, s);
  End(c, kPassing, FeedbackState::kAborted, ErrorId::kNone, s);
  End(c, kWait, FeedbackState::kAborted, ErrorId::kNone, s);
  AbortBuffered(c, s);
}

}  // namespace takt::mover
