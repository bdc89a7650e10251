// One mover on its way along tracks, as if it were alone: the quickest motion that keeps its limits and slows down
// before curves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/planar/braking.h"
#include "takt/planar/network.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/profile.h"

namespace takt::planar {

// How fast a mover may go.
struct Pace {
  trajectory::Limits limits;  // along the way; jerk > 0
  double lateral = 0;         // mm/s², in curves; > 0

  Brakes brakes() const noexcept { return {limits.deceleration, limits.jerk}; }
};

// Where a mover is and where it goes: place, speed and acceleration along the way, >= 0 in its direction.
struct Start {
  const Route* route = nullptr;
  double s = 0;               // mm, on the first track
  std::int8_t direction = 1;  // -1: back along the first track
  double speed = 0;
  double acceleration = 0;
};

// From here on the way may be gone so fast.
struct Cap {
  double way = 0;    // mm from here
  double speed = 0;  // mm/s
};
inline constexpr std::size_t kCaps = 32;
struct Caps {
  std::array<Cap, kCaps> of{};  // the first one is where the mover is
  std::size_t count = 0;
  bool cut = false;  // there are more than it has room for

  void Add(double way, double speed) noexcept;
};
// How fast curves may be gone through, so far on; one at least. A place before the start of the track, by rounding, is
// that start.
Caps CapsAhead(const Network& network, const Start& start, double until, const Pace& pace) noexcept;

// What came of a plan.
enum class Planned : std::uint8_t {
  kWay,   // it is the way, or as much of it as can be planned in one go
  kStop,  // it cannot stop there any more: it brakes as it was told to
  kHard,  // it would get too fast in that, or go back: it uses its greatest dynamics, until another plan can be made
};
// The quickest way to rest so far on (mm from here, along the way, >= 0); `out` begins at 0. `ends`: it is all of it.
// `most`: what it never exceeds, whatever it is told; with that it can brake in time.
Planned PlanWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
                const Pace& most, trajectory::Profile& out, bool& ends) noexcept;

}  // namespace takt::planar
