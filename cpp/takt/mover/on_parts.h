// Movers on a surface made of parts (planar/parts.h): coordinates with a reference, the part under a mover, and that it
// goes nowhere else. Without parts there is nothing to hinder it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "takt/mover/run.h"
#include "takt/planar/area.h"
#include "takt/planar/parts.h"

namespace takt::mover {

// Brings coordinates with a reference into the coordinate system where the mover is. kReference: there is no such
// reference, or it is of another coordinate system.
ErrorId ToItsSystem(const Context& c, const State& s, const Name& reference, double& x, double& y) noexcept;

// What a mover covers of the plane; tracks apart.
struct Cover {
  std::array<planar::Area, 5> areas{};
  std::uint32_t count = 0;

  std::span<const planar::Area> all() const noexcept { return {areas.data(), count}; }
};
// From now on: it stands there or goes on as planned, or stops at once where set points come from outside.
Cover CoverOf(const Context& c, const State& s) noexcept;
// If it had to stop from a set point, as after a fault.
Cover CoverOfStop(const Context& c, const SetPoint& at) noexcept;
// On a track, and by so much off its place there at the end of this cycle: between these places its middle stays until
// it rests, and on its way back to the track.
struct PlacesOff {
  std::array<planar::Place, 4> places;
  double margin = 0;  // mm, round these
};
PlacesOff PlacesOffTrack(const Context& c, const PlaneState& off) noexcept;
Cover CoverOf(const Context& c, const State& s, const PlacesOff& places) noexcept;
// If X and Y went so, and C so.
Cover CoverOf(const Context& c, const PlaneMove& move, const CoordinateMove& turn) noexcept;

// What a mover covers (`kind`: an area without places) while it goes so, from a time (s) on.
Cover CoverOf(const planar::Area& kind, const PlaneMotion& motion, double t) noexcept;

// Why the mover must not cover that: kOffStators, kPartDisabled.
ErrorId WhyNotOn(const Context& c, const State& s, const Cover& cover) noexcept;

// The same of the way of a mover along its tracks, turned as it is and as `turn` has it: to its target, or to where it
// stops; of one that goes along with a master, anywhere on its route.
ErrorId WhyNotAlong(const Context& c, const State& s, const planar::Rider& rider, const CoordinateMove& turn) noexcept;
// Whether that way leads over a part.
bool LeadsOver(const Context& c, const State& s, std::uint32_t part) noexcept;

// The part below it cannot take part in anything: it is on its way.
bool IsAway(const Context& c, const State& s) noexcept;
bool IsPartReady(const Context& c, const State& s) noexcept;  // enabled, or there are no parts
bool IsPartSound(const Context& c, const State& s) noexcept;  // without a fault
bool CanPartBeReady(const Context& c, const State& s) noexcept;

// Nothing of it moves, or is going to; and its track does not lead it on.
bool IsStill(const Context& c, const State& s) noexcept;
// Parts in its coordinate system are enabled for it: until it is disabled, or has a fault that leads there.
bool NeedsParts(const State& s) noexcept;

// After each step: which part it is on.
void Locate(const Context& c, State& s) noexcept;

// Its part has gone so far, or the mover is set there; it rests.
void Carry(const Context& c, const planar::Spot& from, const planar::Spot& to, Inputs& inputs, State& s) noexcept;

// What a mover covers that stands there, turned so (deg).
planar::Area AreaAt(const MoverParams& params, const planar::Place& place, double c) noexcept;
// Where the mover is when it stands so, with this reference: the coordinate system and the place in that. Why it must
// not: kReference, kOffStators.
ErrorId FindSpot(const MoverParams& params, const planar::Parts& parts, std::string_view reference,
                 const planar::Pose& pose, planar::Spot& out) noexcept;
// It stands there.
void PutAt(const planar::Spot& at, State& s) noexcept;

}  // namespace takt::mover
