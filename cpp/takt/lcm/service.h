// Everything an engine needs to be reached over LCM: network, clients, gateway, publisher, log file.
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
  std::uint64_t messages = 0;  // that the network or the log did not take
  bool log = false;            // the log is incomplete
};

struct ServiceOptions {
  std::string url{};       // empty: no network
  std::string log_path{};  // empty: no log
  RunInfo info{};
  std::shared_ptr<Authentication> authentication{};  // null: no key, anyone on the network may command
  Clients::Explain explain = engine::Sentence;
};

class Service {
 public:
  // Serves from now on. Requires: the engine outlives it, and its cycle has ended before this is destroyed. Null, and
  // `problem` says in one line why, when the network cannot be joined or the log cannot be written, or is a file that
  // is no log.
  static std::unique_ptr<Service> Open(engine::Engine& engine, const ServiceOptions& options, std::string& problem);

  // Publishes what is still queued and closes the log. Takes as long as the log takes to be written.
  Losses Close();

 private:
  Service(engine::Engine& engine, const ServiceOptions& options);

  const std::shared_ptr<Authentication> authentication_;
  Clients clients_;
  // Two members of the same network: sending and receiving do not wait for each other.
  Network sending_;
  std::unique_ptr<Receiver> receiving_;
  std::unique_ptr<NetworkOutlet> network_;
  std::unique_ptr<LogOutlet> log_;
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<Gateway> gateway_;
};

}  // namespace takt::lcm
