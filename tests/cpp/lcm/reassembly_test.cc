#include "takt/lcm/reassembly.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <random>

#include "packets.h"

namespace takt::lcm {
namespace {

Packet Counting(std::size_t size) {
  Packet data(size);
  std::iota(data.begin(), data.end(), std::uint8_t{1});
  return data;
}

// EN-30: one datagram is a message; the format is LCM's.
TEST(Reassembly, TakesShortMessages) {
  Reassembly reassembly;
  const auto message = reassembly.Take(1, ShortPacket(7, "takt/command", {1, 2, 3}));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "takt/command");
  EXPECT_EQ(message->data, (Packet{1, 2, 3}));
  EXPECT_TRUE(reassembly.Take(1, ShortPacket(8, std::string(63, 'c'), {})));
  EXPECT_EQ(reassembly.malformed(), 0u);
}

// EN-30: a long message is reassembled with its fragments in any order, with duplicates, and mixed with those of other
// senders.
TEST(Reassembly, JoinsFragmentsInAnyOrder) {
  std::mt19937 random(20261125);
  Reassembly reassembly;
  for (std::uint32_t round = 0; round < 50; ++round) {
    std::vector<std::pair<std::uint64_t, Packet>> packets;
    for (std::uint64_t sender = 1; sender <= 5; ++sender) {
      for (const Packet& packet : Fragments(round, "m" + std::to_string(sender), Counting(997 * sender), 100)) {
        packets.emplace_back(sender, packet);
        if (random() % 5 == 0 && packets.size() % 7 != 0) packets.emplace_back(sender, packet);
      }
    }
    std::shuffle(packets.begin(), packets.end(), random);
    std::map<std::string, Packet> whole;
    for (const auto& [sender, packet] : packets) {
      if (auto message = reassembly.Take(sender, packet)) whole[message->channel] = message->data;
    }
    ASSERT_EQ(whole.size(), 5u);
    for (std::uint64_t sender = 1; sender <= 5; ++sender) {
      EXPECT_EQ(whole["m" + std::to_string(sender)], Counting(997 * sender));
    }
  }
  EXPECT_EQ(reassembly.malformed(), 0u);
}

// EN-30: the fields of a fragment do not fit the message, or the other fragments.
TEST(Reassembly, RefusesFragmentsThatDoNotFit) {
  const Packet data = Counting(10);
  struct Wrong {
    const char* what;
    std::vector<Packet> packets;
  };
  const std::vector<Wrong> wrong = {
      {"offset beyond the size", {FragmentPacket({1, 20, 0xfffffff0, 1, 2}, "c", data)}},
      {"offset just beyond the size", {FragmentPacket({1, 20, 21, 1, 2}, "c", {})}},
      {"data beyond the size", {FragmentPacket({1, 20, 11, 1, 2}, "c", data)}},
      {"data beyond the size, and offset and size together beyond 32 bits",
       {FragmentPacket({1, 0xffffffff, 0xfffffffe, 1, 2}, "c", data)}},
      {"larger than any message", {FragmentPacket({1, 0x7fffffff, 0, 0, 2}, "c", data)}},
      {"fragment beyond their number", {FragmentPacket({1, 20, 0, 2, 2}, "c", data)}},
      {"no fragments", {FragmentPacket({1, 20, 0, 0, 0}, "c", data)}},
      {"overlap", {FragmentPacket({1, 20, 0, 0, 2}, "c", data), FragmentPacket({1, 20, 5, 1, 2}, "c", data)}},
      {"hole", {FragmentPacket({1, 30, 0, 0, 2}, "c", data), FragmentPacket({1, 30, 20, 1, 2}, "c", data)}},
      {"not from the start",
       {FragmentPacket({1, 20, 10, 0, 2}, "c", data), FragmentPacket({1, 20, 0, 1, 2}, "c", data)}},
      {"channel without an end", {FragmentPacket({1, 20, 0, 0, 2}, std::string(64, 'c'), data)}},
      {"no channel", {FragmentPacket({1, 20, 0, 0, 2}, "", data)}},
      {"no channel in a short one", {ShortPacket(1, "", data)}},
      {"channel too long in a short one", {ShortPacket(1, std::string(64, 'c'), data)}},
      {"header cut", {Packet{0x4c, 0x43, 0x30, 0x33, 0, 0, 0, 1, 0, 0, 0, 9, 0, 0}}},
      {"other magic", {Packet{0x4c, 0x43, 0x30, 0x34, 0, 0, 0, 1, 'c', 0}}},
      {"nothing", {Packet{}}},
  };
  for (const Wrong& one : wrong) {
    Reassembly reassembly;
    for (const Packet& packet : one.packets) EXPECT_FALSE(reassembly.Take(1, packet)) << one.what;
    EXPECT_EQ(reassembly.malformed(), 1u) << one.what;
    EXPECT_TRUE(reassembly.Take(1, ShortPacket(2, "c", data))) << one.what << ", and what comes afterwards";
  }
}

// EN-30: a number that is used again with another size begins another message.
TEST(Reassembly, ASenderMayBeginAnew) {
  Reassembly reassembly;
  EXPECT_FALSE(reassembly.Take(1, Fragments(5, "c", Counting(300), 100)[0]));
  std::optional<Reassembly::Message> message;
  for (const Packet& packet : Fragments(5, "c", Counting(250), 100)) message = reassembly.Take(1, packet);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->data, Counting(250));
  EXPECT_EQ(reassembly.unfinished(), 1u);
  EXPECT_EQ(reassembly.held_bytes(), 0u);
}

// EN-30: unfinished messages use bounded memory, and do not block others.
TEST(Reassembly, UnfinishedMessagesAreBounded) {
  Reassembly reassembly({.messages = 8, .bytes = 100'000});
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    EXPECT_FALSE(reassembly.Take(i % 100, FragmentPacket({i, 1 << 20, 0, 0, 60'000}, "c", Counting(1000 + i % 5000))));
    ASSERT_LE(reassembly.held_bytes(), 100'000u);
  }
  EXPECT_GE(reassembly.unfinished(), 9'992u);
  std::optional<Reassembly::Message> message;
  for (const Packet& packet : Fragments(5, "c", Counting(50'000), 1000)) message = reassembly.Take(7, packet);
  EXPECT_TRUE(message);
}

// EN-30: with random packets, nothing crashes, memory stays bounded, and a message is reassembled as it was sent or not
// at all, unless one of its own packets was changed. Run with TAKT_LONG for millions of packets.
TEST(Reassembly, Fuzz) {
  std::mt19937 random(4711);
  const auto uniform = [&](std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random);
  };
  constexpr std::uint32_t kOdd[] = {0, 1, 2, 255, 0x7fff, 0x8000, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff};
  const std::uint32_t rounds = std::getenv("TAKT_LONG") ? 500'000 : 3'000;
  Reassembly reassembly({.messages = 16, .bytes = 1 << 20});
  std::uint64_t whole = 0;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const Packet data = Counting(uniform(0, 2000));
    std::vector<Packet> packets = Fragments(round, "genuine", data, uniform(1, 9) * 100);
    const bool genuine = uniform(0, 1) == 0;
    if (uniform(0, 1) == 0) std::shuffle(packets.begin(), packets.end(), random);
    for (Packet& packet : packets) {
      if (!genuine) {  // a field of the header, some bytes, or the length
        const std::uint32_t kind = uniform(0, 3);
        if (kind == 0) {
          const std::uint32_t odd = kOdd[uniform(0, std::size(kOdd) - 1)] + uniform(0, 2) - 1;
          const std::size_t at = 4 * uniform(1, 4);
          for (std::size_t i = 0; i < 4; ++i) packet[at + i] = static_cast<std::uint8_t>(odd >> (24 - 8 * i));
        } else if (kind == 1) {
          for (std::uint32_t i = uniform(1, 5); i > 0; --i) {
            packet[uniform(4, static_cast<std::uint32_t>(packet.size()) - 1)] = static_cast<std::uint8_t>(random());
          }
        } else if (kind == 2) {
          packet.resize(uniform(0, static_cast<std::uint32_t>(packet.size())));
        }
      }
      const Packet exact(packet.begin(), packet.end());  // with its exact size, so that a read beyond it is detected
      const auto message = reassembly.Take(genuine ? 1 : uniform(2, 9), exact);
      ASSERT_LE(reassembly.held_bytes(), std::size_t{1} << 20);
      if (!message || !genuine) continue;
      EXPECT_EQ(message->channel, "genuine");
      EXPECT_EQ(message->data, data);
      ++whole;
    }
  }
  EXPECT_GT(whole, rounds / 3);
  EXPECT_GT(reassembly.malformed(), rounds / 3);
}

}  // namespace
}  // namespace takt::lcm
