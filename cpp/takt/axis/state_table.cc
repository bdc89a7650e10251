#include "takt/axis/state_table.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Enumeration<PlcState>& e) {
  e.about("PLCopen's states of a single axis.");
  e.value(PlcState::kDisabled, "Disabled", "The loop is open.");
  e.value(PlcState::kStandstill, "Standstill", "Powered and at rest, no command in control.");
  e.value(PlcState::kDiscreteMotion, "DiscreteMotion", "A motion with an end.");
  e.value(PlcState::kContinuousMotion, "ContinuousMotion", "A motion without an end.");
  e.value(PlcState::kSynchronizedMotion, "SynchronizedMotion", "Following a master.");
  e.value(PlcState::kHoming, "Homing", "Searching its reference.");
  e.value(PlcState::kStopping, "Stopping", "Being stopped; takes no other motion.");
  e.value(PlcState::kErrorStop, "ErrorStop",
          "Stopped by a fault; a reset leads out, or power off to Disabled, where the fault stays.");
}

}  // namespace takt::axis
