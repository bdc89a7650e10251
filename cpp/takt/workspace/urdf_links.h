// Shapes of links as URDF gives them, for workspaces that say nothing about links themselves.
#pragma once

#include <string>
#include <vector>

#include "takt/kinematics/kinematics.h"
#include "takt/kinematics/params.h"
#include "takt/kinematics/serial.h"
#include "takt/workspace/params.h"

namespace takt::workspace {

struct UrdfLinks {
  std::vector<SolidParams> links;
  std::string problem;  // empty: none
};

// `serial`: with the text of the URDF; `kinematics`: made from it. `folder`: of the machine file. `urdf_folder`: of the
// URDF's file, seen from `folder`; meshes count from there, and package://NAME/ as well, if that folder or one above,
// up to the root of the file system, is called NAME and has the file.
UrdfLinks LinksOfUrdf(const kinematics::SerialParams& serial, const kinematics::Kinematics& kinematics,
                      const std::string& folder, const std::string& urdf_folder,
                      kinematics::UrdfPurpose purpose = kinematics::UrdfPurpose::kCollision);

}  // namespace takt::workspace
