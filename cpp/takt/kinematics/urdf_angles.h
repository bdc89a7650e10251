// Orientations in a URDF. urdfdom converts roll, pitch and yaw to quaternions with the C library's sine, whose last
// bits depend on the processor; these are computed from the same attributes with the same bits on every processor.
#pragma once

#include <kdl/frames.hpp>
#include <map>
#include <string>
#include <vector>

namespace takt::kinematics {

struct UrdfAngles {
  std::map<std::string, KDL::Rotation> joints;                   // from the parent link, by joint
  std::map<std::string, std::vector<KDL::Rotation>> collisions;  // on the link, by link, in the file's order
  std::map<std::string, std::vector<KDL::Rotation>> visuals;     // likewise
};

// Requires: urdfdom has read the text. Without rpy the orientation is the parent's.
UrdfAngles ReadUrdfAngles(const std::string& xml);

}  // namespace takt::kinematics
