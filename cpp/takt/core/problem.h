// What is wrong in a text somebody wrote, and where.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

// 1-based. Columns count characters, not bytes.
struct Place {
  int line = 1;
  int column = 1;
};

struct Problem {
  std::string source;  // file name, or "arguments"
  Place place;
  std::string path;     // axes[2].drive.mode; empty: the text as a whole
  std::string message;  // expected ..., found ...; did you mean ...?

  // "machine.yaml:6:36: axes[0].direction: expected ..."
  std::string Text() const;
};

// Collects problems up to a number; what comes later is dropped.
class ProblemList {
 public:
  // `source` must outlive the list.
  ProblemList(std::string_view source, std::size_t cap) : source_(source), cap_(cap) {}

  void Add(Place place, std::string path, std::string message);
  bool full() const noexcept { return problems_.size() >= cap_; }
  std::size_t size() const noexcept { return problems_.size(); }
  std::vector<Problem>& problems() noexcept { return problems_; }

 private:
  std::string_view source_;
  std::size_t cap_;
  std::vector<Problem> problems_;
};

// Where each key path of a text that was read stands, for checks that come after reading.
class SourceMap {
 public:
  explicit SourceMap(std::string_view file = {}) : file_(file) {}

  void Add(std::string path, Place place) { places_.insert_or_assign(std::move(path), place); }
  // Place of the value at `path` ("axes[2].drive.mode"); of the nearest enclosing one where that was not written.
  Place PlaceOf(std::string_view path) const;
  // A problem in the same form as the reader's own.
  Problem ProblemAt(std::string_view path, std::string_view message) const;
  const std::string& file() const noexcept { return file_; }

 private:
  std::string file_;
  std::map<std::string, Place, std::less<>> places_;
};

// The candidate a misspelt word most likely meant; empty when none is near.
std::string_view Nearest(std::string_view word, std::span<const std::string_view> candidates);

// "; did you mean position?", or empty.
std::string DidYouMean(std::string_view word, std::span<const std::string_view> candidates);

// The words of a text in quotes, cut to a readable length, without line breaks.
std::string Quoted(std::string_view text);

// The first byte that no text file should hold (control characters, broken UTF-8). False, and problems gets it, if
// there is one.
bool CheckBytes(std::string_view text, ProblemList& problems);

// Line and column of byte `offset` of a text.
Place PlaceAt(std::string_view text, std::size_t offset);

}  // namespace takt
