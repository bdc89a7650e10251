#include "takt/mover/course.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/mover/follow.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

using planar::Area;
using planar::Course;
using planar::kNobody;

constexpr double kAhead = 1;  // [mm] that have to be clear beyond the braking distance

planar::Guard& GuardOf(const Context& c) {
  return c.grounds.guard;
}

ObjectInfo OneInTheWay(std::uint32_t mover) {
  return mover == kNobody ? ObjectInfo{} : ObjectAt(ObjectKind::kMover, mover);
}

// Returns the area without positions: with all angles from here on as planned, or, with external set points, until C
// stops.
Area KindOf(const Context& c, const State& s, const CoordinateMove& turn, const SetPoint& at) {
  Area kind{.places = {}, .count = 0, .mover = {c.params.width, c.params.height}, .margin = 0};
  const double turned = at[kC].position;
  double other = turned, another = turned;
  if (s.external.mode != SetpointMode::kNone) {
    other = trajectory::StopPosition(at[kC], c.params.c.maximum.limits());
  } else if (!IsPlanet(s)) {
    const trajectory::Profile::Range range = turn.profile.PositionRange(Elapsed(c, turn.begin));
    other = range.min;
    another = range.max;
  }
  kind.least_c = std::min({turned, other, another});
  kind.most_c = std::max({turned, other, another});
  return kind;
}

// Adds the displacement of a mover from its position on its track when this cycle begins, and until it rests and is
// back.
void AddOff(const Context& c, const State& s, const SetPoint& at, const SetPoint& more, Area& kind) {
  const planar::Rider& r = c.rider();
  if (r.off == 0 && s.external.mode == SetpointMode::kNone) return;
  const planar::Place on = c.streets.At(r.route.first(), r.at.position).place;
  const planar::Place off = planar::Place{at[kX].position, at[kY].position} - on;
  PlaneMotion rest = s.plane.motion;
  if (s.external.mode == SetpointMode::kRelative) {
    PlaneState from = OffTrack(s, more, Elapsed(c, s.plane.begin));
    from.x.position = off.x;
    from.y.position = off.y;
    if (!PlanRest(c.planner, from, c.params.xy.maximum.limits(), rest)) rest = StandingAt(off.x, off.y);
  }
  kind.places = {planar::Place{}, off, planar::Place{rest.end_x, rest.end_y}};
  kind.count = 3;
  kind.margin += BesideLine(rest);
}

Course CourseOf(const Cover& cover) {
  Course course;
  for (const Area& area : cover.all()) planar::Add(area, course);
  return course;
}

Course OfPlanet(const Context& c, std::uint32_t planet, const Course& star) {
  const planar::Arm arm = ArmOf(c.fleet.params[planet], c.fleet.states[planet].formation);
  Course course;
  for (const Area& area : star.all()) planar::Add(planar::AreaOf(arm, area), course);
  return course;
}

// Returns the mover that this one, or one of its planets, would overlap.
std::uint32_t Find(const Context& c, const Course& course) {
  std::uint32_t found = GuardOf(c).Find(c.index, course);
  EachPlanet(c, [&](std::uint32_t i) {
    if (found == kNobody) found = GuardOf(c).Find(i, OfPlanet(c, i, course));
  });
  return found;
}

void Put(const Context& c, const Course& course) {
  GuardOf(c).Put(c.index, course);
  EachPlanet(c, [&](std::uint32_t i) { GuardOf(c).Put(i, OfPlanet(c, i, course)); });
}

// Returns how the mover brakes in the plane from this set point, its state at the beginning of this cycle. A motion
// that already stops with the maximum dynamics stays as it is.
StopMotion EscapeFrom(const Context& c, const State& s, const SetPoint& at) {
  const bool brakes = s.external.mode == SetpointMode::kNone && (s.plane.waits || !s.plane.goes);
  const bool rests = Elapsed(c, s.plane.begin) >= DurationOf(s.plane.motion);
  if (brakes && (s.plane.hard || rests)) return {s.plane.motion, s.plane.begin, c.cycle.count};
  StopMotion escape{StandingAt(at[kX].position, at[kY].position), c.cycle.count, c.cycle.count};
  PlanStop(c, s, at, c.params.xy.maximum.limits(), escape.motion);
  return escape;
}

Course CourseOf(const Context& c, const Area& kind, const StopMotion& escape) {
  return CourseOf(CoverOf(kind, escape.motion, Elapsed(c, escape.begin)));
}

Course CourseOnTrack(const Context& c, const Area& kind) {
  const planar::Rider& r = c.rider();
  const planar::Braking braking = planar::Brake(r.at, planar::BrakesOf(r));
  const bool rests = planar::Rests(r.at);
  return planar::CourseOn(c.streets.network, r, rests ? r.at.position : braking.lowest,
                          rests ? r.at.position : braking.highest, kind);
}

// Returns the course from the beginning of this cycle on, with the rotation `turn`.
Course CourseNow(const Context& c, const State& s, const CoordinateMove& turn) {
  if (!IsOnTrack(s)) return CourseOf(c, KindOf(c, s, turn, s.set_point), StopMotionOf(c, s));
  Area kind = KindOf(c, s, turn, s.set_point);
  AddOff(c, s, s.set_point, s.external.taken, kind);
  return CourseOnTrack(c, kind);
}

}  // namespace

void SetCourse(const Context& c, const State& s) noexcept {
  planar::Guard& guard = GuardOf(c);
  planar::Guard::Figure& figure = guard.figure(c.index);
  figure.kind = KindOf(c, s, s.others.back(), s.set_point);
  if (IsOnTrack(s)) AddOff(c, s, s.set_point, s.external.taken, figure.kind);
  figure.system = s.system;
  figure.body = BodyOf(c, s);
  figure.on_track = IsOnTrack(s);
  if (IsPlanet(s)) {
    Area stands = figure.kind;
    stands.places[stands.count++] = {s.set_point[kX].position, s.set_point[kY].position};
    Course course;
    planar::Add(stands, course);
    return guard.Put(c.index, course);
  }
  const Course course = CourseNow(c, s, s.others.back());
  if (course.count > 0) guard.Put(c.index, course);
}

void UpdateCourseAtRest(const Context& c, const State& s) noexcept {
  planar::Guard& guard = GuardOf(c);
  const planar::MoverView& now = c.grounds.movers[c.index];
  if (now.comes) {
    Course there;
    planar::Add(planar::AreaThere(now), there);
    guard.PutThere(c.index, now.goal.system, there);
  } else {
    guard.ClearThere(c.index);
  }
  const planar::Guard::Figure& figure = guard.figure(c.index);
  const Course& known = guard.course(c.index);
  const bool turns = !planar::Rests(s.set_point[kC]) || figure.kind.most_c > figure.kind.least_c;
  const Area& area = known.areas[0];
  const bool same = known.count == 1 && area.count == 1 && area.places[0].x == s.set_point[kX].position &&
                    area.places[0].y == s.set_point[kY].position && area.least_c == s.set_point[kC].position &&
                    figure.system == s.system && figure.body == now.body && figure.on_track == now.on_track &&
                    area.mover.width == c.params.width && area.margin == 0;
  const bool off = now.on_track && (c.rider().off > 0 || figure.kind.count > 0);
  // The star has set the course of a planet that moves.
  const bool led = IsPlanet(s) && !now.rests;
  if (!led && (turns || off || (now.rests && !same) || figure.on_track != now.on_track || known.count == 0))
    SetCourse(c, s);
}

StopMotion StopMotionOf(const Context& c, const State& s) noexcept {
  return s.escape.cycle == c.cycle.count ? s.escape : EscapeFrom(c, s, s.set_point);
}

ObjectInfo TryCourse(const Context& now, const SetPoint& at, State& s) noexcept {
  Context c = now;
  ++c.cycle.count;
  const StopMotion escape = EscapeFrom(c, s, at);
  const Course course = CourseOf(c, KindOf(c, s, s.others.back(), at), escape);
  const std::uint32_t found = Find(c, course);
  if (found != kNobody) return OneInTheWay(found);
  Put(c, course);
  s.escape = escape;
  return {};
}

ObjectInfo FindTurnObstacle(const Context& c, const State& s, const CoordinateMove& turn) noexcept {
  if (IsOver(c, turn)) return {};
  return OneInTheWay(Find(c, CourseNow(c, s, turn)));
}

ObjectInfo FindCourseObstacle(const Context& c, const planar::Spot& at, double turned) noexcept {
  Course stands;
  planar::Add(AreaAt(c.params, at.origin, turned), stands);
  return OneInTheWay(GuardOf(c).Find(c.index, at.system, stands));
}

ObjectInfo TakeCourseOff(const Context& now, const State& s, const SetPoint& at) noexcept {
  Context c = now;
  ++c.cycle.count;
  Area kind = KindOf(c, s, s.others.back(), at);
  AddOff(c, s, at, s.external.given, kind);
  const Course course = CourseOnTrack(c, kind);
  planar::Guard& guard = GuardOf(c);
  TrackNetworkState& streets = c.streets;
  const std::uint32_t found =
      streets.traffic.FindAcross(c.cycle, streets.network, streets.riders, guard, c.index, kind, course);
  if (found == kNobody) {
    guard.figure(c.index).kind = kind;  // movers that are processed later in this cycle see it
    guard.Put(c.index, course);
  }
  return OneInTheWay(found);
}

void Hold(const Context& c, std::uint32_t other, State& s) noexcept {
  PlaneMove& plane = s.plane;
  const bool known = s.escape.cycle == c.cycle.count;
  const StopMotion rest =
      known ? s.escape : StopMotion{StandingAt(s.set_point[kX].position, s.set_point[kY].position), c.cycle.count, 0};
  if (plane.goes && plane.each) {
    const auto [x, y] = plane.goals;
    plane.next = {.x = x.active ? x.target : rest.motion.end_x, .y = y.active ? y.target : rest.motion.end_y};
    plane.waits = true;
  } else if (plane.goes && !plane.waits) {
    const trajectory::Limits& l = plane.limits;
    plane.next = {.x = plane.passes ? plane.corner_x : plane.motion.end_x,
                  .y = plane.passes ? plane.corner_y : plane.motion.end_y,
                  .velocity = l.velocity,
                  .acceleration = l.acceleration,
                  .deceleration = l.deceleration,
                  .jerk = l.jerk};
    plane.waits = true;
  }
  plane.motion = rest.motion;
  plane.begin = rest.begin;
  plane.hard = true;
  // The rest of this stop is part of the course that the guard knows, but it may come out larger in the next cycle:
  // areas of turning movers are bounds. So it stays the stop of the mover until a course is clear again.
  s.escape = {rest.motion, rest.begin, c.cycle.count + 1};
  plane.passes = false;
  if (plane.goes && plane.held_by == kNobody) plane.held_since = c.cycle.count;
  if (plane.goes) plane.held_by = other;
}

namespace {

// The same if X and Y continue each by itself: over the braking distance of each from its commanded velocity.
bool IsHeldEach(const Context& c, const planar::Place& here, const planar::Place& way, State& s) {
  const auto ahead = [](const Goal& goal, double left) {
    if (!goal.active) return 0.0;
    const trajectory::Limits& l = goal.limits;
    const double needed = planar::StoppingDistance(l.velocity, {l.deceleration, l.jerk}) + kAhead;
    return std::clamp(left, -needed, needed);
  };
  const double x = ahead(s.plane.goals[0], way.x), y = ahead(s.plane.goals[1], way.y);
  Area area = KindOf(c, s, s.others.back(), s.set_point);
  area.places = {here, here + planar::Place{x, 0}, here + planar::Place{x, y}, here + planar::Place{0, y}};
  area.count = 4;
  Course course;
  planar::Add(area, course);
  s.plane.held_by = Find(c, course);
  return s.plane.held_by != kNobody;
}

}  // namespace

bool IsHeld(const Context& c, State& s) noexcept {
  PlaneMove& plane = s.plane;
  if (plane.held_by == kNobody) return false;
  const planar::Place here{plane.motion.end_x, plane.motion.end_y};
  const planar::Place way = planar::Place{plane.next.x, plane.next.y} - here;
  if (plane.each) return IsHeldEach(c, here, way, s);
  const double length = maths::Hypot(way.x, way.y);
  const double needed =
      planar::StoppingDistance(*plane.next.velocity, {*plane.next.deceleration, *plane.next.jerk}) + kAhead;
  const double share = length > needed ? needed / length : 1;
  Area ahead = KindOf(c, s, s.others.back(), s.set_point);
  ahead.places = {here, here + planar::Place{share * way.x, share * way.y}};
  ahead.count = length > 0 ? 2 : 1;
  Course course;
  planar::Add(ahead, course);
  plane.held_by = Find(c, course);
  return plane.held_by != kNobody;
}

}  // namespace takt::mover
