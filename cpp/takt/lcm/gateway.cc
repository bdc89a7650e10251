#include "takt/lcm/gateway.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "takt/core/problem.h"
#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {
namespace {

// [messages] LCM's default of 30 loses commands given at 100 times the cycle's rate.
constexpr std::size_t kQueueCapacity = 10'000;
constexpr int kWaitMs = 50;  // interval of checks of stop_

// Returns the age of a message by this host's clock: the larger one of the time since its arrival and, if stamped, the
// difference to its sender's stamp. A stamp in the future counts as age, too.
std::int64_t AgeNs(const Heard& heard, std::int64_t given_us) {
  const std::int64_t now_us = WallClockUs();
  const std::int64_t waited = std::max<std::int64_t>(0, now_us - heard.utime);
  if (given_us == 0) return waited * 1000;
  // Stamps may have any value: their difference must not overflow.
  const double apart = std::abs(static_cast<double>(now_us) - static_cast<double>(given_us));
  return std::max(waited, static_cast<std::int64_t>(std::min(apart, 1e15))) * 1000;
}

}  // namespace

Gateway::Gateway(Receiver& network, Clients& clients) : network_(network), clients_(clients) {
  const auto hear = [this](const char* channel, void (Gateway::*handler)(const Heard&)) {
    subscriptions_.push_back(
        network_.Subscribe(channel, kQueueCapacity, [this, handler](const Heard& heard) { (this->*handler)(heard); }));
  };
  hear(kCommandChannel, &Gateway::OnCommand);
  hear(kHeartbeatChannel, &Gateway::OnHeartbeat);
  hear(kMachineChannel, &Gateway::OnMachine);
  thread_ = std::thread([this] { Listen(); });
}

Gateway::~Gateway() {
  stop_ = true;
  thread_.join();
  for (const int subscription : subscriptions_) network_.Unsubscribe(subscription);
}

void Gateway::Listen() {
  while (!stop_) {
    network_.Handle(kWaitMs);
    for (const std::uint64_t now = network_.malformed(); malformed_ != now; ++malformed_) clients_.OnMalformed();
  }
}

void Gateway::OnCommand(const Heard& heard) {
  if (const auto message = DecodeCommand(heard.data)) {
    clients_.OnCommand(*message, SteadyNs(), AgeNs(heard, message->utime));
  } else {
    clients_.OnMalformed();
  }
}

void Gateway::OnHeartbeat(const Heard& heard) {
  if (const auto message = DecodeHeartbeat(heard.data)) {
    clients_.OnHeartbeat(*message, SteadyNs(), AgeNs(heard, message->utime));
  } else {
    clients_.OnMalformed();
  }
}

void Gateway::OnMachine(const Heard& heard) {
  if (met_another_engine_) return;
  const auto message = DecodeMachine(heard.data);
  if (!message || message->run_id == clients_.run_id()) return;
  met_another_engine_ = true;
  std::fprintf(stderr, "another engine runs on this LCM network, machine %s\n", Quoted(message->name).c_str());
}

}  // namespace takt::lcm
