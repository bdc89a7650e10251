// States of movers, tracks, groups and parts in the plane, and all legal transitions between them (PL-01).
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/state_table.h"

namespace takt::planar {

// In: events that lead to the state. Out: events that lead out of it.
enum class ObjectState : std::uint8_t {
  kDisabled,      // in: start, disabled, reset after an abort. out: enable, fault
  kEnabling,      // in: enable. out: done, disable, fault
  kEnabled,       // in: enabled, reset after a quick stop. out: disable, fault
  kDisabling,     // in: disable. out: done, enable, fault
  kErrorPending,  // in: a fault. out: end of its reaction
  kError,         // in: end of the reaction. out: reset, a further fault
  kResetting,     // in: reset. out: done; a fault has to wait
};
inline constexpr int kObjectStates = 7;

using Transition = takt::Transition<ObjectState>;

// Staying in a state is always legal.
inline constexpr std::array kTransitions = {
    Transition{ObjectState::kDisabled, ObjectState::kEnabling, "enable"},
    Transition{ObjectState::kDisabled, ObjectState::kErrorPending, "fault"},
    Transition{ObjectState::kEnabling, ObjectState::kEnabled, "done"},
    Transition{ObjectState::kEnabling, ObjectState::kDisabling, "disable"},
    Transition{ObjectState::kEnabling, ObjectState::kErrorPending, "fault"},
    Transition{ObjectState::kEnabled, ObjectState::kDisabling, "disable"},
    Transition{ObjectState::kEnabled, ObjectState::kErrorPending, "fault"},
    Transition{ObjectState::kDisabling, ObjectState::kDisabled, "done"},
    Transition{ObjectState::kDisabling, ObjectState::kEnabling, "enable"},
    Transition{ObjectState::kDisabling, ObjectState::kErrorPending, "fault"},
    Transition{ObjectState::kErrorPending, ObjectState::kError, "reaction over"},
    Transition{ObjectState::kError, ObjectState::kResetting, "reset"},
    Transition{ObjectState::kError, ObjectState::kErrorPending, "fault"},
    Transition{ObjectState::kResetting, ObjectState::kEnabled, "done, after a quick stop"},
    Transition{ObjectState::kResetting, ObjectState::kDisabled, "done, after an abort"},
};

constexpr bool IsLegal(ObjectState from, ObjectState to) {
  return takt::IsLegal(kTransitions, from, to);
}

void describe(Enumeration<ObjectState>&);

}  // namespace takt::planar
