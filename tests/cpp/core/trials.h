// How often tests try something at random.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace takt {

// Under a sanitizer each trial takes several times as long, and what it looks for a few of them show.
#ifdef TAKT_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// So many; `longer` times as many with TAKT_LONG in the environment; a fifth of that under a sanitizer, one at least.
// What the test has to have seen by then scales the same.
inline int Trials(int usual, int longer = 100) {
  const int trials = std::getenv("TAKT_LONG") ? usual * longer : usual;
  return kSanitized ? std::max(1, trials / 5) : trials;
}

// The first of them; TAKT_FIRST_TRIAL in the environment, so that a long run goes on where another one ended.
inline int FirstTrial() {
  const char* first = std::getenv("TAKT_FIRST_TRIAL");
  return first ? std::atoi(first) : 0;
}

// How far apart the instants are that a test goes through: five times as far under a sanitizer.
template <typename T>
constexpr T Stride(T usual) {
  return kSanitized ? 5 * usual : usual;
}

}  // namespace takt
