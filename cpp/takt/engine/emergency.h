// The emergency stop of the machine as a level (AX-100): who holds it, and what it refuses meanwhile.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/feedback.h"
#include "takt/engine/command.h"

namespace takt::engine {

// Commands that hold the emergency stop. It is on while any does, and in the cycle in which one came that does not.
class EmergencyHolders {
 public:
  // False: as many hold it as there is room for.
  bool Add(Ticket ticket) noexcept;
  void Pulse(std::uint64_t cycle) noexcept { pulse_ = cycle; }
  // True: it held the stop.
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

// Whether a command asks for power or motion, of whatever component: refused while an emergency stop is on.
bool AsksToMove(const Command& command) noexcept;

}  // namespace takt::engine
