// Checks the messages of external drives before the engine receives them: sender, set point that they answer, and
// finite values. Independent of LCM.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "takt/engine/drives.h"
#include "takt/engine/machine.h"
#include "takt/lcm/messages.h"

namespace takt::lcm {

class DriveGate {
 public:
  // Called for every refused message, with a sentence the first time for each channel and reason, else with an empty
  // one.
  using Refuse = std::function<void(const std::string& sentence)>;

  // `machine` must outlive this object.
  DriveGate(const engine::Machine& machine, std::int64_t run_id, Refuse refuse);

  std::size_t size() const { return drives_.size(); }  // number of drives, in the order of their axes

  // Records that a set point was sent. Thread-safe.
  void OnSent(const engine::DriveSetPoint& set_point);
  // Returns the sample in a received message; nothing if it is refused. One thread at a time.
  std::optional<engine::DriveSample> Take(std::string_view channel, std::span<const std::uint8_t> bytes);

  // Returns the number of the drive of this axis. Requires: its drive is external.
  std::size_t DriveOf(std::uint32_t axis) const;
  std::uint32_t AxisOf(std::size_t drive) const { return drives_[drive].axis; }
  std::uint32_t missing_cycles(std::size_t drive) const { return drives_[drive].missing_cycles; }
  // Returns the cycle of the newest set point that the drive has answered; less than -1: none yet.
  std::int64_t answered(std::size_t drive) const { return drives_[drive].answered; }

 private:
  static constexpr std::int64_t kNothing = -2;  // no cycle yet
  static constexpr std::size_t kAskedAgain = 16;

  struct Drive {
    std::uint32_t axis = 0;
    std::uint32_t missing_cycles = 0;
    std::string channel;
    std::int64_t answered = kNothing;
    std::int64_t plant = 0;  // the plant that gave that answer
  };

  // The newest set point sent, and the set points sent more than once.
  struct Sent {
    Sent() {
      for (auto& cycle_again : again) cycle_again = kNothing;
    }
    std::atomic<std::int64_t>& AgainAt(std::int64_t at) { return again[static_cast<std::size_t>(at) % kAskedAgain]; }

    std::atomic<std::int64_t> cycle{kNothing};
    // Cycles whose set point was sent more than once, and may be answered more than once; entry cycle % kAskedAgain. On
    // a busy host an answer may come after set points of later cycles were repeated, too.
    std::array<std::atomic<std::int64_t>, kAskedAgain> again{};
  };
  enum class Reason : std::uint8_t { kChannel, kType, kAxis, kRun, kFuture, kNumber, kPlant, kOld };
  struct Refusal {
    Reason reason{};
    std::string sentence;
  };

  // Returns why this message must not reach the engine; nothing if it may.
  std::optional<Refusal> Diagnose(const msgs::drive_feedback& message, std::size_t drive) const;
  std::string UnknownChannel(std::string_view channel) const;
  void Say(std::string_view channel, const Refusal& refusal);

  const engine::Machine& machine_;
  const std::int64_t run_id_;
  const Refuse refuse_;
  std::vector<Drive> drives_;
  std::vector<Sent> sent_;  // by drive
  std::set<std::pair<std::string, Reason>> said_;
};

}  // namespace takt::lcm
