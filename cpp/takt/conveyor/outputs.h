// The outputs that a belt publishes every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"

namespace takt::conveyor {

struct Outputs {
  // The travel, over all turns: position of the belt when the axes are at the set points of this cycle.
  double position = 0;      // [mm] or [deg]
  double velocity = 0;      // [mm/s] or [deg/s]
  double acceleration = 0;  // [mm/s²] or [deg/s²]
  // the axis' position is known; otherwise the belt is assumed to continue at its last velocity
  bool known = false;
  std::uint32_t object_count = 0;
  std::uint32_t visible_count = 0;  // including taken ones
  std::uint32_t taken_count = 0;
  std::uint32_t in_range_count = 0;  // visible or taken, within the work range
  std::uint32_t last_number = 0;     // number of the last detected object; 0: none yet
  std::uint32_t lost_count = 0;      // objects that left the range without being taken, since the start
  std::uint32_t refused_count = 0;   // objects for which there was no room, since the start
  // The free object in the range that leaves it first. 0 and nan: none.
  std::uint32_t first_number = 0;
  std::uint32_t first_kind = 0;
  std::uint32_t first_colour = 0;
  double first_quality = 0;
  double first_place = 0;       // [mm] or [deg] along the belt, from its origin
  kinematics::Pose first_pose;  // in the world
  double first_time_left = 0;   // [s] until it leaves the range at this speed
};

void describe(Description<Outputs>&);

}  // namespace takt::conveyor
