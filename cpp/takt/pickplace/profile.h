// Travel profiles: from where the tool is to a target, over points above both (PP-10 to PP-14). Pure geometry.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/group/commands.h"
#include "takt/kinematics/frames.h"
#include "takt/pickplace/settings.h"

namespace takt::pickplace {

// Where the tool is to be, in a coordinate system that may move.
struct Place {
  group::CoordinateSystem system = group::CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  kinematics::Pose pose;
  double aux1 = 0;     // u
  bool parks = false;  // it is a parking position
};

// How a profile runs.
struct Shape {
  PathMode mode = PathMode::kLinear;
  double start_distance = 0;   // mm, along Z of the start's coordinate system to point 1
  double target_distance = 0;  // mm, along Z of the target's to point 2
  double height = 0;           // mm, of the ellipse over the higher point
  double radius = 0;           // mm, of the rounding at the points; 0: it stops there
  bool keep_orientation = false;
};

// One move of a profile. Orientation and Aux1 change on one that `turns`, and nowhere else.
struct Leg {
  Place to;
  bool arch = false;
  bool turns = false;
  double height = 0;  // mm, of an arch
  double radius = 0;  // mm, of the rounding where it begins; 0: the one before comes to a stop
};

inline constexpr std::size_t kMostLegs = 3;

struct Profile {
  std::array<Leg, kMostLegs> legs;
  std::uint32_t count = 0;
  ErrorId error = ErrorId::kNone;
};

// Where coordinate systems are now.
struct Systems {
  kinematics::Frame base;    // the MCS in the world
  kinematics::Frame start;   // that of the start in the MCS
  kinematics::Frame target;  // that of the target in the MCS
};

// Linear: up to point 1, across to point 2, down. Elliptical: half an ellipse between the points. To or from a parking
// position: two straight legs whatever the mode, over a point `height` further up, rounded by height + radius. Points
// that would lie where start or target are are left out. A rounding reaches no further than half of the shorter leg
// beside it. kParameter: places in ACS. kTiltedEllipse:
// an ellipse where a coordinate system is turned about A or B of the world.
Profile MakeProfile(const Place& start, const Place& target, const Shape& shape, const Systems& systems) noexcept;

// Z of a coordinate system points up, seen from the world.
bool IsUpright(const kinematics::Frame& system) noexcept;

// Limits along a profile.
struct PathRamps {
  double velocity = 0;      // mm/s
  double acceleration = 0;  // mm/s²
  double deceleration = 0;  // mm/s²
  double jerk = 0;          // mm/s³
};

// s that a way from rest to rest takes with these limits, and that all legs of a profile take if it stopped at its
// points: it takes no longer as far as the axes can keep up.
double TimeFor(double length, const PathRamps& ramps) noexcept;
double TimeAlong(const Profile& profile, const Place& start, const PathRamps& ramps, const Systems& systems) noexcept;

// A leg as a move of a group. `aux1`: place of the auxiliary axis in the group, from 0; none: kMaxAxes.
group::MoveLinearAbsolute LineOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation,
                                 std::size_t aux1) noexcept;
group::MoveArch ArchOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation, std::size_t aux1) noexcept;

void describe(Description<Place>&);
void describe(Description<Shape>&);
void describe(Description<Leg>&);
void describe(Description<Profile>&);
void describe(Description<PathRamps>&);

}  // namespace takt::pickplace
