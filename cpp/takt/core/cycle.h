// The one notion of time below the scheduler: the number of the cycle and its period.
#pragma once

#include <cmath>
#include <cstdint>

namespace takt {

struct Cycle {
  std::uint64_t count = 0;  // 0: the first cycle after start
  double period_s = 0.001;  // [s] 250 µs to 20 ms

  // Returns the time [s] from the start to the begin of this cycle. A product, not a sum: errors do not accumulate.
  constexpr double time_s() const { return static_cast<double>(count) * period_s; }
};

// Returns the first cycle that begins at least `seconds` from now.
inline std::uint64_t CycleIn(const Cycle& now, double seconds) {
  return now.count + static_cast<std::uint64_t>(std::ceil(seconds / now.period_s));
}

}  // namespace takt
