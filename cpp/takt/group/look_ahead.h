// The path ahead of a group: stretches of geometry, and the window of nodes that bounds the path speed. It follows from
// the moves and the cycles in which they came, so that a replay computes it again; it is not part of the state.
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

// Motion of a tool from rest onto a moving carrier (boarding.h).
struct Boarding {
  bool on = false;
  std::uint64_t begin = 0;    // cycle in which it begins
  trajectory::Profile apart;  // travel of the tool minus the carrier's [mm or rad], from the previous cycle on
  // Largest values that it takes of each coordinate, ...
  trajectory::PathCoordinateValues velocity{};
  trajectory::PathCoordinateValues acceleration{};
  trajectory::PathCoordinateValues jerk{};
  double faster = 1;  // largest ratio of the velocity of the tool's travel to the carrier's
  double reach = 0;   // ... up to this arc length of the path [mm], which is not passed before boarding ends
  // At the last node: earliest time of the raw motion since the beginning of boarding [s] (NaN: no node yet), and its
  // largest squared speed.
  double earliest_s = NAN;
  double square = 0;
};

// What carries a path from some arc length on (carrier_bindings.h); "ride" in names.
struct CarrierBinding {
  CarriedTarget cargo;
  Frame reference_inverse;  // of the pose of its object in the planning frame
  bool displaces = false;   // the planning frame is not the MCS there
  // Arc lengths of the path between which the tool changes over from the previous binding.
  double begin = 0;
  double end = 0;
  double speed = 0;  // velocity of the carrier when planned (SpeedOf)
  Boarding boarding;
};

// A carrier of a product coordinate system, and whether its velocity has changed in the last seconds.
struct Unsteady {
  std::uint32_t carrier = 0;
  double left_s = 0;  // [s] until it counts as steady; 0: steady
};

// A piece of path in the planning frame.
struct Stretch {
  path::Segment segment;
  double from = 0;             // arc lengths of the segment between which ...
  double to = 0;               // ... it is used
  double begin = 0;            // arc length of the path at its start
  std::uint64_t move = 0;      // number of its move
  bool joints = false;         // joint space: the auxiliaries are all members; else those beyond the kinematics
  bool stops = false;          // the motion stops at its end
  bool goes_on = false;        // continues the previous stretch without a stop
  bool bends_at_ends = false;  // is blended also where it joins a line tangentially
  bool begun = false;          // its first node has been sampled
  trajectory::AlongPath limits;
  double build_up_s = 0;  // [s] of accelerations; the same from one stop to the next
  // Numbers of the carrier bindings at its start and at its end; if they differ, the tool changes over between them.
  std::uint64_t from_ride = 0, to_ride = 0;
  double eta_begin = 0, eta_end = 0;         // [s] since the start of the engine, expected when planned
  std::array<double, kZones> zones_until{};  // arc length of the segment up to which it meets each zone; 0: not at all
  std::array<double, kZones> zones_from{};   // arc length before which it does not

  double end() const noexcept { return begin + (to - from); }
};

// The corner before the last stretch: two lines with a blend between them. If the blend of the next corner can begin in
// the middle of that stretch, this blend is computed again to end there.
struct OpenCorner {
  bool open = false;
  path::Segment first;   // line before the corner
  double from = 0;       // arc length of `first` at which the blend begins ...
  path::Triple bend{};   // ... and its curvature there
  double reach = 0;      // largest distance from the corner at which it may begin and end
  double deviation = 0;  // largest distance from the lines
};

// The axis named by a feedback with this error.
struct Blame {
  ErrorId error = ErrorId::kNone;
  std::uint32_t axis = 0;  // from 1; 0: none
};

struct LookAhead {
  LookAhead(const trajectory::CoordinateLimits& limits, double period_s)
      : window(kNodes, limits, period_s), timing(period_s), stretches(kStretches) {}

  trajectory::PathWindow window;
  trajectory::PathTiming timing;
  trajectory::PathRehearsal rehearsal;
  CarriedSpeedBound keep_up;
  std::vector<Stretch> stretches;  // a ring
  std::uint64_t first = 0;         // number of the oldest stretch
  std::uint64_t count = 0;

  OpenCorner corner;
  std::array<CarrierBinding, kRides> rides{};        // a ring
  std::array<Unsteady, kProductSystems> unsteady{};  // carriers of product coordinate systems
  std::uint64_t end_ride = 0;                        // of the end of the last stretch
  std::uint64_t from_ride = 0;                       // of the start of the move being planned
  std::uint64_t rides_end = 1;                       // number after the newest one
  double end_eta = 0;                                // expected time of arrival there [s since the start of the engine]
  double next_time_s = 0;                            // [s] expected duration of the next stretch; 0: not yet known

  // The stretch being planned, not yet joined to the others.
  Stretch next;
  trajectory::BuildUp build_up;
  trajectory::PathSlopes tried;  // at the point verified last
  // End of the plan, from which the next move starts; and the end of `next`.
  kinematics::Joints end_joints{};
  kinematics::Frame end_tool;
  kinematics::Joints next_joints{};
  kinematics::Frame next_tool;
  // The whole arch, while its pieces are planned.
  path::Point arch_begin, arch_end;
  path::Triple arch_up{};
  int arch_pieces = 0;
  double arch_left = 0;           // [mm] of the pieces after the next one
  double load = 0;                // largest share of a velocity limit taken by carriers at the points verified
  double tried_at_way = 0;        // arc length of `next` and ...
  KDL::Vector tried_at;           // ... position in the world of the point noted last for zones
  std::uint32_t tried_zones = 0;  // mask, met by the elements of a path verified so far
  // End of the plan before a path was verified that is not yet planned.
  kinematics::Joints tried_from{};
  kinematics::Frame tried_from_tool;
  std::uint64_t tried_from_ride = 0;
  double tried_from_eta = 0;
  double tried_way = 0;        // [mm] of the elements before the next one
  bool known = false;          // the end is that of a plan; false: the present position of the members
  kinematics::Joints near{};   // at the point verified last
  trajectory::PathPoint last;  // the node sampled last
  kinematics::Joints last_joints{};
  std::uint64_t sampling = 0;  // number of the stretch being sampled
  bool delayed = false;        // the motion was slower than rehearsed
  bool asked = false;          // the path check request has been sent
  bool cut_short = false;      // the path ends where it cannot be continued; State::reason says why
  Blame blame;                 // in this cycle
  std::uint64_t failures = 0;  // Failures::Detail (failures.h) at the point refused last; 0: none

  Stretch& operator[](std::uint64_t number) noexcept { return stretches[number % stretches.size()]; }
  const Stretch& operator[](std::uint64_t number) const noexcept { return stretches[number % stretches.size()]; }
  std::uint64_t end() const noexcept { return first + count; }
  // Returns the stretch at an arc length of the path, the first or last one if that is outside; null if there is none.
  const Stretch* At(double place) const noexcept {
    std::uint64_t i = first;
    while (i + 1 < end() && (*this)[i].end() <= place) ++i;
    return count > 0 ? &(*this)[i] : nullptr;
  }
};

}  // namespace takt::group
