// Checksums of the events of a log (EN-36): behind the message, where decoders of LCM do not look, stand "TKX3" and
// eight bytes, the highest first: XXH3 (64 bits, seed 0) of the channel's name, a zero and the message. A reader that
// knows them can tell a message that was changed from one that is as it was written; any other reads the log as it is.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace takt::lcm {

inline constexpr std::size_t kChecksumBytes = 12;

void AppendChecksum(std::string_view channel, std::vector<std::uint8_t>& message);

enum class ChecksumState : std::uint8_t { kNone, kHolds, kBroken };
// Of the bytes of an event.
ChecksumState CheckChecksum(std::string_view channel, std::span<const std::uint8_t> bytes);

}  // namespace takt::lcm
