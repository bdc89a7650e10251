// Machines from texts, and problems of texts.
#pragma once

#include <stdexcept>
#include <string>

#include "takt/engine/load.h"

namespace takt::engine {

// Returns a text with one passage replaced.
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

// Returns the first problem of a text with one passage replaced; empty if there is none.
inline std::string ProblemOf(const std::string& text, const std::string& what, const std::string& instead) {
  const LoadResult loaded = LoadMachine(With(text, what, instead), "test.yaml");
  return loaded.machine ? "" : loaded.problems.front();
}

}  // namespace takt::engine
