// Cams as CSV (CAM-04). Not for use within the cycle.
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
  std::vector<int> lines;         // 1-based line of each point
  std::vector<Problem> problems;  // at most 20
};

// Reads a table (core/csv.h) with columns x and y, optionally v and a, and a line for each point. An empty v or a is
// free; numbers may have a decimal comma if the columns are separated by another character. For other files see
// takt.cam.Table.from_file (CAM-92).
CsvPoints ReadCsv(std::string_view text, std::string_view file_name);

// Returns the position in the file of a finding about "points[3].x".
Place PlaceInCsv(const CsvPoints& csv, std::string_view path);

// v and a have a column if any point gives them. Reads back as the identical points.
std::string WriteCsv(std::span<const CamPoint> points);

}  // namespace takt::cam
