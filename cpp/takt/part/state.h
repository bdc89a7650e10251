// The complete state of a part: plain data that can be copied, compared, hashed and replayed.
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
  std::uint64_t since = 0;  // cycle in which the state was entered
  bool forced = false;      // must not be enabled
  ErrorId error = ErrorId::kNone;
  std::uint32_t position = 0;   // index of the current or last position, from 0
  std::uint32_t commanded = 0;  // index of the commanded position, from 0
  std::uint64_t went = 0;       // cycle of the command to that position
  bool away = false;            // reported neither there nor still at the last one
  Ticket going = 0;             // of ActivatePosition
  Ticket disabling = 0;         // of ForceDisable
  Ticket resetting = 0;
};

State MakeState(const PartParams& params);

// Returns the state as other objects see it.
planar::PartNow Show(const State& s) noexcept;

void describe(Description<State>&);

}  // namespace takt::part
