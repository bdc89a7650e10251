// What a group asks before a path starts: is it free? The cycle puts the question into a queue; whoever knows the cell
// answers outside the cycle with the command PathChecked, in its own time. Until then the group goes on with what it
// has, waits where that ends, and can be stopped: an answer that comes too late is not looked at.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/params.h"
#include "takt/core/spsc_queue.h"
#include "takt/group/look_ahead.h"
#include "takt/group/request.h"

namespace takt::group {

// All that is needed to make the path again that the cycle has tried.
struct PathCheckRequest {
  std::uint32_t group = 0;   // number of it, from 1
  std::uint64_t number = 0;  // of the question, for the answer
  Request move;
  kinematics::Joints from{};  // where it begins
  bool follows = false;       // it may be joined with a blend ...
  Stretch before;             // ... to this
  std::array<bool, kMaxAxes> members{};
  std::array<kinematics::JointRange, kMaxAxes> ranges{};
  trajectory::CoordinateLimits limits;
  kinematics::Pose tool;  // on the flange
};

using PathCheckRequests = SpscQueue<PathCheckRequest>;

}  // namespace takt::group
