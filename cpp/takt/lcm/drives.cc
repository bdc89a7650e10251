#include "takt/lcm/drives.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {

namespace {

constexpr std::size_t kDriveQueue = 10'000;        // messages
constexpr int kDriveWaitMs = 20;                   // real time: interval of checks of stop_; simulated: of one Ready
constexpr std::int64_t kSendAgainNs = 50'000'000;  // simulated time
constexpr int kLooksPerCycle = 10;                 // real time: checks for new set points
constexpr std::int64_t kNsPerMs = 1'000'000;

}  // namespace

Drives::Drives(engine::Engine& engine, const DrivesOptions& options)
    : engine_(engine), options_(options), gate_(engine.machine(), options.run_id, [this](const std::string& sentence) {
        engine_.CountRefusedSample();
        if (!sentence.empty()) options_.complain(sentence);
      }) {
  for (std::size_t i = 0; i < gate_.size(); ++i) {
    lines_.push_back({.channel = SetPointChannel(engine.machine().axes[gate_.AxisOf(i)].name), .newest = {}});
  }
}

std::unique_ptr<Drives> Drives::Open(engine::Engine& engine, const DrivesOptions& options, std::string& problem) {
  std::unique_ptr<Drives> drives(new Drives(engine, options));
  drives->sending_ = OpenNetwork(options.url);
  problem = drives->sending_.problem;
  if (drives->sending_.lcm) drives->receiving_ = OpenReceiver(options.url, problem);
  if (!drives->receiving_) return nullptr;
  if (Authentication* const authentication = options.authentication.get()) {
    drives->signer_.emplace(authentication->keys().own);
    drives->receiving_ = WithKey(std::move(drives->receiving_), authentication->keys(),
                                 [&engine, authentication](std::string_view channel, TagState state) {
                                   engine.CountRefusedSample();
                                   authentication->Refuse(channel, state);
                                 });
  }
  drives->receiving_->Subscribe(kDriveFeedbackChannels, kDriveQueue,
                                [d = drives.get()](const Heard& heard) { d->Receive(heard); });
  if (options.real_time) {
    drives->sender_ = std::thread([d = drives.get()] { d->SendThread(); });
    drives->receiver_ = std::thread([d = drives.get()] { d->ReceiveThread(); });
  }
  return drives;
}

Drives::~Drives() {
  stop_ = true;
  if (sender_.joinable()) sender_.join();
  if (receiver_.joinable()) receiver_.join();
  if (receiving_) SendNewest();
}

bool Drives::Ready() {
  const std::int64_t now = SteadyNs();
  if (SendNewest()) {
    waiting_ = true;
    give_up_ns_ = now + std::llround(engine_.machine().external.answer_within_s * 1e9);
    send_again_ns_ = now + kSendAgainNs;
  }
  for (std::size_t i = 0; i < kDriveQueue && receiving_->Handle(0) > 0; ++i) {
  }
  const std::int64_t until = now + kDriveWaitMs * kNsPerMs;
  while (waiting_ && !AllAnswered()) {
    const std::int64_t at = SteadyNs();
    if (at >= give_up_ns_) {
      GiveUpMissingDrives();
      break;
    }
    if (at >= send_again_ns_) {
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (!Answered(i)) Send(lines_[i]);
      }
      send_again_ns_ = at + kSendAgainNs;
    }
    if (at >= until) return false;
    const std::int64_t wait_ns = std::min({until, give_up_ns_, send_again_ns_}) - at;
    receiving_->Handle(static_cast<int>(wait_ns / kNsPerMs) + 1);
  }
  if (waiting_) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (Answered(i)) lines_[i].misses = 0;
    }
  }
  waiting_ = false;
  return true;
}

bool Drives::Answered(std::size_t drive) const {
  return gate_.answered(drive) >= lines_[drive].newest.cycle;
}

bool Drives::AllAnswered() const {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!lines_[i].given_up && !Answered(i)) return false;
  }
  return true;
}

void Drives::GiveUpMissingDrives() {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Line& line = lines_[i];
    if (line.given_up || Answered(i) || ++line.misses < gate_.missing_cycles(i)) continue;
    line.given_up = true;
    options_.complain("axis " + engine_.machine().axes[gate_.AxisOf(i)].name + ": no plant answers on " + options_.url +
                      "; going on without its drive (takt plant MACHINE simulates it)");
  }
}

bool Drives::SendNewest() {
  engine::DriveSetPoint set_point;
  while (engine_.set_points().TryPop(set_point)) {
    Line& line = lines_[gate_.DriveOf(set_point.axis)];
    line.newest = set_point;
    line.due = true;
  }
  bool any = false;
  for (Line& line : lines_) {
    if (!line.due) continue;
    line.due = false;
    any = true;
    Send(line);
  }
  return any;
}

void Drives::Send(Line& line) {
  msgs::drive_setpoint message = ToMessage(line.newest, engine_.machine());
  message.utime = WallClockUs();
  message.run_id = options_.run_id;
  message.sequence = line.sequence++;
  message.real_time = options_.real_time;
  Encode(message, buffer_);
  if (signer_) signer_->Sign(line.channel, buffer_);
  gate_.OnSent(line.newest);
  sending_.lcm->publish(line.channel, buffer_.data(), static_cast<unsigned>(buffer_.size()));
}

void Drives::Receive(const Heard& heard) {
  const auto sample = gate_.Take(heard.channel, heard.data);
  if (!sample) return;
  if (!engine_.drive_samples().TryPush(*sample)) engine_.CountRefusedSample();
  if (options_.real_time) {
    if (sample->later_s != 0 && !clock_axis_) clock_axis_ = sample->axis;
    if (clock_axis_ == sample->axis) later_ns_ = std::llround(std::clamp(sample->later_s, -1.0, 1.0) * 1e9);
    return;
  }
  Line& line = lines_[gate_.DriveOf(sample->axis)];
  line.given_up = false;
}

std::int64_t Drives::TakeCycleShiftNs() {
  return later_ns_.exchange(0);
}

void Drives::SendThread() {
  const auto period_ns = std::llround(engine_.machine().cycle.period_s * 1e9);
  const std::chrono::nanoseconds look(period_ns / kLooksPerCycle);
  for (;;) {
    const bool last = stop_;  // read before the queue
    if (SendNewest()) continue;
    if (last) break;
    std::this_thread::sleep_for(look);
  }
}

void Drives::ReceiveThread() {
  while (!stop_) receiving_->Handle(kDriveWaitMs);
}

}  // namespace takt::lcm
