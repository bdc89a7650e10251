// The states of a pick and place module and every legal transition between them (PP-02).
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/state_table.h"

namespace takt::pickplace {

enum class PickPlaceState : std::uint8_t {
  kInit,           // the module is not enabled
  kReady,          // waits; a path that was stopped may be held
  kService,        // the group moves by other commands, or is released to them
  kHoming,         // axes are homing
  kJogPos,         // a key is held, or the axis comes to rest after its release
  kJogNeg,         //
  kPreparingPath,  // a profile is being planned
  kMovePp,         // a profile is being executed, or the tool waits at a belt
  kPathInterrupt,  // rests on the path while path_interrupt is true
  kStop,           // stops, or is at rest, while path_stop, path_halt or stop_all is true
  kError,          // until it is reset
};
inline constexpr int kModuleStates = 11;

using Transition = takt::Transition<PickPlaceState>;

inline constexpr std::array kTransitions = [] {
  using S = PickPlaceState;
  return std::array{
      Transition{S::kInit, S::kReady, "enable"},
      Transition{S::kInit, S::kError, "an error that was not reset"},
      Transition{S::kReady, S::kInit, "enable false"},
      Transition{S::kReady, S::kService, "internal_control, or the group moves by itself"},
      Transition{S::kReady, S::kHoming, "home_execute"},
      Transition{S::kReady, S::kJogPos, "jog"},
      Transition{S::kReady, S::kJogNeg, "jog"},
      Transition{S::kReady, S::kPreparingPath, "execute"},
      Transition{S::kReady, S::kMovePp, "execute, with a path held; return_to_path"},
      Transition{S::kReady, S::kStop, "path_stop, path_halt, stop_all"},
      Transition{S::kReady, S::kError, "fault"},
      Transition{S::kService, S::kReady, "over"},
      Transition{S::kService, S::kInit, "enable false"},
      Transition{S::kService, S::kStop, "stop_all, path_stop, path_halt"},
      Transition{S::kService, S::kError, "fault"},
      Transition{S::kHoming, S::kReady, "done"},
      Transition{S::kHoming, S::kInit, "enable false"},
      Transition{S::kHoming, S::kStop, "path_stop, path_halt, stop_all"},
      Transition{S::kHoming, S::kError, "fault"},
      Transition{S::kJogPos, S::kReady, "keys released, at rest"},
      Transition{S::kJogPos, S::kPathInterrupt, "keys released, at rest"},
      Transition{S::kJogPos, S::kInit, "enable false"},
      Transition{S::kJogPos, S::kStop, "path_stop, path_halt, stop_all; or from there"},
      Transition{S::kJogPos, S::kError, "fault"},
      Transition{S::kJogNeg, S::kReady, "keys released, at rest"},
      Transition{S::kJogNeg, S::kPathInterrupt, "keys released, at rest"},
      Transition{S::kJogNeg, S::kInit, "enable false"},
      Transition{S::kJogNeg, S::kStop, "path_stop, path_halt, stop_all; or from there"},
      Transition{S::kJogNeg, S::kError, "fault"},
      Transition{S::kPreparingPath, S::kMovePp, "planned"},
      Transition{S::kPreparingPath, S::kReady, "abort"},
      Transition{S::kPreparingPath, S::kInit, "enable false"},
      Transition{S::kPreparingPath, S::kStop, "path_stop, path_halt, stop_all"},
      Transition{S::kPreparingPath, S::kError, "fault, or there is no such path"},
      Transition{S::kMovePp, S::kReady, "all profiles done"},
      Transition{S::kMovePp, S::kInit, "enable false"},
      Transition{S::kMovePp, S::kPathInterrupt, "path_interrupt"},
      Transition{S::kMovePp, S::kStop, "path_stop, path_halt, stop_all"},
      Transition{S::kMovePp, S::kError, "fault"},
      Transition{S::kPathInterrupt, S::kMovePp, "path_interrupt false"},
      Transition{S::kPathInterrupt, S::kReady, "abort; path_interrupt false away from the path"},
      Transition{S::kPathInterrupt, S::kJogPos, "jog"},
      Transition{S::kPathInterrupt, S::kJogNeg, "jog"},
      Transition{S::kPathInterrupt, S::kInit, "enable false"},
      Transition{S::kPathInterrupt, S::kStop, "path_stop, path_halt, stop_all"},
      Transition{S::kPathInterrupt, S::kError, "fault"},
      Transition{S::kStop, S::kReady, "at rest, and the inputs are false"},
      Transition{S::kStop, S::kJogPos, "jog, with a path held"},
      Transition{S::kStop, S::kJogNeg, "jog, with a path held"},
      Transition{S::kStop, S::kInit, "enable false"},
      Transition{S::kStop, S::kError, "fault"},
      Transition{S::kError, S::kReady, "reset_error"},
      Transition{S::kError, S::kInit, "enable false"},
  };
}();

constexpr bool IsLegal(PickPlaceState from, PickPlaceState to) {
  return takt::IsLegal(kTransitions, from, to);
}

void describe(Enumeration<PickPlaceState>&);

}  // namespace takt::pickplace
