// The possible problems of a path, and the names of the objects involved.
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
  kCollision,  // two objects are nearer than the margin
  kBounds,     // the tool leaves its bounds
  kNoPose,     // the links have no position there
};

// Returns the names in a Finding, numbered from 0: tool, the six bounds, all parts of the links and of the gripper,
// obstacles. Requires: valid parameters; reads no files.
std::vector<std::string> PartNames(const WorkspaceParams& params, const kinematics::Kinematics& kinematics);

void describe(Enumeration<Trouble>&);

}  // namespace takt::workspace
