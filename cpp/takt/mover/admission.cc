#include "takt/mover/admission.h"

#include "takt/core/in_range.h"

namespace takt::mover {

void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  if (ticket != 0 && !std::holds_alternative<SetExternalSetpoint>(command)) {
    s.history.Begin(ticket, c.cycle.count, static_cast<std::uint8_t>(command.index()));
  }
  const Given given{c, ticket, s};
  const Answer answer = std::visit(
      [&](const auto& body) { return InRange(body) ? CarryOut(given, body) : Refused(ErrorId::kParameter); }, command);
  if (answer.status.failed()) {
    return Report(c, ticket, FeedbackState::kError, answer.status.error, 0, s, answer.object);
  }
  Report(c, ticket, FeedbackState::kActive, ErrorId::kNone, answer.value, s);
  if (!answer.goes_on) Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, 0, s);
}

}  // namespace takt::mover
