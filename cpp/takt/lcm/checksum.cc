#include "takt/lcm/checksum.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>

namespace takt::lcm {
namespace {

constexpr std::array<std::uint8_t, 4> kMark = {'T', 'K', 'X', '3'};

std::array<std::uint8_t, kChecksumBytes> ChecksumOf(std::string_view channel, std::span<const std::uint8_t> message) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, channel.data(), channel.size());
  XXH3_64bits_update(&state, "", 1);
  XXH3_64bits_update(&state, message.data(), message.size());
  const std::uint64_t sum = XXH3_64bits_digest(&state);
  std::array<std::uint8_t, kChecksumBytes> bytes{};
  std::ranges::copy(kMark, bytes.begin());
  for (std::size_t i = 0; i < 8; ++i) bytes[kMark.size() + i] = static_cast<std::uint8_t>(sum >> (56 - 8 * i));
  return bytes;
}

}  // namespace

void AppendChecksum(std::string_view channel, std::vector<std::uint8_t>& message) {
  const auto checksum = ChecksumOf(channel, message);
  message.insert(message.end(), checksum.begin(), checksum.end());
}

ChecksumState CheckChecksum(std::string_view channel, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kChecksumBytes) return ChecksumState::kNone;
  const auto message = bytes.first(bytes.size() - kChecksumBytes), found = bytes.last(kChecksumBytes);
  if (!std::ranges::equal(found.first(kMark.size()), kMark)) return ChecksumState::kNone;
  return std::ranges::equal(found, ChecksumOf(channel, message)) ? ChecksumState::kHolds : ChecksumState::kBroken;
}

}  // namespace takt::lcm
