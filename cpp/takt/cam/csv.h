// Cams as CSV (CAM-04). Not for the cycle.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/cam/params.h"
#include "takt/core/problem.h"

namespace takt::cam {

struct CsvPoints {
  std::vector<CamPoint> points;
  std::vector<int> lines;         // 1-based, of each point
  std::vector<Problem> problems;  // 20 at most
};

// A table (core/csv.h) with columns x and y, perhaps v and a, and a line for each point. An empty v or a is free;
// numbers may have a decimal
// comma where none stands between the columns. Other files are for takt.cam.Table.from_file (CAM-92).
CsvPoints ReadCsv(std::string_view text, std::string_view file_name);

// Where a finding about "points[3].x" stands in the file.
Place PlaceInCsv(const CsvPoints& csv, std::string_view path);

// v and a have a column where any point gives them. Reads back as the very same points.
std::string WriteCsv(std::span<const CamPoint> points);

}  // namespace takt::cam
