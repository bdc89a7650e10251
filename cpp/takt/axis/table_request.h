// What a command that follows a table (a cam, or a table over time) carries: which one, and how it is scaled.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

inline constexpr std::uint32_t kNoTable = 0xffffffff;

struct TableRequest {
  Name name;                       // empty: the command follows none
  std::uint32_t index = kNoTable;  // among the machine's cams, found when the command arrives
  double time_scale = 1;           // tables over time: s per s of the table
  double scale = 1;                // of y
  double offset = 0;               // added to that
};

void describe(Description<TableRequest>&);

}  // namespace takt::axis
