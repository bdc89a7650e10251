// All memory of a part: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/part/params.h"
#include "takt/planar/object_state.h"

namespace takt::part {

struct State {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  std::uint64_t since = 0;  // cycle in which it became so
  bool forced = false;      // it must not be enabled
  ErrorId error = ErrorId::kNone;
  std::uint32_t position = 0;   // where it is, or was last, from 0 ...
  std::uint32_t commanded = 0;  // ... and where it is to be
  std::uint64_t went = 0;       // cycle in which it was commanded there
  bool away = false;            // it is not there
  Ticket going = 0;             // of activate_position
  Ticket disabling = 0;         // of force_disable
  Ticket resetting = 0;
};

State MakeState(const PartParams& params);

// As others see it.
planar::PartNow Show(const State& s) noexcept;

void describe(Description<State>&);

}  // namespace takt::part
