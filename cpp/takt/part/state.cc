#include "takt/part/state.h"

#include "takt/core/describe.h"

namespace takt::part {

using planar::ObjectState;

State MakeState(const PartParams& params) {
  State s;
  s.position = s.commanded = params.initial_position - 1;
  return s;
}

planar::PartNow Show(const State& s) noexcept {
  const bool faulty =
      s.state == ObjectState::kErrorPending || s.state == ObjectState::kError || s.state == ObjectState::kResetting;
  return {.position = s.position,
          .commanded = s.commanded,
          .away = s.away || s.commanded != s.position,
          .enabled = s.state == ObjectState::kEnabled,
          .enabling = s.state == ObjectState::kEnabling,
          .allowed = !s.forced && !faulty,
          .faulty = faulty};
}

void describe(Description<State>& d) {
  using S = State;
  d.named("PartState");
  d.about("State of a part of the surface.");
  d.internal<&S::state>("State of the part.");
  d.internal<&S::since>("Cycle in which the state was entered.");
  d.internal<&S::forced>("True: it must not be enabled.");
  d.internal<&S::error>("Error of the fault.");
  d.internal<&S::position>("Index of its present or last position.");
  d.internal<&S::commanded>("Index of its commanded position.");
  d.internal<&S::went>("Cycle of the command to that position.");
  d.internal<&S::away>("True: it is reported neither at that position nor at the last one.");
  d.internal<&S::going>("Ticket of the command that moves it.");
  d.internal<&S::disabling>("Ticket of the command that disables it.");
  d.internal<&S::resetting>("Ticket of the command that resets it.");
}

}  // namespace takt::part
