// Reads a described struct from YAML text, strictly, and reports every problem with its position. Not for use within
// the cycle.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/describe.h"
#include "takt/core/problem.h"

namespace takt {

inline constexpr std::size_t kMaxYamlBytes = 8'000'000;
inline constexpr std::size_t kMaxProblems = 200;

template <typename T>
struct ReadResult {
  std::optional<T> value;         // set only if there are no problems
  std::vector<Problem> problems;  // in the order of the text; at most kMaxProblems and a final one that says so
  SourceMap source;

  bool ok() const { return value.has_value(); }
};

// Reads `text` into `object`, which holds the defaults. The object must only be used if no problem is returned.
std::vector<Problem> ReadYaml(const Type& type, void* object, std::string_view text, std::string_view file_name,
                              SourceMap& source);

// Reads one document with one root mapping. Refused: unknown and repeated keys, values of another type or out of range,
// missing required keys, anchors, aliases, tags, merge keys, a second document, control characters, broken UTF-8, more
// than kMaxYamlBytes.
template <typename T>
ReadResult<T> ReadYaml(std::string_view text, std::string_view file_name) {
  ReadResult<T> result{.value = T{}, .problems = {}, .source = SourceMap(file_name)};
  result.problems = ReadYaml(TypeOf<T>(), &*result.value, text, file_name, result.source);
  if (!result.problems.empty()) result.value.reset();
  return result;
}

// Returns the text of a file, at most one byte more than kMaxYamlBytes; nothing, and a sentence in `why`, if it cannot
// be read.
std::optional<std::string> LoadText(const std::string& path, std::string& why);

template <typename T>
ReadResult<T> ReadYamlFile(const std::string& path) {
  std::string why;
  const std::optional<std::string> text = LoadText(path, why);
  if (text) return ReadYaml<T>(*text, path);
  return {.value = std::nullopt, .problems = {{path, {}, {}, why}}, .source = SourceMap(path)};
}

}  // namespace takt
