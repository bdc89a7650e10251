// The PLCopen single-axis states and every legal transition between them (AX-10).
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/state_table.h"

namespace takt::axis {

// In: how an axis enters the state. Out: how it leaves it.
enum class PlcState : std::uint8_t {
  kDisabled,            // in: start, power off, reset with an open loop. out: power on
  kStandstill,          // in: powered and at rest, nothing commanded. out: any motion, power off, fault
  kDiscreteMotion,      // in: a move with an end, halt. out: done, other motion, stop, fault
  kContinuousMotion,    // in: a move without an end, jog. out: other motion, halt, stop, fault
  kSynchronizedMotion,  // in: following a master. out: other motion, stop, fault
  kHoming,              // in: a homing step. out: a finishing step, stop, fault
  kStopping,            // in: stop, power off while moving. out: at rest and released
  kErrorStop,           // in: a fault of the axis. out: reset, power off
};
inline constexpr int kPlcStates = 8;

using Transition = takt::Transition<PlcState>;

// PLCopen Motion Control Part 1, the state diagram, with its four notes. Staying in a state is always legal.
inline constexpr std::array kTransitions = {
    Transition{PlcState::kDisabled, PlcState::kStandstill, "MC_Power(enable), no error"},
    Transition{PlcState::kDisabled, PlcState::kErrorStop, "MC_Power(enable) with an error; fault"},
    Transition{PlcState::kStandstill, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kStandstill, PlcState::kDiscreteMotion,
               "MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, MC_Halt"},
    Transition{PlcState::kStandstill, PlcState::kContinuousMotion, "MC_MoveVelocity, MC_Jog"},
    Transition{PlcState::kStandstill, PlcState::kSynchronizedMotion, "MC_GearIn, MC_CamIn"},
    Transition{PlcState::kStandstill, PlcState::kHoming, "MC_Home, MC_Step..."},
    Transition{PlcState::kStandstill, PlcState::kStopping, "MC_Stop"},
    Transition{PlcState::kStandstill, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kDiscreteMotion, PlcState::kStandstill, "done"},
    Transition{PlcState::kDiscreteMotion, PlcState::kContinuousMotion, "MC_MoveVelocity, MC_Jog"},
    Transition{PlcState::kDiscreteMotion, PlcState::kSynchronizedMotion, "MC_GearIn, MC_CamIn"},
    Transition{PlcState::kDiscreteMotion, PlcState::kStopping, "MC_Stop, MC_Power(not enable)"},
    Transition{PlcState::kDiscreteMotion, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kDiscreteMotion, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kContinuousMotion, PlcState::kDiscreteMotion,
               "MC_MoveAbsolute, MC_MoveRelative, MC_Halt, jog released"},
    Transition{PlcState::kContinuousMotion, PlcState::kSynchronizedMotion, "MC_GearIn, MC_CamIn"},
    Transition{PlcState::kContinuousMotion, PlcState::kStopping, "MC_Stop, MC_Power(not enable)"},
    Transition{PlcState::kContinuousMotion, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kContinuousMotion, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kSynchronizedMotion, PlcState::kDiscreteMotion, "MC_MoveAbsolute, MC_MoveRelative, MC_Halt"},
    Transition{PlcState::kSynchronizedMotion, PlcState::kContinuousMotion, "MC_GearOut, MC_CamOut, MC_MoveVelocity"},
    Transition{PlcState::kSynchronizedMotion, PlcState::kStopping, "MC_Stop, MC_Power(not enable)"},
    Transition{PlcState::kSynchronizedMotion, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kSynchronizedMotion, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kHoming, PlcState::kStandstill, "finishing step done"},
    Transition{PlcState::kHoming, PlcState::kStopping, "MC_Stop, MC_Power(not enable)"},
    Transition{PlcState::kHoming, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kHoming, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kStopping, PlcState::kStandstill, "MC_Stop done and released"},
    Transition{PlcState::kStopping, PlcState::kDisabled, "MC_Power(not enable)"},
    Transition{PlcState::kStopping, PlcState::kErrorStop, "fault"},
    Transition{PlcState::kErrorStop, PlcState::kStandstill, "MC_Reset, loop closed"},
    Transition{PlcState::kErrorStop, PlcState::kDisabled, "MC_Reset, loop open; MC_Power(not enable)"},
};

constexpr bool IsLegal(PlcState from, PlcState to) {
  return takt::IsLegal(kTransitions, from, to);
}

void describe(Enumeration<PlcState>&);

}  // namespace takt::axis
