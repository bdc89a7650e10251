// The extreme values of the slave (the manual's 3.19 and 3.25), computed over a few pieces of the cams in each cycle.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "takt/cam/extremes.h"
#include "takt/cam/table.h"
#include "takt/core/describe_fwd.h"
#include "takt/flexcam/commands.h"

namespace takt::flexcam {

// The cams and the motion of X for which the extreme values are computed.
struct BoundsOf {
  std::array<std::uint32_t, kSlots> cams{};  // indices among the machine's cams
  std::uint32_t count = 0;                   // number of cams
  double velocity = 0;                       // of X
  double acceleration = 0;

  bool operator==(const BoundsOf&) const = default;
};

struct BoundsState {
  BoundsOf of;
  std::uint32_t cam = 0;    // index of the cam in progress ...
  std::uint32_t piece = 0;  // ... and the number of its pieces that are done
  std::uint32_t leap = 0;   // stride from one piece to the next; 0: not yet known
  bool valid = false;       // the computation is complete
  double max_position = 0, min_position = 0, max_velocity = 0, max_acceleration = 0;  // of Y
};

// Continues the computation by a few pieces; restarts it if `of` has changed.
void WorkOut(const BoundsOf& of, std::span<const cam::Table> cams, BoundsState& state) noexcept;

void describe(Description<BoundsOf>&);
void describe(Description<BoundsState>&);

}  // namespace takt::flexcam
