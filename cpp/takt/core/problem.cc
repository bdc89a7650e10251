#include "takt/core/problem.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

namespace takt {
namespace {

constexpr std::size_t kLongestWord = 48;

char Lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Returns the number of edits from one word to the other; swapping two neighbours counts as one.
std::size_t Distance(std::string_view a, std::string_view b) {
  std::array<std::array<std::size_t, kLongestWord + 1>, 3> rows{};
  std::iota(rows[0].begin(), rows[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    auto& row = rows[i % 3];
    const auto& above = rows[(i - 1) % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = Lower(a[i - 1]) == Lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], rows[(i - 2) % 3][j - 2] + 1);
      }
    }
  }
  return rows[a.size() % 3][b.size()];
}

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;
};

// Returns the UTF-8 character at the start of `text`; nothing if it is malformed.
std::optional<CodePoint> Decode(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return CodePoint{first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return std::nullopt;
  std::uint32_t value = first & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return std::nullopt;
    value = value << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kSmallest[bytes] || value > 0x10FFFF || surrogate) return std::nullopt;
  return CodePoint{value, bytes};
}

std::string Hex(std::uint32_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return {'0', 'x', kDigits[value >> 4 & 15], kDigits[value & 15]};
}

}  // namespace

std::string Problem::Text() const {
  std::string text = source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": ";
  if (!path.empty()) text += path + ": ";
  return text + message;
}

void ProblemList::Add(Place place, std::string path, std::string message) {
  if (full()) return;
  problems_.push_back({std::string(source_), place, std::move(path), std::move(message)});
}

Place SourceMap::PlaceOf(std::string_view path) const {
  for (;;) {
    if (const auto found = places_.find(path); found != places_.end()) return found->second;
    if (path.empty()) return {};
    const std::size_t cut = path.find_last_of(".[");
    path = cut == std::string_view::npos ? std::string_view{} : path.substr(0, cut);
  }
}

Problem SourceMap::ProblemAt(std::string_view path, std::string_view message) const {
  return {file_, PlaceOf(path), std::string(path), std::string(message)};
}

std::string_view Nearest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.size() > kLongestWord) return {};
  std::string_view nearest;
  std::size_t smallest = kLongestWord;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    const std::size_t distance = Distance(word, candidate);
    const bool near = distance * 3 <= std::max(word.size(), candidate.size());
    if (near && distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  if (!nearest.empty() || word.size() < 3) return nearest;
  const auto starts =
      std::find_if(candidates.begin(), candidates.end(), [&](std::string_view c) { return c.starts_with(word); });
  return starts == candidates.end() ? std::string_view{} : *starts;
}

std::string DidYouMean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view nearest = Nearest(word, candidates);
  return nearest.empty() ? std::string() : "; did you mean " + std::string(nearest) + "?";
}

std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  std::size_t characters = 0;
  while (!text.empty()) {
    const auto decoded = Decode(text);
    if (++characters > 40) {
      quoted += "...";
      break;
    }
    if (!decoded || decoded->value < 0x20 || (decoded->value >= 0x7F && decoded->value < 0xA0)) {
      quoted += decoded && decoded->value != 0x7F && decoded->value < 0x20 ? ' ' : '?';
    } else {
      quoted += text.substr(0, decoded->bytes);
    }
    text.remove_prefix(decoded ? decoded->bytes : 1);
  }
  return quoted + "'";
}

bool CheckBytes(std::string_view text, ProblemList& problems) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto decoded = Decode(text.substr(at));
    if (!decoded) {
      problems.Add(PlaceAt(text, at), {},
                   "expected text in UTF-8, found the byte " + Hex(static_cast<std::uint8_t>(text[at])));
      return false;
    }
    const std::uint32_t c = decoded->value;
    const bool allowed = c == '\t' || c == '\n' || c == '\r' || (c >= 0x20 && c < 0x7F) || c >= 0xA0;
    if (!allowed) {
      problems.Add(PlaceAt(text, at), {}, "expected text, found the control character " + Hex(c));
      return false;
    }
    at += decoded->bytes;
  }
  return true;
}

Place PlaceAt(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const std::size_t newline = before.rfind('\n');
  const std::string_view line = newline == std::string_view::npos ? before : before.substr(newline + 1);
  const auto starts_character = [](char c) { return (static_cast<std::uint8_t>(c) & 0xC0) != 0x80; };
  return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(std::count_if(line.begin(), line.end(), starts_character))};
}

}  // namespace takt
