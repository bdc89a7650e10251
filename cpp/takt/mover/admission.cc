#include "takt/mover/admission.h"

#include <type_traits>
#include <variant>

#include "takt/core/in_range.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

// What a mover is told whatever its part does; the rest would move it.
template <typename T>
constexpr bool kAlways = std::is_same_v<T, Enable> || std::is_same_v<T, Disable> || std::is_same_v<T, Reset> ||
                         std::is_same_v<T, Halt> || std::is_same_v<T, StopExternalSetpointGeneration>;

}  // namespace

void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  if (ticket != 0 && !std::holds_alternative<SetExternalSetpoint>(command)) {
    s.history.Begin(ticket, c.cycle.count, static_cast<std::uint8_t>(command.index()));
  }
  const Given given{c, ticket, s};
  const Answer answer = std::visit(
      [&]<typename T>(const T& body) {
        if (!InRange(body)) return Refused(ErrorId::kParameter);
        return !kAlways<T> && IsAway(c, s) ? Refused(ErrorId::kPartDisabled) : CarryOut(given, body);
      },
      command);
  if (answer.status.failed()) return Report(c, ticket, FeedbackState::kError, answer.status.error, 0, s);
  Report(c, ticket, FeedbackState::kActive, ErrorId::kNone, answer.value, s);
  if (!answer.goes_on) Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, 0, s);
}

}  // namespace takt::mover
