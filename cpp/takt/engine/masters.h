// The step order of axes: masters before followers, carriers before the groups that ride on them (EN-03). All movers
// step together: they are one node, numbered after the axes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "takt/engine/world.h"

namespace takt::engine {

// The couplings that a command not applied yet would add to the order.
struct Wanted {
  const axis::CouplingRequest* coupling = nullptr;
  std::uint32_t of = 0;                  // the axis that requests `coupling`
  std::uint32_t group = 0;               // from 1; 0: none
  std::uint32_t master = axis::kNoAxis;  // axis that the members of `group` will follow
  std::uint32_t synced = axis::kNoAxis;  // axis that will follow the members of `group`
  std::uint32_t carrier = 0;             // number of the carrier that `group` will ride on; 0: none
  std::uint32_t added = axis::kNoAxis;   // axis that will become a member of `group`
  std::uint32_t movers = axis::kNoAxis;  // axis that a mover will follow
};

// Computes the step order anew, with the couplings of `wanted`. Returns false, and keeps the old order, if there is a
// loop.
bool MakeOrder(World& world, const Wanted& wanted = {}) noexcept;

// Returns what a command adds: the axis or carrier that the members of group `index` will follow, the axis that will
// follow them, or the axis that will become a member.
// Returns true if `wanted` adds a master or a follower of a group or of movers, so that the order must be made anew.
Wanted WantedBy(World& world, const group::Command& command, std::size_t index) noexcept;

inline bool Changes(const Wanted& wanted) noexcept {
  return wanted.master != axis::kNoAxis || wanted.synced != axis::kNoAxis || wanted.carrier != 0 ||
         wanted.added != axis::kNoAxis || wanted.movers != axis::kNoAxis;
}

}  // namespace takt::engine
