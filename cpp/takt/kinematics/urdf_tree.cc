#include "takt/kinematics/urdf_tree.h"

#include <tinyxml.h>

#include <map>
#include <vector>

namespace takt::kinematics {
namespace {

// Returns the link that a joint names as its parent or child; empty if there is none.
std::string LinkOf(const TiXmlElement& joint, const char* which) {
  const TiXmlElement* element = joint.FirstChildElement(which);
  const char* name = element != nullptr ? element->Attribute("link") : nullptr;
  return name != nullptr ? name : "";
}

}  // namespace

// Links without a parent are removed with the joints below them, as long as there are any (Kahn 1962). Links that
// remain are in a loop, or below one.
std::string LinkInLoop(const std::string& xml) {
  TiXmlDocument document;
  document.Parse(xml.c_str());
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) return {};
  std::map<std::string, std::vector<std::string>> children;
  std::map<std::string, std::size_t> hangs_on;  // number of joints
  for (const TiXmlElement* e = robot->FirstChildElement("joint"); e != nullptr; e = e->NextSiblingElement("joint")) {
    const std::string parent = LinkOf(*e, "parent"), child = LinkOf(*e, "child");
    if (parent.empty() || child.empty()) continue;  // urdfdom refuses it
    children[parent].push_back(child);
    hangs_on.try_emplace(parent, 0);
    ++hangs_on[child];
  }
  std::vector<std::string> free;
  for (const auto& [link, joints] : hangs_on) {
    if (joints == 0) free.push_back(link);
  }
  while (!free.empty()) {
    const std::string link = free.back();
    free.pop_back();
    for (const std::string& child : children[link]) {
      if (--hangs_on[child] == 0) free.push_back(child);
    }
    hangs_on.erase(link);
  }
  return hangs_on.empty() ? std::string() : hangs_on.begin()->first;
}

}  // namespace takt::kinematics
