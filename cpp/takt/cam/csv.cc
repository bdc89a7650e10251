#include "takt/cam/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "takt/core/scalar.h"

namespace takt::cam {

namespace {

constexpr std::size_t kMaxProblemsOfFile = 20;
constexpr std::array<std::string_view, 4> kColumns{"x", "y", "v", "a"};
constexpr int kAbsent = -1;

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view file_name) : text_(text), problems_(file_name, kMaxProblemsOfFile) {}

  CsvPoints Run() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    if (CheckBytes(text_, problems_)) ReadLines();
    csv_.problems = std::move(problems_.problems());
    return std::move(csv_);
  }

 private:
  void ReadLines() {
    bool header = false;
    for (std::size_t at = 0; at < text_.size() && !problems_.full();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      const std::string_view line = text_.substr(at, end - at);
      at = end + 1;
      ++line_;
      const std::string_view content = Trimmed(line);
      if (content.empty() || content.front() == '#') continue;
      if (!std::exchange(header, true)) {
        if (!ReadHeader(line)) return;
      } else if (csv_.points.size() == kMaxPoints) {
        return Add(0, "expected 100,000 points at most, found one more");
      } else {
        ReadRow(line);
      }
    }
    if (!header) Add(0, "expected a line with the names of the columns: x, y, perhaps v and a; found an empty file");
  }

  void Add(std::size_t column, std::string message) {
    problems_.Add({line_, static_cast<int>(column) + 1}, {}, std::move(message));
  }

  // Calls `use(index, field, column in the line)`.
  template <typename Use>
  void Split(std::string_view line, Use use) const {
    std::size_t index = 0;
    for (std::size_t at = 0;; ++index) {
      const std::size_t end = std::min(line.find(separator_, at), line.size());
      use(index, Trimmed(line.substr(at, end - at)), at);
      if (end == line.size()) return;
      at = end + 1;
    }
  }

  bool ReadHeader(std::string_view line) {
    for (const char candidate : {',', ';', '\t'}) {
      separator_ = candidate;
      if (line.find(candidate) != std::string_view::npos) break;
    }
    const std::size_t before = problems_.size();
    Split(line, [&](std::size_t index, std::string_view name, std::size_t at) {
      const auto found = std::find(kColumns.begin(), kColumns.end(), name);
      if (found == kColumns.end()) {
        Add(at, "expected the columns x, y and perhaps v, a, found " + Quoted(name));
      } else if (int& of = of_[static_cast<std::size_t>(found - kColumns.begin())]; of != kAbsent) {
        Add(at, "expected each column once, found " + Quoted(name) + " again");
      } else {
        of = static_cast<int>(index);
      }
      ++columns_;
    });
    if (problems_.size() == before && (of_[0] == kAbsent || of_[1] == kAbsent)) {
      Add(0, "expected the columns x and y, found " + Quoted(Trimmed(line)));
    }
    return problems_.size() == before;
  }

  void ReadRow(std::string_view line) {
    const std::size_t fields = 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), separator_));
    if (fields != columns_) {
      return Add(0, "expected " + std::to_string(columns_) + " columns, found " + std::to_string(fields));
    }
    CamPoint point;
    bool good = true;
    Split(line, [&](std::size_t index, std::string_view field, std::size_t at) {
      const auto column = std::find(of_.begin(), of_.end(), static_cast<int>(index));
      if (column == of_.end()) return;
      const auto k = static_cast<std::size_t>(column - of_.begin());
      if (k >= 2 && field.empty()) return;
      double value = 0;
      if (ParseReal(field, value) != NumberError::kNone) {
        Add(at, "expected a finite number for " + std::string(kColumns[k]) + ", found " + Quoted(field));
        good = false;
      }
      if (k == 0) point.x = value;
      if (k == 1) point.y = value;
      if (k == 2) point.v = value;
      if (k == 3) point.a = value;
    });
    if (!good) return;
    csv_.points.push_back(point);
    csv_.lines.push_back(line_);
  }

  std::string_view text_;
  ProblemList problems_;
  CsvPoints csv_;
  int line_ = 0;
  char separator_ = ',';
  std::size_t columns_ = 0;
  std::array<int, 4> of_{kAbsent, kAbsent, kAbsent, kAbsent};  // which column of the file is x, y, v, a
};

}  // namespace

CsvPoints ReadCsv(std::string_view text, std::string_view file_name) {
  return Reader(text, file_name).Run();
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
