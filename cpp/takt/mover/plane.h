// Motions of X and Y: on a straight line, from one line onto another, to rest.
//
// Limits hold along the way. X and Y may also move each by itself (PlanEach): that is a motion whose frame is that of X
// and Y. Whatever one of them does, the other has the share kEach of the limits, so that the vectors keep them and
// neither has to know of the other.
//
// A motion has a frame: one coordinate along a direction, the other across it, each with a
// profile of its own. On a line there is nothing across. Where a move begins in the middle of another one the new line
// is the direction; what the mover has across it, it brakes and takes back while it already goes along. For that the
// limits are split: the share s of each for across, sqrt(1 - s²) for along, so that velocity, acceleration and jerk as
// vectors stay within their limits at all times, whatever the two profiles do. Once across is over, along has all of
// them. Where no share fits, or it would take longer, the mover comes to rest on its old line first.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

struct PlaneState {
  KinematicState x, y;  // mm
};

struct PlaneMotion {
  double origin_x = 0, origin_y = 0;        // mm
  double direction_x = 1, direction_y = 0;  // of along; across is to its left
  double share = 0;                         // of the limits, for across as long as that lasts; 0: a line
  double end_x = 0, end_y = 0;              // mm
  trajectory::Profile along, across;        // mm, from the origin
};

PlaneMotion StandingAt(double x, double y) noexcept;
// At `t` seconds from its beginning; behind its end it rests there, bit for bit.
PlaneState At(const PlaneMotion& motion, double t) noexcept;
double DurationOf(const PlaneMotion& motion) noexcept;  // s
// Returns an upper bound of the distance [mm] between the motion and the straight line from its start to its end.
double BesideLine(const PlaneMotion& motion) noexcept;
// What the speed does not exceed, mm/s.
double SpeedBound(const PlaneMotion& motion) noexcept;

// Straight to a place and there to rest, or onto the line to it. False: not within these limits.
bool PlanMove(trajectory::Planner& planner, const PlaneState& from, double x, double y,
              const trajectory::Limits& limits, PlaneMotion& out) noexcept;
// How a corner is gone round: `before` it on the first line with `speed`, there over onto the second one.
struct Corner {
  double before = 0;  // mm, > 0
  double speed = 0;   // mm/s; from it the mover can still stop at the corner
  double share = 0;   // of the limits, across the second line
};
// The quickest one from the end of a motion to a place; the motion may be left at `most` mm before its end.
// Motion and limits are those of the first line, changed so that it passes; `then` those of the second.
bool PlanCorner(trajectory::Planner& planner, double x, double y, double most, const trajectory::Limits& limits,
                const trajectory::Limits& then, double t, PlaneMotion& motion, Corner& corner) noexcept;
// From there onto the line from the corner to the place.
bool PlanRound(trajectory::Planner& planner, const PlaneState& from, const PlaneState& corner, double x, double y,
               double share, const trajectory::Limits& limits, PlaneMotion& out) noexcept;
// To rest, from `t` of a motion, in its own frame.
bool PlanRest(trajectory::Planner& planner, const PlaneMotion& motion, double t, const trajectory::Limits& limits,
              PlaneMotion& out) noexcept;
// To rest from any state: on a line if it is on one, else the acceleration goes first, at full jerk in its own
// direction, and then the velocity on a line.
bool PlanRest(trajectory::Planner& planner, const PlaneState& from, const trajectory::Limits& limits,
              PlaneMotion& out) noexcept;

// Of the limits, that X and Y each have that moves by itself: as vectors, both keep the limits whatever they do.
inline constexpr double kEach = 0.70710678118654752;
// Limits of X or Y by itself. One may brake while the other speeds up, so the smaller acceleration counts.
trajectory::Limits LimitsOfEach(const trajectory::Limits& maximum) noexcept;
// Whether X and Y can each go on by themselves from this state within such limits.
bool FitsEach(const PlaneState& at, const trajectory::Limits& each) noexcept;
// X and Y each by itself from now on; both profiles count from the origin of the coordinates.
PlaneMotion MotionOfEach(const trajectory::Profile& x, const trajectory::Profile& y) noexcept;

// Moves all of it.
inline void Shift(double x, double y, PlaneMotion& motion) noexcept {
  motion.origin_x += x;
  motion.origin_y += y;
  motion.end_x += x;
  motion.end_y += y;
}

void describe(Description<PlaneMotion>&);

}  // namespace takt::mover
