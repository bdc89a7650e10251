#include "takt/workspace/urdf_links.h"

#include <filesystem>
#include <map>
#include <system_error>

#include "takt/core/problem.h"
#include "takt/kinematics/links.h"

namespace takt::workspace {
namespace {

using kinematics::UrdfShape;

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";

// Returns why we cannot use a mesh; empty if we can.
std::string Diagnose(const UrdfShape& shape) {
  std::string extension = std::filesystem::path(shape.mesh).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::string of = "link " + Quoted(shape.link) + " of the URDF has the mesh " + Quoted(shape.mesh);
  if (extension != ".stl") return of + ", expected an STL file: give the shapes of its links here";
  const bool even = shape.size[0] == shape.size[1] && shape.size[1] == shape.size[2];
  return even ? "" : of + " with one scale along each axis, expected one for all: give the shapes of its links here";
}

}  // namespace

std::string FileOfMesh(const std::string& mesh, const std::string& machine_folder, const std::string& urdf_folder) {
  namespace fs = std::filesystem;
  if (mesh.starts_with(kFile)) return mesh.substr(kFile.size());
  if (!mesh.starts_with(kPackage)) return (fs::path(urdf_folder) / mesh).string();
  const fs::path inside = mesh.substr(kPackage.size());
  if (inside.empty()) return urdf_folder;
  // A file found by the relative path keeps a relative path, so that the machine can be moved.
  const fs::path folder = urdf_folder;
  std::error_code unknown;  // no working directory: only the relative path is searched
  const fs::path base = fs::current_path(unknown) / machine_folder;
  for (const fs::path& begin : {folder, (base / folder).lexically_normal()}) {
    for (fs::path above = begin; !above.empty(); above = above.parent_path()) {
      const fs::path file = above.parent_path() / inside;
      if (above.filename() == *inside.begin() && fs::exists(base / file, unknown)) return file.string();
      if (above == above.parent_path()) break;
    }
  }
  return (folder / inside.lexically_relative(*inside.begin())).string();
}

UrdfLinks LinksOfUrdf(const kinematics::SerialParams& serial, const kinematics::Kinematics& kinematics,
                      const std::string& folder, const std::string& urdf_folder, kinematics::UrdfPurpose purpose) {
  UrdfLinks out;
  const std::vector<kinematics::LinkInfo> links = kinematics::LinksOf(kinematics);
  std::map<std::string, int> named;
  for (const UrdfShape& shape : kinematics::ReadUrdfShapes(serial.urdf, serial.base, serial.tip, purpose)) {
    SolidParams& solid = out.links.emplace_back();
    solid.link = links[shape.axis].name;
    solid.pose = kinematics::ToPose(shape.pose);
    if (const int count = ++named[shape.link]; shape.link != solid.link || count > 1) {
      solid.name = shape.link + (count > 1 ? "#" + std::to_string(count) : "");
    }
    switch (shape.kind) {
      case UrdfShape::Kind::kBox:
        solid.box = {shape.size[0], shape.size[1], shape.size[2]};
        break;
      case UrdfShape::Kind::kCylinder:
        solid.cylinder = {shape.size[0], shape.size[1]};
        break;
      case UrdfShape::Kind::kSphere:
        solid.sphere = {shape.size[0]};
        break;
      case UrdfShape::Kind::kMesh:
        solid.mesh = {FileOfMesh(shape.mesh, folder, urdf_folder), shape.size[0]};
        if (out.problem.empty()) out.problem = Diagnose(shape);
        break;
    }
  }
  return out;
}

}  // namespace takt::workspace
