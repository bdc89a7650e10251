#include "takt/mover/follow.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "takt/core/maths.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/course.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"
#include "takt/mover/run.h"

namespace takt::mover {

namespace {

constexpr double kRounding = 1e-6;  // of the limits, for rounding in the program that sends set points
constexpr double kStill = 1e-9;     // [mm, deg] counts as no motion
constexpr int kHalvings = 12;       // of shares

double Length(double x, double y) {
  return maths::Hypot(x, y);
}

// Returns true if one coordinate, or two as a vector, keep the limits in this step. For one, all of y is 0.
bool Keeps(const KinematicState& from_x, const KinematicState& from_y, const KinematicState& x, const KinematicState& y,
           const trajectory::Limits& limits, double period) {
  constexpr double kMore = 1 + kRounding;
  const double most = kMore * std::max(limits.acceleration, limits.deceleration);
  const double a = Length(x.acceleration, y.acceleration);
  // The velocity that is reached even if the acceleration is ramped down at once.
  const double still = a / (2 * limits.jerk);
  const double speed = Length(x.velocity + still * x.acceleration, y.velocity + still * y.acceleration);
  const auto off = [&](const KinematicState& from, const KinematicState& to) {
    return to.position - from.position - 0.5 * period * (from.velocity + to.velocity);
  };
  return Length(x.velocity, y.velocity) <= kMore * limits.velocity && speed <= kMore * limits.velocity && a <= most &&
         Length(x.velocity - from_x.velocity, y.velocity - from_y.velocity) <= most * period &&
         Length(off(from_x, x), off(from_y, y)) <= 0.5 * most * period * period + kStill;
}

// Extrapolates the last external set point with its acceleration.
void GoOn(double period, SetPoint& given) {
  for (KinematicState& k : given) {
    k.position += period * (k.velocity + 0.5 * period * k.acceleration);
    k.velocity += period * k.acceleration;
  }
}

// On a track, where the mover needs lateral acceleration as well: the added set point keeps the limits by itself, and
// both together keep what a track alone may require.
bool AddsNoMore(const Context& c, const External& external, const SetPoint& to) {
  constexpr double kMore = 1 + kRounding;
  const trajectory::Limits limits = c.params.xy.maximum.limits();
  const SetPoint &was = external.taken, &is = external.given;
  const double most = Length(std::max(limits.acceleration, limits.deceleration), c.params.lateral());
  // The speed as a vector that both motions reach before they can slow down: each acceleration ends at full jerk.
  const KinematicState& way = c.rider().at;
  const double still = Length(is[kX].acceleration, is[kY].acceleration) / (2 * limits.jerk);
  const double more = std::max(0.0, way.acceleration * way.velocity) * std::abs(way.acceleration) / (2 * limits.jerk);
  const double x = to[kX].velocity - is[kX].velocity, y = to[kY].velocity - is[kY].velocity, along = x * x + y * y;
  const double longer = along > 0 ? more / along : 0;
  const double speed = Length(to[kX].velocity + still * is[kX].acceleration + longer * x,
                              to[kY].velocity + still * is[kY].acceleration + longer * y);
  return speed <= kMore * limits.velocity && Keeps(was[kX], was[kY], is[kX], is[kY], limits, c.cycle.period_s) &&
         Length(to[kX].velocity, to[kY].velocity) <= kMore * limits.velocity &&
         Length(to[kX].acceleration, to[kY].acceleration) <= kMore * most;
}

// Returns the range of positions that a coordinate passes if it has to stop.
trajectory::Profile::Range StoppingDistance(const Context& c, const KinematicState& from,
                                            const trajectory::Limits& limits) {
  trajectory::Profile stop;
  if (planar::Rests(from) || !c.planner.Stop(from, limits, stop).ok()) return {from.position, from.position};
  return stop.PositionRange();
}

// Returns an upper bound [mm] of the displacement from the position on the track after this set point, even if the
// mover has to stop.
double ReachOf(const Context& c, const PlaneState& off) {
  const planar::Brakes brakes{c.params.xy.maximum.limits().deceleration, c.params.xy.maximum.jerk};
  const double a = Length(off.x.acceleration, off.y.acceleration), t = a / brakes.jerk;
  const double v = Length(off.x.velocity, off.y.velocity);
  return Length(off.x.position, off.y.position) + t * (v + a * t / 3) +
         planar::StoppingDistance(v + 0.5 * a * t, brakes);
}

// Sets the displacement by which the gaps of other movers on tracks to this one grow; kCollision if there is no room.
ErrorId ReserveDisplacement(const Context& c, const PlaneState& off, ObjectInfo& object) {
  planar::Rider& rider = c.rider();
  const double before = rider.off;
  rider.off = ReachOf(c, off);
  if (rider.off <= before) return ErrorId::kNone;
  TrackNetworkState& streets = c.streets;
  const std::uint32_t near = streets.traffic.TooNear(c.cycle, streets.network, streets.riders, c.index);
  if (near == planar::kNobody) return ErrorId::kNone;
  object = ObjectAt(ObjectKind::kMover, near);
  rider.off = before;
  return ErrorId::kCollision;
}

}  // namespace

bool CanFollow(const Context& c, const State& s, const SetPoint& from, const SetPoint& to) noexcept {
  const double period = c.cycle.period_s;
  // With relative set points the mode decides whether X, Y and C may move together; a formation turns within its
  // window.
  const double way = Length(to[kX].position - from[kX].position, to[kY].position - from[kY].position);
  const bool moves = s.mode == CommandMode::kExternalSetpointGeneration &&
                     (way > kStill || !planar::Rests(to[kX]) || !planar::Rests(to[kY]));
  const bool keeps = IsOnTrack(s) ? AddsNoMore(c, s.external, to)
                                  : Keeps(from[kX], from[kY], to[kX], to[kY], c.params.xy.maximum.limits(), period);
  if (!keeps) return false;
  for (std::size_t i = 0; i < kOthers.size(); ++i) {
    const CoordinateParams params = ParamsOf(c, s, i);
    const KinematicState& k = to[kOthers[i]];
    if (!Keeps(from[kOthers[i]], {}, k, {}, params.maximum.limits(), period)) return false;
    const trajectory::Profile::Range stop = StoppingDistance(c, k, params.maximum.limits());
    if (kOthers[i] == kC) {
      const bool bound = moves || IsStar(c) || std::isfinite(params.lower);
      if (bound && !InOneWindow(c.params.c, stop.min, stop.max)) return false;
    } else if (stop.min < params.lower - kRounding || stop.max > params.upper + kRounding) {
      return false;
    }
  }
  const bool locked = s.mode == CommandMode::kCRotationFreeMovement || s.mode == CommandMode::kCRotationOnTrack;
  return !locked || way <= kStill;
}

PlaneState OffTrack(const State& s, const SetPoint& more, double t) noexcept {
  PlaneState off = At(s.plane.motion, t);
  for (const auto& [own, its] : {std::pair(&off.x, &more[kX]), std::pair(&off.y, &more[kY])}) {
    own->position += its->position;
    own->velocity += its->velocity;
    own->acceleration += its->acceleration;
  }
  return off;
}

double ReachOf(const Context& c, const State& s) noexcept {
  const SetPoint& taken = s.external.taken;
  return s.external.mode == SetpointMode::kRelative ? ReachOf(c, PlaneState{taken[kX], taken[kY]}) : 0;
}

namespace {

// A star within the limits of its formation. If it moves and turns, each gets a share of the dynamics with which it
// could stop from there; the remainder is divided equally.
bool CanFollowAsBody(const Context& c, const SetPoint& to, State& s) {
  const SetPoint& from = s.set_point;
  const Body& body = c.fleet.bodies[c.index];
  const auto moves = [&](Coordinate i) {
    return from[i].velocity != 0 || from[i].acceleration != 0 || to[i].velocity != 0 || to[i].acceleration != 0;
  };
  if (!(moves(kX) || moves(kY)) || !moves(kC)) return CanFollow(With(c, body.alone), s, from, to);
  const auto may_turn = [&] { return Keeps(from[kC], {}, to[kC], {}, body.both.c.maximum.limits(), c.cycle.period_s); };
  const auto may_move = [&] {
    return Keeps(from[kX], from[kY], to[kX], to[kY], body.both.xy.maximum.limits(), c.cycle.period_s);
  };
  // Returns bounds, from below and above, of the share up to which `holds_below` is true.
  const auto bound = [&](const auto& holds_below) {
    double below = 0, above = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (below + above) / 2;
      ShareOut(c, middle, s);
      (holds_below() ? below : above) = middle;
    }
    return std::pair{below, above};
  };
  const double before = s.formation.share;
  const double least = bound([&] { return !may_turn(); }).second, most = bound(may_move).first;
  ShareOut(c, (least + most) / 2, s);
  if (least <= most && CanFollow(With(c, body.both), s, from, to)) return true;
  ShareOut(c, before, s);
  return false;
}

}  // namespace

ErrorId Follow(const Context& c, SetPoint& at, State& s, ObjectInfo& object) noexcept {
  External& external = s.external;
  external.missing = external.fresh ? 0 : external.missing + 1;
  if (external.missing >= c.params.missing_setpoints) return ErrorId::kNoSetPoint;
  if (!external.fresh) GoOn(c.cycle.period_s, external.given);
  external.fresh = false;
  SetPoint to = external.given;
  if (external.mode == SetpointMode::kRelative) {
    for (std::size_t i = 0; i < kCoordinates; ++i) {
      to[i].position += at[i].position;
      to[i].velocity += at[i].velocity;
      to[i].acceleration += at[i].acceleration;
    }
  }
  const bool follows = IsStar(c) ? CanFollowAsBody(c, to, s) : CanFollow(c, s, s.set_point, to);
  if (!follows) return ErrorId::kWildSetPoint;
  const PlaneState off = OffTrack(s, external.given, Elapsed(c, s.plane.begin) + c.cycle.period_s);
  if (IsOnTrack(s)) {
    const DisplacedHull places = DisplacedHullOf(c, off);
    if (const ErrorId why = DiagnoseCover(c, s, CoverOf(c, s, places)); why != ErrorId::kNone) return why;
    object = TakeStopOff(c, places, to);
    if (!object) object = TakeCourseOff(c, s, to);
  } else {
    if (const ErrorId why = DiagnoseCover(c, s, CoverOfStop(c, to)); why != ErrorId::kNone) return why;
    if (external.mode == SetpointMode::kRelative) object = TakeStop(c, s, to);
    if (!object) object = TryCourse(c, to, s);
  }
  ErrorId why = object ? ErrorId::kCollision : ErrorId::kNone;
  if (!object && c.rider().on)
    why = ReserveDisplacement(c, IsOnTrack(s) ? off : PlaneState{external.given[kX], external.given[kY]}, object);
  if (why != ErrorId::kNone) return why;
  external.taken = external.given;
  at = to;
  return ErrorId::kNone;
}

}  // namespace takt::mover
