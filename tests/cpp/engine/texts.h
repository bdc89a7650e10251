// Machines from texts, and what is wrong with texts.
#pragma once

#include <stdexcept>
#include <string>

#include "takt/engine/load.h"

namespace takt::engine {

// A text with something else in one place.
inline std::string With(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("not in the text: " + what);
  return text.replace(at, what.size(), instead);
}

inline Machine MachineOf(const std::string& text) {
  LoadResult loaded = LoadMachine(text, "test.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

// The first sentence about a text with something else in one place; nothing if it is fine.
inline std::string ProblemOf(const std::string& text, const std::string& what, const std::string& instead) {
  const LoadResult loaded = LoadMachine(With(text, what, instead), "test.yaml");
  return loaded.machine ? "" : loaded.problems.front();
}

}  // namespace takt::engine
