#include "takt/group/state_table.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Enumeration<GroupState>& e) {
  e.about("State of a group of axes.");
  e.value(GroupState::kDisabled, "GroupDisabled", "Not enabled: its members go by commands of their own.");
  e.value(GroupState::kStandby, "GroupStandby", "Enabled; nothing moves the group.");
  e.value(GroupState::kMoving, "GroupMoving", "Moves, or waits on its path.");
  e.value(GroupState::kHoming, "GroupHoming", "The members look for their references.");
  e.value(GroupState::kStopping, "GroupStopping", "Stops, or is kept so.");
  e.value(GroupState::kErrorStop, "GroupErrorStop", "After a fault; waits for a reset.");
}

}  // namespace takt::group
