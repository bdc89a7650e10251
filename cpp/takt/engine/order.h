// In which order axes step: masters before followers (EN-03).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "takt/engine/machine.h"

namespace takt::engine {

// The order of `count` components such that each comes behind all its masters; otherwise as they stand. `masters[i]`
// lists those of i. Nothing where there is a loop; `loop` then gets its members, each a master of the next, the last
// one of the first.
std::optional<std::vector<std::uint32_t>> OrderByMasters(std::span<const std::vector<std::uint32_t>> masters,
                                                         std::vector<std::uint32_t>& loop);

// Index of the axis that this one follows, if any.
std::optional<std::uint32_t> MasterOf(const Machine& machine, std::size_t axis);
// The same for all axes, as OrderByMasters takes it.
std::vector<std::vector<std::uint32_t>> MastersOf(const Machine& machine);

}  // namespace takt::engine
