// Receives the messages of an LCM network.
//
// On UDP this is our own receiver instead of liblcm's, whose reassembly trusts offset and size of fragments and writes
// where they point (1.3.1 and 1.5.3): one datagram ends the program. Messages are sent by liblcm. It receives only
// datagrams to the group's address, none that is sent to this host itself; and with ttl 0, which is the default, only
// those sent on this host (EN-25, EN-30): the sender's address must be one of this host's, which the kernel does not
// accept from outside.
#pragma once

#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <span>
#include <string>

namespace takt::lcm {

struct Heard {
  const std::string& channel;
  std::span<const std::uint8_t> data;
  std::int64_t utime = 0;  // [us] wall clock: arrival at this host
};

class Receiver {
 public:
  using Handler = std::function<void(const Heard&)>;
  static constexpr std::size_t kAll = 0;

  virtual ~Receiver() = default;
  // Receives the channels that this regular expression matches as a whole, from now on; returns the subscription's
  // number. If more than `capacity` messages wait (kAll: limited by memory only), the newest are dropped.
  virtual int Subscribe(const std::string& channels, std::size_t capacity, Handler handler) = 0;
  virtual void Unsubscribe(int subscription) = 0;
  virtual void SetCapacity(int subscription, std::size_t capacity) = 0;
  // Handles one message that has arrived, or arrives within `wait_ms`; returns 1, or 0 if there was none. Below 0: the
  // network is lost; it has waited.
  virtual int Handle(int wait_ms) = 0;
  // Returns a file descriptor that is readable while messages wait.
  virtual int file() const = 0;
  // Returns the number of datagrams that were no LCM packets, or came from elsewhere while only this host is accepted.
  virtual std::uint64_t malformed() const = 0;
};

// Returns a receiver for a network that liblcm reads: memq:// and tcpq://. `network` must outlive it.
std::unique_ptr<Receiver> ReceiverOf(::lcm::LCM& network);

// Returns null, and one line in `problem`, if the network cannot be joined. Messages of memq:// and tcpq:// are
// received through `network`, a member of the same network, which must outlive the receiver; without it, through a
// member of its own.
std::unique_ptr<Receiver> OpenReceiver(const std::string& url, ::lcm::LCM& network, std::string& problem);
std::unique_ptr<Receiver> OpenReceiver(const std::string& url, std::string& problem);

}  // namespace takt::lcm
