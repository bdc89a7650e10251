// The part of a request that only homing steps have: the search.
#pragma once

#include "takt/axis/commands/homing.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct HomingRequest {
  HomingDirection direction = HomingDirection::kPositive;
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double set_position = 0;    // [u] position to be set at the point found
  bool sets_position = true;  // false: positions keep their numbers
  double deviation = 0;       // [u] StepBlock: following error at an end stop
  double time_limit = 0;      // [s] 0: none
  double distance_limit = 0;  // [u] 0: none

  double torque_limit = 0;  // [Nm] 0: as the axis
  bool until_halt = false;  // in passing: a halt or a stop ends the search

  // MC_Home: the search of a switch, with that of the index pulse if there is one, ends homing.
  bool ends = false;
  double pulse_velocity = 0;  // [u/s] search of the index pulse after the switch; 0: the switch itself is the reference
  HomingDirection pulse_direction = HomingDirection::kPositive;
};

void describe(Description<HomingRequest>&);

}  // namespace takt::axis
