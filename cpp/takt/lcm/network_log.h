// Writes down what is said on an LCM network, without gaps: what lcm-logger is for, but that holds 30 messages which it
// has not got to and forgets the others (1.3.1 and 1.5), so a busy host makes holes in what it writes.
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
  // Listens at once, on a thread of its own. A log that is there is kept under another name; anything else that is
  // there is left as it is. Null: `problem` says why, in one line.
  static std::unique_ptr<NetworkLog> Open(const std::string& url, const std::string& path, std::string& problem);
  // Closes it, if nobody has, without waiting for what is still to be written.
  ~NetworkLog();

  // Ends it when all that was said before the call is written, or after `patience`; where the file itself takes
  // nothing, not before that does. False: that was not enough, the network broke meanwhile, or the file is incomplete.
  bool Close(std::chrono::milliseconds patience);

 private:
  NetworkLog(Network network, std::unique_ptr<Receiver> receiver, std::unique_ptr<LogOutlet> log);
  void Hear(const Heard& heard);
  void End();

  Network network_;  // for the last word
  std::unique_ptr<Receiver> receiver_;
  std::unique_ptr<LogOutlet> log_;  // of the thread, while that runs
  const std::string last_;          // the channel of the last word
  std::atomic<bool> heard_all_{false};
  std::atomic<bool> broken_{false};
  std::atomic<bool> stop_{false};
  bool complete_ = false;
  std::thread thread_;
};

}  // namespace takt::lcm
