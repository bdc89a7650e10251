// Whether the links of a URDF form a tree, before urdfdom reads it: of links in a loop, each of which keeps the next
// one, a model that it gives up would never be freed.
#pragma once

#include <string>

namespace takt::kinematics {

// A link that hangs, through others or not, on itself; empty: there is none, or this is no URDF.
std::string LinkInLoop(const std::string& xml);

}  // namespace takt::kinematics
