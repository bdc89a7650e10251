// One mover on its way along tracks, as if it were alone: a quick motion that keeps its limits and slows down before
// curves.
//
// Velocity, acceleration and jerk of the mover are vectors in the plane. Along a track of curvature k, with its rate k'
// by arc length, and with speed v, acceleration a and jerk j along the track,
//   acceleration:  a along,               k v²            across
//   jerk:          j - k² v³ along,       3 k v a + k' v³ across.
// In a bend a mover therefore has only a share of its dynamics along the track (kShares): the largest one with which
// both lengths keep their maxima. The speed in a bend is such that the smallest share always does (SpeedIn).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

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
  // The largest lengths of the vectors, whatever is commanded; infinite: not bounded.
  double vector_acceleration = std::numeric_limits<double>::infinity();  // mm/s²
  double vector_jerk = std::numeric_limits<double>::infinity();          // mm/s³

  Brakes brakes() const noexcept { return {limits.deceleration, limits.jerk}; }
};

// Shares of the largest acceleration and jerk that a mover has along a track, the largest first.
struct Share {
  double acceleration = 1;
  double jerk = 1;
};
inline constexpr std::array<Share, 4> kShares{{{1, 1}, {0.7, 0.7}, {0.4, 0.45}, {0.2, 0.25}}};

// `limits` and `brakes` with this share at the most.
trajectory::Limits WithShare(trajectory::Limits limits, const Pace& pace, std::size_t share) noexcept;
Brakes WithShare(Brakes brakes, const Pace& pace, std::size_t share) noexcept;

// What a mover does at most in a stretch, without signs.
struct Stress {
  double speed = 0;
  double acceleration = 0;  // along the track
  double jerk = 0;
};
// Whether the vectors keep their maxima in a bend.
bool KeepsVectors(const Bend& bend, const Stress& stress, const Pace& pace) noexcept;
// mm/s: the largest speed in a bend, not more than that of the pace.
double SpeedIn(const Bend& bend, const Pace& pace) noexcept;

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
  double way;        // mm from here
  double speed;      // mm/s
  double curvature;  // as of Bend
  double rate;

  Bend bend() const noexcept { return {0, curvature, rate}; }
  bool bends() const noexcept { return curvature > 0; }
};
inline constexpr std::size_t kCaps = 64;
struct Caps {
  std::array<Cap, kCaps> of;  // the first one is where the mover is; only the first `count` are set
  std::size_t count = 0;
  bool cut = false;  // there are more than it has room for

  void Add(double way, double speed, const Bend& bend) noexcept;
  std::span<const Cap> all() const noexcept { return {of.data(), count}; }
};
// How fast curves may be gone through, so far on; one at least. A place before the start of the track, by rounding, is
// that start.
Caps CapsAhead(const Network& network, const Start& start, double until, const Pace& pace) noexcept;

// Returns true if there is no bend up to this distance [mm]: all caps are the velocity of the pace. False for a closed
// track.
bool IsStraight(const Network& network, const Start& start, double until) noexcept;

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

// Returns an estimate of the travel time [s] to a stop at this distance [mm], ours, in closed form: constant
// acceleration between the caps, plus what the jerk limit adds at each change between acceleration and deceleration.
// The error is below 8 per cent for nine of ten random routes with bends. Beyond 1000 caps the mean speed so far is
// taken.
double TimeOfWay(const Network& network, const Start& start, double way, const Pace& pace) noexcept;

}  // namespace takt::planar
