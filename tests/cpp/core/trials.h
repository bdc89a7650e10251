// The number of trials of randomised tests.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace takt {

// Under a sanitizer each trial takes several times as long, and a few of them suffice.
#ifdef TAKT_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// Returns the number of trials; `longer` times as many with TAKT_LONG in the environment; a fifth under a sanitizer, at
// least one. Minimum counts that a test requires scale accordingly.
inline int Trials(int usual, int longer = 100) {
  const int trials = std::getenv("TAKT_LONG") ? usual * longer : usual;
  return kSanitized ? std::max(1, trials / 5) : trials;
}

// Returns the first trial; TAKT_FIRST_TRIAL in the environment, so that a long run can continue an earlier one.
inline int FirstTrial() {
  const char* first = std::getenv("TAKT_FIRST_TRIAL");
  return first ? std::atoi(first) : 0;
}

// Scales the stride of tested instants: five times as large under a sanitizer.
template <typename T>
constexpr T Stride(T usual) {
  return kSanitized ? 5 * usual : usual;
}

}  // namespace takt
