// The states of an axes group and every legal transition between them (GR-01).
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/state_table.h"

namespace takt::group {

// In: how a group enters the state. Out: how it leaves it.
enum class GroupState : std::uint8_t {
  kDisabled,   // in: start, disable, ungroup, remove of the last axis. out: enable
  kStandby,    // in: enable, a motion done, reset. out: any motion, disable. Members are at rest
  kMoving,     // in: a motion of the group. out: done, stop, fault. Members are in SynchronizedMotion
  kHoming,     // in: home. out: done, stop, fault
  kStopping,   // in: stop. out: at rest and released, fault
  kErrorStop,  // in: a fault of a member, or of the group. out: reset
};
inline constexpr int kGroupStates = 6;

using Transition = takt::Transition<GroupState>;

// PLCopen Motion Control Part 4, the state diagram of groups. Staying in a state is always legal.
inline constexpr std::array kTransitions = {
    Transition{GroupState::kDisabled, GroupState::kStandby, "MC_GroupEnable"},
    Transition{GroupState::kStandby, GroupState::kDisabled, "MC_GroupDisable, MC_UngroupAllAxes"},
    Transition{GroupState::kStandby, GroupState::kMoving,
               "MC_MoveLinear..., MC_MoveDirect..., MC_MovePath, MC_GroupHalt"},
    Transition{GroupState::kStandby, GroupState::kHoming, "MC_GroupHome"},
    Transition{GroupState::kStandby, GroupState::kStopping, "MC_GroupStop"},
    Transition{GroupState::kStandby, GroupState::kErrorStop, "fault of a member"},
    Transition{GroupState::kMoving, GroupState::kStandby, "done"},
    Transition{GroupState::kMoving, GroupState::kStopping, "MC_GroupStop"},
    Transition{GroupState::kMoving, GroupState::kErrorStop, "fault"},
    Transition{GroupState::kMoving, GroupState::kDisabled, "MC_GroupDisable, MC_UngroupAllAxes"},
    Transition{GroupState::kHoming, GroupState::kStandby, "done"},
    Transition{GroupState::kHoming, GroupState::kStopping, "MC_GroupStop"},
    Transition{GroupState::kHoming, GroupState::kErrorStop, "fault"},
    Transition{GroupState::kHoming, GroupState::kDisabled, "MC_GroupDisable, MC_UngroupAllAxes"},
    Transition{GroupState::kStopping, GroupState::kStandby, "MC_GroupStop done and released"},
    Transition{GroupState::kStopping, GroupState::kErrorStop, "fault"},
    Transition{GroupState::kStopping, GroupState::kDisabled, "MC_GroupDisable, MC_UngroupAllAxes"},
    Transition{GroupState::kErrorStop, GroupState::kStandby, "MC_GroupReset"},
};

constexpr bool IsLegal(GroupState from, GroupState to) {
  return takt::IsLegal(kTransitions, from, to);
}

void describe(Enumeration<GroupState>&);

}  // namespace takt::group
