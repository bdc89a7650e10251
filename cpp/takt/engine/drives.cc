#include "takt/engine/drives.h"

#include <utility>

#include "takt/core/describe.h"

namespace takt::engine {

namespace {

// Returns the number of missing answers in this cycle if `answered` is the newest one.
std::int64_t Missing(Cycle cycle, std::int64_t answered) noexcept {
  return static_cast<std::int64_t>(cycle.count) - 1 - answered;
}

}  // namespace

bool Take(Cycle cycle, const DriveSample& sample, HeardDrive& drive, ServoInputs& inputs) noexcept {
  if (sample.cycle < -1 || (drive.heard && sample.cycle <= drive.answered)) return false;
  const std::int64_t missing = Missing(cycle, sample.cycle);
  if (missing < 0 || missing >= drive.missing_cycles) return false;
  drive.step += drive.heard ? static_cast<std::uint32_t>(sample.cycle - drive.answered) : 1;
  drive.heard = true;
  drive.answered = sample.cycle;
  inputs = sample.inputs;
  return true;
}

Sampling SamplingIn(Cycle cycle, HeardDrive& drive) noexcept {
  if (!drive.heard) return {DriveLink::kAwaited, 0, 0};
  const std::int64_t missing = Missing(cycle, drive.answered);
  const bool lost = missing >= drive.missing_cycles;
  return {lost ? DriveLink::kLost : DriveLink::kHeard, static_cast<std::uint32_t>(missing),
          std::exchange(drive.step, 0u)};
}

void describe(Description<HeardDrive>& d) {
  using H = HeardDrive;
  d.about("State of a drive in another process.");
  d.internal<&H::axis>("Index of its axis.");
  d.internal<&H::missing_cycles>(unit::cycles, "Missing answers in a row after which the drive is lost.");
  d.internal<&H::heard>("The drive has answered.");
  d.internal<&H::answered>("Cycle of the set point that its newest sample answers.");
  d.internal<&H::step>(unit::cycles, "Cycles from the previous sample to the one that came in this cycle.");
}

}  // namespace takt::engine
