// The two clocks of this folder's threads.
#pragma once

#include <chrono>
#include <cstdint>

namespace takt::lcm {

// Returns the wall clock [µs since 1970-01-01 UTC], as LCM stamps messages and logs.
inline std::int64_t WallClockUs() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::microseconds(1);
}
// Returns the monotonic clock [ns].
inline std::int64_t SteadyNs() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace takt::lcm
