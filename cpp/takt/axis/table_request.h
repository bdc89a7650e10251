// The part of a request that only commands with a table (a cam, or a table over time) have: which table, and its
// scaling.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

inline constexpr std::uint32_t kNoTable = 0xffffffff;

struct TableRequest {
  Name name;                       // empty: no table
  std::uint32_t index = kNoTable;  // among the machine's cams, looked up when the command arrives
  double time_scale = 1;           // tables over time: [s per s of the table]
  double scale = 1;                // of y
  double offset = 0;               // added to the scaled y
};

void describe(Description<TableRequest>&);

}  // namespace takt::axis
