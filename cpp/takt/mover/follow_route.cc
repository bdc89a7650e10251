#include "takt/mover/follow_route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "takt/core/maths.h"
#include "takt/mover/admission.h"

namespace takt::mover {

namespace {

constexpr double kApart = 1;              // [mm] added to the size of a mover
constexpr double kPatience = 10;          // [s] delay of a planned motion, after which places are granted one by one
constexpr std::uint32_t kAgainAfter = 8;  // cycles after an obstacle
constexpr double kSoon = 0.02;            // [s]
constexpr double kLookWithin = 16;        // cycles
constexpr double kUnknown = std::numeric_limits<double>::infinity();

const State& StateOf(const Context& c, std::size_t mover) {
  return c.fleet.states[mover];
}

// Returns the position [mm] from the place that the mover has passed towards the next one.
double Along(const State& s, const SurfaceRoute& r) {
  const Heading ahead = HeadingAt(r, r.passed);
  const Visit& from = r.visits[r.passed];
  return (s.set_point[kX].position - from.x) * ahead.x + (s.set_point[kY].position - from.y) * ahead.y;
}

// Returns the larger side [mm] of the bounding rectangle along X and Y.
double SizeOf(const MoverParams& params, const State& s) {
  const auto [sine, cosine] = maths::SinCos(s.set_point[kC].position * (std::numbers::pi / 180));
  const double width = params.width * std::abs(cosine) + params.height * std::abs(sine);
  const double height = params.width * std::abs(sine) + params.height * std::abs(cosine);
  return std::max(width, height) + kApart;
}

// Returns true if no part of the mover covers the place of this visit any more.
bool HasLeft(const Context& c, std::uint32_t mover, std::uint64_t visit) {
  const SurfaceRoute& r = RouteOf(c, mover);
  const State& s = StateOf(c, mover);
  if (r.passed != visit || visit == r.last() || !IsOnRoute(s)) return r.passed > visit;
  const double pitch = PitchAt(r, visit);
  return Along(s, r) >= (pitch + std::min(SizeOf(c.fleet.params[mover], s), pitch)) / 2 - kNear;
}

bool IsWatched(const Context& c) {
  return c.grounds.Watching(c.grounds.group_of_mover[c.index]) != 0;
}

bool MayEnter(const Context& c, const SurfaceRoute& r, std::uint64_t visit) {
  const std::optional<std::uint32_t> before = Before(c, r.visits[visit]);
  if (!before) return true;
  const std::uint64_t its = r.visits[visit].after_visit;
  const SurfaceRoute& other = RouteOf(c, *before);
  if (IsWatched(c)) return other.passed > its;
  if (HasLeft(c, *before, its)) return true;
  if (!IsOnRoute(StateOf(c, *before)) || other.granted <= its) return false;
  const Heading heading = HeadingAt(r, visit - 1);
  for (std::uint64_t k = other.passed; k <= its; ++k) {
    if (HeadingAt(other, k) != heading) return false;
  }
  return true;
}

// --- times ---

bool HasLeg(const SurfaceRoute& r) {
  return r.timed && r.leg < r.last();
}

std::uint64_t EndOfLeg(const SurfaceRoute& r, std::uint64_t leg) {
  std::uint64_t end = leg + 1;
  while (end < r.last() && !r.visits[end].arrival_time) ++end;
  return end;
}

double Departure(const SurfaceRoute& r, std::uint64_t leg) {
  return r.visits[leg].departure_time.value_or(0);
}

// Updates which planned motion is the present one, after the mover has passed a place or come to rest.
void NotePassed(SurfaceRoute& r, bool rests) {
  while (HasLeg(r)) {
    const std::uint64_t end = EndOfLeg(r, r.leg);
    if (r.passed < end || (r.passed == end && !rests)) return;
    r.leg = end;
    r.leaves = !rests;
    r.late = rests ? 0 : kUnknown;
  }
}

// Returns the expected delay [s] with which the place of this visit is left.
double LateAt(const SurfaceRoute& r, std::uint64_t visit, double now) {
  if (!HasLeg(r)) return 0;
  const double late = r.leaves ? r.late : std::max(0.0, now - Departure(r, r.leg));
  std::uint64_t leg = r.leg, end = EndOfLeg(r, leg);
  if (visit < end) return late;
  double free = r.visits[end].arrival_time.value_or(0) + late;
  for (leg = end; leg < r.last(); leg = end) {
    end = EndOfLeg(r, leg);
    if (visit < end) break;
    const double departure = Departure(r, leg);
    free = std::max(departure, free) + r.visits[end].arrival_time.value_or(0) - departure;
  }
  return std::max(0.0, free - Departure(r, std::min(leg, r.last())));
}

// Returns the earliest start [s] of the leg at which each of its places is free on arrival; infinite: not known.
double BeginOfLeg(const Context& c, const SurfaceRoute& r, double now) {
  const double departure = Departure(r, r.leg);
  const std::uint64_t end = EndOfLeg(r, r.leg);
  double begin = -kUnknown;
  for (std::uint64_t visit = r.leg + 1; visit <= end; ++visit) {
    const std::optional<std::uint32_t> before = Before(c, r.visits[visit]);
    const std::uint64_t its = r.visits[visit].after_visit;
    if (!before || HasLeft(c, *before, its)) continue;
    const SurfaceRoute& other = RouteOf(c, *before);
    if (!other.timed || !IsOnRoute(StateOf(c, *before)) || its == other.last()) return kUnknown;
    const double late = LateAt(other, its, now);
    if (HeadingAt(other, its) == HeadingAt(r, visit - 1)) {  // it follows that mover
      begin = std::max(begin, departure + late);
    } else {
      const double ahead = r.visits[visit].entry_time.value_or(departure) - departure;
      // [s] bound of the delay with which that exit, and an own stop, take effect
      const double seen = 2 * c.cycle.period_s;
      begin = std::max(begin, other.visits[its].exit_time.value_or(kUnknown) + late - ahead + seen);
    }
    if (begin > now + kSoon) break;  // too early in any case
  }
  return begin;
}

// --- motion ---

MoveToPosition MoveTo(const RouteDynamics& d, const Visit& to) {
  return {.x = to.x,
          .y = to.y,
          .use_orientation = false,
          .velocity = d.velocity,
          .acceleration = d.acceleration,
          .deceleration = d.deceleration,
          .jerk = d.jerk};
}

trajectory::Limits LimitsFor(const Context& c, const RouteDynamics& dynamics) {
  LimitedBy unused;
  return LimitsOf(MoveTo(dynamics, {}), c.params.xy, unused);
}

// Sends the mover straight on to the place of this visit.
void Send(const Context& c, std::uint64_t visit, State& s, SurfaceRoute& r) {
  const Visit& to = r.visits[visit];
  const AdmissionResult answer = MoveAlong(c, MoveTo(r.dynamics, to), s);
  if (!answer.status.failed()) {
    r.sent = visit;
    r.aims = true;
    r.aim_x = to.x;
    r.aim_y = to.y;
    return;
  }
  // A refused move changes nothing, and another mover in the way may leave.
  const bool waits = answer.status.error == ErrorId::kCollision && answer.object.kind == ObjectKind::kMover;
  if (waits) {
    r.pause = kAgainAfter;
  } else {
    End(c, kRoute, FeedbackState::kError, answer.status.error, s, answer.object);
  }
}

// Returns the distance [mm] that a leader covers from rest while a follower brakes from full speed, on average.
double LeadOf(const trajectory::Limits& l) {
  const double ramp = l.acceleration / l.jerk;
  const double time = 1.05 * ((l.velocity / l.acceleration + ramp) / 2 + ramp);  // it may still accelerate
  if (time < ramp) return l.jerk * time * time * time / 6;
  const double since = time - ramp / 2;
  return std::min(l.acceleration * (since * since / 2 + ramp * ramp / 24), l.velocity * time);
}

// Returns true if the mover rests behind a mover with the same heading, and would have to brake for it. The guard lets
// it move only as far as it could stop behind the present position of that mover: so it starts later by the time of a
// stop from full speed.
bool WouldBrakeForLeader(const Context& c, const State& s, const SurfaceRoute& r, std::uint64_t from) {
  const Visit& to = r.visits[from + 1];
  const std::optional<std::uint32_t> before = Before(c, to);
  if (!before || RouteOf(c, *before).passed > to.after_visit) return false;
  const Heading ahead = HeadingAt(r, from);
  const SetPoint& leader = StateOf(c, *before).set_point;
  const double lead = (leader[kX].position - s.set_point[kX].position) * ahead.x +
                      (leader[kY].position - s.set_point[kY].position) * ahead.y;
  return lead < PitchAt(r, from) + LeadOf(LimitsFor(c, r.dynamics));
}

// Ends a motion that was started by time at the last granted place.
void StopWhereGranted(const Context& c, State& s, SurfaceRoute& r) {
  Disturb(r);
  if (r.sent > r.granted) Send(c, r.granted, s, r);
}

// Starts and supervises a planned motion. Returns false if places are to be granted one by one.
bool GoByTime(const Context& c, double now, bool rests, State& s, SurfaceRoute& r) {
  if (!HasLeg(r)) return false;
  const std::uint64_t end = EndOfLeg(r, r.leg);
  if (!r.leaves) {
    if (!rests || r.passed != r.leg) return false;
    if (c.cycle.count < r.look_again) return true;
    const double begin = BeginOfLeg(c, r, now), departure = Departure(r, r.leg);
    if (begin == kUnknown || now > std::max(begin, departure) + kPatience) return false;
    if (now < begin) {
      const double cycles = (begin - now) / (4 * c.cycle.period_s);
      r.look_again = c.cycle.count + static_cast<std::uint64_t>(std::min(kLookWithin, cycles));
      return true;
    }
    r.leaves = true;
    r.late = now - departure;
    Send(c, end, s, r);
    if (r.pause > 0) Disturb(r);
    return true;
  }
  if (r.late == kUnknown) return false;
  if (r.granted < end && r.passed < end) {  // a cycle later it could no longer stop
    const double left = Distance(r.visits[r.passed], r.visits[r.granted]);
    if (RestsAt(c, s, r, r.dynamics, c.cycle.period_s) > left + kNear) StopWhereGranted(c, s, r);
  }
  return true;
}

bool AimsAt(const SurfaceRoute& r, const Visit& place) {
  return r.aims && r.aim_x == place.x && r.aim_y == place.y;
}

void GoStraightOn(const Context& c, bool rests, State& s, SurfaceRoute& r) {
  // The motion leads further than the route does now.
  const std::uint64_t bound = std::min(r.sent, r.granted);
  const bool ends_here = bound <= r.passed || bound < r.sent;
  if (!rests && ends_here && r.aims && !AimsAt(r, r.visits[bound])) return Send(c, bound, s, r);
  std::uint64_t from = r.passed;
  if (!rests && r.passed >= r.sent) {
    if (r.sent <= r.begin) return;
    from = r.sent - 1;  // it moves in this direction already
  }
  std::uint64_t to = from;
  while (to < r.granted && HeadingAt(r, to) == HeadingAt(r, from)) ++to;
  if (to <= r.passed || (rests && WouldBrakeForLeader(c, s, r, from))) return;
  if (!rests && AimsAt(r, r.visits[to])) {  // its motion ends there already
    r.sent = to;
    return;
  }
  if (r.timed) Disturb(r);
  Send(c, to, s, r);
}

void GoOn(const Context& c, State& s, SurfaceRoute& r) {
  if (r.pause > 0) {
    --r.pause;
    return;
  }
  const bool rests = Rests(c, s, r);
  if (r.passed == r.last() && rests) return End(c, kRoute, FeedbackState::kDone, ErrorId::kNone, s);
  const bool held = rests && r.granted == r.passed;
  r.rests_since = !held ? 0 : r.rests_since != 0 ? r.rests_since : c.cycle.count;
  if (rests && OffRoute(s, r) > 2 * kNear) {
    const auto why = static_cast<double>(RouteProblem::kElsewhere);
    Report(c, std::exchange(s.tickets[kRoute], 0), FeedbackState::kError, ErrorId::kRoute, why, s);
    return;
  }
  if (r.timed && !IsWatched(c)) {
    NotePassed(r, rests);
    const bool waits = r.held && !r.leaves;
    if (!waits && GoByTime(c, Elapsed(c, r.started), rests, s, r)) return;
  }
  GoStraightOn(c, rests, s, r);
}

}  // namespace

std::optional<std::uint32_t> Before(const Context& c, const Visit& visit) noexcept {
  if (visit.after == 0 || visit.after == c.index + 1) return {};
  return visit.after - 1;
}

bool Rests(const Context& c, const State& s, const SurfaceRoute& r) noexcept {
  return r.passed == r.sent && IsPlaneResting(c, s);
}

double OffRoute(const State& s, const SurfaceRoute& r) noexcept {
  double x = s.set_point[kX].position - r.visits[r.passed].x, y = s.set_point[kY].position - r.visits[r.passed].y;
  if (r.passed != r.last()) {
    const Heading ahead = HeadingAt(r, r.passed);
    const double along = std::clamp(Along(s, r), 0.0, PitchAt(r, r.passed));
    x -= along * ahead.x;
    y -= along * ahead.y;
  }
  return maths::Hypot(x, y);
}

void Disturb(SurfaceRoute& r) noexcept {
  r.leaves = true;
  r.late = kUnknown;
}

void Look(const Context& c, State& s, SurfaceRoute& r) noexcept {
  const bool able = s.state == planar::ObjectState::kEnabled && s.mode == CommandMode::kFreeMovement &&
                    s.external.mode == SetpointMode::kNone && s.system == r.system;
  if (!able) return End(c, kRoute, FeedbackState::kAborted, ErrorId::kNone, s);
  while (r.passed < r.sent && Along(s, r) >= PitchAt(r, r.passed) - kNear) ++r.passed;
}

double RestsAt(const Context& c, const State& s, const SurfaceRoute& r, const RouteDynamics& dynamics,
               double later) noexcept {
  PlaneMotion rest;
  const double then = Elapsed(c, s.plane.begin) + later;
  if (!PlanRest(c.planner, s.plane.motion, then, LimitsFor(c, dynamics), rest)) return kUnknown;
  const Heading ahead = HeadingAt(r, r.passed);
  const Visit& from = r.visits[r.passed];
  return (rest.end_x - from.x) * ahead.x + (rest.end_y - from.y) * ahead.y;
}

std::uint64_t StopsAt(const Context& c, const State& s, const SurfaceRoute& r) noexcept {
  if (r.sent <= r.passed || Rests(c, s, r)) return r.passed;
  const double rest = RestsAt(c, s, r, r.dynamics) - 1e-9;
  std::uint64_t visit = r.passed + 1;
  while (visit < r.granted && Distance(r.visits[r.passed], r.visits[visit]) < rest) ++visit;
  return std::min(visit, r.granted);
}

void FollowRoutes(const RoutedMovers& all) noexcept {
  if (all.routes.changes == 0) return;
  all.Each([](const Context& c, State& s, SurfaceRoute& r) { Look(c, s, r); });
  all.Each([](const Context& c, const State&, SurfaceRoute& r) {
    while (!r.held && r.granted < r.last() && MayEnter(c, r, r.granted + 1)) ++r.granted;
  });
  all.Each([](const Context& c, State& s, SurfaceRoute& r) { GoOn(c, s, r); });
}

RestInPlace WhyResting(const Context& c, const State& s) noexcept {
  if (!c.fleet.routes || !IsOnRoute(s)) return {};
  const SurfaceRoute& r = RouteOf(c, c.index);
  if (r.rests_since == 0 || r.granted == r.last()) return {};
  return {r.held, Before(c, r.visits[r.granted + 1]).value_or(planar::kNobody), r.rests_since};
}

}  // namespace takt::mover
