// A mover on a track: all that is remembered of it from one cycle to the next.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/planar/braking.h"
#include "takt/planar/gear.h"
#include "takt/planar/network.h"
#include "takt/planar/way.h"
#include "takt/trajectory/profile.h"

namespace takt::planar {

inline constexpr std::uint32_t kNobody = 0xffffffff;
inline constexpr std::size_t kPassed = 4;  // tracks that a mover remembers having come from

// What a mover on a track is about.
enum class Aim : std::uint8_t {
  kRest,    // come to rest and stay
  kTarget,  // go to a place on the last track of the route
  kFollow,  // go along with a demand that comes anew in each cycle
};

// Why a mover does not go on.
enum class Waits : std::uint8_t {
  kNot,
  kMover,   // for a mover before it, or at a node
  kRoute,   // its route ends here
  kMaster,  // for its master, an axis, to come where it may go
};

struct Rider {
  bool on = false;                              // on a track; else nothing else counts
  KinematicState at;                            // mm on the first track of the route, and its derivatives
  Route route;                                  // from where it is
  std::array<std::uint32_t, kPassed> passed{};  // the tracks before, the last one first
  std::uint32_t passed_count = 0;
  std::int8_t direction = 1;  // of its way; changes at rest only

  Aim aim = Aim::kRest;
  bool softly = false;     // kRest: as its pace says; else as hard as it can
  double target = 0;       // mm on the last track of the route; of a closed loop turns are counted in
  Gear gear;               // kFollow: whom, and how
  KinematicState demand;   // kFollow: mm, where its master is at the end of this cycle, over all tracks
  Pace pace;               // as commanded
  Brakes brakes;           // its greatest
  std::uint8_t share = 0;  // of kShares: what it brakes with from where it is, by the bends on its way to rest
  double top_speed = 0;    // mm/s, its greatest
  double gap = 0;          // mm to the mover before it, from centre to centre
  double off = 0;          // mm, so far from its place it may be; everybody's gap to it is as much larger
  double zone = 0;         // mm around a node in which it is active at the least: its gap, once there is room for that

  bool planned = false;           // `plan` is good
  trajectory::Profile plan;       // along the way, 0 at `plan_from`
  double plan_from = 0;           // mm on the first track
  double plan_time = 0;           // s since it began
  bool plan_ends = false;         // it goes all the way to the target
  bool there = false;             // it rests at its target
  std::uint32_t calm_cycles = 0;  // so long it does not speed up more, having had to brake
  double eased = 0;               // mm/s², what following asks for, without the shaking of those before it
  double origin = 0;              // mm, of all tracks that it has left behind: at + origin goes on over borders

  std::uint32_t held_by = kNobody;  // the mover that is across its way: it brakes, and goes on once that is clear
  Waits waits = Waits::kNot;
  std::uint32_t waits_for = kNobody;
  std::uint64_t waits_since = 0;  // cycle
};

// What it never exceeds, whatever is commanded.
inline Pace MostOf(const Rider& r) noexcept {
  return {{r.top_speed, r.pace.limits.acceleration, r.brakes.deceleration, r.brakes.jerk},
          r.pace.lateral,
          r.pace.vector_acceleration,
          r.pace.vector_jerk};
}
// What it brakes with from where it is.
inline Brakes BrakesOf(const Rider& r) noexcept {
  return WithShare(r.brakes, r.pace, r.share);
}
// The limits it goes by now: those commanded; but where by their jerk the acceleration that it has would make it faster
// than commanded (than it is, if that is more), or drive it back from braking, its greatest jerk, until that is over.
trajectory::Limits LimitsNow(const Rider& r) noexcept;

inline bool Rests(const KinematicState& x) noexcept {
  return x.velocity == 0 && x.acceleration == 0;
}

// The tracks that it is to go along, that where it is first; of one that stands and is to stay, that one alone. Empty:
// it is on none.
Route TrailOf(const Rider& r) noexcept;

void describe(Enumeration<Aim>&);
void describe(Enumeration<Waits>&);
void describe(Description<Pace>&);
void describe(Description<Brakes>&);
void describe(Description<Rider>&);

}  // namespace takt::planar
