#include "takt/lcm/network.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "takt/core/problem.h"
#include "takt/lcm/udp_receiver.h"

namespace takt::lcm {
namespace {

// LCM itself would print a page of advice to stderr.
bool HasRoute(const UdpAddress& network) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = network.group;
  address.sin_port = htons(network.port);
  const int probe = socket(AF_INET, SOCK_DGRAM, 0);
  if (probe < 0) return false;
  const bool reached = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return reached;
}

}  // namespace

std::string WhyNotUrl(const std::string& url) {
  const bool good = ParseUdp(url) || url.starts_with("tcpq://") || url.starts_with("memq://");
  return good ? "" : "LCM URL " + Quoted(url) + ": expected one like udpm://239.255.76.67:7667?ttl=0";
}

Network OpenNetwork(const std::string& url) {
  if (std::string problem = WhyNotUrl(url); !problem.empty()) return {nullptr, std::move(problem)};
  if (const std::optional<UdpAddress> address = ParseUdp(url); address && !HasRoute(*address)) {
    return {nullptr, "LCM network " + url + " is not reachable (" + std::strerror(errno) +
                         "); with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo"};
  }
  Network network{std::make_unique<::lcm::LCM>(url), {}};
  // Nothing may make this member read on UDP: getFileno() alone would (receiver.h).
  if (!network.lcm->good()) {
    return {nullptr,
            "LCM network " + url +
                " cannot be joined; with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo"};
  }
  return network;
}

}  // namespace takt::lcm
