// Sends the contents of the engine's queues to the network and to a log file (EN-20, EN-21), on its own thread. The
// cycle does not wait for them: if they are slow, the queues fill up and the engine counts the dropped entries.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "takt/engine/engine.h"
#include "takt/lcm/clients.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/messages.h"
#include "takt/lcm/outlet.h"

namespace takt::lcm {

struct RunInfo {
  std::string machine_text{};           // the machine file as read
  std::string version{};                // of the engine
  std::int8_t pace = 0;                 // one of engine_state's PACE_ constants
  std::int64_t run_id = WallClockUs();  // distinguishes one run of the engine from the next
};

class Publisher {
 public:
  // Publishes from now on. `network`, `log` and `authentication` (no key) may be null; everything else must outlive
  // this object. All states that the engine hands over go to the log, those that are due also to the network.
  Publisher(engine::Engine& engine, Clients& clients, Outlet* network, Outlet* log, RunInfo info,
            const Authentication* authentication = nullptr);
  ~Publisher() { Stop(); }
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // Publishes the remaining queue entries, then ends the thread. Requires: the cycle has ended.
  void Stop();

  // Returns the number of messages that the network or the log did not accept.
  std::uint64_t send_failures() const { return send_failures_.load(std::memory_order_relaxed); }

 private:
  struct Channel {
    std::string name;
    std::int64_t network_sequence = 0;
    std::int64_t log_sequence = 0;
  };

  void Run();
  // Returns true if any queue had entries.
  bool Drain();
  // Drains the published states of all components: all to the log, those due also to the network.
  template <typename... Outputs>
  bool DrainStates(const std::tuple<Outputs...>* kinds);
  template <typename Outputs>
  bool DrainStatesOf(std::vector<Channel>& channels);
  // Appends points to the shape of their track; sends it once it is complete.
  void AppendShapePoints(const engine::TrackPlaces& places);
  void PublishReplies();
  void PublishMachine();
  void PublishFigures(const engine::EngineFigures& figures);
  void StartJournal();
  void AddHash(const engine::HashEntry& entry);
  void FlushHashes();

  template <typename Message>
  void ToNetwork(Channel& channel, Message& message);
  template <typename Message>
  void ToLog(Channel& channel, Message& message);
  template <typename Message>
  void ToBoth(Channel& channel, Message& message);
  template <typename Message>
  void ToJournal(const char* channel, const Message& message);
  void Send(Outlet& outlet, const std::string& channel, std::int64_t utime);

  engine::Engine& engine_;
  Clients& clients_;
  Outlet* const network_;
  Outlet* const log_;
  const RunInfo info_;
  const Authentication* const authentication_;

  std::vector<std::vector<Channel>> state_channels_;  // by kind, by component
  std::size_t first_kind_ = 0;                        // round robin: the kind drained first
  std::vector<Channel> object_channels_;              // by belt
  std::vector<Channel> trail_channels_;               // by mover
  std::vector<Channel> route_channels_;               // by mover
  std::vector<Channel> shape_channels_;               // by track
  std::vector<msgs::track_shape> shapes_;             // complete shapes, by track; sent again for later subscribers
  std::vector<msgs::track_shape> partial_shapes_;     // by track
  Channel engine_channel_, machine_channel_, feedback_channel_, cam_channel_;
  std::int64_t next_machine_ns_ = 0;
  std::int64_t next_flush_ns_ = 0;  // of the log
  msgs::journal_hashes hashes_{};
  std::vector<std::uint8_t> buffer_;

  std::atomic<std::uint64_t> send_failures_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace takt::lcm
