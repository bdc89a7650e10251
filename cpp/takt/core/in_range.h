// Whether what a program gives is what the description allows: readers of text see to that themselves, but a struct
// made in C++ may hold anything.
#pragma once

#include "takt/core/describe.h"

namespace takt {

// The first field of a flat struct whose number is not finite or not in its range, or whose enum is none of its values;
// of optionals, where they hold something. Null: all is well. Fit for the cycle.
const Field* FirstOutOfRange(const Type& type, const void* object) noexcept;

template <typename T>
bool InRange(const T& object) noexcept {
  return FirstOutOfRange(TypeOf<T>(), &object) == nullptr;
}

}  // namespace takt
