// Equality and hash over the described fields of a struct, independent of padding. Fit for the cycle: no allocation.
#pragma once

#include <cstdint>

#include "takt/core/describe.h"

namespace takt {

// Numbers are hashed by their bits: a NaN hashes like itself, 0 and -0 differ. The same on all machines of the same
// byte order.
std::uint64_t HashOf(const Type& type, const void* object, std::uint64_t seed = 0) noexcept;

template <typename T>
std::uint64_t HashOf(const T& object, std::uint64_t seed = 0) noexcept {
  return HashOf(TypeOf<T>(), static_cast<const void*>(&object), seed);
}

// Compares by bits as well: an object equals its copy, NaN or not.
bool Equal(const Type& type, const void* a, const void* b) noexcept;

template <typename T>
bool Equal(const T& a, const T& b) noexcept {
  return Equal(TypeOf<T>(), static_cast<const void*>(&a), static_cast<const void*>(&b));
}

}  // namespace takt
