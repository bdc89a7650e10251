// Motions of X and Y: on a straight line, from one line onto another, to rest.
//
// Limits hold along the path. X and Y may also move each by itself (MotionOfEach): a motion whose frame is that of X
// and Y. Each has the share kEach of the limits, so that the vectors keep the limits whatever the other coordinate
// does, and the two are planned independently.
//
// A motion has a frame: one coordinate along a direction, the other across it, each with a profile of its own. On a
// line there is no motion across. If a move begins during another one, the new line is the direction; the velocity and
// acceleration across it are braked and the displacement is taken back while the mover already moves along. For that
// the limits are split: the share s of each for across, sqrt(1 - s²) for along, so that velocity, acceleration and jerk
// as vectors stay within their limits at all times, whatever the two profiles do. Once the motion across is over, along
// has the full limits. If no share fits, or it would take longer, the mover first comes to rest on its old line.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

struct PlaneState {
  KinematicState x, y;  // [mm]
};

struct PlaneMotion {
  double origin_x = 0, origin_y = 0;        // [mm]
  double direction_x = 1, direction_y = 0;  // unit vector of along; across is to its left
  double share = 0;                         // of the limits, for across while that lasts; 0: a line
  double end_x = 0, end_y = 0;              // [mm]
  trajectory::Profile along, across;        // [mm] from the origin
};

PlaneMotion StandingAt(double x, double y) noexcept;
// Returns the state `t` [s] after the beginning; from the end on, exactly the end position at rest.
PlaneState At(const PlaneMotion& motion, double t) noexcept;
double DurationOf(const PlaneMotion& motion) noexcept;  // [s]
// Returns an upper bound of the distance [mm] between the motion and the straight line from its start to its end.
double BesideLine(const PlaneMotion& motion) noexcept;
// Returns an upper bound of the speed [mm/s].
double SpeedBound(const PlaneMotion& motion) noexcept;

// Plans a straight motion to rest at (x, y), or, from a motion in progress, onto the line to it. Returns false if there
// is none within these limits.
bool PlanMove(trajectory::Planner& planner, const PlaneState& from, double x, double y,
              const trajectory::Limits& limits, PlaneMotion& out) noexcept;
// How a corner is blended: the mover leaves the first line `before` the corner with `speed`, and moves onto the second
// one.
struct Corner {
  double before = 0;  // [mm] above 0
  double speed = 0;   // [mm/s] from which the mover can still stop at the corner
  double share = 0;   // of the limits, across the second line
};
// Plans the fastest blend from a motion, which ends at the corner, to (x, y). The motion may be left at most `most`
// [mm] before its end. `motion` and `limits` are those of the first line, and `motion` is changed for the blend;
// `then`: the limits of the second line; `t` [s]: elapsed time of `motion`. Returns false if there is none; `motion` is
// then unchanged.
bool PlanCorner(trajectory::Planner& planner, double x, double y, double most, const trajectory::Limits& limits,
                const trajectory::Limits& then, double t, PlaneMotion& motion, Corner& corner) noexcept;
// Plans the motion from the point where the first line is left onto the line from the corner to (x, y).
bool PlanRound(trajectory::Planner& planner, const PlaneState& from, const PlaneState& corner, double x, double y,
               double share, const trajectory::Limits& limits, PlaneMotion& out) noexcept;
// Plans a stop from the time `t` [s] of a motion, in its own frame.
bool PlanRest(trajectory::Planner& planner, const PlaneMotion& motion, double t, const trajectory::Limits& limits,
              PlaneMotion& out) noexcept;
// Plans a stop from any state: on a line if velocity and acceleration are parallel; else the acceleration is first
// taken to 0 at full jerk against its own direction, and then the velocity on a line.
bool PlanRest(trajectory::Planner& planner, const PlaneState& from, const trajectory::Limits& limits,
              PlaneMotion& out) noexcept;

// Share of the limits for X and Y each, if they move independently: as vectors, both together keep the limits.
inline constexpr double kEach = 0.70710678118654752;
// Returns the limits of X or Y by itself. One may brake while the other accelerates, so the smaller of acceleration and
// deceleration counts for both.
trajectory::Limits LimitsOfEach(const trajectory::Limits& maximum) noexcept;
// Returns true if X and Y can each move independently from this state within the limits `each`.
bool FitsEach(const PlaneState& at, const trajectory::Limits& each) noexcept;
// Returns the motion of X and Y each by itself; both profiles count from the origin of the coordinates.
PlaneMotion MotionOfEach(const trajectory::Profile& x, const trajectory::Profile& y) noexcept;

// Shifts the whole motion.
inline void Shift(double x, double y, PlaneMotion& motion) noexcept {
  motion.origin_x += x;
  motion.origin_y += y;
  motion.end_x += x;
  motion.end_y += y;
}

void describe(Description<PlaneMotion>&);

}  // namespace takt::mover
