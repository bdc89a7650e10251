// Shapes of links from URDF, for workspaces that do not define links themselves.
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
  std::string problem;  // empty if there is none
};

// Returns the file of a mesh that a URDF names: relative to `urdf_folder`; package://NAME/ in that folder or one above
// it, up to the root of the file system, that has the name NAME and contains the file, else in `urdf_folder`; file://
// as it is. `machine_folder`: base of a relative `urdf_folder`, and of the returned path.
std::string FileOfMesh(const std::string& mesh, const std::string& machine_folder, const std::string& urdf_folder);

// `serial`: with the text of the URDF; `kinematics`: made from it. `folder`: of the machine file. `urdf_folder`: of the
// URDF's file, relative to `folder`; meshes are found as by FileOfMesh.
UrdfLinks LinksOfUrdf(const kinematics::SerialParams& serial, const kinematics::Kinematics& kinematics,
                      const std::string& folder, const std::string& urdf_folder,
                      kinematics::UrdfPurpose purpose = kinematics::UrdfPurpose::kCollision);

}  // namespace takt::workspace
