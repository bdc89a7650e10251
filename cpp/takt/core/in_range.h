// Checks values that a program gives against their description: readers of text check them themselves, but a struct
// made in C++ may hold any value.
#pragma once

#include "takt/core/describe.h"

namespace takt {

// Returns the first field of a flat struct whose number is not finite or out of range, or whose enum value is unknown
// (optionals: if they hold a value); null if there is none. Fit for the cycle.
const Field* FirstOutOfRange(const Type& type, const void* object) noexcept;

template <typename T>
bool InRange(const T& object) noexcept {
  return FirstOutOfRange(TypeOf<T>(), &object) == nullptr;
}

}  // namespace takt
