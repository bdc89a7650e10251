// Keys (EN-31): with a key, messages that command, keep alive, drive or describe carry an authentication tag, and those
// without a good one are counted and ignored.
//
// The tag follows the message, where decoders of LCM do not look: "TKH1"; then eight bytes each, the highest first: the
// sender's random number, its counter, its wall clock [us]; then HMAC-SHA-256 (RFC 2104, by OpenSSL) with the key over
// the channel's name, a zero, the message and the tag so far. Commands, heartbeats, descriptions and messages of drives
// name the start of the engine they belong to (run_id), which the tag thereby covers.
//
// Replay protection follows IPsec (RFC 4303, 3.4.3): a receiver takes each counter of a sender once, in a window of
// kWindow behind the newest, since the threads of a sender may overtake one another; and, as MAVLink 2 message signing
// does, no message whose clock differs from that of its arrival by more than kFreshUs. A sender that was forgotten has
// sent nothing for that long, so that what it had sent is stale. The clock is no part of the counter: a clock that is
// set back does not silence a sender. While a key is changed, a second one is accepted; counters are the sender's,
// whichever of the two it tags with.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/lcm/key.h"
#include "takt/lcm/receiver.h"

namespace takt::lcm {

inline constexpr std::size_t kTagBytes = 4 + 3 * 8 + 32;
inline constexpr std::int64_t kFreshUs = 2'000'000;
inline constexpr std::uint64_t kWindow = 64;  // counters

// With a key, the messages of this channel carry a tag: commands, heartbeats, feedback, the engine's description and
// figures, drives. States of components are open.
bool IsTaggedChannel(std::string_view channel);
// These bytes end like a tag; Verifier finds out whether it is good.
bool HasTag(std::span<const std::uint8_t> bytes);

enum class TagState : std::uint8_t {
  kGood,
  kMissing,
  kForeign,   // made with another key, or the message was changed
  kReplayed,  // this counter was heard before
  kStale,     // its clock differs by more than kFreshUs from the receiver's
};
inline constexpr std::size_t kTagStates = 5;
// What is wrong, for people.
std::string_view Text(TagState state);

class Mac;

// Tags the messages of one sender. Any thread.
class Signer {
 public:
  // Throws std::runtime_error where OpenSSL offers no HMAC-SHA-256, as Verifier does.
  explicit Signer(const Key& key);
  ~Signer();
  // Appends a tag.
  void Sign(std::string_view channel, std::vector<std::uint8_t>& message);

 private:
  const std::uint64_t sender_;
  std::mutex mutex_;
  const std::unique_ptr<Mac> mac_;
  std::uint64_t counter_ = 0;
};

// Checks the tags of what one receiver hears. One thread at a time.
class Verifier {
 public:
  explicit Verifier(const Keys& keys);
  ~Verifier();
  // Takes a good tag off the end of `bytes`, which came at `heard_us` by the wall clock.
  TagState Open(std::string_view channel, std::span<const std::uint8_t>& bytes, std::int64_t heard_us);

 private:
  struct Sender {
    std::uint64_t newest = 0;  // counter
    std::uint64_t taken = 0;   // bit i: newest - i
    std::int64_t utime = 0;    // of the newest, by the sender's clock
  };
  static bool Take(Sender& sender, std::uint64_t counter);

  std::vector<std::unique_ptr<Mac>> macs_;  // one for each key
  std::map<std::uint64_t, Sender> senders_;
};

// The keys of an engine, and what was ignored for want of a good tag. Any thread.
class Authentication {
 public:
  using Complain = std::function<void(const std::string& sentence)>;
  // `complain` takes a sentence the first time for each reason.
  explicit Authentication(
      const Keys& keys, Complain complain = [](const std::string&) {});

  const Keys& keys() const { return keys_; }
  // A message of this channel was ignored.
  void Refuse(std::string_view channel, TagState state);
  // How many were, so far.
  std::uint64_t refused(TagState state) const;

 private:
  const Keys keys_;
  const Complain complain_;
  std::array<std::atomic<std::uint64_t>, kTagStates> refused_{};
};

// Called for each message that is refused.
using OnRefused = std::function<void(std::string_view channel, TagState state)>;
// Hears the same as `receiver`; of tagged channels only messages with a good tag, without it.
std::unique_ptr<Receiver> WithKey(std::unique_ptr<Receiver> receiver, const Keys& keys, OnRefused refused);

}  // namespace takt::lcm
