// Whether a path is free, before it starts: of obstacles, of the mechanism's own links, within the bounds.
//
// A path is given as positions of the axes; between two of them all axes are taken to go straight, each at a constant
// share of its way. (A path that is straight in space bends between two samples: by well under 0.01 mm where they are
// 1 mm apart.)
//
// What is guaranteed, for all of the path and not only where it was sampled:
//   - what is reported is so: there the two are nearer than the margin, or the tool is out of its bounds;
//   - nothing that comes nearer than margin - resolution, and no way out of the bounds further than resolution, goes
//     unseen, however thin it is and however far apart the samples are;
//   - the place reported is the first one on the path, or after it by no more than what moves the link by resolution.
// All of it to within kDistanceError (scene.h). It is kept by going on, from each place looked at, no further than the
// links can move before the distance seen there is used up, but by resolution at least.
//
// The answer depends on the arguments alone. Allocates, takes its time, and is not for two threads at once.
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
  double s = 0;                 // mm along the path; only reported
  kinematics::Joints joints{};  // in the axes' own units
};

struct Finding {
  Trouble trouble = Trouble::kCollision;
  std::string first;            // what moves: a link, a part of the gripper; tool
  std::string second;           // what it meets; which bound ("upper x"); empty
  double s = 0;                 // mm along the path
  std::size_t index = 0;        // the last sample at or before the place
  double distance = 0;          // mm between the two, 0 if they touch; how far out of the bounds
  kinematics::Joints joints{};  // there
  kinematics::Reason reason = kinematics::Reason::kNone;  // no position: why
};

class Checker {
 public:
  explicit Checker(Cell cell) : cell_(std::move(cell)) {}

  // The first place where something is wrong; nothing: the path is free. Positions that are no numbers are kNoPose.
  std::optional<Finding> Check(std::span<const Sample> path);

  // Another tool: what stays within the bounds, seen from the flange.
  void SetToolCentre(const KDL::Vector& centre) noexcept { cell_.tool_centre = centre; }

  // One sentence without a full stop: "finger meets post 12.3 mm along the path (5 mm are to be kept)". `unit`: what
  // s counts.
  std::string Describe(const Finding& finding, std::string_view unit = "mm") const;

  // Parts of the mechanism that are not checked against one another because they are nearer than the margin with all of
  // its axes at 0.
  std::vector<std::pair<std::string, std::string>> NearAtRest() const;

 private:
  Cell cell_;
  std::vector<kinematics::Sweep> sweeps_;  // of the path checked last; kept for its memory
};

struct MakeResult {
  std::optional<Checker> checker;
  std::string path;     // without: which key of the parameters is wrong, "obstacles[2].mesh.file"; empty: all of them
  std::string problem;  // and why
};

// `folder`: where paths of files begin. `tool_centre`: what stays within the bounds, seen from the flange. Reads files.
MakeResult Make(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder = ".",
                const KDL::Vector& tool_centre = {});

}  // namespace takt::workspace
