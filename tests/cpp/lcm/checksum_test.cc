#include "takt/lcm/checksum.h"

#include <gtest/gtest.h>

#include <random>

namespace takt::lcm {
namespace {

// EN-36: a bit changed anywhere, in the message, in its channel or in the checksum itself, is found.
TEST(Checksum, FindsEveryChangedBit) {
  std::mt19937 random(36);
  for (const std::size_t size : {0u, 1u, 50u, 700u}) {
    std::vector<std::uint8_t> bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(CheckChecksum("takt/axis/x", bytes), ChecksumState::kNone);
    AppendChecksum("takt/axis/x", bytes);
    ASSERT_EQ(bytes.size(), size + kChecksumBytes);
    EXPECT_EQ(CheckChecksum("takt/axis/x", bytes), ChecksumState::kHolds);
    EXPECT_EQ(CheckChecksum("takt/axis/y", bytes), ChecksumState::kBroken);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      EXPECT_NE(CheckChecksum("takt/axis/x", bytes), ChecksumState::kHolds) << bit;
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    }
  }
}

}  // namespace
}  // namespace takt::lcm
