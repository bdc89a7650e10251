// Numbers and words in YAML text: one strict reading and one writing for all interfaces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace takt {

enum class NumberError : std::uint8_t {
  kNone,
  kNotANumber,
  kNotFinite,    // nan, inf
  kNotWhole,     // 3.0 where an integer is expected
  kLeadingZero,  // 010
  kTooLarge,     // more than the type can hold
};

// Reads 12, -0.5, .5, 1e3, +2. On an error `value` is unchanged. Does not allocate.
NumberError ParseReal(std::string_view text, double& value) noexcept;

// Sign and digits. The value is (negative ? -magnitude : magnitude).
struct Integer {
  std::uint64_t magnitude = 0;
  bool negative = false;
};
NumberError ParseInteger(std::string_view text, Integer& value) noexcept;

// Returns true if a YAML reader, of version 1.1 or 1.2, would read this plain word as something other than text (5,
// true, on, ~, 1:30, 2026-01-01). Except y and n: an axis may have such a name, and hardly any reader takes them for
// yes and no.
bool NeedsQuotes(std::string_view word) noexcept;

// Returns the shortest text that reads back as the same number and that every YAML reader takes for a real: 100.0,
// 1.0e-05.
std::string FormatReal(double value);

// Returns the written value of a held value: the one with the fewest digits that gives back the identical held value.
double Written(double held, double scale) noexcept;

}  // namespace takt
