#include "takt/lcm/gateway.h"

#include <span>

#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {
namespace {

// Messages. LCM's own default of 30 loses commands given at 100 times the cycle's rate.
constexpr int kQueueCapacity = 10'000;
constexpr int kWaitMs = 50;  // between looks at stop_

std::span<const std::uint8_t> Bytes(const ::lcm::ReceiveBuffer* received) {
  return {static_cast<const std::uint8_t*>(received->data), received->data_size};
}

}  // namespace

Gateway::Gateway(::lcm::LCM& network, Clients& clients) : network_(network) {
  subscriptions_[0] = network_.subscribeFunction(kCommandChannel, &Gateway::OnCommand, &clients);
  subscriptions_[1] = network_.subscribeFunction(kHeartbeatChannel, &Gateway::OnHeartbeat, &clients);
  for (::lcm::Subscription* subscription : subscriptions_) subscription->setQueueCapacity(kQueueCapacity);
  thread_ = std::thread([this] { Listen(); });
}

Gateway::~Gateway() {
  stop_ = true;
  thread_.join();
  for (::lcm::Subscription* subscription : subscriptions_) network_.unsubscribe(subscription);
}

void Gateway::Listen() {
  while (!stop_) network_.handleTimeout(kWaitMs);
}

void Gateway::OnCommand(const ::lcm::ReceiveBuffer* received, const std::string&, Clients* clients) {
  if (const auto message = DecodeCommand(Bytes(received))) {
    clients->OnCommand(*message, SteadyNs());
  } else {
    clients->OnMalformed();
  }
}

void Gateway::OnHeartbeat(const ::lcm::ReceiveBuffer* received, const std::string&, Clients* clients) {
  if (const auto message = DecodeHeartbeat(Bytes(received))) {
    clients->OnHeartbeat(*message, SteadyNs());
  } else {
    clients->OnMalformed();
  }
}

}  // namespace takt::lcm
