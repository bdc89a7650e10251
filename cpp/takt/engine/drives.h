// The engine's side of drives in other processes (EN-26, AX-87): what goes to them and comes from them, and for how
// long the last that came is gone by. How it travels is none of its business: see lcm/drives.h.
//
// Every cycle has a set point for each drive, numbered as the cycle; the drive answers with what it measured once it
// had carried that out. So in cycle k the answer to cycle k - 1 is wanted; the one to cycle -1, with the drive off,
// before the first cycle. An older answer is carried on (axis/drive_link.h); when so many in a row are missing as the
// machine file says, the drive is lost. One that has not answered at all yet is no fault: its axis is Disabled, and
// switching it on fails when the drive does not get ready in time.
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
  std::int64_t cycle = -1;  // of the set point it answers
  std::uint32_t axis = 0;   // index in Machine::axes
  ServoInputs inputs;
  // u: where the load really is, of a plant that knows it; published, but not used by the engine.
  double true_position = std::numeric_limits<double>::quiet_NaN();
  // s, real time: how much later the cycles ought to begin for the clock of the drive's bus. Looked at by the
  // scheduler, through lcm/drives.h; the engine does not know of it.
  double later_s = 0;
};

struct DriveEntry {  // a sample as the cycle took it, for the journal
  std::uint64_t cycle = 0;
  DriveSample sample;
};

// What the engine remembers of one drive.
struct HeardDrive {
  std::uint32_t axis = 0;            // index in Machine::axes
  std::uint32_t missing_cycles = 1;  // answers missing in a row that make it lost
  bool heard = false;                // at all
  std::int64_t answered = -1;        // cycle of the set point that its newest sample answers ...
  std::uint32_t step = 0;            // ... and how many cycles after the sample before, if it came in this cycle
};

// Takes the newest sample. False: it is none, or too old to go by, or answers what was not asked yet; nothing changes.
bool Take(Cycle cycle, const DriveSample& sample, HeardDrive& drive, ServoInputs& inputs) noexcept;

// When what is known in this cycle was sampled; once a cycle, after what has come was taken.
Sampling SamplingIn(Cycle cycle, HeardDrive& drive) noexcept;

void describe(Description<HeardDrive>&);

}  // namespace takt::engine
