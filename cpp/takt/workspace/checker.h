// Checks before a path starts whether it is free of obstacles and of the mechanism's own links, and within the bounds.
//
// A path is given as positions of the axes; between two samples all axes are assumed to move linearly and in
// proportion. (A path that is straight in space bends between two samples: by well under 0.01 mm if they are 1 mm
// apart.)
//
// Guaranteed for the whole path, not only for its samples:
//   - a finding is true: at that position the two are nearer than the margin, or the tool is out of its bounds;
//   - no approach nearer than margin - resolution, and no violation of the bounds by more than resolution, is missed,
//     however thin the object and however far apart the samples are;
//   - the reported position is the first one on the path, or after it by at most the motion that moves the link by
//     resolution.
// All within kDistanceError (scene.h). To this end each step along the path is limited so that the links cannot move
// further than the last distance allows, but by at least resolution.
//
// The result depends on the arguments alone. Allocates, is slow, and is not thread-safe.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "takt/kinematics/joints.h"
#include "takt/kinematics/kinematics.h"
#include "takt/kinematics/links.h"
#include "takt/workspace/cell.h"
#include "takt/workspace/params.h"
#include "takt/workspace/trouble.h"

namespace takt::workspace {

struct Sample {
  double s = 0;                 // [mm] along the path; only reported
  kinematics::Joints joints{};  // in the axes' own units
};

struct Finding {
  Trouble trouble = Trouble::kCollision;
  std::string first;                                      // the moving object: a link, a part of the gripper; tool
  std::string second;                                     // the object it meets; the bound ("upper x"); empty
  double s = 0;                                           // [mm] along the path
  std::size_t index = 0;                                  // the last sample at or before this position
  double distance = 0;                                    // [mm] between the two, 0 if they touch; or beyond the bound
  kinematics::Joints joints{};                            // at this position
  kinematics::Reason reason = kinematics::Reason::kNone;  // kNoPose: why
};

class Checker {
 public:
  explicit Checker(Cell cell) : cell_(std::move(cell)) {}

  // Returns the first finding; nothing if the path is free. Positions that are not finite are kNoPose.
  std::optional<Finding> Check(std::span<const Sample> path);

  // Sets the point that must stay within the bounds, in the flange's frame.
  void SetToolCentre(const KDL::Vector& centre) noexcept { cell_.tool_centre = centre; }

  // Returns one sentence without a full stop: "finger meets post 12.3 mm along the path (5 mm are to be kept)". `unit`:
  // unit of s.
  std::string Describe(const Finding& finding, std::string_view unit = "mm") const;

  // Returns the parts of the mechanism that are not checked against one another because they are nearer than the margin
  // with all axes at 0.
  std::vector<std::pair<std::string, std::string>> NearAtRest() const;

 private:
  Cell cell_;
  std::vector<kinematics::Sweep> sweeps_;  // of the last path; kept for its memory
};

struct MakeResult {
  std::optional<Checker> checker;
  // if there is no checker: key of the wrong parameter, "obstacles[2].mesh.file"; empty: all of them
  std::string path;
  std::string problem;  // and the reason
};

// `folder`: base of relative file paths. `tool_centre`: the point that must stay within the bounds, in the flange's
// frame. Reads files.
MakeResult Make(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder = ".",
                const KDL::Vector& tool_centre = {});

}  // namespace takt::workspace
