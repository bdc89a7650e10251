// What a cam module follows: the set or measured position of an axis, filtered if it is measured, a coordinate of a
// mover, the travel of a belt, or a virtual master.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/axis.h"
#include "takt/core/describe_fwd.h"
#include "takt/flexcam/params.h"
#include "takt/flexcam/settings.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/tracking_filter.h"

namespace takt::flexcam {

struct MasterState {
  KinematicState now;          // over all turns
  KinematicState before;       // in the cycle before
  bool known = false;          // what is above means something
  bool coasts = false;         // it does not, and goes on as it was
  bool comes_to_rest = false;  // it got slower when it was lost, and does on
  trajectory::TrackingFilterState filter;
  trajectory::Profile motion;  // of a virtual master
  std::uint64_t start_cycle = 0;
  double velocity = 0;  // that it has, or is on its way to
};

// The axis, mover or belt that is followed, as this cycle has it.
struct MasterSeen {
  KinematicState at;  // over all turns
  double zero = 0;    // where its own position is 0
  double turn = 0;    // of it; 0: it has none
  bool known = false;
  bool measured = false;  // `at` is
};
MasterSeen SeeMaster(const axis::Context& slave, std::uint32_t master, axis::MasterSource source) noexcept;

// Each cycle, behind the axis that is the master. `coast`: if its position is lost it goes on with its last velocity;
// one that got slower comes to rest, with the ramp of a virtual one.
void Follow(const axis::Context& slave, std::optional<std::uint32_t> master, axis::MasterSource source,
            const Settings& settings, double virtual_velocity, bool coast, MasterState& state) noexcept;

// Master's own numbers: where its position is 0, and one turn of it (0: it has none).
double ZeroOf(const axis::Context& slave, std::optional<std::uint32_t> master) noexcept;
double TurnOf(const axis::Context& slave, std::optional<std::uint32_t> master) noexcept;
// A position of it as it is reported.
double ReportedOf(const axis::Context& slave, std::optional<std::uint32_t> master, double position) noexcept;

void describe(Description<MasterState>&);

}  // namespace takt::flexcam
