// The keys that an engine, its clients and its drives share (EN-31), and the file they are in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace takt::lcm {

inline constexpr std::size_t kKeyBytes = 32;
using Key = std::array<std::uint8_t, kKeyBytes>;

// One key; or two while it is changed, so that programs with the old file and with the new one hear each other.
struct Keys {
  Key own{};                 // tags what is sent, and is accepted
  std::optional<Key> other;  // is accepted, too
};

// The keys in a file that its owner alone may read, each a line of 64 hexadecimal digits, the own one first. Nothing:
// `problem` says why, in one line, without what is in the file.
std::optional<Keys> ReadKeys(const std::string& path, std::string& problem);

}  // namespace takt::lcm
