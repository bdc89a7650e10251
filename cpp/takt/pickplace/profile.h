// Travel profiles: from the present pose of the tool to a target, via points above both (PP-10 to PP-14). Pure
// geometry.
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

// A pose of the tool in a coordinate system that may move.
struct Place {
  group::CoordinateSystem system = group::CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  kinematics::Pose pose;
  double aux1 = 0;     // [u]
  bool parks = false;  // a parking position
};

// Parameters of a profile.
struct Shape {
  PathMode mode = PathMode::kLinear;
  double start_distance = 0;   // [mm] along Z of the start's coordinate system to point 1
  double target_distance = 0;  // [mm] along Z of the target's coordinate system to point 2
  double height = 0;           // [mm] of the ellipse over the higher point
  double radius = 0;           // [mm] of the rounding at the points; 0: the tool stops there
  bool keep_orientation = false;
};

// One move of a profile. Orientation and Aux1 change only on a leg that `turns`.
struct Leg {
  Place to;
  bool arch = false;
  bool turns = false;
  double height = 0;  // [mm] of an arch
  double radius = 0;  // [mm] of the rounding at its start; 0: the previous leg ends at rest
};

inline constexpr std::size_t kMostLegs = 3;

struct Profile {
  std::array<Leg, kMostLegs> legs;
  std::uint32_t count = 0;
  ErrorId error = ErrorId::kNone;
};

// Present poses of coordinate systems.
struct Systems {
  kinematics::Frame base;    // the MCS in the world
  kinematics::Frame start;   // the start's coordinate system in the MCS
  kinematics::Frame target;  // the target's coordinate system in the MCS
};

// Makes the profile. Linear: up to point 1, across to point 2, down. Elliptical: half an ellipse between the points. To
// or from a parking position: two straight legs in either mode, via a point `height` above point 1 or 2, rounded by
// height + radius; one leg between two parking positions, or if that point coincides with start or target. Points that
// coincide with start or target are omitted. A rounding reaches no further than half of the shorter adjacent leg.
// Errors: kParameter: start or target in ACS; kTiltedEllipse: an ellipse where a coordinate system is turned about A or
// B of the world.
Profile MakeProfile(const Place& start, const Place& target, const Shape& shape, const Systems& systems) noexcept;

// Returns true if Z of a coordinate system points up, seen from the world.
bool IsUpright(const kinematics::Frame& system) noexcept;

// Limits along a profile.
struct PathRamps {
  double velocity = 0;      // [mm/s]
  double acceleration = 0;  // [mm/s²]
  double deceleration = 0;  // [mm/s²]
  double jerk = 0;          // [mm/s³]
};

// TimeFor returns the time [s] from rest to rest over a distance [mm] with these limits; TimeAlong the time [s] of a
// profile that stops at all of its points: the profile takes no longer as far as the axes can keep up.
double TimeFor(double length, const PathRamps& ramps) noexcept;
double TimeAlong(const Profile& profile, const Place& start, const PathRamps& ramps, const Systems& systems) noexcept;

// Returns a leg as a move of a group. `aux1`: index of the auxiliary axis in the group; none: kMaxAxes.
group::MoveLinearAbsolute LineOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation,
                                 std::size_t aux1) noexcept;
group::MoveArch ArchOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation, std::size_t aux1) noexcept;

void describe(Description<Place>&);
void describe(Description<Shape>&);
void describe(Description<Leg>&);
void describe(Description<Profile>&);
void describe(Description<PathRamps>&);

}  // namespace takt::pickplace
