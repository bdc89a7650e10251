#include "takt/mover/admission.h"

#include <type_traits>
#include <variant>

#include "takt/core/in_range.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

// It has X and Y now.
bool TookOver(Ticket ticket, const State& s) {
  return ticket != 0 && (s.tickets[kPlane] == ticket || s.tickets[kExternal] == ticket);
}

ErrorId WhyNotBuffered(const Command& command, const State& s) {
  const bool in_range = std::visit([](const auto& body) { return InRange(body); }, command);
  if (!in_range) return ErrorId::kParameter;
  return s.state == planar::ObjectState::kEnabled ? ErrorId::kNone : ErrorId::kMoverDisabled;
}

// What a mover is told whatever its part does; the rest would move it.
template <typename T>
constexpr bool kAlways =
    std::is_same_v<T, Enable> || std::is_same_v<T, Disable> || std::is_same_v<T, Reset> || std::is_same_v<T, Halt> ||
    std::is_same_v<T, StopExternalSetpointGeneration> || std::is_same_v<T, Wait> || std::is_same_v<T, Release>;

}  // namespace

bool Begin(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  const Given given{c, ticket, s};
  const Answer answer = std::visit(
      [&]<typename T>(const T& body) {
        if (!InRange(body)) return Refused(ErrorId::kParameter);
        return !kAlways<T> && IsAway(c, s) ? Refused(ErrorId::kPartDisabled) : CarryOut(given, body);
      },
      command);
  if (answer.status.failed()) {
    Report(c, ticket, FeedbackState::kError, answer.status.error, 0, s, answer.object);
    return false;
  }
  Report(c, ticket, FeedbackState::kActive, ErrorId::kNone, answer.value, s);
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
    if (why != ErrorId::kNone) Report(c, ticket, FeedbackState::kError, why, 0, s);
    return;
  }
  if (!Begin(c, ticket, command, s) || !TookOver(ticket, s)) return;
  End(c, kPassing, FeedbackState::kAborted, ErrorId::kNone, s);
  End(c, kWait, FeedbackState::kAborted, ErrorId::kNone, s);
  AbortBuffered(c, s);
}

}  // namespace takt::mover
