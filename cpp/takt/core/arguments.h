// Reads the arguments of a command from one line of text: {position: 100, velocity: 50, direction: positive}.
#pragma once

#include <cstddef>
#include <string_view>

#include "takt/core/describe.h"
#include "takt/core/problem.h"

namespace takt {

inline constexpr std::size_t kMaxArgumentBytes = 16'384;

// Reads YAML's flow form (JSON is a subset of it) into `object`, which holds the defaults; rules and messages as those
// of the YAML reader. An empty text has no arguments. Returns false on failure: `problem` receives the first problem,
// with "arguments" as its file, and the object must not be used. On success it allocates only for strings and lists of
// the object. `most_bytes`: maximum length of the text.
bool ReadArguments(const Type& type, void* object, std::string_view text, Problem* problem,
                   std::size_t most_bytes = kMaxArgumentBytes);

template <typename T>
bool ReadArguments(T& object, std::string_view text, Problem* problem, std::size_t most_bytes = kMaxArgumentBytes) {
  return ReadArguments(TypeOf<T>(), static_cast<void*>(&object), text, problem, most_bytes);
}

}  // namespace takt
