#include "takt/core/scalar.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace takt {
namespace {

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view TakeDigits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), IsDigit);
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  return digits;
}

bool TakeSign(std::string_view& text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  return negative;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return (x >= 'A' && x <= 'Z' ? static_cast<char>(x - 'A' + 'a') : x) == y; });
}

bool IsNotFinite(std::string_view text) {
  TakeSign(text);
  if (text.starts_with('.')) text.remove_prefix(1);
  return EqualsIgnoringCase(text, "nan") || EqualsIgnoringCase(text, "inf") || EqualsIgnoringCase(text, "infinity");
}

}  // namespace

NumberError ParseReal(std::string_view text, double& value) noexcept {
  if (IsNotFinite(text)) return NumberError::kNotFinite;
  if (text.starts_with('+')) text.remove_prefix(1);
  std::string_view rest = text;
  if (rest.starts_with('-')) rest.remove_prefix(1);
  const std::string_view whole = TakeDigits(rest);
  std::string_view fraction;
  if (rest.starts_with('.')) {
    rest.remove_prefix(1);
    fraction = TakeDigits(rest);
  }
  if (whole.empty() && fraction.empty()) return NumberError::kNotANumber;
  if (rest.starts_with('e') || rest.starts_with('E')) {
    rest.remove_prefix(1);
    TakeSign(rest);
    if (TakeDigits(rest).empty()) return NumberError::kNotANumber;
  }
  if (!rest.empty()) return NumberError::kNotANumber;
  if (whole.size() > 1 && whole.front() == '0') return NumberError::kLeadingZero;
  double parsed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error == std::errc::result_out_of_range) return NumberError::kTooLarge;
  if (error != std::errc() || end != text.data() + text.size()) return NumberError::kNotANumber;
  value = parsed;
  return NumberError::kNone;
}

NumberError ParseInteger(std::string_view text, Integer& value) noexcept {
  double real = 0;
  std::string_view rest = text;
  const bool negative = TakeSign(rest);
  const std::string_view digits = TakeDigits(rest);
  if (digits.empty() || !rest.empty()) {
    const NumberError error = ParseReal(text, real);
    return error == NumberError::kNone ? NumberError::kNotWhole : error;
  }
  if (digits.size() > 1 && digits.front() == '0') return NumberError::kLeadingZero;
  std::uint64_t magnitude = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), magnitude);
  if (error != std::errc()) return NumberError::kTooLarge;
  value = {magnitude, negative && magnitude != 0};
  return NumberError::kNone;
}

bool NeedsQuotes(std::string_view word) noexcept {
  constexpr std::array<std::string_view, 8> kReserved{"~", "null", "true", "false", "yes", "no", "on", "off"};
  if (word.empty() || word == "<<" || word == "=") return true;
  if (std::any_of(kReserved.begin(), kReserved.end(), [&](auto r) { return EqualsIgnoringCase(word, r); })) return true;
  if (IsNotFinite(word)) return true;
  double unused = 0;
  if (ParseReal(word, unused) != NumberError::kNotANumber) return true;
  std::string_view rest = word;
  TakeSign(rest);
  if (rest.starts_with("0x") || rest.starts_with("0o") || rest.starts_with("0b")) return true;
  // 1_000, 1:30, 2026-01-01.
  return !rest.empty() && IsDigit(rest.front()) && rest.find_first_not_of("0123456789_:.-") == std::string_view::npos;
}

std::string FormatReal(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

double Written(double held, double scale) noexcept {
  const double near = held / scale;
  if (scale == 1 || !std::isfinite(near)) return near;
  std::array<char, 40> buffer;
  for (int digits = 1; digits <= 17; ++digits) {
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), near, std::chars_format::scientific, digits - 1);
    double candidate = 0;
    std::from_chars(buffer.data(), end, candidate);
    if (candidate * scale == held) return candidate;
  }
  double below = near, above = near;
  for (int i = 0; i < 4; ++i) {
    below = std::nextafter(below, -HUGE_VAL);
    above = std::nextafter(above, HUGE_VAL);
    if (below * scale == held) return below;
    if (above * scale == held) return above;
  }
  return near;
}

}  // namespace takt
