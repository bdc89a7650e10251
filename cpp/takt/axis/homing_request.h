// What a homing step carries beyond the common part of a request: its search.
#pragma once

#include "takt/axis/commands/homing.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct HomingRequest {
  HomingDirection direction = HomingDirection::kPositive;
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double set_position = 0;    // u, what the found place is called ...
  bool sets_position = true;  // ... or the numbers stay as they are
  double deviation = 0;       // u, DevRef: following error at an end stop
  double time_limit = 0;      // s; 0: none
  double distance_limit = 0;  // u; 0: none

  double torque_limit = 0;  // Nm; 0: that of the axis
  bool until_halt = false;  // in passing: a halt or a stop ends it

  // MC_Home: a step that ends homing, where it was to end the search of a switch after one of the index pulse.
  bool ends = false;
  double pulse_velocity = 0;  // u/s; 0: the switch itself is the reference
  HomingDirection pulse_direction = HomingDirection::kPositive;
};

void describe(Description<HomingRequest>&);

}  // namespace takt::axis
