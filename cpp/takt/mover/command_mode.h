// The kind of command that a mover executes, and what it accepts meanwhile (PL-10).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/state_table.h"

namespace takt::mover {

// in: how a mover enters the mode; out: how it leaves it.
enum class CommandMode : std::uint8_t {
  kFreeMovement,                // in: enabled, a track left, turned into a window. out: to any other mode
  kJoiningTrack,                // in: a move onto a track. out: the move is over
  kOnTrack,                     // in: joined. out: a move from the track, a turn out of a window
  kLeavingTrack,                // in: a move from a track. out: the move is over
  kCRotationFreeMovement,       // in: a turn out of a window, enabled outside of them. out: at rest within one
  kCRotationOnTrack,            // the same on a track
  kExternalSetpointGeneration,  // in: absolute external set points. out: at rest after them
  kFormation,                   // in: a formation joined. out: left, or dissolved
};
inline constexpr int kCommandModes = 8;

using ModeTransition = Transition<CommandMode>;

// Staying in a mode is always legal.
inline constexpr std::array kModeTransitions = [] {
  using M = CommandMode;
  return std::array{
      ModeTransition{M::kFreeMovement, M::kCRotationFreeMovement, "move_c out of a window; enabled outside of them"},
      ModeTransition{M::kCRotationFreeMovement, M::kFreeMovement, "at rest within a window; set_position"},
      ModeTransition{M::kFreeMovement, M::kExternalSetpointGeneration, "start_external_setpoint_generation, absolute"},
      ModeTransition{M::kExternalSetpointGeneration, M::kFreeMovement, "at rest after it"},
      ModeTransition{M::kExternalSetpointGeneration, M::kCRotationFreeMovement, "at rest after it, outside a window"},
      ModeTransition{M::kFreeMovement, M::kJoiningTrack, "join_track"},
      ModeTransition{M::kJoiningTrack, M::kOnTrack, "joined"},
      ModeTransition{M::kJoiningTrack, M::kFreeMovement, "halt, fault"},
      ModeTransition{M::kOnTrack, M::kLeavingTrack, "leave_track"},
      ModeTransition{M::kLeavingTrack, M::kFreeMovement, "done, halt, fault"},
      ModeTransition{M::kOnTrack, M::kCRotationOnTrack, "move_c, adopt_track_orientation out of a window"},
      ModeTransition{M::kCRotationOnTrack, M::kOnTrack, "at rest within a window"},
      ModeTransition{M::kFreeMovement, M::kFormation, "join_formation"},
      ModeTransition{M::kFormation, M::kFreeMovement, "leave_formation; disabled; a fault of the planet or the star"},
  };
}();

constexpr bool IsLegal(CommandMode from, CommandMode to) {
  return takt::IsLegal(kModeTransitions, from, to);
}

// What a command asks of a mover. Enable, disable, reset and halt are accepted in every mode.
enum class Ask : std::uint8_t {
  kMoveToPosition,  // or X or Y by itself
  kMoveC,
  kMoveAuxiliary,  // Z, A, B
  kExternalAbsolute,
  kExternalRelative,
  kJoinTrack,
  kLeaveTrack,
  kMoveOnTrack,  // to a position, or geared to something
  kAdoptTrackOrientation,
  kJoinFormation,
  kLeaveFormation,
  kHaltOnTrack,
};
inline constexpr int kAsks = 12;

struct Acceptance {
  CommandMode mode;
  Ask ask;
};
inline constexpr std::array kAccepted = [] {
  using M = CommandMode;
  return std::array{
      Acceptance{M::kFreeMovement, Ask::kMoveToPosition},
      Acceptance{M::kFreeMovement, Ask::kMoveC},
      Acceptance{M::kFreeMovement, Ask::kMoveAuxiliary},
      Acceptance{M::kFreeMovement, Ask::kExternalAbsolute},
      Acceptance{M::kFreeMovement, Ask::kExternalRelative},
      Acceptance{M::kFreeMovement, Ask::kJoinTrack},
      Acceptance{M::kFreeMovement, Ask::kJoinFormation},
      Acceptance{M::kOnTrack, Ask::kMoveC},
      Acceptance{M::kOnTrack, Ask::kMoveAuxiliary},
      Acceptance{M::kOnTrack, Ask::kExternalRelative},
      Acceptance{M::kOnTrack, Ask::kLeaveTrack},
      Acceptance{M::kOnTrack, Ask::kMoveOnTrack},
      Acceptance{M::kOnTrack, Ask::kAdoptTrackOrientation},
      Acceptance{M::kOnTrack, Ask::kHaltOnTrack},
      Acceptance{M::kCRotationFreeMovement, Ask::kMoveC},
      Acceptance{M::kCRotationFreeMovement, Ask::kMoveAuxiliary},
      Acceptance{M::kCRotationFreeMovement, Ask::kExternalRelative},
      Acceptance{M::kCRotationOnTrack, Ask::kMoveC},
      Acceptance{M::kCRotationOnTrack, Ask::kMoveAuxiliary},
      Acceptance{M::kCRotationOnTrack, Ask::kExternalRelative},
      Acceptance{M::kCRotationOnTrack, Ask::kAdoptTrackOrientation},
      Acceptance{M::kCRotationOnTrack, Ask::kHaltOnTrack},
      Acceptance{M::kFormation, Ask::kMoveAuxiliary},
      Acceptance{M::kFormation, Ask::kLeaveFormation},
  };
}();

constexpr bool Accepts(CommandMode mode, Ask ask) {
  const auto says = [&](const Acceptance& a) { return a.mode == mode && a.ask == ask; };
  return std::any_of(kAccepted.begin(), kAccepted.end(), says);
}

void describe(Enumeration<CommandMode>&);

}  // namespace takt::mover
