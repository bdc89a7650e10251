// External drives over LCM (EN-26, AX-87): sends the engine's set points and receives the measured values. Sockets are
// used by threads of this class, or between the cycles of simulated time, never by the cycle.
//
// Real time: two threads. The newest set point of each drive is sent; feedback is queued for the next cycle, in which
// the engine checks its age.
//
// Simulated time: in lock step, so that runs are reproducible. No threads; the caller of the cycle calls Ready before
// each. Unanswered set points are sent again, so that lost messages and plants that start later do no harm. A cycle
// waits for external.answer_within_s, then runs without the answer; a drive that is lost because of that is not waited
// for until it answers again.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "takt/engine/engine.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/drive_gate.h"
#include "takt/lcm/network.h"
#include "takt/lcm/receiver.h"

namespace takt::lcm {

struct DrivesOptions {
  std::string url{};
  std::int64_t run_id = 0;
  bool real_time = false;
  std::shared_ptr<Authentication> authentication{};  // null: no key, any process on the network may answer
  // Receives one sentence for users; called from any thread.
  std::function<void(const std::string&)> complain = [](const std::string&) {};
};

class Drives {
 public:
  // For an engine made with EngineOptions::drives, which must outlive this object. Returns null, and one line in
  // `problem`, if the network cannot be joined.
  static std::unique_ptr<Drives> Open(engine::Engine& engine, const DrivesOptions& options, std::string& problem);
  // Sends the remaining set points. Requires: the cycle has ended.
  ~Drives();
  Drives(const Drives&) = delete;
  Drives& operator=(const Drives&) = delete;

  // Simulated time, between two cycles. Returns false, after a short wait, if not all drives have answered yet.
  bool Ready();

  // Real time: returns and clears the delay [ns] by which later cycles should begin for the clock of a bus, +-1e9; 0:
  // nothing new. From the newest answer; only the first drive that sends a value other than 0 counts.
  std::int64_t TakeCycleShiftNs();

 private:
  // The link to one drive.
  struct Line {
    std::string channel;
    engine::DriveSetPoint newest;
    bool due = false;  // the newest set point has not been sent yet
    std::int64_t sequence = 0;
    std::uint32_t misses = 0;  // simulated time: consecutive cycles that ran without its answer
    bool given_up = false;     // simulated time: not waited for
  };

  Drives(engine::Engine& engine, const DrivesOptions& options);
  void Receive(const Heard& heard);
  // Returns true if it sent anything.
  bool SendNewest();
  void Send(Line& line);
  void SendThread();
  void ReceiveThread();
  bool Answered(std::size_t drive) const;
  bool AllAnswered() const;
  void GiveUpMissingDrives();

  engine::Engine& engine_;
  const DrivesOptions options_;
  DriveGate gate_;
  Network sending_;
  std::unique_ptr<Receiver> receiving_;
  std::optional<Signer> signer_;
  std::vector<Line> lines_;
  std::vector<std::uint8_t> buffer_;

  // Simulated time.
  bool waiting_ = false;
  std::int64_t give_up_ns_ = 0;
  std::int64_t send_again_ns_ = 0;

  // Real time.
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> later_ns_{0};
  std::optional<std::uint32_t> clock_axis_;  // of the drive whose bus provides the clock
  std::thread sender_, receiver_;
};

}  // namespace takt::lcm
