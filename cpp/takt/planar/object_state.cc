#include "takt/planar/object_state.h"

#include "takt/core/describe.h"

namespace takt::planar {

void describe(Enumeration<ObjectState>& e) {
  e.about("State of a mover, a track, a group or a part in the plane.");
  e.value(ObjectState::kDisabled, "Disabled", "Does nothing, and can be configured.");
  e.value(ObjectState::kEnabling, "Enabling", "Is being enabled.");
  e.value(ObjectState::kEnabled, "Enabled", "Does all it can.");
  e.value(ObjectState::kDisabling, "Disabling", "Is being disabled.");
  e.value(ObjectState::kErrorPending, "ErrorPending", "After a fault, as long as the reaction to it takes.");
  e.value(ObjectState::kError, "Error", "After a fault; waits for a reset.");
  e.value(ObjectState::kResetting, "Resetting", "The fault is being reset.");
}

}  // namespace takt::planar
