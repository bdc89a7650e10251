#include "takt/planar/object_state.h"

#include "takt/core/describe.h"

namespace takt::planar {

void describe(Enumeration<ObjectState>& e) {
  e.about("State of a mover, a track, a group or a part in the plane.");
  e.value(ObjectState::kDisabled, "Disabled", "Inactive; it can be configured.");
  e.value(ObjectState::kEnabling, "Enabling", "It is being enabled.");
  e.value(ObjectState::kEnabled, "Enabled", "Fully operational.");
  e.value(ObjectState::kDisabling, "Disabling", "It is being disabled.");
  e.value(ObjectState::kErrorPending, "ErrorPending", "After a fault, during the reaction to it.");
  e.value(ObjectState::kError, "Error", "After a fault, until a reset.");
  e.value(ObjectState::kResetting, "Resetting", "The fault is being reset.");
}

}  // namespace takt::planar
