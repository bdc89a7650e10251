// Request to check whether a path is free before it starts. The cycle puts it into a queue; the engine answers outside
// the cycle with the command PathChecked, in its own time. Until then the group continues with what is planned, waits
// where that ends, and can be stopped: an answer that comes too late is ignored.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/params.h"
#include "takt/core/spsc_queue.h"
#include "takt/group/look_ahead.h"
#include "takt/group/request.h"

namespace takt::group {

// Everything needed to make the path again that the cycle has verified.
struct PathCheckRequest {
  std::uint32_t group = 0;   // number, from 1
  std::uint64_t number = 0;  // of the request, for the answer
  Request move;
  kinematics::Joints from{};  // start of the path
  bool follows = false;       // it may be joined with a blend ...
  Stretch before;             // ... to this
  std::array<bool, kMaxAxes> members{};
  std::array<kinematics::JointRange, kMaxAxes> ranges{};
  trajectory::CoordinateLimits limits;
  kinematics::Pose tool;  // pose of the tool centre point on the flange
};

using PathCheckRequests = SpscQueue<PathCheckRequest>;

}  // namespace takt::group
