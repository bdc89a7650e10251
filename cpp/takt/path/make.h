// Lines and arcs.
//
// The orientation is interpolated about one fixed axis (SLERP; MakeTwist: by the given vector), linearly in s, as are
// auxiliary axes. MakeLine, MakeTwist and MakeArc return kNone and write `out`, or return the problem and leave `out`
// unchanged.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::path {

// Makes a straight line. The length counts the tool's displacement; if that is less than kSame, or up to 0.2 um and
// less than a thousandth of the turn or of the auxiliary axes' displacements, its turn; if the same holds for the turn
// (kSameTurn, 0.0002 deg) and the auxiliary axes, the displacement of the auxiliary axis that moves furthest.
// Everything that the length does not count changes linearly along with it.
Problem MakeLine(const Point& from, const Point& to, Segment& out) noexcept;

// Makes a straight line with the displacement `way` [mm], linearly turned by the vector `turn_rad` (axis times angle,
// any number of turns), to the auxiliary axes `to`. The length counts as for MakeLine.
Problem MakeTwist(const Point& from, const Triple& way, const Triple& turn_rad, const Auxiliaries& to,
                  Segment& out) noexcept;

// Returns a segment in which nothing moves; only its beginning is meaningful.
Segment Still(const Point& point) noexcept;

// Points closer than this are the same.
inline constexpr double kSame = 1e-6;      // [mm]
inline constexpr double kSameTurn = 1e-6;  // [deg]

// How a circular arc is given (PLCopen's CircMode).
enum class CircMode : std::uint8_t {
  kBorder,  // by a point that it passes on its way to the end
  kCenter,  // by its centre
  kRadius,  // by a vector normal to its plane, as long as its radius
};

// Choice between several arcs.
enum class PathChoice : std::uint8_t {
  kCounterclockwise,  // about the normal by the right-hand rule: as seen with the normal pointing at the eye
  kClockwise,         // in the opposite sense
  kShort,             // radius mode: up to half a turn
  kLong,              // radius mode: half a turn or more
};

// An arc from a start to `end`.
//
// Border: the arc runs from the start through the border point to the end, in the plane of the three points.
//
// Center: kCounterclockwise or kClockwise about `normal`. Without a normal (0, 0, 0) the plane is that of start, centre
// and end, and its normal the one with Z above 0; if Z is 0, the one with Y above 0; else with X. Where start, centre
// and end lie on a line (half a turn, a whole one), the plane is parallel to X and Y if possible. An end equal to the
// start is a whole turn. The centre may lie anywhere along the normal: it defines the axis.
//
// Radius: turns counterclockwise about the vector, so its opposite gives the opposite sense; kShort or kLong.
//
// An end out of the plane (center with a normal, radius) makes it a helix with a constant rise. `turns` whole turns are
// added, in every mode.
//
// Small errors are accepted: the centre is moved to where start and end are equally far away, by up to kCircleSlack of
// the radius; the radius grows by up to as much if the end lies too far away.
struct Circle {
  CircMode mode = CircMode::kBorder;
  Triple auxiliary_point{};  // [mm] border point, centre, or the vector of radius mode
  PathChoice choice = PathChoice::kCounterclockwise;
  Triple normal{};   // center mode: normal of any length; 0: see above
  double turns = 0;  // whole turns added: a whole number from 0 to kMostTurns, else Problem::kTurns
};

inline constexpr double kCircleSlack = 1e-3;
inline constexpr double kMostTurns = 1e6;

Problem MakeArc(const Point& from, const Circle& circle, const Point& to, Segment& out) noexcept;

void describe(Description<Circle>&);
void describe(Enumeration<CircMode>&);
void describe(Enumeration<PathChoice>&);

}  // namespace takt::path
