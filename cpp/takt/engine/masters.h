// Which axes must not step before which: followers behind masters, groups behind what they ride on (EN-03). All movers
// step together: they are one more, numbered behind the axes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "takt/engine/world.h"

namespace takt::engine {

// What a command that has not been taken yet adds to the order.
struct Wanted {
  const axis::CouplingRequest* coupling = nullptr;
  std::uint32_t of = 0;                  // for this axis
  std::uint32_t group = 0;               // from 1; 0: none
  std::uint32_t master = axis::kNoAxis;  // that its members follow
  std::uint32_t synced = axis::kNoAxis;  // that follows its members
  std::uint32_t carrier = 0;             // number of what it is to ride on; 0: nothing
  std::uint32_t added = axis::kNoAxis;   // that becomes a member
  std::uint32_t movers = axis::kNoAxis;  // that a mover follows
};

// Makes the order of the axes anew, with what is wanted. False: there would be a loop; the order stays as it was.
bool MakeOrder(World& world, const Wanted& wanted = {}) noexcept;

// What a command makes the members of group `index` follow or ride on, makes follow them, or makes a member.
Wanted WantedBy(World& world, const group::Command& command, std::size_t index) noexcept;

inline bool Changes(const Wanted& wanted) noexcept {
  return wanted.master != axis::kNoAxis || wanted.synced != axis::kNoAxis || wanted.carrier != 0 ||
         wanted.added != axis::kNoAxis || wanted.movers != axis::kNoAxis;
}

}  // namespace takt::engine
