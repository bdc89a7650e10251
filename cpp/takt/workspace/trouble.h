// What can be wrong with a path, and the names of what can be in the way.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/kinematics.h"
#include "takt/workspace/params.h"

namespace takt::workspace {

enum class Trouble : std::uint8_t {
  kNone,       // the path is free
  kCollision,  // two things are nearer than the margin
  kBounds,     // the tool leaves its bounds
  kNoPose,     // no position of the links there
};

// The names in a Finding, numbered from 0: tool, the six bounds, all parts of the links and of the gripper, obstacles.
// The parameters must be good; needs no files.
std::vector<std::string> PartNames(const WorkspaceParams& params, const kinematics::Kinematics& kinematics);

void describe(Enumeration<Trouble>&);

}  // namespace takt::workspace
