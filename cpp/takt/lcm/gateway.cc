#include "takt/lcm/gateway.h"

#include <cstdio>
#include <span>

#include "takt/core/problem.h"
#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/messages.h"
#include "takt/lcm/network.h"

namespace takt::lcm {
namespace {

// Messages. LCM's own default of 30 loses commands given at 100 times the cycle's rate.
constexpr int kQueueCapacity = 10'000;
constexpr int kWaitMs = 50;  // between looks at stop_

std::span<const std::uint8_t> Bytes(const ::lcm::ReceiveBuffer* received) {
  return {static_cast<const std::uint8_t*>(received->data), received->data_size};
}

}  // namespace

Gateway::Gateway(::lcm::LCM& network, Clients& clients) : network_(network), clients_(clients) {
  subscriptions_[0] = network_.subscribeFunction(kCommandChannel, &Gateway::OnCommand, &clients);
  subscriptions_[1] = network_.subscribeFunction(kHeartbeatChannel, &Gateway::OnHeartbeat, &clients);
  for (int i = 0; i < 2; ++i) subscriptions_[i]->setQueueCapacity(kQueueCapacity);
  subscriptions_[2] = network_.subscribeFunction(kMachineChannel, &Gateway::OnMachine, this);
  thread_ = std::thread([this] { Listen(); });
}

Gateway::~Gateway() {
  stop_ = true;
  thread_.join();
  for (::lcm::Subscription* subscription : subscriptions_) network_.unsubscribe(subscription);
}

void Gateway::Listen() {
  while (!stop_) Handle(network_, kWaitMs);
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

void Gateway::OnMachine(const ::lcm::ReceiveBuffer* received, const std::string&, Gateway* gateway) {
  if (gateway->met_another_engine_) return;
  const auto message = DecodeMachine(Bytes(received));
  if (!message || message->run_id == gateway->clients_.run_id()) return;
  gateway->met_another_engine_ = true;
  std::fprintf(stderr, "another engine runs on this LCM network, machine %s\n", Quoted(message->name).c_str());
}

}  // namespace takt::lcm
