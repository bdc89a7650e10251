// The receiver of udpm:// networks; see receiver.h.
#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "takt/lcm/receiver.h"

namespace takt::lcm {

struct UdpAddress {
  in_addr group{};
  std::uint16_t port = 0;
  bool this_host_only = true;  // ttl 0
  int buffer = 4 << 20;        // [bytes] socket buffer, as far as the system allows
};
// Parses "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000000"; returns nothing if it is no such URL.
std::optional<UdpAddress> ParseUdp(const std::string& url);

// Returns null on failure; errno says why.
std::unique_ptr<Receiver> OpenUdpReceiver(const UdpAddress& address);

}  // namespace takt::lcm
