// Characters above U+FFFF as escaped by JSON: a pair of surrogates, \uD83D\uDE00 (RFC 8259, section 7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace takt {

inline constexpr std::size_t kSurrogatePairBytes = 12;

// Returns the character of the escaped pair at the start of `text`; nothing if there is none.
std::optional<char32_t> ReadSurrogatePair(std::string_view text);

void AppendUtf8(std::string& text, char32_t c);

// Masks the pairs of `text`, which must be UTF-8: yaml-cpp refuses escaped surrogates, but masked pairs pass through it
// as text of the same length, so that positions are preserved.
void MaskSurrogatePairs(std::string& text);

// Returns a scalar of a masked text: each pair as its character if `escapes` (the scalar is in double quotes), else as
// written.
std::string UnmaskSurrogatePairs(std::string_view scalar, bool escapes);

}  // namespace takt
