// The axes of a pick and place module: those of the tool, the real ones and an auxiliary one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::pickplace {

// Selected axis; its index in lists is one less.
enum class SelectAxis : std::uint8_t { kNone, kX, kY, kZ, kA, kB, kC, kA1, kA2, kA3, kA4, kA5, kA6, kAux1 };

// X, Y, Z, A, B, C, A1 to A6, Aux1.
inline constexpr std::size_t kAllAxes = 13;
// A1 to A6, Aux1: the axes with drives.
inline constexpr std::size_t kRealAxes = 7;
// X, Y, Z, A, B, C, Aux1: the axes that a profile moves.
inline constexpr std::size_t kProfileAxes = 7;
inline constexpr std::size_t kFirstReal = 6;

template <typename T, std::size_t kCount>
constexpr std::array<T, kCount> Filled(T value) {
  std::array<T, kCount> all{};
  all.fill(value);
  return all;
}

void describe(Enumeration<SelectAxis>&);

}  // namespace takt::pickplace
