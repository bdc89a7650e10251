#include "takt/lcm/publisher.h"

#include <array>
#include <chrono>
#include <utility>

#include "takt/engine/components.h"
#include "takt/lcm/channels.h"
#include "takt/lcm/checksum.h"

namespace takt::lcm {
namespace {

constexpr auto kIdleWait = std::chrono::milliseconds(1);
constexpr std::int64_t kMachinePeriodNs = 1'000'000'000;
constexpr std::size_t kHashesPerMessage = 1000;
constexpr std::int64_t kFlushNs = 50'000'000;  // a log is complete up to 100 ms before the program was killed (EN-36)
constexpr int kBatch = 4096;                   // elements of one queue before the next is served

template <typename T, typename Use>
bool Take(SpscQueue<T>& queue, Use use) {
  T element;
  int taken = 0;
  while (taken < kBatch && queue.TryPop(element)) {
    use(element);
    ++taken;
  }
  return taken > 0;
}

}  // namespace

Publisher::Publisher(engine::Engine& engine, Clients& clients, Outlet* network, Outlet* log, RunInfo info,
                     const Authentication* authentication)
    : engine_(engine),
      clients_(clients),
      network_(network),
      log_(log),
      info_(std::move(info)),
      authentication_(authentication) {
  engine_channel_.name = kEngineChannel;
  machine_channel_.name = kMachineChannel;
  feedback_channel_.name = kFeedbackChannel;
  cam_channel_.name = kCamChannel;
  for (const engine::ComponentKind& kind : engine::ComponentKinds()) {
    std::vector<Channel>& channels = state_channels_.emplace_back();
    for (std::size_t i = 0; i < kind.count(engine_.machine()); ++i) {
      channels.push_back({.name = StateChannel(kind.name, kind.name_of(engine_.machine(), i))});
    }
  }
  for (const conveyor::BeltParams& belt : engine_.machine().belts) {
    object_channels_.push_back({.name = ObjectsChannel(belt.name)});
  }
  for (const mover::MoverParams& mover : engine_.machine().movers) {
    trail_channels_.push_back({.name = TrailChannel(mover.name)});
    route_channels_.push_back({.name = RouteChannel(mover.name)});
  }
  for (const track::TrackParams& track : engine_.machine().tracks) {
    shape_channels_.push_back({.name = ShapeChannel(track.name)});
  }
  shapes_.resize(shape_channels_.size());
  partial_shapes_.resize(shape_channels_.size());
  thread_ = std::thread([this] { Run(); });
}

void Publisher::Stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Publisher::Run() {
  if (log_ != nullptr) StartJournal();
  for (;;) {
    const bool last = stop_;  // read before the queues: earlier entries are not missed
    const std::int64_t now_ns = SteadyNs();
    if (now_ns >= next_machine_ns_) PublishMachine();
    if (log_ != nullptr && now_ns >= next_flush_ns_) {
      FlushHashes();
      log_->Flush();
      next_flush_ns_ = now_ns + kFlushNs;
    }
    if (Drain()) continue;
    if (last) break;
    std::this_thread::sleep_for(kIdleWait);
  }
  FlushHashes();
}

bool Publisher::Drain() {
  bool any = Take(engine_.feedback(), [this](const FeedbackEvent& event) { clients_.OnFeedback(event); });
  PublishReplies();
  any |= Take(engine_.journal(), [this](const engine::JournalEntry& entry) {
    if (log_ != nullptr) ToJournal(kJournalCommandChannel, ToMessage(entry, engine_.machine()));
  });
  any |= Take(engine_.drive_journal(), [this](const engine::DriveEntry& entry) {
    if (log_ != nullptr) ToJournal(kJournalDriveChannel, ToMessage(entry, engine_.machine()));
  });
  any |= Take(engine_.hashes(), [this](const engine::HashEntry& entry) { AddHash(entry); });
  any |= Take(engine_.figure_queue(), [this](const engine::EngineFigures& figures) { PublishFigures(figures); });
  any |= Take(engine_.belt_objects(), [this](const engine::ObjectsSnapshot& snapshot) {
    auto message = ToMessage(snapshot, engine_.machine());
    ToBoth(object_channels_[snapshot.index], message);
  });
  any |= Take(engine_.mover_trails(), [this](const engine::TrailSnapshot& snapshot) {
    auto message = ToMessage(snapshot, engine_.machine());
    ToBoth(trail_channels_[snapshot.index], message);
  });
  any |= Take(engine_.mover_routes(), [this](const engine::RouteSnapshot& snapshot) {
    auto message = ToMessage(snapshot, engine_.machine());
    ToBoth(route_channels_[snapshot.index], message);
  });
  any |= Take(engine_.cam_pieces(), [this](const cam::CamPiece& piece) {
    auto message = ToMessage(piece, engine_.machine());
    ToBoth(cam_channel_, message);
  });
  any |= Take(engine_.track_places(), [this](const engine::TrackPlaces& places) { AppendShapePoints(places); });
  return any | DrainStates(static_cast<engine::PublishedKinds*>(nullptr));
}

template <typename... Outputs>
bool Publisher::DrainStates(const std::tuple<Outputs...>*) {
  constexpr std::array kDrains = {&Publisher::DrainStatesOf<Outputs>...};
  bool any = false;
  for (std::size_t k = 0; k < kDrains.size(); ++k) {
    const std::size_t kind = (first_kind_ + k) % kDrains.size();
    any |= (this->*kDrains[kind])(state_channels_[kind]);
  }
  // The last kind is the one that a receiver with a small buffer misses: another kind every time.
  if (any) first_kind_ = (first_kind_ + 1) % kDrains.size();
  return any;
}

template <typename Outputs>
bool Publisher::DrainStatesOf(std::vector<Channel>& channels) {
  return Take(engine_.snapshots<Outputs>(), [&](const auto& snapshot) {
    Channel& channel = channels[snapshot.index];
    auto message = ToMessage(snapshot, engine_.machine());
    if (snapshot.due) ToNetwork(channel, message);
    ToLog(channel, message);
  });
}

void Publisher::AppendShapePoints(const engine::TrackPlaces& places) {
  msgs::track_shape& shape = partial_shapes_[places.track];
  if (places.first == 0) shape = {};
  Add(places, engine_.machine(), shape);
  if (places.first + places.count < places.total) return;
  shapes_[places.track] = shape;
  ToBoth(shape_channels_[places.track], shapes_[places.track]);
}

void Publisher::PublishReplies() {
  msgs::feedback reply;
  while (clients_.TakeReply(reply)) ToBoth(feedback_channel_, reply);
}

void Publisher::PublishMachine() {
  msgs::machine_description message{};
  message.run_id = info_.run_id;
  message.name = engine_.machine().name;
  message.version = info_.version;
  message.period_s = engine_.machine().cycle.period_s;
  message.text = info_.machine_text;
  ToNetwork(machine_channel_, message);
  if (next_machine_ns_ == 0) ToLog(machine_channel_, message);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (!shapes_[i].name.empty()) ToNetwork(shape_channels_[i], shapes_[i]);
  }
  next_machine_ns_ = SteadyNs() + kMachinePeriodNs;
}

void Publisher::PublishFigures(const engine::EngineFigures& figures) {
  const ClientFigures clients = clients_.figures(SteadyNs());
  msgs::engine_state message = ToMessage(figures, engine_.machine());
  message.run_id = info_.run_id;
  message.pace = info_.pace;
  message.malformed = static_cast<std::int64_t>(clients.malformed);
  message.ignored = static_cast<std::int64_t>(clients.ignored);
  message.other_run = static_cast<std::int64_t>(clients.other_run);
  message.has_key = authentication_ != nullptr;
  if (authentication_ != nullptr) {
    const auto refused = [this](TagState state) { return static_cast<std::int64_t>(authentication_->refused(state)); };
    message.untagged = refused(TagState::kMissing);
    message.wrong_key = refused(TagState::kForeign);
    message.replayed = refused(TagState::kReplayed);
    message.stale = refused(TagState::kStale);
  }
  message.send_failures = static_cast<std::int64_t>(send_failures());
  message.replies_dropped = static_cast<std::int64_t>(clients.replies_dropped);
  message.clients = static_cast<std::int32_t>(clients.alive);
  ToBoth(engine_channel_, message);
}

void Publisher::StartJournal() {
  msgs::journal_start message{};
  message.utime = WallClockUs();
  message.run_id = info_.run_id;
  message.version = info_.version;
  message.period_s = engine_.machine().cycle.period_s;
  message.text = info_.machine_text;
  ToJournal(kJournalStartChannel, message);
}

void Publisher::AddHash(const engine::HashEntry& entry) {
  if (log_ == nullptr) return;
  const auto cycle = static_cast<std::int64_t>(entry.cycle);
  const auto count = static_cast<std::int64_t>(hashes_.hashes.size());
  if (count != 0 && cycle != hashes_.first_cycle + count) FlushHashes();
  if (hashes_.hashes.empty()) hashes_.first_cycle = cycle;
  hashes_.hashes.push_back(static_cast<std::int64_t>(entry.hash));
  if (hashes_.hashes.size() == kHashesPerMessage) FlushHashes();
}

void Publisher::FlushHashes() {
  if (hashes_.hashes.empty()) return;
  hashes_.count = static_cast<std::int32_t>(hashes_.hashes.size());
  ToJournal(kJournalHashesChannel, hashes_);
  hashes_.hashes.clear();
}

template <typename Message>
void Publisher::ToNetwork(Channel& channel, Message& message) {
  if (network_ == nullptr) return;
  message.utime = WallClockUs();
  message.sequence = channel.network_sequence++;
  Encode(message, buffer_);
  Send(*network_, channel.name, message.utime);
}

template <typename Message>
void Publisher::ToLog(Channel& channel, Message& message) {
  if (log_ == nullptr) return;
  message.utime = WallClockUs();
  message.sequence = channel.log_sequence++;
  Encode(message, buffer_);
  AppendChecksum(channel.name, buffer_);
  Send(*log_, channel.name, message.utime);
}

template <typename Message>
void Publisher::ToBoth(Channel& channel, Message& message) {
  ToNetwork(channel, message);
  ToLog(channel, message);
}

template <typename Message>
void Publisher::ToJournal(const char* channel, const Message& message) {
  Encode(message, buffer_);
  AppendChecksum(channel, buffer_);
  Send(*log_, channel, WallClockUs());
}

void Publisher::Send(Outlet& outlet, const std::string& channel, std::int64_t utime) {
  if (!outlet.Send(channel, buffer_, utime)) send_failures_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace takt::lcm
