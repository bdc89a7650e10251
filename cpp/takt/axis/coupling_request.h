// The part of a request that only coupling commands have: the masters and how they are followed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "takt/axis/commands/cam.h"
#include "takt/axis/commands/coupling.h"
#include "takt/axis/params.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct CouplingTerm {
  Name name;                       // of the master; empty: term not used
  std::uint32_t master = kNoAxis;  // index of the master in the machine, looked up when the command arrives
  MasterSource source = MasterSource::kSetValue;
  double filter_s = -1;  // [s] filter of a measured master; negative: that of its encoder
  double ratio = 1;      // own u (cams: x) per master's u; negated for a master that is subtracted
};

struct CouplingRequest {
  std::array<CouplingTerm, 2> terms;
  double master_sync_position = 0;    // master's u (GearInPos)
  double slave_sync_position = 0;     // [u]
  double master_start_distance = -1;  // [master's u] negative: synchronise at once
  SyncMode sync_mode = SyncMode::kShortest;

  // Cams.
  double master_offset = 0;  // [x]
  bool master_absolute = true;
  bool slave_absolute = true;
  bool at_sync_position = false;   // a master position was given; else the beginning of the cam counts
  std::optional<bool> periodic{};  // unset: as the table is, once that was found
};

void describe(Description<CouplingTerm>&);
void describe(Description<CouplingRequest>&);

}  // namespace takt::axis
