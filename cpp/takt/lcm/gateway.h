// Receives commands and heartbeats from the network (EN-22, EN-23), on its own thread. Another engine on the same
// network is reported in one line on stderr: clients cannot distinguish the states of the two engines.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "takt/lcm/clients.h"
#include "takt/lcm/receiver.h"

namespace takt::lcm {

class Gateway {
 public:
  // Listens from now on. Both must outlive this object; nothing else may use `network`.
  Gateway(Receiver& network, Clients& clients);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

 private:
  void OnCommand(const Heard& heard);
  void OnHeartbeat(const Heard& heard);
  void OnMachine(const Heard& heard);
  void Listen();

  Receiver& network_;
  Clients& clients_;
  std::vector<int> subscriptions_;
  std::uint64_t malformed_ = 0;  // datagrams, at the last check
  bool met_another_engine_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::lcm
