// The keys that an engine, its clients and its drives share (EN-31), and their file.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace takt::lcm {

inline constexpr std::size_t kKeyBytes = 32;
using Key = std::array<std::uint8_t, kKeyBytes>;

// One key; or two while it is being changed, so that programs with the old file and with the new one accept each other.
struct Keys {
  Key own{};                 // tags sent messages, and is accepted
  std::optional<Key> other;  // is accepted, too
};

// Reads the keys from a file that only its owner may read, one line of 64 hexadecimal digits each, the own one first.
// Returns nothing on failure; `problem` then says why, in one line, without any content of the file.
std::optional<Keys> ReadKeys(const std::string& path, std::string& problem);

}  // namespace takt::lcm
