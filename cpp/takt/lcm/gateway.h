// Commands and heartbeats from the network (EN-22, EN-23), on a thread of its own.
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
  void OnCommand(const ::lcm::ReceiveBuffer* received, const std::string& channel);
  void OnHeartbeat(const ::lcm::ReceiveBuffer* received, const std::string& channel);
  void Listen();

  ::lcm::LCM& network_;
  Clients& clients_;
  ::lcm::Subscription* subscriptions_[2];
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::lcm
