// The master of a cam module: the set or measured position of an axis (filtered if it is measured), a coordinate of a
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
  KinematicState before;       // in the previous cycle
  bool known = false;          // the states above are valid
  bool coasts = false;         // the master is lost; the state continues with its last velocity
  bool comes_to_rest = false;  // it was decelerating when it was lost, and continues to do so
  trajectory::TrackingFilterState filter;
  trajectory::Profile motion;  // of a virtual master, or while coasting
  std::uint64_t start_cycle = 0;
  double velocity = 0;  // velocity that `motion` has or approaches
};

// The axis, mover or belt that is followed, as of this cycle.
struct MasterSeen {
  KinematicState at;  // over all turns
  double zero = 0;    // zero of its own position
  double turn = 0;    // one turn; 0: linear
  bool known = false;
  bool measured = false;  // `at` is measured; also set for movers and belts
};
// Returns the state of a master (numbered as by axis::FindMaster) in this cycle.
MasterSeen SeeMaster(const axis::Context& slave, std::uint32_t master, axis::MasterSource source) noexcept;

// Each cycle, after the master has stepped. `coast`: if its position is lost it continues with its last velocity; if it
// was decelerating it comes to rest, with the ramp of a virtual master.
void Follow(const axis::Context& slave, std::optional<std::uint32_t> master, axis::MasterSource source,
            const Settings& settings, double virtual_velocity, bool coast, MasterState& state) noexcept;

// Return the zero of the master's own position, and the length of one turn (0: linear).
double ZeroOf(const axis::Context& slave, std::optional<std::uint32_t> master) noexcept;
double TurnOf(const axis::Context& slave, std::optional<std::uint32_t> master) noexcept;
// Returns a position of the master as it is reported.
double ReportedOf(const axis::Context& slave, std::optional<std::uint32_t> master, double position) noexcept;

void describe(Description<MasterState>&);

}  // namespace takt::flexcam
