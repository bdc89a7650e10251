// Checks that the links of a URDF form a tree, before urdfdom reads it: links in a loop keep one another alive, so that
// a model that urdfdom gives up would never be freed.
#pragma once

#include <string>

namespace takt::kinematics {

// Returns a link that is its own ancestor or a descendant of one; empty if there is none, or this is no URDF.
std::string LinkInLoop(const std::string& xml);

}  // namespace takt::kinematics
