#include <charconv>
#include <utility>

#include "takt/core/csv.h"
#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/group/path_table.h"

namespace takt::group {

namespace {

constexpr std::size_t kMaxProblemsOfFile = 20;
constexpr std::size_t kMaxLines = 20'000;

enum Column : std::size_t { kX, kY, kZ, kShape, kA, kB, kC, kViaX, kViaY, kViaZ, kVelocity };

class Reader {
 public:
  explicit Reader(std::string_view file_name)
      : format_{{"x", "y", "z"},
                {"shape", "a", "b", "c", "via_x", "via_y", "via_z", "velocity"},
                kMaxLines,
                "20,000 lines"},
        problems_(file_name, kMaxProblemsOfFile) {}

  PathCsv Run(std::string_view text) {
    ReadCsvTable(text, format_, problems_, [this](std::span<const CsvCell> cells) { Take(cells); });
    csv_.problems = std::move(problems_.problems());
    return std::move(csv_);
  }

 private:
  std::string_view NameOf(std::size_t column) const {
    const std::size_t required = format_.required.size();
    return column < required ? format_.required[column] : format_.optional[column - required];
  }

  bool Number(std::span<const CsvCell> cells, std::size_t column, double& value) {
    return ReadCsvNumber(cells[column], NameOf(column), problems_, value);
  }
  bool Number(std::span<const CsvCell> cells, std::size_t column, std::optional<double>& value) {
    return cells[column].text.empty() || Number(cells, column, value.emplace());
  }

  void Take(std::span<const CsvCell> cells) {
    PathElement element;
    PathPose pose;
    bool good = Shape(cells[kShape], element.shape);
    for (const auto& [column, value] : {std::pair{kX, &pose.x}, {kY, &pose.y}, {kZ, &pose.z}}) {
      good &= Number(cells, column, *value);
    }
    for (const auto& [column, value] : {std::pair{kA, &pose.a},
                                        {kB, &pose.b},
                                        {kC, &pose.c},
                                        {kViaX, &element.via_x},
                                        {kViaY, &element.via_y},
                                        {kViaZ, &element.via_z},
                                        {kVelocity, &element.velocity}}) {
      good &= Number(cells, column, *value);
    }
    if (good && Fits(TypeOf<PathPose>(), &pose, cells[kX].place)) Append(std::move(element), pose, cells);
  }

  bool Shape(const CsvCell& cell, ElementShape& shape) {
    if (cell.text.empty()) return true;
    const Enumerator* found = TypeOf<ElementShape>().FindEnumerator(cell.text);
    if (found == nullptr) {
      problems_.Add(cell.place, {}, "expected line, arc or spline, found " + Quoted(cell.text));
      return false;
    }
    shape = static_cast<ElementShape>(found->value);
    return true;
  }

  bool Fits(const Type& type, const void* object, Place place) {
    if (const Field* wrong = FirstOutOfRange(type, object)) {
      problems_.Add(place, {}, std::string(wrong->name) + ": expected a number " + Text(wrong->range));
      return false;
    }
    for (const Rule& rule : type.rules) {
      if (rule.holds(object)) continue;
      problems_.Add(place, {}, std::string(type.fields[rule.field].name) + ": " + std::string(rule.text));
      return false;
    }
    return true;
  }

  void Append(PathElement element, const PathPose& pose, std::span<const CsvCell> cells) {
    const int line = cells[kX].place.line;
    const bool spline = element.shape == ElementShape::kSpline;
    if (spline) {
      element.points.push_back(pose);
    } else {
      element.to = pose;
    }
    if (!Fits(TypeOf<PathElement>(), &element, cells[kX].place)) return;
    if (spline && !csv_.elements.empty() && csv_.elements.back().shape == ElementShape::kSpline) {
      if (element.velocity) {
        problems_.Add(cells[kVelocity].place, {}, "expected none: the first line of a spline gives its velocity");
      }
      csv_.elements.back().points.push_back(pose);
      csv_.lines.back().push_back(line);
      return;
    }
    csv_.elements.push_back(std::move(element));
    csv_.lines.push_back({line});
  }

  const CsvFormat format_;
  ProblemList problems_;
  PathCsv csv_;
};

// Removes `key` and the number after it from the front of `path`. Returns the number; nothing if they are not there.
std::optional<std::size_t> TakeIndex(std::string_view& path, std::string_view key) {
  if (!path.starts_with(key)) return std::nullopt;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(path.data() + key.size(), path.data() + path.size(), index);
  if (error != std::errc{}) return std::nullopt;
  path.remove_prefix(static_cast<std::size_t>(end - path.data()));
  return index;
}

}  // namespace

PathCsv ReadPathCsv(std::string_view text, std::string_view file_name) {
  return Reader(file_name).Run(text);
}

Place PlaceInCsv(const PathCsv& csv, std::string_view path) {
  const std::optional<std::size_t> element = TakeIndex(path, "elements[");
  if (!element || *element >= csv.lines.size()) return {};
  const std::size_t point = TakeIndex(path, "].points[").value_or(0);
  const std::vector<int>& lines = csv.lines[*element];
  return {lines[point < lines.size() ? point : 0], 1};
}

}  // namespace takt::group
