// Movers on a surface made of parts (planar/parts.h): coordinates with a reference, the part under a mover, and the
// check that a mover stays on enabled stators. Without parts every check passes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "takt/mover/run.h"
#include "takt/planar/area.h"
#include "takt/planar/parts.h"

namespace takt::mover {

// Transforms coordinates relative to `reference` into the coordinate system of the mover. Returns kReference if the
// reference is unknown or belongs to another coordinate system.
ErrorId ToMoverSystem(const Context& c, const State& s, const Name& reference, double& x, double& y) noexcept;

// The areas that a mover covers in the plane, without those that it will cover along tracks.
struct Cover {
  std::array<planar::Area, 5> areas{};
  std::uint32_t count = 0;

  std::span<const planar::Area> all() const noexcept { return {areas.data(), count}; }
};
// From now on: along the planned motion; with external set points, along a stop with maximum dynamics.
Cover CoverOf(const Context& c, const State& s) noexcept;
// Along a stop with maximum dynamics from the set point `at`, as after a fault; empty without parts.
Cover CoverOfStop(const Context& c, const SetPoint& at) noexcept;
// Of a mover displaced from its track by `off` [mm] at the end of this cycle: the hull of its centre until it rests,
// with the return onto the track.
struct DisplacedHull {
  std::array<planar::Place, 4> places;
  double margin = 0;  // [mm] around these positions
};
DisplacedHull DisplacedHullOf(const Context& c, const PlaneState& off) noexcept;
Cover CoverOf(const Context& c, const State& s, const DisplacedHull& places) noexcept;
// Along a planned motion of X and Y with a rotation of C.
Cover CoverOf(const Context& c, const PlaneMove& move, const CoordinateMove& turn) noexcept;

// The area that a mover (`kind`: an area without positions) covers along a motion, from the time t [s] on.
Cover CoverOf(const planar::Area& kind, const PlaneMotion& motion, double t) noexcept;

// Returns kOffStators if the cover, with that of the planets of its formation, leaves the stators; kPartDisabled if it
// touches a part that is neither enabled nor about to be; else kNone.
ErrorId DiagnoseCover(const Context& c, const State& s, const Cover& cover) noexcept;

// The same for the route of a mover on tracks (planar::ReachableInterval), with its present angle and those of `turn`.
ErrorId DiagnoseRoute(const Context& c, const State& s, const planar::Rider& rider,
                      const CoordinateMove& turn) noexcept;
// Returns true if the route of a mover on a track leads over the part; false off tracks.
bool LeadsOver(const Context& c, const State& s, std::uint32_t part) noexcept;

// Returns true if the part under the mover is changing its position; false without a part.
bool IsAway(const Context& c, const State& s) noexcept;
bool IsPartReady(const Context& c, const State& s) noexcept;     // enabled; true without parts
bool IsPartSound(const Context& c, const State& s) noexcept;     // without a fault
bool CanPartBeReady(const Context& c, const State& s) noexcept;  // may be enabled; true without parts

// Returns true if the mover rests, has no pending move and is not joining or leaving a track.
bool IsStill(const Context& c, const State& s) noexcept;
// Returns true if the parts in the coordinate system of the mover must be enabled: unless it is Disabled, or has a
// fault whose reset leads there.
bool NeedsParts(const State& s) noexcept;

// After each step: updates the part that the centre of the mover is on.
void Locate(const Context& c, State& s) noexcept;

// Shifts set and actual position from one spot to the other, with the part under the mover. Requires: at rest.
void ShiftWithPart(const Context& c, const planar::Spot& from, const planar::Spot& to, Inputs& inputs,
                   State& s) noexcept;

// Returns the area of a mover at the position `place` [mm] with the angle `c` [deg].
planar::Area AreaAt(const MoverParams& params, const planar::Place& place, double c) noexcept;
// Resolves a pose relative to `reference` into a coordinate system and a position in it. Returns kNone, kReference
// (unknown, or a part that is moving) or kOffStators.
ErrorId FindSpot(const MoverParams& params, const planar::Parts& parts, std::string_view reference,
                 const planar::Pose& pose, planar::Spot& out) noexcept;
// Sets the mover at rest at this spot.
void PutAt(const planar::Spot& at, State& s) noexcept;

}  // namespace takt::mover
