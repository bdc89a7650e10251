// Joins an LCM network, or says in one sentence why it cannot be joined.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

namespace takt::lcm {

struct Network {
  std::unique_ptr<::lcm::LCM> lcm;  // null: see problem
  std::string problem;              // one line; empty if `lcm` is set
};

// Returns why this cannot be the URL of an LCM network, in one line; empty if it can.
std::string WhyNotUrl(const std::string& url);

// Joins for sending: "udpm://239.255.76.67:7667?ttl=0"; also tcpq:// and memq://. OpenReceiver is for receiving.
Network OpenNetwork(const std::string& url);

}  // namespace takt::lcm
