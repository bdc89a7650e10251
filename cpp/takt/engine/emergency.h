// The emergency stop of the machine as a level (AX-100): the commands that hold it, and the commands it refuses.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/feedback.h"
#include "takt/engine/command.h"

namespace takt::engine {

// The commands that hold the emergency stop. It is on while at least one holds it, and in the cycle of any
// EmergencyStop.
class EmergencyHolders {
 public:
  // Returns false if there is no room for a further holder.
  bool Add(Ticket ticket) noexcept;
  void Pulse(std::uint64_t cycle) noexcept { pulse_ = cycle; }
  // Returns true if the command held the stop.
  bool Remove(Ticket ticket) noexcept;
  void Clear() noexcept { *this = {}; }
  bool held() const noexcept { return count_ > 0; }
  bool on(std::uint64_t cycle) const noexcept { return held() || pulse_ == cycle; }

 private:
  static constexpr std::size_t kMost = 16;
  std::array<Ticket, kMost> tickets_{};
  std::uint32_t count_ = 0;
  std::uint64_t pulse_ = UINT64_MAX;  // cycle
};

// Returns true if a command, of any component, requests power or motion: refused while an emergency stop is on.
bool AsksToMove(const Command& command) noexcept;

}  // namespace takt::engine
