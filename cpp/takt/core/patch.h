// Changes some members of a struct at run time: a second struct has the same members as optionals, and those that are
// set replace the values of the first. Both come from one template, so that they are described once:
//
//   template <template <typename> class Of>
//   struct SettingsOf { Of<double> jerk = Preset<Of>(100.0); ... };
//   using Settings = SettingsOf<Plain>;
//   using Configure = SettingsOf<std::optional>;
#pragma once

#include <optional>
#include <type_traits>

#include "takt/core/describe_fwd.h"

namespace takt {

template <typename T>
using Plain = T;

// Returns the initial value of a plain member; optionals begin empty.
template <template <typename> class Of, typename T>
constexpr Of<T> Preset(T value) {
  if constexpr (std::is_same_v<Of<T>, T>) {
    return value;
  } else {
    return std::nullopt;
  }
}

template <typename T>
const Type& TypeOf();

// Requires: `given` and `whole` describe the same members in the same order. Fit for the cycle.
void ApplyPatch(const Type& given_type, const void* given, const Type& whole_type, void* whole) noexcept;

template <template <template <typename> class> class StructOf>
void ApplyPatch(const StructOf<std::optional>& given, StructOf<Plain>& whole) noexcept {
  static_assert(std::is_trivially_copyable_v<StructOf<Plain>>, "members are copied as bytes");
  ApplyPatch(TypeOf<StructOf<std::optional>>(), &given, TypeOf<StructOf<Plain>>(), &whole);
}

}  // namespace takt
