#include "takt/lcm/network.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "takt/core/problem.h"

namespace takt::lcm {
namespace {

bool ParseMulticast(std::string_view url, sockaddr_in& address) {
  url.remove_prefix(std::string_view("udpm://").size());
  url = url.substr(0, url.find('?'));
  const std::size_t colon = url.find(':');
  if (colon == std::string_view::npos) return false;
  const std::string_view port_text = url.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(port_text.data(), port_text.data() + port_text.size(), port);
  if (error != std::errc{} || end != port_text.data() + port_text.size() || port == 0) return false;
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  return inet_pton(AF_INET, std::string(url.substr(0, colon)).c_str(), &address.sin_addr) == 1 &&
         IN_MULTICAST(ntohl(address.sin_addr.s_addr));
}

// LCM itself answers the same question with a page of advice on stderr.
bool HasRoute(const sockaddr_in& address) {
  const int probe = socket(AF_INET, SOCK_DGRAM, 0);
  if (probe < 0) return false;
  const bool reached = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return reached;
}

}  // namespace

std::string WhyNotUrl(const std::string& url) {
  sockaddr_in address{};
  const bool good = url.starts_with("udpm://") ? ParseMulticast(url, address)
                                               : url.starts_with("tcpq://") || url.starts_with("memq://");
  return good ? "" : "LCM URL " + Quoted(url) + ": expected one like udpm://239.255.76.67:7667?ttl=0";
}

Network OpenNetwork(const std::string& url) {
  if (std::string problem = WhyNotUrl(url); !problem.empty()) return {nullptr, std::move(problem)};
  sockaddr_in address{};
  if (url.starts_with("udpm://") && ParseMulticast(url, address)) {
    if (!HasRoute(address)) {
      return {nullptr, "LCM network " + url + " is not reachable (" + std::strerror(errno) +
                           "); with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo"};
    }
  }
  Network network{std::make_unique<::lcm::LCM>(url), {}};
  // Without a file descriptor LCM sends but cannot receive, and its handle() aborts.
  if (!network.lcm->good() || network.lcm->getFileno() < 0) {
    return {nullptr,
            "LCM network " + url +
                " cannot be joined; with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo"};
  }
  return network;
}

int Handle(::lcm::LCM& network, int wait_ms) {
  if (network.getFileno() >= 0) return network.handleTimeout(wait_ms);
  std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
  return -1;
}

}  // namespace takt::lcm
