// A mover on a track: its complete state from one cycle to the next.
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
inline constexpr std::size_t kPassed = 4;  // number of tracks remembered behind a mover

// What a mover on a track is to do.
enum class Aim : std::uint8_t {
  kRest,    // come to rest and stay
  kTarget,  // move to a position on the last track of the route
  kFollow,  // follow a demand that is updated in each cycle
};

// Why a mover waits.
enum class Waits : std::uint8_t {
  kNot,
  kMover,   // for a mover ahead, or at a node
  kRoute,   // its route ends here
  kMaster,  // for its master, an axis, to reach a position that the mover may take
};

struct Rider {
  bool on = false;                              // on a track; if false, nothing else is valid
  KinematicState at;                            // [mm] on the first track of the route, and derivatives
  Route route;                                  // from the current track on
  std::array<std::uint32_t, kPassed> passed{};  // the tracks before, the latest first
  std::uint32_t passed_count = 0;
  std::int8_t direction = 1;  // of its motion, 1 or -1; at rest, of the next one

  Aim aim = Aim::kRest;
  bool softly = false;     // kRest: with its pace; if false, with its maximum dynamics
  double target = 0;       // [mm] on the last track of the route; on a closed loop with turns
  Gear gear;               // kFollow: the master and the coupling
  KinematicState demand;   // kFollow: [mm] master at the end of this cycle, over all tracks
  Pace pace;               // commanded limits
  Brakes brakes;           // maximum dynamics
  std::uint8_t share = 0;  // index into kShares: dynamics for braking from here in the bends ahead
  double top_speed = 0;    // [mm/s] maximum speed
  double gap = 0;          // [mm] to the mover ahead, between centres
  double off = 0;          // [mm] largest displacement from its position; every gap to it grows by that
  double zone = 0;         // [mm] around nodes, at least, in which it is active: its gap, once there is room for that

  bool planned = false;           // `plan` is valid
  trajectory::Profile plan;       // along the route in its direction, 0 at `plan_from`
  double plan_from = 0;           // [mm] on the first track
  double plan_time = 0;           // [s] since the start of the plan
  bool plan_ends = false;         // the plan reaches the target
  bool there = false;             // at rest at its target
  std::uint32_t calm_cycles = 0;  // cycles left in which its acceleration does not grow, after it had to brake
  double eased = 0;               // [mm/s²] acceleration that following asks for, smoothed
  double origin = 0;              // [mm] length of all tracks left behind: at + origin is continuous across tracks

  std::uint32_t held_by = kNobody;  // the mover across its path, for which it brakes until the path is clear
  Waits waits = Waits::kNot;
  std::uint32_t waits_for = kNobody;
  std::uint64_t waits_since = 0;  // cycle
};

// Returns the limits that it never exceeds, whatever is commanded.
inline Pace MostOf(const Rider& r) noexcept {
  return {{r.top_speed, r.pace.limits.acceleration, r.brakes.deceleration, r.brakes.jerk},
          r.pace.lateral,
          r.pace.vector_acceleration,
          r.pace.vector_jerk};
}
// Returns the limits with which it brakes from its current position.
inline Brakes BrakesOf(const Rider& r) noexcept {
  return WithShare(r.brakes, r.pace, r.share);
}
// Returns the limits in force: those commanded, but with its maximum jerk as long as the commanded jerk would let the
// current acceleration make it faster than commanded (than its speed, if that is higher), or drive it back after
// braking.
trajectory::Limits LimitsNow(const Rider& r) noexcept;

inline bool Rests(const KinematicState& x) noexcept {
  return x.velocity == 0 && x.acceleration == 0;
}

// Returns the tracks that it is to move along, the current one first; only that one if it is at rest and is to stay.
// Empty if it is on no track.
Route RemainingTracks(const Rider& r) noexcept;

void describe(Enumeration<Aim>&);
void describe(Enumeration<Waits>&);
void describe(Description<Pace>&);
void describe(Description<Brakes>&);
void describe(Description<Rider>&);

}  // namespace takt::planar
