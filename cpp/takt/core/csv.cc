#include "takt/core/csv.h"

#include <algorithm>
#include <utility>

#include "takt/core/scalar.h"

namespace takt {

namespace {

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Returns "x, y, z" or "x, y and z".
std::string Joined(std::span<const std::string_view> names, std::string_view last = ", ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? last : ", ";
    text += names[i];
  }
  return text;
}

class Reader {
 public:
  Reader(const CsvFormat& format, ProblemList& problems, const std::function<void(std::span<const CsvCell>)>& take)
      : format_(format), problems_(problems), take_(take), names_(format.required) {
    names_.insert(names_.end(), format.optional.begin(), format.optional.end());
    cells_.resize(names_.size());
  }

  void Run(std::string_view text) {
    bool header = false;
    std::size_t rows = 0;
    for (std::size_t at = 0; at < text.size() && !problems_.full();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view line = text.substr(at, end - at);
      at = end + 1;
      ++line_;
      const std::string_view content = Trimmed(line);
      if (content.empty() || content.front() == '#') continue;
      if (!std::exchange(header, true)) {
        if (!ReadHeader(line)) return;
      } else if (rows++ == format_.most) {
        return Add(0, "expected " + std::string(format_.most_text) + " at most, found one more");
      } else {
        ReadRow(line);
      }
    }
    if (!header) Add(0, "expected a line with the names of " + Expected() + "; found an empty file");
  }

 private:
  void Add(std::size_t column, std::string message) { problems_.Add(PlaceAt(column), {}, std::move(message)); }

  Place PlaceAt(std::size_t column) const { return {line_, static_cast<int>(column) + 1}; }

  std::string Expected() const {
    const std::string perhaps = format_.optional.empty() ? "" : " and perhaps " + Joined(format_.optional);
    return "the columns " + Joined(format_.required) + perhaps;
  }

  std::string Hint() const { return format_.hint.empty() ? "" : "; " + std::string(format_.hint); }

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
    Split(line, [&](std::size_t, std::string_view name, std::size_t at) {
      const auto found = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
      if (found == names_.size()) {
        Add(at, "expected " + Expected() + ", found " + Quoted(name) + Hint());
      } else if (std::ranges::find(columns_, found) != columns_.end()) {
        Add(at, "expected each column once, found " + Quoted(name) + " again");
      }
      columns_.push_back(found);
    });
    const auto missing = [&](std::size_t k) { return std::ranges::find(columns_, k) == columns_.end(); };
    for (std::size_t k = 0; k < format_.required.size() && problems_.size() == before; ++k) {
      if (missing(k)) {
        Add(0,
            "expected the columns " + Joined(format_.required, " and ") + ", found " + Quoted(Trimmed(line)) + Hint());
      }
    }
    return problems_.size() == before;
  }

  void ReadRow(std::string_view line) {
    const std::size_t fields = 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), separator_));
    if (fields != columns_.size()) {
      return Add(0, "expected " + std::to_string(columns_.size()) + " columns, found " + std::to_string(fields));
    }
    std::ranges::fill(cells_, CsvCell{{}, PlaceAt(0)});
    Split(line, [&](std::size_t index, std::string_view field, std::size_t at) {
      cells_[columns_[index]] = {field, PlaceAt(at), separator_ != ','};
    });
    take_(cells_);
  }

  const CsvFormat& format_;
  ProblemList& problems_;
  const std::function<void(std::span<const CsvCell>)>& take_;
  std::vector<std::string_view> names_;
  std::vector<std::size_t> columns_;  // of the file: index of the name
  std::vector<CsvCell> cells_;
  int line_ = 0;
  char separator_ = ',';
};

}  // namespace

void ReadCsvTable(std::string_view text, const CsvFormat& format, ProblemList& problems,
                  const std::function<void(std::span<const CsvCell>)>& take) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (CheckBytes(text, problems)) Reader(format, problems, take).Run(text);
}

bool ReadCsvNumber(const CsvCell& cell, std::string_view column, ProblemList& problems, double& value) {
  if (ParseReal(cell.text, value) == NumberError::kNone) return true;
  // "1.234,5" is refused: which one is the decimal separator depends on the country.
  const std::size_t comma = cell.decimal_comma ? cell.text.find(',') : std::string_view::npos;
  if (comma != std::string_view::npos && cell.text.find('.') == std::string_view::npos) {
    std::string plain(cell.text);
    plain[comma] = '.';
    if (ParseReal(plain, value) == NumberError::kNone) return true;
  }
  problems.Add(cell.place, {}, "expected a finite number for " + std::string(column) + ", found " + Quoted(cell.text));
  return false;
}

}  // namespace takt
