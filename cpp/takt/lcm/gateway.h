// Commands and heartbeats from the network (EN-22, EN-23), on a thread of its own. Another engine on the same network
// is said in one line on stderr: nobody can tell the two engines' states from one another.
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
  // Listens from now on. Both must outlive this; nobody else uses `network`.
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
  std::uint64_t malformed_ = 0;  // datagrams, as counted last
  bool met_another_engine_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::lcm
