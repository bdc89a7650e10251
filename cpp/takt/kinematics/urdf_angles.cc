#include "takt/kinematics/urdf_angles.h"

#include <tinyxml.h>

#include <locale>
#include <sstream>

#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

KDL::Rotation OriginIn(const TiXmlElement& element) {
  const TiXmlElement* origin = element.FirstChildElement("origin");
  const char* angles = origin != nullptr ? origin->Attribute("rpy") : nullptr;
  if (angles == nullptr) return KDL::Rotation::Identity();
  std::istringstream text(angles);
  text.imbue(std::locale::classic());
  double roll = 0, pitch = 0, yaw = 0;
  text >> roll >> pitch >> yaw;
  return RollPitchYaw(roll, pitch, yaw);
}

std::string NameOf(const TiXmlElement& element) {
  const char* name = element.Attribute("name");
  return name != nullptr ? name : "";
}

template <typename Visit>
void ForEach(const TiXmlElement& parent, const char* kind, Visit&& visit) {
  for (const TiXmlElement* e = parent.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) visit(*e);
}

}  // namespace

UrdfAngles ReadUrdfAngles(const std::string& xml) {
  UrdfAngles out;
  TiXmlDocument document;
  document.Parse(xml.c_str());
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) return out;
  ForEach(*robot, "joint", [&](const TiXmlElement& joint) { out.joints[NameOf(joint)] = OriginIn(joint); });
  ForEach(*robot, "link", [&](const TiXmlElement& link) {
    std::vector<KDL::Rotation>& collisions = out.collisions[NameOf(link)];
    ForEach(link, "collision", [&](const TiXmlElement& shape) { collisions.push_back(OriginIn(shape)); });
    std::vector<KDL::Rotation>& visuals = out.visuals[NameOf(link)];
    ForEach(link, "visual", [&](const TiXmlElement& shape) { visuals.push_back(OriginIn(shape)); });
  });
  return out;
}

}  // namespace takt::kinematics
