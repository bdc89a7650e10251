#include "takt/lcm/network_log.h"

#include <lcm/lcm-cpp.hpp>
#include <random>
#include <utility>

#include "takt/lcm/udp_receiver.h"

namespace takt::lcm {
namespace {

constexpr int kQuietMs = 100;                       // after this silence, all received messages are in the file
constexpr std::chrono::milliseconds kSayAgain{50};  // the end marker may get lost on a busy network
constexpr std::chrono::milliseconds kLookAgain{1};

// Returns a unique channel: several logs may listen to one network.
std::string LastWord() {
  std::random_device random;
  return "takt/log_ends/" + std::to_string(random()) + "." + std::to_string(random());
}

}  // namespace

std::unique_ptr<NetworkLog> NetworkLog::Open(const std::string& url, const std::string& path, std::string& problem) {
  Network network = OpenNetwork(url);
  if (!network.lcm) {
    problem = network.problem;
    return nullptr;
  }
  std::unique_ptr<Receiver> receiver = OpenReceiver(url, *network.lcm, problem);
  if (!receiver) return nullptr;
  std::unique_ptr<LogOutlet> log = OpenLog(path, problem);
  if (!log) return nullptr;
  return std::unique_ptr<NetworkLog>(new NetworkLog(std::move(network), std::move(receiver), std::move(log)));
}

NetworkLog::NetworkLog(Network network, std::unique_ptr<Receiver> receiver, std::unique_ptr<LogOutlet> log)
    : network_(std::move(network)), receiver_(std::move(receiver)), log_(std::move(log)), last_(LastWord()) {
  receiver_->Subscribe(".*", Receiver::kAll, [this](const Heard& heard) { Hear(heard); });
  thread_ = std::thread([this] {
    while (!heard_all_ && !stop_) {
      const int heard = receiver_->Handle(kQuietMs);
      if (heard <= 0) log_->Flush();
      broken_ = broken_ || heard < 0;
    }
  });
}

NetworkLog::~NetworkLog() {
  End();
}

void NetworkLog::Hear(const Heard& heard) {
  if (heard.channel == last_) {
    heard_all_ = true;
  } else if (!heard_all_) {
    log_->Send(heard.channel, heard.data, heard.utime);  // it remembers failures itself
  }
}

bool NetworkLog::Close(std::chrono::milliseconds patience) {
  if (!thread_.joinable()) return complete_;
  const auto until = std::chrono::steady_clock::now() + patience;
  auto say = std::chrono::steady_clock::now();
  while (!heard_all_ && !broken_ && std::chrono::steady_clock::now() < until) {
    if (std::chrono::steady_clock::now() >= say) {
      network_.lcm->publish(last_, nullptr, 0);
      say += kSayAgain;
    }
    std::this_thread::sleep_for(kLookAgain);
  }
  const bool all = heard_all_ && !broken_;
  End();
  return complete_ = complete_ && all;
}

void NetworkLog::End() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
  log_->Flush();
  complete_ = !log_->failed();
  log_.reset();
}

}  // namespace takt::lcm
