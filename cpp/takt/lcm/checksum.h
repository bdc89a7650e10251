// Checksums of the events of a log (EN-36): "TKX3" and eight big-endian bytes follow the message, where LCM decoders do
// not read: XXH3 (64 bits, seed 0) of the channel's name, a zero and the message. A reader that knows them can detect a
// changed message; any other reader reads the log as usual.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace takt::lcm {

inline constexpr std::size_t kChecksumBytes = 12;

void AppendChecksum(std::string_view channel, std::vector<std::uint8_t>& message);

enum class ChecksumState : std::uint8_t { kNone, kHolds, kBroken };
// Checks the bytes of an event.
ChecksumState CheckChecksum(std::string_view channel, std::span<const std::uint8_t> bytes);

}  // namespace takt::lcm
