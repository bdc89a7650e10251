// Whether what a program gives is what the description allows: readers of text see to that themselves, but a struct
// made in C++ may hold anything.
#pragma once

#include "takt/core/describe.h"

namespace takt {

// Every number of a flat struct is finite and in its range, every enum one of its values; of optionals, where they hold
// something. Fit for the cycle.
bool InRange(const Type& type, const void* object) noexcept;

template <typename T>
bool InRange(const T& object) noexcept {
  return InRange(TypeOf<T>(), static_cast<const void*>(&object));
}

}  // namespace takt
