// Problems in a text written by a user, and their positions in it.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

// A position in a text, 1-based. Columns count characters, not bytes.
struct Place {
  int line = 1;
  int column = 1;
};

struct Problem {
  std::string source;  // file name, or "arguments"
  Place place;
  std::string path;     // axes[2].drive.mode; empty: the whole text
  std::string message;  // expected ..., found ...; did you mean ...?

  // Returns "machine.yaml:6:36: axes[0].direction: expected ...".
  std::string Text() const;
};

// Collects up to `cap` problems; later ones are dropped.
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

// The position of each key path in a text that was read, for checks after reading.
class SourceMap {
 public:
  explicit SourceMap(std::string_view file = {}) : file_(file) {}

  void Add(std::string path, Place place) { places_.insert_or_assign(std::move(path), place); }
  // Returns the position of the value at `path` ("axes[2].drive.mode"), or of the nearest enclosing one if it was not
  // written.
  Place PlaceOf(std::string_view path) const;
  // Returns a problem in the same form as the reader's own.
  Problem ProblemAt(std::string_view path, std::string_view message) const;
  const std::string& file() const noexcept { return file_; }

 private:
  std::string file_;
  std::map<std::string, Place, std::less<>> places_;
};

// Returns the candidate that a misspelt word most likely meant; empty if none is near.
std::string_view Nearest(std::string_view word, std::span<const std::string_view> candidates);

// Returns "; did you mean position?", or an empty text.
std::string DidYouMean(std::string_view word, std::span<const std::string_view> candidates);

// Returns the text in quotes, without line breaks, cut to a readable length.
std::string Quoted(std::string_view text);

// Looks for bytes that no text file should hold (control characters, broken UTF-8). Returns false, and adds a problem
// for the first one, if there are any.
bool CheckBytes(std::string_view text, ProblemList& problems);

// Returns line and column of byte `offset` of a text.
Place PlaceAt(std::string_view text, std::size_t offset);

}  // namespace takt
