// Pseudorandom numbers that are the same on every host and with every library. SplitMix64 (Steele, Lea and Flood,
// 2014).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace takt::routing {

class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t Next() noexcept {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  // Returns a number from 0 to count - 1. Requires: count > 0.
  std::size_t Below(std::size_t count) noexcept { return static_cast<std::size_t>(Next() % count); }
  double Unit() noexcept { return static_cast<double>(Next() >> 11U) * 0x1p-53; }  // in [0, 1)

  template <typename T>
  void Shuffle(std::vector<T>& values) noexcept {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[Below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace takt::routing
