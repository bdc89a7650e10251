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
  d.about("A part of the surface.");
  d.internal<&S::state>("What it can do.");
  d.internal<&S::since>("Cycle in which it came to be so.");
  d.internal<&S::forced>("It must not be enabled.");
  d.internal<&S::error>("Of the fault.");
  d.internal<&S::position>("Where it is, or was last.");
  d.internal<&S::commanded>("Where it is to be.");
  d.internal<&S::went>("Cycle in which it was commanded there.");
  d.internal<&S::away>("It is not there.");
  d.internal<&S::going>("Command that brings it somewhere.");
  d.internal<&S::disabling>("Command that disables it.");
  d.internal<&S::resetting>("Command that resets it.");
}

}  // namespace takt::part
