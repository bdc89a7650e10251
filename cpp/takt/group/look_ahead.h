// What a group knows of the path ahead: stretches of geometry, and the window of nodes that says how fast it may go.
// It follows from the moves and the cycles in which they came, so that a replay makes it again, and is no part of the
// state.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "takt/group/keep_up.h"
#include "takt/group/params.h"
#include "takt/group/request.h"
#include "takt/kinematics/frames.h"
#include "takt/path/segment.h"
#include "takt/trajectory/path_rehearsal.h"
#include "takt/trajectory/path_sampling.h"
#include "takt/trajectory/path_timing.h"
#include "takt/trajectory/path_window.h"
#include "takt/trajectory/profile.h"

namespace takt::group {

using kinematics::Frame;

inline constexpr std::size_t kStretches = 512;
inline constexpr std::size_t kNodes = 4096;
inline constexpr std::size_t kRides = 16;

// The way of a tool that was at rest onto a carrier that moves (boarding.h).
struct Boarding {
  bool on = false;
  std::uint64_t begin = 0;    // the cycle in which it begins
  trajectory::Profile apart;  // of the travel of the tool from the carrier's [mm or rad], from the cycle before on
  // What it takes of each coordinate at most, ...
  trajectory::PathCoordinateValues velocity{};
  trajectory::PathCoordinateValues acceleration{};
  trajectory::PathCoordinateValues jerk{};
  double faster = 1;  // the largest velocity of the tool's travel, of the carrier's
  double reach = 0;   // ... before this place along the path [mm]: the path is not further when it ends
  // At the last node: earliest time of the raw motion since the begin of boarding [s] (NaN: no node yet), and its
  // largest squared speed.
  double earliest_s = NAN;
  double square = 0;
};

// What a path is carried by from some place on (carrier_bindings.h).
struct CarrierBinding {
  CarriedTarget cargo;
  Frame reference_inverse;  // of where it lies in the still world
  bool displaces = false;   // the still world is not the MCS there
  // From where to where along the path the tool goes over to it from the ride before.
  double begin = 0;
  double end = 0;
  double speed = 0;  // of what carries, when it was planned
  Boarding boarding;
};

// A carrier of a product coordinate system, and whether its speed has changed in the last seconds.
struct Unsteady {
  std::uint32_t carrier = 0;
  double left_s = 0;  // until it counts as steady; 0: it does
};

// A piece of path in the still world.
struct Stretch {
  path::Segment segment;
  double from = 0;             // of the segment ...
  double to = 0;               // ... is gone
  double begin = 0;            // along the path
  std::uint64_t move = 0;      // number of the move that it belongs to
  bool joints = false;         // its auxiliaries are all members; else those behind the kinematics
  bool stops = false;          // the motion stops at its end
  bool goes_on = false;        // from the stretch before, without a corner
  bool bends_at_ends = false;  // it is rounded also where it goes on from a line
  bool begun = false;          // its first node is there
  trajectory::AlongPath limits;
  double build_up_s = 0;  // of accelerations, from one stop to the next
  // Numbers of the ride on which it is, and of the one from which the tool goes over to that on the way.
  std::uint64_t from_ride = 0, to_ride = 0;
  double eta_begin = 0, eta_end = 0;         // s from the start of the engine, expected when it was planned
  std::array<double, kZones> zones_until{};  // of the segment: so far it meets these zones; 0: it does not
  std::array<double, kZones> zones_from{};   // and not before this

  double end() const noexcept { return begin + (to - from); }
};

// The corner before the last stretch: two lines, a blend between them. Where the next corner's blend can begin in the
// middle of that stretch, this one is made again to end there.
struct OpenCorner {
  bool open = false;
  path::Segment first;   // the line before it
  double from = 0;       // of that, where the blend begins
  path::Triple bend{};   // with this curvature
  double reach = 0;      // so far from the corner may it begin and end at most
  double deviation = 0;  // and be so far from the lines
};

// The axis that a feedback with this error names.
struct Blame {
  ErrorId error = ErrorId::kNone;
  std::uint32_t axis = 0;  // number, from 1; 0: none
};

struct LookAhead {
  LookAhead(const trajectory::CoordinateLimits& limits, double period_s)
      : window(kNodes, limits, period_s), timing(period_s), stretches(kStretches) {}

  trajectory::PathWindow window;
  trajectory::PathTiming timing;
  trajectory::PathRehearsal rehearsal;
  KeepUp keep_up;
  std::vector<Stretch> stretches;  // a ring
  std::uint64_t first = 0;         // number of the oldest one
  std::uint64_t count = 0;

  OpenCorner corner;
  std::array<CarrierBinding, kRides> rides{};        // a ring
  std::array<Unsteady, kProductSystems> unsteady{};  // carriers of product coordinate systems
  std::uint64_t end_ride = 0;                        // of the last stretch
  std::uint64_t from_ride = 0;                       // of the start of the move being planned
  std::uint64_t rides_end = 1;                       // behind the newest one
  double end_eta = 0;                                // when the tool is expected there
  double next_time_s = 0;                            // how long the next stretch is expected to take; 0: not known yet

  // The stretch being planned: not yet joined to the others.
  Stretch next;
  trajectory::BuildUp build_up;
  trajectory::PathSlopes tried;  // of the place tried last
  // Where the plan ends, as the next move finds it; and with the next stretch.
  kinematics::Joints end_joints{};
  kinematics::Frame end_tool;
  kinematics::Joints next_joints{};
  kinematics::Frame next_tool;
  // An arch, as a whole, while its pieces are planned.
  path::Point arch_begin, arch_end;
  path::Triple arch_up{};
  int arch_pieces = 0;
  double arch_left = 0;           // mm, of the pieces behind the next one
  double load = 0;                // the largest share of a limit that carriers take, of what was tried
  double tried_at_way = 0;        // of `next`, and
  KDL::Vector tried_at;           // in the world: the place tried last
  std::uint32_t tried_zones = 0;  // that a path meets, a mask
  // Where it ended before a path was tried that is not yet planned.
  kinematics::Joints tried_from{};
  kinematics::Frame tried_from_tool;
  std::uint64_t tried_from_ride = 0;
  double tried_from_eta = 0;
  double tried_way = 0;        // mm, of the elements before the next one
  bool known = false;          // whether it is more than where the members stand
  kinematics::Joints near{};   // of the place tried last
  trajectory::PathPoint last;  // the node sampled last
  kinematics::Joints last_joints{};
  std::uint64_t sampling = 0;  // the stretch being sampled
  bool delayed = false;        // the motion was slower than rehearsed
  bool asked = false;          // the question whether the path is free is on its way
  bool cut_short = false;      // the path ends where it could not be gone on with; `reason` says why
  Blame blame;                 // in this cycle
  std::uint64_t failures = 0;  // of the axes there, or at the place refused last (failures.h)

  Stretch& operator[](std::uint64_t number) noexcept { return stretches[number % stretches.size()]; }
  const Stretch& operator[](std::uint64_t number) const noexcept { return stretches[number % stretches.size()]; }
  std::uint64_t end() const noexcept { return first + count; }
  // The stretch that a place of the path lies on, the first or the last one beyond their ends; null: there is none.
  const Stretch* At(double place) const noexcept {
    std::uint64_t i = first;
    while (i + 1 < end() && (*this)[i].end() <= place) ++i;
    return count > 0 ? &(*this)[i] : nullptr;
  }
};

}  // namespace takt::group
