#include "takt/mover/on_parts.h"

#include <algorithm>
#include <cmath>

#include "takt/mover/area_reservation.h"
#include "takt/mover/formation.h"
#include "takt/planar/course.h"

namespace takt::mover {

namespace {

using planar::Area;

const planar::Parts& PartsOf(const Context& c) {
  return *c.streets.parts;
}

const planar::PartNow* PartNowOf(const Context& c, const State& s) {
  const planar::Parts& parts = PartsOf(c);
  return s.part < parts.now.size() ? &parts.now[s.part] : nullptr;
}

struct Angles {
  double least = 0, most = 0;  // [deg]
};

Angles AnglesOf(const Context& c, const CoordinateMove& turn) {
  const trajectory::Profile::Range range = turn.profile.PositionRange(Elapsed(c, turn.begin));
  return {range.min, range.max};
}

Area AreaOf(const Context& c, const Angles& angles) {
  return {.places = {},
          .count = 0,
          .least_c = angles.least,
          .most_c = angles.most,
          .mover = {c.params.width, c.params.height},
          .margin = 0};
}

void Add(const Area& kind, std::initializer_list<planar::Place> places, Cover& out) {
  Area& area = out.areas[out.count++];
  area = kind;
  for (const planar::Place& place : places) area.places[area.count++] = place;
}

// Adds the rest of a motion: while it has a motion across, the rectangle in its frame of all positions along and
// across; then a line.
void Add(const Area& kind, const PlaneMotion& m, double t, Cover& out) {
  if (t >= DurationOf(m)) return Add(kind, {{m.end_x, m.end_y}}, out);
  const auto at = [&](double along, double across) {
    return planar::Place{m.origin_x + m.direction_x * along - m.direction_y * across,
                         m.origin_y + m.direction_y * along + m.direction_x * across};
  };
  const double alone = std::max(t, m.across.duration());
  if (alone > t) {
    trajectory::Profile beside = m.along;
    beside.Cut(alone);
    const trajectory::Profile::Range u = beside.PositionRange(t), w = m.across.PositionRange(t);
    Add(kind, {at(u.min, w.min), at(u.max, w.min), at(u.max, w.max), at(u.min, w.max)}, out);
  }
  const trajectory::Profile::Range line = m.along.PositionRange(alone);
  const double off = m.across.end().position;
  Add(kind, {at(line.min, off), at(line.max, off)}, out);
}

void Add(const Context& c, const Area& kind, const PlaneMove& move, Cover& out) {
  Add(kind, move.motion, Elapsed(c, move.begin), out);
  const planar::Place rest{move.motion.end_x, move.motion.end_y}, next{move.next.x, move.next.y};
  if (move.waits && move.each) Add(kind, {rest, {next.x, rest.y}, next, {rest.x, next.y}}, out);
  if (move.waits && !move.each) Add(kind, {rest, next}, out);
  // If no command takes over before the corner, the mover continues to it.
  if (move.passes) {
    const PlaneMotion& m = move.motion;
    const double along = m.along.end().position;
    const planar::Place end{m.origin_x + m.direction_x * along, m.origin_y + m.direction_y * along};
    Add(kind, {end, {move.corner_x, move.corner_y}}, out);
  }
}

// Adds a stop with the maximum dynamics, as after a fault.
void AddStop(const Context& c, const SetPoint& at, Cover& out) {
  PlaneMotion rest;
  const trajectory::Limits limits = c.params.xy.maximum.limits();
  if (!PlanRest(c.planner, {at[kX], at[kY]}, limits, rest)) rest = StandingAt(at[kX].position, at[kY].position);
  const double turned = at[kC].position;
  const double stop = trajectory::StopPosition(at[kC], c.params.c.maximum.limits());
  Add(AreaOf(c, {std::min(turned, stop), std::max(turned, stop)}), rest, 0, out);
}

ErrorId DiagnoseCover(const planar::Parts& parts, std::uint32_t system, const Area& area) {
  if (!planar::Carries(parts, system, area)) return ErrorId::kOffStators;
  for (std::uint32_t i = 0; i < parts.all.size(); ++i) {
    const planar::PartNow& now = parts.now[i];
    if (now.away || now.enabled || now.enabling) continue;
    if (planar::Touches(parts.all[i], parts.spot(i), system, area)) return ErrorId::kPartDisabled;
  }
  return ErrorId::kNone;
}

}  // namespace

ErrorId ToMoverSystem(const Context& c, const State& s, const Name& reference, double& x, double& y) noexcept {
  const std::optional<planar::Spot> from = planar::Resolve(PartsOf(c), reference.view());
  if (!from || from->system != s.system) return ErrorId::kReference;
  x += from->origin.x;
  y += from->origin.y;
  return ErrorId::kNone;
}

Cover CoverOf(const Context& c, const State& s) noexcept {
  if (IsPlanet(s)) {
    Cover cover = CoverOf(StarOf(c, s), StateOfStar(c, s));
    for (Area& area : std::span(cover.areas).first(cover.count)) area = AreaOf(ArmOf(c.params, s.formation), area);
    return cover;
  }
  Cover cover;
  const Angles angles = AnglesOf(c, s.others.back());
  const double turned = s.set_point[kC].position;
  if (s.external.mode != SetpointMode::kNone) {
    AddStop(c, s.set_point, cover);
  } else {
    Add(AreaOf(c, {std::min(angles.least, turned), std::max(angles.most, turned)}),
        {{s.set_point[kX].position, s.set_point[kY].position}}, cover);
  }
  if (!IsOnTrack(s) && s.external.mode != SetpointMode::kAbsolute) Add(c, AreaOf(c, angles), s.plane, cover);
  return cover;
}

Cover CoverOfStop(const Context& c, const SetPoint& at) noexcept {
  Cover cover;
  if (!PartsOf(c).none()) AddStop(c, at, cover);
  return cover;
}

DisplacedHull DisplacedHullOf(const Context& c, const PlaneState& off) noexcept {
  const planar::Rider& r = c.rider();
  const planar::Network& network = c.streets.network;
  const auto place = [&](std::uint32_t track, double s) {
    const double length = network[track].length;
    const double around = s - length * std::floor(s / length);
    return c.streets.At(track, network[track].closed ? around : std::clamp(s, 0.0, length)).place;
  };
  double rest = planar::Brake(r.at, planar::BrakesOf(r)).rest;
  std::uint32_t k = 0;
  while (k + 1 < r.route.count && rest > network[r.route.tracks[k]].length) rest -= network[r.route.tracks[k++]].length;
  PlaneMotion stop;
  if (!PlanRest(c.planner, off, c.params.xy.maximum.limits(), stop)) {
    stop = StandingAt(off.x.position, off.y.position);
  }
  const planar::Place by{stop.end_x, stop.end_y};
  const planar::Place here = place(r.route.first(), r.at.position), there = place(r.route.tracks[k], rest);
  return {{here, there, here + by, there + by}, BesideLine(stop)};
}

Cover CoverOf(const Context& c, const State& s, const DisplacedHull& places) noexcept {
  Cover cover;
  planar::Area& area = cover.areas[cover.count++];
  const Angles angles = AnglesOf(c, s.others.back());
  const double turned = s.set_point[kC].position;
  area = AreaOf(c, {std::min(angles.least, turned), std::max(angles.most, turned)});
  for (const planar::Place& place : places.places) area.places[area.count++] = place;
  area.margin += places.margin;
  return cover;
}

Cover CoverOf(const Context& c, const PlaneMove& move, const CoordinateMove& turn) noexcept {
  Cover cover;
  Add(c, AreaOf(c, AnglesOf(c, turn)), move, cover);
  return cover;
}

Cover CoverOf(const Area& kind, const PlaneMotion& motion, double t) noexcept {
  Cover cover;
  Add(kind, motion, t, cover);
  return cover;
}

ErrorId DiagnoseCover(const Context& c, const State& s, const Cover& cover) noexcept {
  const planar::Parts& parts = PartsOf(c);
  ErrorId why = ErrorId::kNone;
  if (parts.none()) return why;
  for (const Area& area : cover.all()) {
    if (why == ErrorId::kNone) why = DiagnoseCover(parts, s.system, area);
    EachPlanet(c, [&](std::uint32_t i) {
      const planar::Arm arm = ArmOf(c.fleet.params[i], c.fleet.states[i].formation);
      if (why == ErrorId::kNone) why = DiagnoseCover(parts, s.system, planar::AreaOf(arm, area));
    });
  }
  return why;
}

namespace {

constexpr double kFlush = 0.01;  // [mm] accuracy to which a path is checked against the border

// By bisection, until the bend departs so little from its chord that it can be neglected.
ErrorId DiagnoseCover(const planar::Parts& parts, std::uint32_t system, const planar::Road& road, double from,
                      double to, const Area& kind) {
  const double length = to - from, curvature = 1.01 * planar::PeakCurvature(*road.track, from, to);
  const double stray = curvature * length * length / 8;
  Area area = kind;
  area.places = {planar::PlaceAt(*road.track, from) + road.origin, planar::PlaceAt(*road.track, to) + road.origin};
  area.count = length > 0 ? 2 : 1;
  area.margin = stray > kFlush ? stray : 0;
  const ErrorId why = DiagnoseCover(parts, system, area);
  if (why == ErrorId::kNone || stray <= kFlush) return why;
  const double middle = from + length / 2;
  const ErrorId first = DiagnoseCover(parts, system, road, from, middle, kind);
  return first != ErrorId::kNone ? first : DiagnoseCover(parts, system, road, middle, to, kind);
}

Area KindOnTrack(const Context& c, const State& s, const CoordinateMove& turn) {
  const Angles angles = AnglesOf(c, turn);
  const double turned = s.set_point[kC].position;
  return AreaOf(c, {std::min(angles.least, turned), std::max(angles.most, turned)});
}

}  // namespace

ErrorId DiagnoseRoute(const Context& c, const State& s, const planar::Rider& rider,
                      const CoordinateMove& turn) noexcept {
  const planar::Parts& parts = PartsOf(c);
  if (parts.none()) return ErrorId::kNone;
  const planar::Network& network = c.streets.network;
  const planar::Interval way = planar::ReachableInterval(network, rider);
  const Area kind = KindOnTrack(c, s, turn);
  ErrorId why = ErrorId::kNone;
  planar::EachStretch(network, rider.route, way.from, way.to, [&](std::uint32_t track, double from, double to) {
    if (why == ErrorId::kNone) why = DiagnoseCover(parts, s.system, network[track], from, to, kind);
  });
  return why;
}

bool LeadsOver(const Context& c, const State& s, std::uint32_t part) noexcept {
  if (!IsOnTrack(s)) return false;
  const planar::Parts& parts = PartsOf(c);
  const planar::Network& network = c.streets.network;
  const planar::Interval way = planar::ReachableInterval(network, c.rider());
  const Area kind = KindOnTrack(c, s, s.others.back());
  bool leads = false;
  planar::EachStretch(network, c.rider().route, way.from, way.to, [&](std::uint32_t track, double from, double to) {
    constexpr int kStrides = 1000;
    planar::EachArea(*network[track].track, network[track].origin, from, to, kind, kStrides, [&](const Area& area) {
      leads = leads || planar::Touches(parts.all[part], parts.spot(part), s.system, area);
    });
  });
  return leads;
}

bool IsAway(const Context& c, const State& s) noexcept {
  const planar::PartNow* part = PartNowOf(c, s);
  return part && part->away;
}

bool IsPartReady(const Context& c, const State& s) noexcept {
  const planar::PartNow* part = PartNowOf(c, s);
  return part ? part->enabled : PartsOf(c).none();
}

bool IsPartSound(const Context& c, const State& s) noexcept {
  const planar::PartNow* part = PartNowOf(c, s);
  return !part || !part->faulty;
}

bool CanPartBeReady(const Context& c, const State& s) noexcept {
  const planar::PartNow* part = PartNowOf(c, s);
  return part ? part->allowed : PartsOf(c).none();
}

bool IsStill(const Context& c, const State& s) noexcept {
  if (IsPlanet(s)) return IsStill(StarOf(c, s), StateOfStar(c, s));
  return IsResting(c, s) && !s.plane.waits && s.mode != CommandMode::kJoiningTrack &&
         s.mode != CommandMode::kLeavingTrack;
}

bool NeedsParts(const State& s) noexcept {
  switch (s.state) {
    case planar::ObjectState::kDisabled:
      return false;
    case planar::ObjectState::kError:
    case planar::ObjectState::kResetting:
      return !s.aborts;
    default:
      return true;
  }
}

void Locate(const Context& c, State& s) noexcept {
  const planar::Parts& parts = PartsOf(c);
  if (parts.none() || IsAway(c, s)) return;
  s.part = IsOnTrack(s) ? c.streets.tracks[s.track].part
                        : planar::PartAt(parts, s.system, {s.set_point[kX].position, s.set_point[kY].position}, s.part);
}

void ShiftWithPart(const Context& c, const planar::Spot& from, const planar::Spot& to, Inputs& inputs,
                   State& s) noexcept {
  const planar::Place by = to.origin - from.origin;
  inputs.actual.x += by.x;
  inputs.actual.y += by.y;
  s.carried = s.carried + by;
  PutAt({to.system, planar::Place{s.set_point[kX].position, s.set_point[kY].position} + by}, s);
  if (IsOnTrack(s)) s.plane = {};
  s.plane.begin = c.cycle.count;
  Stand(c, s);
}

planar::Area AreaAt(const MoverParams& params, const planar::Place& place, double c) noexcept {
  return {
      .places = {place}, .count = 1, .least_c = c, .most_c = c, .mover = {params.width, params.height}, .margin = 0};
}

ErrorId FindSpot(const MoverParams& params, const planar::Parts& parts, std::string_view reference,
                 const planar::Pose& pose, planar::Spot& out) noexcept {
  const std::optional<planar::Spot> from = planar::Resolve(parts, reference);
  if (!from) return ErrorId::kReference;
  out = {from->system, from->origin + pose.place};
  if (parts.none()) return ErrorId::kNone;
  return planar::Carries(parts, out.system, AreaAt(params, out.origin, pose.c)) ? ErrorId::kNone : ErrorId::kOffStators;
}

void PutAt(const planar::Spot& at, State& s) noexcept {
  s.system = at.system;
  s.set_point[kX].position = at.origin.x;
  s.set_point[kY].position = at.origin.y;
  s.plane = {};
  s.plane.motion = StandingAt(at.origin.x, at.origin.y);
  s.escape = {};
}

}  // namespace takt::mover
