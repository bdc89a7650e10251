#include "takt/lcm/receiver.h"

#include <chrono>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

#include "takt/lcm/network.h"
#include "takt/lcm/udp_receiver.h"

namespace takt::lcm {
namespace {

class LcmReceiver : public Receiver {
 public:
  explicit LcmReceiver(::lcm::LCM& network) : network_(network) {}
  explicit LcmReceiver(std::unique_ptr<::lcm::LCM> network) : owned_(std::move(network)), network_(*owned_) {}
  ~LcmReceiver() override {
    while (!subscriptions_.empty()) Unsubscribe(subscriptions_.begin()->first);
  }

  int Subscribe(const std::string& channels, std::size_t capacity, Handler handler) override {
    auto own = std::make_unique<Handler>(std::move(handler));
    ::lcm::Subscription* subscription = network_.subscribeFunction(channels, &LcmReceiver::OnMessage, own.get());
    subscription->setQueueCapacity(static_cast<int>(capacity));
    subscriptions_[++last_number_] = {subscription, std::move(own)};
    return last_number_;
  }

  void Unsubscribe(int number) override {
    const auto found = subscriptions_.find(number);
    if (found == subscriptions_.end()) return;
    network_.unsubscribe(found->second.subscription);
    subscriptions_.erase(found);
  }

  void SetCapacity(int number, std::size_t capacity) override {
    subscriptions_.at(number).subscription->setQueueCapacity(static_cast<int>(capacity));
  }

  int Handle(int wait_ms) override {
    if (network_.getFileno() >= 0) return network_.handleTimeout(wait_ms);
    // The server of a tcpq:// network is lost: LCM's own handle() would end the program.
    std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    return -1;
  }

  int file() const override { return network_.getFileno(); }
  std::uint64_t malformed() const override { return 0; }

 private:
  struct Subscribed {
    ::lcm::Subscription* subscription = nullptr;
    std::unique_ptr<Handler> handler;
  };
  // A plain function: GCC 12's undefined-behaviour sanitizer breaks LCM's calls of member functions.
  static void OnMessage(const ::lcm::ReceiveBuffer* received, const std::string& channel, Handler* handler) {
    (*handler)(
        {channel, {static_cast<const std::uint8_t*>(received->data), received->data_size}, received->recv_utime});
  }

  const std::unique_ptr<::lcm::LCM> owned_;
  ::lcm::LCM& network_;
  std::map<int, Subscribed> subscriptions_;
  int last_number_ = 0;
};

}  // namespace

std::unique_ptr<Receiver> ReceiverOf(::lcm::LCM& network) {
  return std::make_unique<LcmReceiver>(network);
}

std::unique_ptr<Receiver> OpenReceiver(const std::string& url, ::lcm::LCM& network, std::string& problem) {
  std::unique_ptr<Receiver> receiver;
  if (const std::optional<UdpAddress> address = ParseUdp(url)) {
    receiver = OpenUdpReceiver(*address);
  } else if (network.getFileno() >= 0) {  // otherwise LCM sends but cannot receive
    receiver = ReceiverOf(network);
  }
  if (!receiver) {
    problem = "LCM network " + url + " cannot be joined (" + std::strerror(errno) +
              "); with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo";
  }
  return receiver;
}

std::unique_ptr<Receiver> OpenReceiver(const std::string& url, std::string& problem) {
  Network network = OpenNetwork(url);
  problem = network.problem;
  if (!network.lcm) return nullptr;
  if (ParseUdp(url) || network.lcm->getFileno() < 0) return OpenReceiver(url, *network.lcm, problem);
  return std::make_unique<LcmReceiver>(std::move(network.lcm));
}

}  // namespace takt::lcm
