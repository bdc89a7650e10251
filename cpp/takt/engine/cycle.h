// One cycle of a machine, as a list of stages over plain data.
#pragma once

#include <cstddef>

#include "takt/axis/forecast.h"
#include "takt/engine/command.h"
#include "takt/engine/drives.h"
#include "takt/engine/world.h"

namespace takt::engine {

// Forecasts the motion of an axis, without or with a further command (axis/forecast.h). Not for use within the cycle.
axis::Forecast Foresee(World& world, std::size_t axis);
axis::Forecast Foresee(World& world, std::size_t axis, const axis::Command& command);

// The stages, in the order of the cycle. Commands are applied between Sense and Move.
// Takes a sample of an external drive; returns false if it is of no use (see drives.h).
bool Take(World& world, const DriveSample& sample) noexcept;
void Sense(World& world) noexcept;
void Apply(World& world, const Command& command) noexcept;
void Move(World& world) noexcept;
void Control(World& world) noexcept;
void Actuate(World& world) noexcept;

}  // namespace takt::engine
