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

// For sending: "udpm://239.255.76.67:7667?ttl=0"; also tcpq:// and memq://. What is said there hears OpenReceiver.
Network OpenNetwork(const std::string& url);

}  // namespace takt::lcm
