// The emergency stop of the machine as a level (AX-100): who holds it, and what it refuses meanwhile.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/feedback.h"
#include "takt/engine/command.h"

namespace takt::engine {

// Commands that hold the emergency stop. It is on while any does.
class EmergencyHolders {
 public:
  void Add(Ticket ticket) noexcept;
  // True: it held the stop.
  bool Remove(Ticket ticket) noexcept;
  void Clear() noexcept { *this = {}; }
  bool held() const noexcept { return count_ > 0 || nameless_; }

 private:
  static constexpr std::size_t kMost = 16;
  std::array<Ticket, kMost> tickets_{};
  std::uint32_t count_ = 0;
  bool nameless_ = false;  // more than there is room for: until all are released
};

// Whether a command asks for power or motion, of whatever component: refused while an emergency stop is on.
bool AsksToMove(const Command& command) noexcept;

}  // namespace takt::engine
