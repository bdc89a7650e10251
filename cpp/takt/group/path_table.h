// A path of the machine file, made when it is loaded.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/problem.h"
#include "takt/group/params.h"
#include "takt/path/segment.h"

namespace takt::group {

// One element, or what is between two points of a spline. Places are those of the coordinate system that the command
// names. Where the first one begins says the group: lines and arcs of it are made when they are gone.
struct PathPiece {
  ElementShape shape = ElementShape::kLine;
  kinematics::Pose to{};  // where it ends
  // Its orientation is given. If not, it stays as it is where the path begins: then a, b, c of `to` and the orientation
  // of the segment mean nothing.
  bool turned = false;
  path::Triple via{};       // arc
  path::Segment segment{};  // spline: ready made
  double velocity = 0;      // mm/s; 0: that of the command
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

// Of elements: those of a file must have been read. Allocates.
PathTableResult MakePathTable(const PathParams& params);

struct PathCsv {
  std::vector<PathElement> elements;
  std::vector<std::vector<int>> lines;  // 1-based, of each element; of splines: of each point
  std::vector<Problem> problems;        // 20 at most
};

// A table (core/csv.h) with columns x, y, z and perhaps shape (line unless it says something else), a, b, c, via_x,
// via_y, via_z, velocity. Lines of shape spline that follow one another are the points of one spline, whose velocity
// stands in the first of them.
PathCsv ReadPathCsv(std::string_view text, std::string_view file_name);

// Where a finding about "elements[3].points[1].a" stands in the file.
Place PlaceInCsv(const PathCsv& csv, std::string_view path);

}  // namespace takt::group
