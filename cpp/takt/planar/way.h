// The motion of one mover along its route without other movers: time-optimal within its limits, slowing down before
// curves.
//
// Velocity, acceleration and jerk of the mover are vectors in the plane. Along a track of curvature k, with its rate k'
// by arc length, and with speed v, acceleration a and jerk j along the track,
//   acceleration:  a along,               k v²            across
//   jerk:          j - k² v³ along,       3 k v a + k' v³ across.
// In a bend a mover therefore has only a share of its dynamics along the track (kShares): the largest one with which
// the lengths of both vectors keep their maxima. The speed in a bend is such that the smallest share always does
// (SpeedIn).
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

// Limits of the motion of a mover.
struct Pace {
  trajectory::Limits limits;  // along the route; jerk > 0
  double lateral = 0;         // [mm/s²] in curves; > 0
  // The largest lengths of the vectors, whatever is commanded; infinite: not limited.
  double vector_acceleration = std::numeric_limits<double>::infinity();  // [mm/s²]
  double vector_jerk = std::numeric_limits<double>::infinity();          // [mm/s³]

  Brakes brakes() const noexcept { return {limits.deceleration, limits.jerk}; }
};

// Shares of the largest acceleration and jerk that a mover may use along a track, the largest first.
struct Share {
  double acceleration = 1;
  double jerk = 1;
};
inline constexpr std::array<Share, 4> kShares{{{1, 1}, {0.7, 0.7}, {0.4, 0.45}, {0.2, 0.25}}};

// Return `limits` and `brakes`, reduced to at most this share of the vectors' maxima.
trajectory::Limits WithShare(trajectory::Limits limits, const Pace& pace, std::size_t share) noexcept;
Brakes WithShare(Brakes brakes, const Pace& pace, std::size_t share) noexcept;

// Largest absolute values of the motion in a stretch.
struct Stress {
  double speed = 0;
  double acceleration = 0;  // along the track
  double jerk = 0;
};
// Returns true if the vectors keep their maxima in a bend.
bool KeepsVectors(const Bend& bend, const Stress& stress, const Pace& pace) noexcept;
// Returns the largest speed [mm/s] in a bend, at most that of the pace.
double SpeedIn(const Bend& bend, const Pace& pace) noexcept;

// Start of a motion: position, speed and acceleration along the route, >= 0 in its direction.
struct Start {
  const Route* route = nullptr;
  double s = 0;               // [mm] on the first track
  std::int8_t direction = 1;  // -1: backwards on the first track
  double speed = 0;
  double acceleration = 0;
};

// A speed limit from a distance on.
struct Cap {
  double way;        // [mm] from here
  double speed;      // [mm/s]
  double curvature;  // [1/mm] as in Bend
  double rate;

  Bend bend() const noexcept { return {0, curvature, rate}; }
  bool bends() const noexcept { return curvature > 0; }
};
inline constexpr std::size_t kCaps = 64;
struct Caps {
  std::array<Cap, kCaps> of;  // the first one is at the mover; only the first `count` are set
  std::size_t count = 0;
  bool cut = false;  // there are more than fit in

  void Add(double way, double speed, const Bend& bend) noexcept;
  std::span<const Cap> all() const noexcept { return {of.data(), count}; }
};
// Returns the speed limits of bends up to the distance `until` [mm]; at least one. A start beyond an end of the first
// track, by rounding, counts as that end.
Caps CapsAhead(const Network& network, const Start& start, double until, const Pace& pace) noexcept;

// Returns true if there is no bend up to this distance [mm]: all caps are the velocity of the pace. Always false on a
// closed track.
bool IsStraight(const Network& network, const Start& start, double until) noexcept;

// Result of planning.
enum class Planned : std::uint8_t {
  kWay,   // the motion to the target, or as much of it as fits in one plan
  kStop,  // it cannot stop there any more: it brakes as commanded
  kHard,  // that would make it too fast, or reverse: its maximum dynamics, until another plan is possible
};
// Plans the quickest motion to rest at the distance `way` [mm, >= 0] along the route; `out` begins at 0. `ends`: the
// plan reaches that distance. `most`: limits that are never exceeded, whatever is commanded; with them the mover can
// brake in time.
Planned PlanWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
                const Pace& most, trajectory::Profile& out, bool& ends) noexcept;

// Returns an estimate of the travel time [s] to a stop at this distance [mm], ours, in closed form: constant
// acceleration between the caps, plus the delay by the jerk limit at each change between acceleration and deceleration.
// The error is below 8 per cent for nine of ten random routes with bends. Beyond 1000 caps the mean speed so far is
// assumed.
double EstimateTravelTime(const Network& network, const Start& start, double way, const Pace& pace) noexcept;

}  // namespace takt::planar
