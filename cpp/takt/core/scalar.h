// Numbers and words in YAML text: one strict reading and one writing for all faces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace takt {

enum class NumberError : std::uint8_t {
  kNone,
  kNotANumber,
  kNotFinite,    // nan, inf
  kNotWhole,     // 3.0 where an integer is wanted
  kLeadingZero,  // 010
  kTooLarge,     // more than the type can hold
};

// 12, -0.5, .5, 1e3, +2. On an error `value` is untouched. No allocation.
NumberError ParseReal(std::string_view text, double& value) noexcept;

// Sign and digits. The value is (negative ? -magnitude : magnitude).
struct Integer {
  std::uint64_t magnitude = 0;
  bool negative = false;
};
NumberError ParseInteger(std::string_view text, Integer& value) noexcept;

// Would a YAML reader, of version 1.1 or 1.2, take this plain word for something else than text (5, true, on, ~, 1:30,
// 2026-01-01)? Not y and n: an axis may be called so, and hardly any reader takes them for yes and no.
bool NeedsQuotes(std::string_view word) noexcept;

// The shortest text that reads back as the same number, always one that every YAML reader takes for a real:
// 100.0, 1.0e-05.
std::string FormatReal(double value);

// Held value -> written value: the one with the fewest digits that gives back the very same held value.
double Written(double held, double scale) noexcept;

}  // namespace takt
