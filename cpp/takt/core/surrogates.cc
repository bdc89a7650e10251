#include "takt/core/surrogates.h"

#include <charconv>

namespace takt {
namespace {

constexpr char kMask = '\xC0';  // replaces the backslashes of a pair: never a byte of UTF-8

// Returns the code of a surrogate from four hexadecimal digits after `mark` and 'u'; 0 if there is none.
std::uint32_t ReadSurrogate(std::string_view text, char mark) {
  constexpr std::size_t kBytes = kSurrogatePairBytes / 2;
  if (text.size() < kBytes || text[0] != mark || text[1] != 'u') return 0;
  std::uint32_t code = 0;
  const char* const end = text.data() + kBytes;
  const auto [stop, error] = std::from_chars(text.data() + 2, end, code, 16);
  const bool surrogate = error == std::errc() && stop == end && code >= 0xD800 && code <= 0xDFFF;
  return surrogate ? code : 0;
}

std::optional<char32_t> ReadPair(std::string_view text, char mark) {
  const std::uint32_t high = ReadSurrogate(text, mark);
  if (high == 0 || high >= 0xDC00) return std::nullopt;
  const std::uint32_t low = ReadSurrogate(text.substr(kSurrogatePairBytes / 2), mark);
  if (low < 0xDC00) return std::nullopt;
  return 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00);
}

}  // namespace

std::optional<char32_t> ReadSurrogatePair(std::string_view text) {
  return ReadPair(text, '\\');
}

void AppendUtf8(std::string& text, char32_t c) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | c >> 6);
    put(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    put(0xE0 | c >> 12);
    put(0x80 | (c >> 6 & 0x3F));
    put(0x80 | (c & 0x3F));
  } else {
    put(0xF0 | c >> 18);
    put(0x80 | (c >> 12 & 0x3F));
    put(0x80 | (c >> 6 & 0x3F));
    put(0x80 | (c & 0x3F));
  }
}

void MaskSurrogatePairs(std::string& text) {
  for (std::size_t at = text.find('\\'); at < text.size(); at = text.find('\\', at)) {
    if (ReadSurrogatePair(std::string_view(text).substr(at))) {
      text[at] = text[at + kSurrogatePairBytes / 2] = kMask;
      at += kSurrogatePairBytes;
    } else {
      at += 2;  // an escaped backslash does not begin a pair
    }
  }
}

std::string UnmaskSurrogatePairs(std::string_view scalar, bool escapes) {
  if (scalar.find(kMask) == std::string_view::npos) return std::string(scalar);
  std::string text;
  while (!scalar.empty()) {
    const std::optional<char32_t> pair = escapes ? ReadPair(scalar, kMask) : std::nullopt;
    if (pair) {
      AppendUtf8(text, *pair);
    } else {
      text += scalar[0] == kMask ? '\\' : scalar[0];
    }
    scalar.remove_prefix(pair ? kSurrogatePairBytes : 1);
  }
  return text;
}

}  // namespace takt
