// Lines and arcs.
//
// The orientation is interpolated about one fixed axis (SLERP; MakeTwist: by the given vector), linearly in s, as are
// auxiliary axes. MakeLine, MakeTwist and MakeArc return kNone and write `out`, or return the problem and leave it.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::path {

// Straight on. The length counts the tool's displacement; where that is less than kSame, or up to 0.2 um and less than
// a thousandth of the others, its turn; where the same holds of that (kSameTurn, 0.0002 deg), the displacement of the
// auxiliary axes. What the length does not count moves evenly along with it.
Problem MakeLine(const Point& from, const Point& to, Segment& out) noexcept;

// Straight on by `way` and, meanwhile, turned evenly by the vector `turn` (axis times angle, of any number of turns),
// to those auxiliary axes. The length counts as for MakeLine.
Problem MakeTwist(const Point& from, const Triple& way, const Triple& turn_rad, const Auxiliaries& to,
                  Segment& out) noexcept;

// Where nothing moves: a place as a segment, of which only the beginning is of use.
Segment Still(const Point& point) noexcept;

// Nearer than this, points are the same.
inline constexpr double kSame = 1e-6;      // mm
inline constexpr double kSameTurn = 1e-6;  // deg

// How a circular arc is given (PLCopen's CircMode).
enum class CircMode : std::uint8_t {
  kBorder,  // a point that it goes through on its way to the end
  kCenter,  // its centre
  kRadius,  // a vector normal to its plane that is as long as its radius
};

// Which of several arcs.
enum class PathChoice : std::uint8_t {
  kCounterclockwise,  // about the normal by the right-hand rule: as seen with the normal pointing at the eye
  kClockwise,         // the other way
  kShort,             // of radius mode: up to half a turn
  kLong,              // of radius mode: half a turn or more
};

// An arc from a start to `end`.
//
// Border: the arc goes from the start through the border point to the end. The plane is that of the three points.
//
// Center: kCounterclockwise or kClockwise about `normal`. Without a normal (0, 0, 0) the plane is that of start, centre
// and end, and its normal the one with Z above 0; if Z is 0, the one with Y above 0; else with X. Where start, centre
// and end lie on a line (half a turn, a whole one), the plane is parallel to X and Y if it can be. An end that is the
// start is a whole turn. The centre may lie anywhere along the normal: it gives the axis.
//
// Radius: turns counterclockwise about the vector, so its other sign gives the other sense; kShort or kLong.
//
// An end out of the plane (center with a normal, radius) makes it a helix with an even rise. `turns` whole turns come
// on top, in every mode.
//
// Small errors are taken: the centre is moved to where start and end are equally far away, by up to kCircleSlack of the
// radius; the radius grows by as much where the end lies too far away.
struct Circle {
  CircMode mode = CircMode::kBorder;
  Triple auxiliary_point{};  // mm: border point, centre, or the vector of radius mode
  PathChoice choice = PathChoice::kCounterclockwise;
  Triple normal{};   // of center mode, of any length
  double turns = 0;  // whole turns on top: a whole number from 0 to kMostTurns, else Problem::kTurns
};

inline constexpr double kCircleSlack = 1e-3;
inline constexpr double kMostTurns = 1e6;

Problem MakeArc(const Point& from, const Circle& circle, const Point& to, Segment& out) noexcept;

void describe(Description<Circle>&);
void describe(Enumeration<CircMode>&);
void describe(Enumeration<PathChoice>&);

}  // namespace takt::path
