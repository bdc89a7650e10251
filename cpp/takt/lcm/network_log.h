// Logs an LCM network without gaps. lcm-logger queues 30 messages and drops the others (1.3.1 and 1.5), so its logs
// have gaps on a busy host.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "takt/lcm/network.h"
#include "takt/lcm/outlet.h"
#include "takt/lcm/receiver.h"

namespace takt::lcm {

class NetworkLog {
 public:
  // Listens at once, on its own thread. An existing log is kept under another name; any other existing file is left
  // unchanged. Returns null, and one line in `problem`, on failure.
  static std::unique_ptr<NetworkLog> Open(const std::string& url, const std::string& path, std::string& problem);
  // Closes the log, unless Close was called, without waiting for messages that are still to be written.
  ~NetworkLog();

  // Ends the log when all messages sent before the call are written, or after `patience`; if the file blocks, not
  // before it accepts them. Returns false if `patience` was not enough, the network broke meanwhile, or the file is
  // incomplete.
  bool Close(std::chrono::milliseconds patience);

 private:
  NetworkLog(Network network, std::unique_ptr<Receiver> receiver, std::unique_ptr<LogOutlet> log);
  void Hear(const Heard& heard);
  void End();

  Network network_;  // sends the end marker
  std::unique_ptr<Receiver> receiver_;
  std::unique_ptr<LogOutlet> log_;  // used by the thread while it runs
  const std::string last_;          // channel of the end marker
  std::atomic<bool> heard_all_{false};
  std::atomic<bool> broken_{false};
  std::atomic<bool> stop_{false};
  bool complete_ = false;
  std::thread thread_;
};

}  // namespace takt::lcm
