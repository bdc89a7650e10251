// The key that an engine, its clients and its drives share (EN-31), and the file it is in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace takt::lcm {

inline constexpr std::size_t kKeyBytes = 32;
using Key = std::array<std::uint8_t, kKeyBytes>;

// The key in a file of 64 hexadecimal digits that its owner alone may read. Nothing: `problem` says why, in one line,
// without what is in the file.
std::optional<Key> ReadKey(const std::string& path, std::string& problem);

}  // namespace takt::lcm
