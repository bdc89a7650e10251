#include "takt/mover/command_mode.h"

#include "takt/core/describe.h"

namespace takt::mover {

void describe(Enumeration<CommandMode>& e) {
  using M = CommandMode;
  e.about("Kind of command that a mover executes.");
  e.value(M::kFreeMovement, "FreeMovement", "The mover moves freely.");
  e.value(M::kJoiningTrack, "JoiningTrack", "The mover moves onto a track.");
  e.value(M::kOnTrack, "OnTrack", "The mover moves along a track, or rests on it.");
  e.value(M::kLeavingTrack, "LeavingTrack", "The mover moves off a track.");
  e.value(M::kCRotationFreeMovement, "CRotationFreeMovement", "C is outside its windows: X and Y are locked.");
  e.value(M::kCRotationOnTrack, "CRotationOnTrack", "C is outside its windows on a track: X and Y are locked.");
  e.value(M::kExternalSetpointGeneration, "ExternalSetpointGeneration",
          "The mover follows absolute external set points.");
  e.value(M::kFormation, "Formation", "The mover follows the star of its formation.");
}

}  // namespace takt::mover
