// Commands and heartbeats from the network (EN-22, EN-23), on a thread of its own. Another engine on the same network
// is said in one line on stderr: nobody can tell the two engines' states from one another.
#pragma once

#include <atomic>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <thread>

#include "takt/lcm/clients.h"

namespace takt::lcm {

class Gateway {
 public:
  // Listens from now on. Both must outlive this; nobody else calls handle() of `network`.
  Gateway(::lcm::LCM& network, Clients& clients);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

 private:
  // Plain functions: GCC 12's undefined-behaviour sanitizer breaks LCM's calls of member functions.
  static void OnCommand(const ::lcm::ReceiveBuffer* received, const std::string& channel, Clients* clients);
  static void OnHeartbeat(const ::lcm::ReceiveBuffer* received, const std::string& channel, Clients* clients);
  static void OnMachine(const ::lcm::ReceiveBuffer* received, const std::string& channel, Gateway* gateway);
  void Listen();

  ::lcm::LCM& network_;
  const Clients& clients_;
  ::lcm::Subscription* subscriptions_[3];
  bool met_another_engine_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::lcm
