// Reads the arguments of a command from one line of text: {position: 100, velocity: 50, direction: positive}.
#pragma once

#include <cstddef>
#include <string_view>

#include "takt/core/describe.h"
#include "takt/core/problem.h"

namespace takt {

inline constexpr std::size_t kMaxArgumentBytes = 16'384;

// Reads YAML's flow form (JSON is one case of it) over `object`, which holds the defaults; same rules and messages as
// the YAML reader. Empty text: no arguments. False: `problem` gets the first problem, with "arguments" for the file,
// and the object is of no use. Allocates nothing on success, but for what strings and lists of the object need.
// `most_bytes`: bound of the text.
bool ReadArguments(const Type& type, void* object, std::string_view text, Problem* problem,
                   std::size_t most_bytes = kMaxArgumentBytes);

template <typename T>
bool ReadArguments(T& object, std::string_view text, Problem* problem, std::size_t most_bytes = kMaxArgumentBytes) {
  return ReadArguments(TypeOf<T>(), static_cast<void*>(&object), text, problem, most_bytes);
}

}  // namespace takt
