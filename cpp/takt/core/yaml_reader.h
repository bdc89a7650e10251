// Reads a described struct from YAML text, strictly, with every problem and its place. Not for the cycle.
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
  std::optional<T> value;         // only without problems
  std::vector<Problem> problems;  // in the order of the text; at most kMaxProblems and one that says so
  SourceMap source;

  bool ok() const { return value.has_value(); }
};

// Reads `text` over `object`, which holds the defaults. The object is of use only if no problem comes back.
std::vector<Problem> ReadYaml(const Type& type, void* object, std::string_view text, std::string_view file_name,
                              SourceMap& source);

// One document, one root mapping. Refused: unknown and repeated keys, values of another type or out of range, missing
// required keys, anchors, aliases, tags, merge keys, a second document, control characters, broken UTF-8, more than
// kMaxYamlBytes.
template <typename T>
ReadResult<T> ReadYaml(std::string_view text, std::string_view file_name) {
  ReadResult<T> result{.value = T{}, .problems = {}, .source = SourceMap(file_name)};
  result.problems = ReadYaml(TypeOf<T>(), &*result.value, text, file_name, result.source);
  if (!result.problems.empty()) result.value.reset();
  return result;
}

// The text of a file, or nothing and a sentence why in `why`. Stops one byte behind kMaxYamlBytes.
std::optional<std::string> LoadText(const std::string& path, std::string& why);

template <typename T>
ReadResult<T> ReadYamlFile(const std::string& path) {
  std::string why;
  const std::optional<std::string> text = LoadText(path, why);
  if (text) return ReadYaml<T>(*text, path);
  return {.value = std::nullopt, .problems = {{path, {}, {}, why}}, .source = SourceMap(path)};
}

}  // namespace takt
