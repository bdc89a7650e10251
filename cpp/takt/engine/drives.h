// The engine's side of drives in other processes (EN-26, AX-87): the set points sent, the samples received, and how
// long the last sample stays valid. Transport: lcm/drives.h.
//
// Every cycle sends each drive one set point, numbered as the cycle; the drive answers with what it measured after it
// had carried out that set point. So cycle k expects the answer to cycle k - 1; cycle 0 expects the answer to "cycle
// -1" (drive off). An older answer is extrapolated (axis/drive_link.h); the drive is lost when missing_cycles
// consecutive answers are missing. A drive that has never answered is no fault: its axis is Disabled, and switching it
// on fails if the drive is not ready in time.
#pragma once

#include <cstdint>
#include <limits>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::engine {

struct DriveSetPoint {
  std::int64_t cycle = -1;
  std::uint32_t axis = 0;  // index in Machine::axes
  ServoOutputs outputs;
};

struct DriveSample {
  std::int64_t cycle = -1;  // of the set point that this sample answers
  std::uint32_t axis = 0;   // index in Machine::axes
  ServoInputs inputs;
  // [u] true position of the load, if the plant knows it; published, not used by the engine.
  double true_position = std::numeric_limits<double>::quiet_NaN();
  // [s] real time: delay by which later cycles should begin, for the clock of the drive's bus. Read by the scheduler
  // through lcm/drives.h; the engine does not use it.
  double later_s = 0;
};

struct DriveEntry {  // a sample as the cycle took it, for the journal
  std::uint64_t cycle = 0;
  DriveSample sample;
};

// The link state of one external drive.
struct HeardDrive {
  std::uint32_t axis = 0;            // index in Machine::axes
  std::uint32_t missing_cycles = 1;  // consecutive missing answers after which the drive is lost
  bool heard = false;                // it has answered at least once
  std::int64_t answered = -1;        // cycle of the set point that its newest sample answers ...
  // ... and the number of cycles since the sample before, if it arrived in this cycle
  std::uint32_t step = 0;
};

// Takes a newer sample. Returns false, and changes nothing, if it is not newer than the last one, is too old to be
// valid, or answers a set point that has not been sent yet.
bool Take(Cycle cycle, const DriveSample& sample, HeardDrive& drive, ServoInputs& inputs) noexcept;

// Returns the age and link state of the inputs of this cycle. Call once a cycle, after all samples have been taken.
Sampling SamplingIn(Cycle cycle, HeardDrive& drive) noexcept;

void describe(Description<HeardDrive>&);

}  // namespace takt::engine
