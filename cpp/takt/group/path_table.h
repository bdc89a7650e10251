// A path of the machine file, made when it is loaded.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/group/params.h"
#include "takt/path/segment.h"

namespace takt::group {

// One element. Places are those of the coordinate system that the command names. Where the first one begins says the
// group: lines and arcs of it are made when they are gone.
struct PathPiece {
  ElementShape shape = ElementShape::kLine;
  kinematics::Pose to;    // where it ends
  path::Triple via{};     // arc
  path::Segment segment;  // spline: ready made
  double velocity = 0;    // mm/s; 0: that of the command
};

struct PathTable {
  std::string name;
  std::vector<PathPiece> pieces;
};

struct PathTableResult {
  std::optional<PathTable> table;
  std::string path;     // without: which key of the parameters is wrong, "elements[3].via_x"
  std::string problem;  // and why
};

// Reads files and allocates. `folder`: where paths of files begin.
PathTableResult MakePathTable(const PathParams& params, std::string_view folder = ".");

void describe(Description<PathPiece>&);

}  // namespace takt::group
