#include "takt/mover/command_mode.h"

#include "takt/core/describe.h"

namespace takt::mover {

void describe(Enumeration<CommandMode>& e) {
  using M = CommandMode;
  e.about("What kind of command a mover carries out.");
  e.value(M::kFreeMovement, "FreeMovement", "It moves freely.");
  e.value(M::kJoiningTrack, "JoiningTrack", "It is on its way to a track.");
  e.value(M::kOnTrack, "OnTrack", "It moves along a track.");
  e.value(M::kLeavingTrack, "LeavingTrack", "It is on its way from a track.");
  e.value(M::kCRotationFreeMovement, "CRotationFreeMovement", "It is turned out of its windows: X and Y are locked.");
  e.value(M::kCRotationOnTrack, "CRotationOnTrack", "The same on a track.");
  e.value(M::kExternalSetpointGeneration, "ExternalSetpointGeneration", "It follows set points from outside.");
  e.value(M::kFormation, "Formation", "It goes along with the star of its formation.");
}

}  // namespace takt::mover
