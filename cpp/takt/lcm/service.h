// Everything that makes an engine reachable over LCM: network, clients, gateway, publisher, log file.
#pragma once

#include <memory>
#include <string>

#include "takt/engine/engine.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/clients.h"
#include "takt/lcm/gateway.h"
#include "takt/lcm/network.h"
#include "takt/lcm/outlet.h"
#include "takt/lcm/publisher.h"
#include "takt/lcm/receiver.h"

namespace takt::lcm {

struct Losses {
  std::uint64_t messages = 0;  // messages that the network or the log did not accept
  bool log = false;            // the log is incomplete
};

struct ServiceOptions {
  std::string url{};       // empty: no network
  std::string log_path{};  // empty: no log
  RunInfo info{};
  std::shared_ptr<Authentication> authentication{};  // null: no key, any process on the network may command
  Clients::Explain explain = engine::Sentence;
};

class Service {
 public:
  // Serves from now on. Requires: the engine outlives this object, and its cycle has ended before it is destroyed.
  // Returns null, and one line in `problem`, if the network cannot be joined, or the log cannot be written or is an
  // existing file that is no log.
  static std::unique_ptr<Service> Open(engine::Engine& engine, const ServiceOptions& options, std::string& problem);

  // Publishes the remaining queue entries and closes the log; waits until the log is written.
  Losses Close();

 private:
  Service(engine::Engine& engine, const ServiceOptions& options);

  const std::shared_ptr<Authentication> authentication_;
  Clients clients_;
  // Two members of the same network, so that sending and receiving do not wait for each other.
  Network sending_;
  std::unique_ptr<Receiver> receiving_;
  std::unique_ptr<NetworkOutlet> network_;
  std::unique_ptr<LogOutlet> log_;
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<Gateway> gateway_;
};

}  // namespace takt::lcm
