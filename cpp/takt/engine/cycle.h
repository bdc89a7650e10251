// One cycle of a machine, as a list of stages over plain data.
#pragma once

#include <cstddef>

#include "takt/axis/forecast.h"
#include "takt/engine/command.h"
#include "takt/engine/drives.h"
#include "takt/engine/world.h"

namespace takt::engine {

// Not for the cycle (axis/forecast.h).
axis::Forecast Foresee(World& world, std::size_t axis);
axis::Forecast Foresee(World& world, std::size_t axis, const axis::Command& command);

// The stages, in the order of the cycle. Commands come between sense and move (Apply).
// What a drive in another process has sent. False: nothing to go by.
bool Take(World& world, const DriveSample& sample) noexcept;
void Sense(World& world) noexcept;
void Apply(World& world, const Command& command) noexcept;
void Move(World& world) noexcept;
void Control(World& world) noexcept;
void Actuate(World& world) noexcept;

}  // namespace takt::engine
