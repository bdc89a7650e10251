// Writes a described struct as YAML that reads back as the identical object. Not for use within the cycle.
#pragma once

#include <cstdint>
#include <string>

#include "takt/core/describe.h"

namespace takt {

enum class Comments : std::uint8_t { kNone, kUnits };

// Writes a machine file: one key a line, followed by its unit if requested. Internal fields and empty optionals are
// omitted.
std::string WriteYaml(const Type& type, const void* object, Comments comments = Comments::kNone);
// Writes one line: {position: 100.0, velocity: 50.0}.
std::string WriteFlow(const Type& type, const void* object);

template <typename T>
std::string WriteYaml(const T& object, Comments comments = Comments::kNone) {
  return WriteYaml(TypeOf<T>(), static_cast<const void*>(&object), comments);
}
template <typename T>
std::string WriteFlow(const T& object) {
  return WriteFlow(TypeOf<T>(), static_cast<const void*>(&object));
}

}  // namespace takt
