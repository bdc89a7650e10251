// Safe reassembly of LCM's UDP packets (EN-30): the fields of a datagram are checked before they are used, and the
// memory for unfinished messages is bounded. The format is that of LCM's documentation ("UDP Multicast Protocol
// Description"): short messages (LC02) in one datagram, long ones (LC03) in fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace takt::lcm {

inline constexpr std::size_t kLongestChannel = 63;                // [bytes] as in LCM
inline constexpr std::size_t kLongestMessage = 16 * 1024 * 1024;  // [bytes] longer ones are malformed

class Reassembly {
 public:
  struct Limits {
    std::size_t messages = 64;             // unfinished ones; the one without new fragments for longest is dropped
    std::size_t bytes = 64 * 1024 * 1024;  // total of all unfinished ones
  };
  struct Message {
    std::string channel;
    std::vector<std::uint8_t> data;
  };

  Reassembly() = default;
  explicit Reassembly(const Limits& limits) : limits_(limits) {}

  // Returns the message that this datagram completes; nothing if it completes none. `sender` distinguishes sockets.
  std::optional<Message> Take(std::uint64_t sender, std::span<const std::uint8_t> datagram);

  // Number of datagrams that were no LCM packets, and of messages whose fragments do not fit together.
  std::uint64_t malformed() const { return malformed_; }
  // Number of messages that were dropped before all their fragments arrived.
  std::uint64_t unfinished() const { return unfinished_; }
  std::size_t held_bytes() const { return held_; }

 private:
  struct Key {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;
    auto operator<=>(const Key&) const = default;
  };
  struct Piece {
    std::uint32_t offset = 0;
    std::vector<std::uint8_t> data;
  };
  struct Partial {
    Key key;
    std::uint32_t size = 0;                 // [bytes] of the whole message
    std::uint16_t fragments = 0;            // of the whole message
    std::string channel;                    // from fragment 0
    std::map<std::uint16_t, Piece> pieces;  // by fragment number
    std::size_t held = 0;                   // [bytes] including overhead
  };
  using Partials = std::list<Partial>;  // the one without new fragments for longest first

  std::optional<Message> TakeShort(std::span<const std::uint8_t> packet);
  std::optional<Message> TakeFragment(std::uint64_t sender, std::span<const std::uint8_t> packet);
  // Joins the pieces, which must be contiguous from 0 to the end.
  std::optional<Message> Join(Partial& partial);
  void Drop(Partials::iterator partial);
  std::nullopt_t Malformed();

  const Limits limits_{};
  Partials partials_;
  std::map<Key, Partials::iterator> by_key_;
  std::size_t held_ = 0;
  std::uint64_t malformed_ = 0;
  std::uint64_t unfinished_ = 0;
};

}  // namespace takt::lcm
