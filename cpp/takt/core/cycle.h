// The one notion of time below the scheduler: which cycle this is and how long a cycle lasts.
#pragma once

#include <cmath>
#include <cstdint>

namespace takt {

struct Cycle {
  std::uint64_t count = 0;  // 0 for the first cycle after start
  double period_s = 0.001;  // 250 µs to 20 ms

  // Seconds from the start to the beginning of this cycle. A product, not a sum: no error builds up.
  constexpr double time_s() const { return static_cast<double>(count) * period_s; }
};

// The cycle `seconds` from now, or the first one behind that.
inline std::uint64_t CycleIn(const Cycle& now, double seconds) {
  return now.count + static_cast<std::uint64_t>(std::ceil(seconds / now.period_s));
}

}  // namespace takt
