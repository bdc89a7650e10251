#include "takt/lcm/authentication.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <random>
#include <utility>

#include "takt/lcm/clock.h"

namespace takt::lcm {
namespace {

using Bytes = std::vector<std::uint8_t>;

Key KeyFrom(unsigned seed) {
  std::mt19937 random(seed);
  Key key{};
  for (std::uint8_t& byte : key) byte = static_cast<std::uint8_t>(random());
  return key;
}

Keys KeysFrom(unsigned seed) {
  return {.own = KeyFrom(seed), .other = {}};
}

Bytes MessageFrom(unsigned seed, std::size_t size) {
  std::mt19937 random(seed);
  Bytes message(size);
  for (std::uint8_t& byte : message) byte = static_cast<std::uint8_t>(random());
  return message;
}

Bytes Signed(Signer& signer, std::string_view channel, Bytes message) {
  signer.Sign(channel, message);
  return message;
}

TagState Open(Verifier& verifier, std::string_view channel, const Bytes& bytes, std::int64_t heard_us = WallClockUs()) {
  std::span<const std::uint8_t> view = bytes;
  return verifier.Open(channel, view, heard_us);
}

// EN-31: a good tag is removed, and the message is unchanged, at any length.
TEST(Authentication, LeavesTheMessageAsItWas) {
  Signer signer(KeyFrom(1));
  Verifier verifier(KeysFrom(1));
  for (const std::size_t size : {0u, 1u, 55u, 64u, 60u, 5000u}) {
    const Bytes message = MessageFrom(7, size);
    const Bytes bytes = Signed(signer, "takt/command", message);
    ASSERT_EQ(bytes.size(), size + kTagBytes);
    EXPECT_TRUE(HasTag(bytes));
    std::span<const std::uint8_t> view = bytes;
    EXPECT_EQ(verifier.Open("takt/command", view, WallClockUs()), TagState::kGood);
    EXPECT_TRUE(std::ranges::equal(view, message));
  }
}

// EN-31: a bit changed anywhere, in message, tag or channel, another key, or a truncated message: always refused.
TEST(Authentication, RefusesEveryChangedBit) {
  Signer signer(KeyFrom(1));
  Verifier verifier(KeysFrom(1)), other(KeysFrom(2));
  Bytes bytes = Signed(signer, "takt/heartbeat", MessageFrom(3, 90));
  EXPECT_EQ(Open(verifier, "takt/heartbeas", bytes), TagState::kForeign);
  EXPECT_EQ(Open(verifier, "takt/heartbeat/", bytes), TagState::kForeign);
  EXPECT_EQ(Open(other, "takt/heartbeat", bytes), TagState::kForeign);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    const TagState state = Open(verifier, "takt/heartbeat", bytes);
    EXPECT_TRUE(state == TagState::kForeign || state == TagState::kMissing) << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(Open(verifier, "takt/heartbeat", Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
              TagState::kGood);
  }
  EXPECT_EQ(Open(verifier, "takt/heartbeat", bytes), TagState::kGood);  // none of these used the counter
}

// EN-31: in any order and with any repetitions, each message is accepted at most once, and all within the window are.
TEST(Authentication, TakesEachMessageOnce) {
  std::mt19937 random(31);
  for (int round = 0; round < 20; ++round) {
    Signer signer(KeyFrom(1));
    Verifier verifier(KeysFrom(1));
    std::vector<Bytes> said;
    for (unsigned i = 0; i < 300; ++i) said.push_back(Signed(signer, "takt/command", MessageFrom(i, 20)));
    std::vector<int> taken(said.size(), 0);
    for (std::size_t begin = 0; begin < said.size(); begin += kWindow / 2) {  // out of order within half a window
      std::vector<std::size_t> some;
      for (std::size_t i = begin; i < std::min(said.size(), begin + kWindow / 2); ++i) some.insert(some.end(), 3, i);
      std::ranges::shuffle(some, random);
      for (const std::size_t i : some) taken[i] += Open(verifier, "takt/command", said[i]) == TagState::kGood;
    }
    for (const Bytes& bytes : said) EXPECT_EQ(Open(verifier, "takt/command", bytes), TagState::kReplayed);
    EXPECT_TRUE(std::ranges::all_of(taken, [](int times) { return times == 1; }));
  }
}

// EN-31: a message older than the window is refused, although it was never received.
TEST(Authentication, TakesNothingFromBehindTheWindow) {
  Signer signer(KeyFrom(1));
  Verifier verifier(KeysFrom(1));
  const Bytes late = Signed(signer, "takt/command", MessageFrom(1, 20));
  const Bytes edge = Signed(signer, "takt/command", MessageFrom(1, 20));
  for (std::uint64_t i = 0; i < kWindow - 1; ++i) {
    EXPECT_EQ(Open(verifier, "takt/command", Signed(signer, "takt/command", {})), TagState::kGood);
  }
  EXPECT_EQ(Open(verifier, "takt/command", edge), TagState::kGood);
  EXPECT_EQ(Open(verifier, "takt/command", late), TagState::kReplayed);
}

// EN-31: messages of another time are stale, even for a receiver that has received nothing from their sender.
TEST(Authentication, TakesNothingOfAnotherTime) {
  Signer signer(KeyFrom(1));
  const std::int64_t now = WallClockUs();
  for (const auto& [late_us, state] : {std::pair<std::int64_t, TagState>{0, TagState::kGood},
                                       {kFreshUs - 1'000'000, TagState::kGood},
                                       {-kFreshUs + 1'000'000, TagState::kGood},
                                       {kFreshUs + 1'000'000, TagState::kStale},
                                       {-kFreshUs - 1'000'000, TagState::kStale},
                                       {std::int64_t{1} << 62, TagState::kStale},
                                       {-now - 1, TagState::kStale}}) {
    Verifier verifier(KeysFrom(1));
    EXPECT_EQ(Open(verifier, "takt/machine", Signed(signer, "takt/machine", {1, 2, 3}), now + late_us), state)
        << late_us;
  }
}

// EN-31: while a key is being changed, senders with the old one and with the new one are accepted, each message once,
// with whichever key the sender tags; others are not. Sent messages have the first one's tag.
TEST(Authentication, AcceptsTwoKeysWhileOneIsChanged) {
  const Keys changing{.own = KeyFrom(1), .other = KeyFrom(2)};
  Verifier verifier(changing), old(KeysFrom(2)), made(KeysFrom(1));
  Signer with_new(KeyFrom(1)), with_old(KeyFrom(2)), foreign(KeyFrom(3)), both(changing.own);
  for (Signer* const signer : {&with_new, &with_old}) {
    const Bytes bytes = Signed(*signer, "takt/command", MessageFrom(1, 40));
    EXPECT_EQ(Open(verifier, "takt/command", bytes), TagState::kGood);
    EXPECT_EQ(Open(verifier, "takt/command", bytes), TagState::kReplayed);
    Bytes changed = Signed(*signer, "takt/command", MessageFrom(1, 40));
    changed[7] ^= 1;
    EXPECT_EQ(Open(verifier, "takt/command", changed), TagState::kForeign);
  }
  EXPECT_EQ(Open(verifier, "takt/command", Signed(foreign, "takt/command", {1})), TagState::kForeign);
  EXPECT_EQ(Open(made, "takt/command", Signed(both, "takt/command", {1})), TagState::kGood);
  EXPECT_EQ(Open(old, "takt/command", Signed(both, "takt/command", {1})), TagState::kForeign);
}

// EN-31: many senders, each with its own counters, are distinguished; forgetting some forgets no fresh counter.
TEST(Authentication, RemembersManySenders) {
  Verifier verifier(KeysFrom(1));
  std::vector<Bytes> said;
  for (int i = 0; i < 5000; ++i) {
    Signer signer(KeyFrom(1));
    said.push_back(Signed(signer, "takt/command", {1}));
    ASSERT_EQ(Open(verifier, "takt/command", said.back()), TagState::kGood);
  }
  for (const Bytes& bytes : said) EXPECT_NE(Open(verifier, "takt/command", bytes), TagState::kGood);
}

// EN-31: the tag as the header describes it, made with OpenSSL's one-shot function.
TEST(Authentication, IsAsDescribed) {
  const Key key = KeyFrom(9);
  const Bytes message = MessageFrom(4, 33);
  Bytes bytes = message;
  for (const char c : {'T', 'K', 'H', '1'}) bytes.push_back(static_cast<std::uint8_t>(c));
  const auto append = [&](std::uint64_t number) {
    for (int i = 7; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  };
  append(0xFEDCBA9876543210);
  append(5);
  append(static_cast<std::uint64_t>(WallClockUs()));
  Bytes authenticated{'t', 'a', 'k', 't', '/', 'd', 'r', 'i', 'v', 'e', '/', 'x', '/', 's', 0};
  authenticated.insert(authenticated.end(), bytes.begin(), bytes.end());
  std::array<std::uint8_t, 32> mac{};
  unsigned size = 0;
  ASSERT_NE(HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), authenticated.data(), authenticated.size(),
                 mac.data(), &size),
            nullptr);
  bytes.insert(bytes.end(), mac.begin(), mac.end());
  Verifier verifier({.own = key, .other = {}});
  std::span<const std::uint8_t> view = bytes;
  EXPECT_EQ(verifier.Open("takt/drive/x/s", view, WallClockUs()), TagState::kGood);
  EXPECT_TRUE(std::ranges::equal(view, message));
}

// EN-31: each reason is counted, and reported once.
TEST(Authentication, CountsAndSaysEachReasonOnce) {
  std::vector<std::string> said;
  Authentication authentication(KeysFrom(1), [&](const std::string& sentence) { said.push_back(sentence); });
  for (int i = 0; i < 3; ++i) authentication.Refuse("takt/command", TagState::kMissing);
  authentication.Refuse("takt/heartbeat", TagState::kReplayed);
  EXPECT_EQ(authentication.refused(TagState::kMissing), 3u);
  EXPECT_EQ(authentication.refused(TagState::kReplayed), 1u);
  EXPECT_EQ(authentication.refused(TagState::kForeign), 0u);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("takt/command"), std::string::npos);
  EXPECT_NE(said[0].find("no authentication tag"), std::string::npos);
}

}  // namespace
}  // namespace takt::lcm
