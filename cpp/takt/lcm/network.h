// Joins an LCM network, or says in one sentence why not.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

namespace takt::lcm {

struct Network {
  std::unique_ptr<::lcm::LCM> lcm;  // null: see problem
  std::string problem;              // one line
};

// Why this cannot be the URL of an LCM network, in one line; empty: it can.
std::string WhyNotUrl(const std::string& url);

// "udpm://239.255.76.67:7667?ttl=0"; also tcpq:// and memq://.
Network OpenNetwork(const std::string& url);

// Handles what has come, or comes within `wait_ms`: how many messages. Below 0: the server of a tcpq:// network is
// gone. LCM's own handle() then ends the program the next time; this just waits.
int Handle(::lcm::LCM& network, int wait_ms);

}  // namespace takt::lcm
