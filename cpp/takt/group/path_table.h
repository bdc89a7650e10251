// A path of the machine file, made when the file is loaded.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/problem.h"
#include "takt/group/params.h"
#include "takt/path/segment.h"

namespace takt::group {

// One element, or the piece between two points of a spline. Poses are in the coordinate system that the command names.
// The start of the path is the present pose of the group: lines and arcs are made when the move is planned.
struct PathPiece {
  ElementShape shape = ElementShape::kLine;
  kinematics::Pose to{};  // end of the piece
  // Its orientation is given. If not, the orientation at the start of the path is kept: a, b, c of `to` and the
  // orientation of the segment are unused.
  bool turned = false;
  path::Triple via{};       // arc
  path::Segment segment{};  // spline: complete
  double velocity = 0;      // [mm/s] limit; 0: that of the command
};

struct PathTable {
  std::string name;
  std::vector<PathPiece> pieces;
};

struct PathTableResult {
  std::optional<PathTable> table;
  std::string path;     // if there is no table: key of the wrong parameter, such as "elements[3].via_x"
  std::string problem;  // and the reason
};

// Makes a path from elements; those of a file must have been read. Allocates.
PathTableResult MakePathTable(const PathParams& params);

struct PathCsv {
  std::vector<PathElement> elements;
  std::vector<std::vector<int>> lines;  // 1-based line of each element; of splines: of each point
  std::vector<Problem> problems;        // at most 20
};

// Reads a table (core/csv.h) with columns x, y, z and optionally shape (default: line), a, b, c, via_x, via_y, via_z,
// velocity. Consecutive lines of shape spline are the points of one spline, whose velocity is in its first line.
PathCsv ReadPathCsv(std::string_view text, std::string_view file_name);

// Returns the position in the file of a finding about a key such as "elements[3].points[1].a".
Place PlaceInCsv(const PathCsv& csv, std::string_view path);

}  // namespace takt::group
