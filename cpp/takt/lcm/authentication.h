// Keys (EN-31): with a key, messages that command, keep alive, drive or describe carry an authentication tag, and those
// without a valid one are counted and ignored.
//
// The tag follows the message, where LCM decoders do not read: "TKH1"; then, as eight big-endian bytes each, the
// sender's random number, its counter, its wall clock [us]; then HMAC-SHA-256 (RFC 2104, by OpenSSL) with the key over
// the channel's name, a zero, the message and the tag so far. Commands, heartbeats, descriptions and messages of drives
// contain the run of the engine that they belong to (run_id), which the tag thereby covers.
//
// Replay protection follows IPsec (RFC 4303, 3.4.3): a receiver accepts each counter of a sender once, in a window of
// kWindow behind the newest, since the threads of a sender may overtake one another; and, as in MAVLink 2 message
// signing, no message whose clock differs from that of its arrival by more than kFreshUs. A sender that was forgotten
// has sent nothing for that long, so its earlier messages are stale. The clock is not part of the counter: a clock that
// is set back does not silence a sender. While a key is being changed, a second one is accepted; counters belong to the
// sender, with whichever of the two keys it tags.
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

// Returns true if messages of this channel carry a tag when there is a key: commands, heartbeats, feedback, the
// engine's description and figures, drives. States of components are not tagged.
bool IsTaggedChannel(std::string_view channel);
// Returns true if these bytes end like a tag; Verifier checks whether it is valid.
bool HasTag(std::span<const std::uint8_t> bytes);

enum class TagState : std::uint8_t {
  kGood,
  kMissing,
  kForeign,   // made with another key, or the message was changed
  kReplayed,  // this counter was received before
  kStale,     // its clock differs by more than kFreshUs from the receiver's
};
inline constexpr std::size_t kTagStates = 5;
// Returns what is wrong, for users; empty for kGood.
std::string_view Text(TagState state);

class Mac;

// Tags the messages of one sender. Thread-safe.
class Signer {
 public:
  // Throws std::runtime_error if OpenSSL offers no HMAC-SHA-256, as Verifier does.
  explicit Signer(const Key& key);
  ~Signer();
  // Appends a tag to the message.
  void Sign(std::string_view channel, std::vector<std::uint8_t>& message);

 private:
  const std::uint64_t sender_;
  std::mutex mutex_;
  const std::unique_ptr<Mac> mac_;
  std::uint64_t counter_ = 0;
};

// Checks the tags of the messages of one receiver. One thread at a time.
class Verifier {
 public:
  explicit Verifier(const Keys& keys);
  ~Verifier();
  // Checks the tag, and removes it from the end of `bytes` if it is good. `heard_us`: arrival by the wall clock.
  TagState Open(std::string_view channel, std::span<const std::uint8_t>& bytes, std::int64_t heard_us);

 private:
  struct Sender {
    std::uint64_t newest = 0;  // counter
    std::uint64_t taken = 0;   // bit i: counter newest - i was received
    std::int64_t utime = 0;    // of the newest message, by the sender's clock
  };
  static bool Take(Sender& sender, std::uint64_t counter);

  std::vector<std::unique_ptr<Mac>> macs_;  // one for each key
  std::map<std::uint64_t, Sender> senders_;
};

// The keys of an engine, and the counts of messages ignored for lack of a good tag. Thread-safe.
class Authentication {
 public:
  using Complain = std::function<void(const std::string& sentence)>;
  // `complain` receives a sentence the first time for each reason.
  explicit Authentication(
      const Keys& keys, Complain complain = [](const std::string&) {});

  const Keys& keys() const { return keys_; }
  // Counts an ignored message of this channel.
  void Refuse(std::string_view channel, TagState state);
  // Returns the number of messages ignored for this reason so far.
  std::uint64_t refused(TagState state) const;

 private:
  const Keys keys_;
  const Complain complain_;
  std::array<std::atomic<std::uint64_t>, kTagStates> refused_{};
};

// Called for each refused message.
using OnRefused = std::function<void(std::string_view channel, TagState state)>;
// Returns a receiver that passes on the messages of `receiver`; of tagged channels only those with a good tag, without
// the tag.
std::unique_ptr<Receiver> WithKey(std::unique_ptr<Receiver> receiver, const Keys& keys, OnRefused refused);

}  // namespace takt::lcm
