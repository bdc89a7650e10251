// Hears what is said on an LCM network.
//
// On UDP this is a receiver of our own instead of liblcm's, whose reassembly believes what fragments say of offset and
// size and writes where they point (1.3.1 and 1.5.3): one datagram ends the program. Messages are sent by liblcm.
// It hears the group's address alone, so no datagram that is sent to this host itself; and with ttl 0, which is the
// default, only what was sent on this host (EN-25, EN-30): the sender's address must be one of this host's, which the
// kernel does not accept from outside.
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
  std::int64_t utime = 0;  // us, wall clock: when it came to this host
};

class Receiver {
 public:
  using Handler = std::function<void(const Heard&)>;
  static constexpr std::size_t kAll = 0;

  virtual ~Receiver() = default;
  // Hears the channels that this regular expression matches as a whole, from now on; returns the subscription's number.
  // Of more than `capacity` messages that wait (kAll: as many as memory is meant for) the newest are dropped.
  virtual int Subscribe(const std::string& channels, std::size_t capacity, Handler handler) = 0;
  virtual void Unsubscribe(int subscription) = 0;
  virtual void SetCapacity(int subscription, std::size_t capacity) = 0;
  // Handles one message that has come, or comes within `wait_ms`: 1, or 0. Below 0: the network is gone; it has waited.
  virtual int Handle(int wait_ms) = 0;
  // Readable while messages wait.
  virtual int file() const = 0;
  // Datagrams that were none of LCM's, or from elsewhere where only this host is heard.
  virtual std::uint64_t malformed() const = 0;
};

// Messages of a network that liblcm reads: memq:// and tcpq://. `network` must outlive this.
std::unique_ptr<Receiver> ReceiverOf(::lcm::LCM& network);

// Null, and `problem` says in one line why, when the network cannot be joined. What is heard on memq:// and tcpq://
// comes through `network`, a member of the same network, which must outlive the receiver; or through a member of its
// own.
std::unique_ptr<Receiver> OpenReceiver(const std::string& url, ::lcm::LCM& network, std::string& problem);
std::unique_ptr<Receiver> OpenReceiver(const std::string& url, std::string& problem);

}  // namespace takt::lcm
