#include "takt/cam/csv.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "takt/core/csv.h"
#include "takt/core/scalar.h"

namespace takt::cam {

namespace {

constexpr std::size_t kMaxProblemsOfFile = 20;

}  // namespace

CsvPoints ReadCsv(std::string_view text, std::string_view file_name) {
  const CsvFormat format{{"x", "y"},
                         {"v", "a"},
                         kMaxPoints,
                         "100,000 points",
                         "takt cam FILE --csv cam.csv converts files of other systems"};
  CsvPoints csv;
  ProblemList problems(file_name, kMaxProblemsOfFile);
  ReadCsvTable(text, format, problems, [&](std::span<const CsvCell> cells) {
    CamPoint point;
    bool good = ReadCsvNumber(cells[0], "x", problems, point.x);
    good &= ReadCsvNumber(cells[1], "y", problems, point.y);
    if (!cells[2].text.empty()) good &= ReadCsvNumber(cells[2], "v", problems, point.v.emplace());
    if (!cells[3].text.empty()) good &= ReadCsvNumber(cells[3], "a", problems, point.a.emplace());
    if (!good) return;
    csv.points.push_back(point);
    csv.lines.push_back(cells[0].place.line);
  });
  csv.problems = std::move(problems.problems());
  return csv;
}

Place PlaceInCsv(const CsvPoints& csv, std::string_view path) {
  constexpr std::string_view kPoints = "points[";
  std::size_t index = 0;
  if (!path.starts_with(kPoints)) return {};
  path.remove_prefix(kPoints.size());
  std::from_chars(path.data(), path.data() + path.size(), index);
  return index < csv.lines.size() ? Place{csv.lines[index], 1} : Place{};
}

std::string WriteCsv(std::span<const CamPoint> points) {
  const bool v = std::any_of(points.begin(), points.end(), [](const CamPoint& p) { return p.v.has_value(); });
  const bool a = std::any_of(points.begin(), points.end(), [](const CamPoint& p) { return p.a.has_value(); });
  std::string text = std::string("x,y") + (v ? ",v" : "") + (a ? ",a" : "") + "\n";
  for (const CamPoint& p : points) {
    text += FormatReal(p.x) + "," + FormatReal(p.y);
    if (v) text += "," + (p.v ? FormatReal(*p.v) : "");
    if (a) text += "," + (p.a ? FormatReal(*p.a) : "");
    text += "\n";
  }
  return text;
}

}  // namespace takt::cam
