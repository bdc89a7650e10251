#include "takt/workspace/trouble.h"

#include "takt/core/describe.h"
#include "takt/workspace/cell.h"

namespace takt::workspace {

std::vector<std::string> PartNames(const WorkspaceParams& params, const kinematics::Kinematics& kinematics) {
  std::vector<std::string> names = {"tool", "lower x", "lower y", "lower z", "upper x", "upper y", "upper z"};
  for (const Part& part : PartsOf(params, kinematics)) names.push_back(part.name);
  for (const SolidParams& obstacle : params.obstacles) names.push_back(obstacle.name);
  return names;
}

void describe(Enumeration<Trouble>& e) {
  e.about("Problem of a path.");
  e.value(Trouble::kNone, "none", "No problem.");
  e.value(Trouble::kCollision, "collision", "Two bodies come nearer to one another than the margin.");
  e.value(Trouble::kBounds, "bounds", "The tool leaves its bounds.");
  e.value(Trouble::kNoPose, "no_pose", "The links have no position.");
}

}  // namespace takt::workspace
