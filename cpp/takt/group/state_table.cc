#include "takt/group/state_table.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Enumeration<GroupState>& e) {
  e.about("State of a group of axes.");
  e.value(GroupState::kDisabled, "GroupDisabled", "Not enabled: its members take commands of their own.");
  e.value(GroupState::kStandby, "GroupStandby", "Enabled; the group performs no motion.");
  e.value(GroupState::kMoving, "GroupMoving", "Moves, or waits on its path.");
  e.value(GroupState::kHoming, "GroupHoming", "The members are homing.");
  e.value(GroupState::kStopping, "GroupStopping", "Stops, or is held after a stop.");
  e.value(GroupState::kErrorStop, "GroupErrorStop", "After a fault; waits for a reset.");
}

}  // namespace takt::group
