#include "takt/mover/area_reservation.h"

#include <algorithm>

#include "takt/mover/course.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

using trajectory::Profile;

constexpr double kBeyond = 1e-9;  // [mm, deg] differences below are rounding

// Adds the corners of the area that X and Y still pass outside of the straight line from their position to the end.
void Surround(const PlaneMotion& m, double t, planar::Move& move) {
  const auto corner = [&](double along, double across) {
    move.corners[move.corner_count++] = {m.origin_x + m.direction_x * along - m.direction_y * across,
                                         m.origin_y + m.direction_y * along + m.direction_x * across};
  };
  const double alone = std::max(t, m.share > 0 ? m.across.duration() : 0.0);
  const double from = m.along.At(alone).position, to = m.along.end().position;
  const Profile::Range line = m.along.PositionRange(alone);
  const bool above = line.max > std::max(from, to) + kBeyond, below = line.min < std::min(from, to) - kBeyond;
  if (alone > t) {
    Profile beside = m.along;
    if (!above && !below) beside.Cut(alone);
    const Profile::Range along = beside.PositionRange(t), across = m.across.PositionRange(t);
    corner(along.min, across.min);
    corner(along.max, across.min);
    corner(along.max, across.max);
    corner(along.min, across.max);
    return;
  }
  const double off = m.across.end().position;
  if (above) corner(line.max, off);
  if (below) corner(line.min, off);
}

// Replaces the corners by the rectangle of a motion that comes to rest, and then continues with X and Y each by itself.
void SurroundAll(const PlaneState& now, const planar::Place& rest, planar::Move& move) {
  planar::Place lower{now.x.position, now.y.position}, upper = lower;
  const auto add = [&](const planar::Place& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  };
  for (std::size_t i = 0; i < move.corner_count; ++i) add(move.corners[i]);
  add(rest);
  add(move.target.place);
  move.corners = {lower, planar::Place{upper.x, lower.y}, upper, planar::Place{lower.x, upper.y}};
  move.corner_count = 4;
}

planar::Move MoveOf(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) {
  planar::Move move{.on_track = on_track};
  const PlaneMotion& m = plane.motion;
  if (!on_track) {
    Surround(m, Elapsed(c, plane.begin), move);
    move.target.place = {m.end_x, m.end_y};
    if (plane.waits) {
      const planar::Place rest = move.target.place;
      move.target.place = {plane.next.x, plane.next.y};
      if (plane.each) {
        SurroundAll(At(m, Elapsed(c, plane.begin)), rest, move);
      } else {
        move.over = rest;
      }
    }
  }
  const double now = Now(c, turn).position, end = turn.profile.end().position;
  const Profile::Range range = turn.profile.PositionRange(Elapsed(c, turn.begin));
  move.target.c = end;
  if (range.max > std::max(now, end) + kBeyond) move.over_c = range.max;
  if (range.min < std::min(now, end) - kBeyond) move.over_c = range.min;
  return move;
}

bool IsWatched(const Context& c, std::uint32_t mover) {
  return c.grounds.Watching(c.grounds.group_of_mover[mover]) != 0;
}

// Returns the move of a planet during that of its star.
planar::Move MoveOfPlanet(const Context& star, std::uint32_t planet, const PlaneMove& plane,
                          const CoordinateMove& turn) {
  const PlaneState at = At(plane.motion, Elapsed(star, plane.begin));
  const planar::Pose from{{at.x.position, at.y.position}, Now(star, turn).position};
  const planar::Arm arm = ArmOf(star.fleet.params[planet], star.fleet.states[planet].formation);
  return planar::MoveOf(arm, from, MoveOf(star, plane, turn, false));
}

void Take(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) {
  if (IsWatched(c, c.index)) planar::TakeMove(c.index, MoveOf(c, plane, turn, on_track), c.grounds);
  EachPlanet(c, [&](std::uint32_t i) {
    if (IsWatched(c, i)) planar::TakeMove(i, MoveOfPlanet(c, i, plane, turn), c.grounds);
  });
}

// Returns a mover that its part will bring into the area of the motion.
ObjectInfo MoverArrivingAt(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) {
  const auto comes = [](const planar::MoverView& now) { return now.comes; };
  if (std::ranges::none_of(c.grounds.movers, comes)) return {};
  const planar::MoverView& own = c.grounds.movers[c.index];
  Cover cover = CoverOf(c, plane, turn);
  if (on_track) {
    cover.count = 1;
    cover.areas[0].count = 1;
    cover.areas[0].places[0] = own.pose.place;
  }
  for (const planar::Area& area : cover.all()) {
    if (const ObjectInfo who = planar::MoverArrivingAt(c.index, own.system, area, c.grounds)) return who;
  }
  return {};
}

}  // namespace

ObjectInfo FindObstacle(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) noexcept {
  ObjectInfo object = MoverArrivingAt(c, plane, turn, on_track);
  if (!object && IsWatched(c, c.index)) {
    const planar::Move move = MoveOf(c, plane, turn, on_track);
    object = planar::AskMove(c.index, move, c.grounds);
    if (planar::Turn* its = planar::TurnOf(c.index, c.grounds); its->asks) its->move = move;
  }
  EachPlanet(c, [&](std::uint32_t i) {
    if (!object && IsWatched(c, i)) object = planar::AskMove(i, MoveOfPlanet(c, i, plane, turn), c.grounds);
  });
  return object;
}

void Reserve(const Context& c, const State& s, bool on_track) noexcept {
  Take(c, s.plane, s.others.back(), on_track);
}

ObjectInfo TakeStop(const Context& now, const State& s, const SetPoint& at) noexcept {
  Context c = now;
  ++c.cycle.count;
  PlaneMove plane;
  plane.begin = c.cycle.count;
  if (!PlanStop(c, s, at, c.params.xy.maximum.limits(), plane.motion)) {
    plane.motion = StandingAt(at[kX].position, at[kY].position);
  }
  CoordinateMove turn;
  turn.begin = c.cycle.count;
  if (!c.planner.Stop(at[kC], c.params.c.maximum.limits(), turn.profile).ok()) {
    turn.profile = {at[kC]};
    turn.profile.SnapEnd(at[kC]);
  }
  const ObjectInfo object = FindObstacle(c, plane, turn, false);
  if (!object) Take(c, plane, turn, false);
  return object;
}

ObjectInfo TakeStopOff(const Context& c, const DisplacedHull& places, const SetPoint& at) noexcept {
  if (!IsWatched(c, c.index)) return {};
  planar::Move move{.on_track = true, .kept_by_gaps = true};
  for (const planar::Place& place : places.places) move.corners[move.corner_count++] = place;
  move.target.c = trajectory::StopPosition(at[kC], c.params.c.maximum.limits());
  const ObjectInfo object = planar::AskMove(c.index, move, c.grounds);
  if (!object) planar::TakeMove(c.index, move, c.grounds);
  return object;
}

planar::Pose GoalOf(const Context& c, const State& s) noexcept {
  if (IsPlanet(s)) {
    const State& leads = StateOfStar(c, s);
    if (leads.external.mode == SetpointMode::kNone) {
      return MoveOfPlanet(StarOf(c, s), c.index, leads.plane, leads.others.back()).target;
    }
  }
  planar::Pose goal{{s.set_point[kX].position, s.set_point[kY].position}, s.set_point[kC].position};
  if (IsPlanet(s) || s.external.mode != SetpointMode::kNone) return goal;
  goal.c = s.others.back().profile.end().position;
  if (IsOnTrack(s)) return goal;
  const PlaneMotion& m = s.plane.motion;
  goal.place = s.plane.waits ? planar::Place{s.plane.next.x, s.plane.next.y} : planar::Place{m.end_x, m.end_y};
  return goal;
}

void Stand(const Context& c, const State& s) noexcept {
  planar::GroupRegistry& g = c.grounds;
  planar::MoverView& now = g.movers[c.index];
  const auto rests = [&](Coordinate i) { return s.set_point[i].velocity == 0 && s.set_point[i].acceleration == 0; };
  now.mover = {c.params.width, c.params.height};
  now.system = s.system;
  now.pose = {{s.set_point[kX].position, s.set_point[kY].position}, s.set_point[kC].position};
  now.rests = s.external.mode == SetpointMode::kNone && IsPlaneResting(c, s) && IsOver(c, s.others.back()) &&
              rests(kX) && rests(kY) && rests(kC);
  if (IsPlanet(s)) now.rests = g.movers[s.formation.star].rests;
  now.body = BodyOf(c, s);
  now.on_track = IsOnTrack(s);
  now.track = s.track;
  const planar::Parts& parts = *c.streets.parts;
  now.comes = s.part < parts.all.size() && parts.now[s.part].commanded != parts.now[s.part].position;
  if (now.comes) {
    const planar::Spot &from = parts.spot(s.part), &to = parts.goal(s.part);
    now.goal = {to.system, now.pose.place + (to.origin - from.origin)};
  }
  UpdateCourseAtRest(c, s);
  const std::uint32_t group = g.Watching(g.group_of_mover[c.index]);
  if (group == 0) return;
  // Reservations that are not straight are computed anew.
  const planar::Reservation& own = g.grounds[group - 1].reserved.movers[c.index];
  const bool bends = own.move.corner_count > 0 || own.move.over || own.move.over_c;
  const State& leads = IsPlanet(s) ? StateOfStar(c, s) : s;
  const bool led = leads.external.mode == SetpointMode::kRelative;  // then TakeStop reserves
  const bool returns = now.on_track && c.rider().off > 0;           // TakeStopOff has reserved the return, too
  if (returns) {
    planar::AdvanceMover(c.index, g);
    return;
  }
  if (own.moving && bends && !led && IsPlanet(s)) {
    planar::TakeMove(c.index, MoveOfPlanet(StarOf(c, s), c.index, leads.plane, leads.others.back()), g);
  } else if (own.moving && bends && !led) {
    Reserve(c, s, now.on_track);
  }
  planar::AdvanceMover(c.index, g);
}

}  // namespace takt::mover
