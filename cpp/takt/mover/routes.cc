#include "takt/mover/routes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/core/in_range.h"
#include "takt/core/maths.h"
#include "takt/mover/admission.h"
#include "takt/mover/formation.h"

namespace takt::mover {

namespace {

constexpr double kRounded = 1e-6;  // [s]

// Returns the last visit of a mover once the drafts that are to begin have begun.
std::uint64_t LastOf(const SurfaceRoute& r) {
  return r.takes ? r.draft.last() : r.last();
}

AdmissionResult RefusedRoute(RouteProblem problem) {
  return Refused(ErrorId::kRoute, {}, static_cast<double>(problem));
}
planar::Verdict RefusedRoute(RouteProblem problem, std::size_t mover) {
  return {ErrorId::kRoute, ObjectAt(ObjectKind::kMover, mover), static_cast<double>(problem)};
}

bool IsBeside(const Visit& a, const Visit& b) {
  const double x = std::abs(b.x - a.x), y = std::abs(b.y - a.y);
  return std::max(x, y) > 2 * kNear && std::min(x, y) <= 1e-6;
}

// Returns why a mover on its route cannot change to its draft.
RouteProblem WhyNotChange(const Context& c, const State& s, const SurfaceRoute& r, const RouteDynamics& dynamics) {
  const std::uint64_t at = r.draft.first();
  if (at < r.passed || at > r.last()) return RouteProblem::kNumber;
  const Visit &place = r.visits[at], &as_told = r.draft[at];
  if (maths::Hypot(place.x - as_told.x, place.y - as_told.y) > 1e-6) return RouteProblem::kElsewhere;
  if (at - r.passed > kMostKept) return RouteProblem::kTooLate;
  if (r.sent <= at) return RouteProblem::kNone;
  const double left = Distance(r.visits[r.passed], place);  // straight on, as it was sent further
  return RestsAt(c, s, r, dynamics) <= left + kNear ? RouteProblem::kNone : RouteProblem::kTooLate;
}

bool IsAt(const State& s, const Visit& place) {
  return maths::Hypot(s.set_point[kX].position - place.x, s.set_point[kY].position - place.y) <= 2 * kNear;
}

// Returns why a mover that is not on its route cannot begin its draft.
RouteProblem WhyNotBegin(const Context& c, const State& s, const SurfaceRoute& r) {
  const std::uint64_t at = r.draft.first();
  // The place to which it has moved on while braking; other movers wait for the places that it has not left.
  const bool on_old = at > r.passed && at <= r.last() && IsAt(s, r.visits[at]);
  if (at != r.passed && !on_old) return RouteProblem::kNumber;
  if (!IsPlaneResting(c, s)) return RouteProblem::kMoves;
  return IsAt(s, r.draft[at]) ? RouteProblem::kNone : RouteProblem::kElsewhere;
}

ErrorId WhyNotAble(const State& s) {
  if (const ErrorId why = Diagnose(s, Ask::kMoveToPosition); why != ErrorId::kNone) return why;
  const bool free = s.mode == CommandMode::kFreeMovement && s.external.mode == SetpointMode::kNone && !IsPlanet(s);
  return free ? ErrorId::kNone : ErrorId::kCommandMode;
}

// Returns true if each straight motion has a departure and an arrival, in order.
bool HasGoodTimes(const Visits& visits) {
  if (!visits[visits.first()].departure_time) return true;
  double last = 0;
  for (std::uint64_t k = visits.first(); k < visits.last();) {
    const std::optional<double> departure = visits[k].departure_time;
    const Heading heading = HeadingOf(visits[k], visits[k + 1]);
    std::uint64_t end = k + 1;
    while (end < visits.last() && !visits[end].arrival_time) {
      if (visits[end].departure_time || HeadingOf(visits[end], visits[end + 1]) != heading) return false;
      ++end;
    }
    const std::optional<double> arrival = visits[end].arrival_time;
    if (!departure || !arrival || *departure < last - kRounded || *arrival < *departure) return false;
    last = *arrival;
    k = end;
  }
  return true;
}

RouteProblem WhyNotVisits(const SurfaceRoutes& routes, const SurfaceRoute& r) {
  for (std::uint64_t k = r.draft.first() + 1; k <= r.draft.last(); ++k) {
    const Visit& visit = r.draft[k];
    if (visit.after > routes.of.size()) return RouteProblem::kNoMover;
    if (visit.after != 0 && visit.after_visit > LastOf(routes.of[visit.after - 1])) return RouteProblem::kNoVisit;
  }
  return HasGoodTimes(r.draft) ? RouteProblem::kNone : RouteProblem::kTimes;
}

// Returns why a place for which the mover is already bound would not become free.
RouteProblem WhyNotKept(const Context& c, const SurfaceRoute& r) {
  for (std::uint64_t k = r.passed + 1; k <= r.draft.first(); ++k) {
    const std::optional<std::uint32_t> before = Before(c, r.visits[k]);
    if (!before) continue;
    const SurfaceRoute& other = RouteOf(c, *before);
    const std::uint64_t its = r.visits[k].after_visit;
    if (other.passed <= its && LastOf(other) <= its) return RouteProblem::kBehind;
  }
  return RouteProblem::kNone;
}

// Returns true if a mover can keep its route behind those that change theirs: these still leave the places in question.
bool StaysBehind(const Context& c, const SurfaceRoute& r) {
  for (std::uint64_t k = r.passed + 1; k <= r.last(); ++k) {
    const std::optional<std::uint32_t> before = Before(c, r.visits[k]);
    if (!before || !RouteOf(c, *before).takes) continue;
    const Visits& draft = RouteOf(c, *before).draft;
    const std::uint64_t its = r.visits[k].after_visit;
    if (its >= draft.first() && (its > draft.first() || its == draft.last())) return false;
  }
  return true;
}

// Determines which movers begin their drafts.
planar::Verdict SelectDrafts(const RoutedMovers& all, std::span<const std::uint32_t> listed) {
  for (SurfaceRoute& r : all.routes.of) r.takes = listed.empty() && r.draft_ticket != 0;
  for (const std::uint32_t number : listed) {
    if (number == 0 || number > all.routes.of.size()) return {ErrorId::kParameter};
    SurfaceRoute& r = all.routes.of[number - 1];
    if (r.draft_ticket == 0) return RefusedRoute(RouteProblem::kNoneTold, number - 1);
    r.takes = true;
  }
  const bool none = std::ranges::none_of(all.routes.of, &SurfaceRoute::takes);
  return none ? planar::Verdict{ErrorId::kRoute, {}, static_cast<double>(RouteProblem::kNoneTold)} : planar::Verdict{};
}

planar::Verdict WhyNotStart(const RoutedMovers& all, const RouteDynamics& dynamics) {
  for (std::size_t i = 0; i < all.routes.of.size(); ++i) {
    const SurfaceRoute& r = all.routes.of[i];
    const State& s = all.states[i];
    const Context c = all.of(i);
    const bool on_way = IsOnRoute(s);
    if (!r.takes) {
      if (on_way && !StaysBehind(c, r)) return RefusedRoute(RouteProblem::kMissing, i);
      continue;
    }
    if (const ErrorId why = WhyNotAble(s); why != ErrorId::kNone) return {why, ObjectAt(ObjectKind::kMover, i)};
    RouteProblem problem = on_way ? WhyNotChange(c, s, r, dynamics) : WhyNotBegin(c, s, r);
    if (problem == RouteProblem::kNone) problem = WhyNotVisits(all.routes, r);
    if (problem == RouteProblem::kNone && on_way) problem = WhyNotKept(c, r);
    if (problem != RouteProblem::kNone) return RefusedRoute(problem, i);
  }
  return {};
}

void BeginDraft(const Context& c, const RouteDynamics& dynamics, State& s, SurfaceRoute& r) {
  const bool on_way = IsOnRoute(s);
  const std::uint64_t at = r.draft.first();
  for (std::uint64_t k = r.passed; on_way && k < at; ++k) {
    Visit kept = r.visits[k];
    kept.departure_time.reset();
    kept.arrival_time.reset();
    r.draft.Put(k, kept);
  }
  if (on_way) {  // the visit before this one at that place is unchanged
    Visit junction = r.draft[at];
    junction.after = r.visits[at].after;
    junction.after_visit = r.visits[at].after_visit;
    r.draft.Put(at, junction);
  }
  std::swap(r.visits, r.draft);
  r.draft.Clear(0);
  if (!on_way) r.passed = at;  // earlier visits are over
  r.begin = r.passed;
  r.granted = on_way ? std::min(r.granted, at) : at;
  r.sent = on_way ? std::min(r.sent, at) : at;
  r.aims = on_way && r.aims;
  r.leg = at;
  r.timed = r.visits[at].departure_time.has_value();
  r.leaves = false;
  r.held &= on_way;
  r.late = 0;
  r.look_again = 0;
  r.pause = 0;
  r.rests_since = 0;
  r.system = s.system;
  r.dynamics = dynamics;
  r.started = c.cycle.count;
  End(c, kRoute, FeedbackState::kAborted, ErrorId::kNone, s);
  if (!on_way) AbortBuffered(c, s);
  s.tickets[kRoute] = std::exchange(r.draft_ticket, 0);
  s.begun[kRoute] = c.cycle.count;
  Report(c, s.tickets[kRoute], FeedbackState::kActive, ErrorId::kNone, 0, s);
}

}  // namespace

AdmissionResult CarryOut(const CommandContext& g, const SetRoute& command) noexcept {
  SurfaceRoute& r = RouteOf(g.c, g.c.index);
  const auto visits = command.visits.all();
  const bool continues = command.continues;
  if (continues && (r.draft_ticket == 0 || command.first != r.draft.last() + 1)) {
    return RefusedRoute(RouteProblem::kNotNext);
  }
  for (std::size_t i = continues ? 0 : 1; i < visits.size(); ++i) {
    const Visit& before = i == 0 ? r.draft[r.draft.last()] : visits[i - 1];
    if (!IsBeside(before, visits[i])) return RefusedRoute(RouteProblem::kNotBeside);
  }
  const std::size_t known = continues ? static_cast<std::size_t>(r.draft.last() - r.draft.first()) + 1 : 0;
  if (known + visits.size() > kMostVisits) return RefusedRoute(RouteProblem::kTooMany);
  ++g.c.fleet.routes->changes;
  if (!continues) {
    if (r.draft_ticket != 0) Report(g.c, r.draft_ticket, FeedbackState::kAborted, ErrorId::kNone, 0, g.s);
    r.draft.Clear(command.first);
    r.draft_ticket = visits.empty() ? 0 : g.ticket;
  }
  if (visits.empty()) return Done();
  for (const Visit& visit : visits) r.draft.Add(visit);
  return {.status = Status::Ok(), .goes_on = !continues, .waits = !continues, .object = {}};
}

AdmissionResult CarryOut(const CommandContext& g, const ContinueRoute&) noexcept {
  State& s = g.s;
  SurfaceRoute& r = RouteOf(g.c, g.c.index);
  if (const ErrorId why = WhyNotAble(s); why != ErrorId::kNone) return Refused(why);
  if (IsOnRoute(s)) return Done();
  if (r.visits.empty() || r.system != s.system) return RefusedRoute(RouteProblem::kNoRoute);
  if (!IsPlaneResting(g.c, s)) return RefusedRoute(RouteProblem::kMoves);
  const std::uint64_t passed = r.passed, sent = std::exchange(r.sent, r.granted);
  Look(g.c, s, r);  // it may have passed places while braking
  if (OffRoute(s, r) > kNear) {
    r.passed = passed;
    r.sent = sent;
    return RefusedRoute(RouteProblem::kElsewhere);
  }
  r.sent = r.passed;
  r.aims = false;
  r.pause = 0;
  if (r.timed) Disturb(r);
  AbortBuffered(g.c, s);
  Take(g, kRoute);
  return {};
}

planar::Verdict Start(const RoutedMovers& all, const StartRoutes& command) noexcept {
  if (!InRange(command)) return {ErrorId::kParameter};
  const RouteDynamics dynamics{command.velocity, command.acceleration, command.deceleration, command.jerk};
  planar::Verdict why = SelectDrafts(all, command.movers.all());
  if (why.error == ErrorId::kNone) why = WhyNotStart(all, dynamics);
  if (why.error != ErrorId::kNone) return why;
  // A mover that was taken off its route cannot resume it behind visits that no longer take place.
  for (std::size_t i = 0; i < all.routes.of.size(); ++i) {
    SurfaceRoute& r = all.routes.of[i];
    if (!r.takes && !IsOnRoute(all.states[i]) && !StaysBehind(all.of(i), r)) r.visits.Clear(r.passed);
  }
  for (std::size_t i = 0; i < all.routes.of.size(); ++i) {
    if (all.routes.of[i].takes) BeginDraft(all.of(i), dynamics, all.states[i], all.routes.of[i]);
  }
  return {};
}

namespace {

constexpr std::uint64_t kGoesOn = std::numeric_limits<std::uint64_t>::max();

// Finds where movers that are held, and those behind them, come to rest (`held_at`).
void FindRests(const RoutedMovers& all) {
  auto& of = all.routes.of;
  const auto ahead = [&](const Context& c, const Visit& visit) -> SurfaceRoute* {
    const std::optional<std::uint32_t> before = Before(c, visit);
    return before && of[*before].held_at != kGoesOn ? &of[*before] : nullptr;
  };
  for (bool again = true; std::exchange(again, false);) {
    all.Each([&](const Context& c, const State& s, SurfaceRoute& r) {
      const bool rests = r.held_at != kGoesOn;
      for (std::uint64_t k = r.passed + 1; k <= (rests ? r.held_at : r.granted); ++k) {
        SurfaceRoute* other = ahead(c, r.visits[k]);
        const std::uint64_t its = r.visits[k].after_visit;
        if (!other || other->passed > its || other->held_at > its) continue;
        if (!rests) {
          r.held_at = StopsAt(c, s, r);
        } else if (its < other->granted) {  // the other mover moves on until it has left the place
          other->held_at = its + 1;
        } else {
          continue;
        }
        again = true;
        return;
      }
    });
  }
}

}  // namespace

planar::Verdict Hold(const RoutedMovers& all, const HoldRoutes& command) noexcept {
  const auto numbers = command.movers.all();
  for (const std::uint32_t number : numbers) {
    if (number == 0 || number > all.routes.of.size()) return {ErrorId::kParameter};
  }
  all.Each([](const Context& c, State& s, SurfaceRoute& r) { Look(c, s, r); });
  for (std::size_t i = 0; i < all.routes.of.size(); ++i) {
    SurfaceRoute& r = all.routes.of[i];
    const bool listed = numbers.empty() || std::ranges::find(numbers, i + 1) != numbers.end();
    const bool holds = listed && command.hold && !r.held && IsOnRoute(all.states[i]);
    r.held_at = holds ? StopsAt(all.of(i), all.states[i], r) : r.held ? r.granted : kGoesOn;
    if (listed) r.held = command.hold && (holds || r.held);
  }
  if (!command.hold) return {};
  FindRests(all);
  all.Each([](const Context&, const State&, SurfaceRoute& r) {
    if (r.held_at == kGoesOn) return;
    r.granted = r.held_at;
    if (r.timed && r.sent > r.granted) Disturb(r);
  });
  return {};
}

std::uint64_t HashOf(const SurfaceRoutes& routes, std::uint64_t hash) noexcept {
  if (routes.changes == 0) return hash;
  for (const SurfaceRoute& route : routes.of) {
    hash = takt::HashOf(route, hash);
    for (std::uint64_t k = route.begin; !route.visits.empty() && k <= route.last(); ++k) {
      hash = takt::HashOf(route.visits[k], hash);
    }
    if (route.draft_ticket == 0) continue;
    for (std::uint64_t k = route.draft.first(); k <= route.draft.last(); ++k) {
      hash = takt::HashOf(route.draft[k], hash);
    }
  }
  return hash;
}

std::string_view MessageOf(RouteProblem problem) noexcept {
  switch (problem) {
    case RouteProblem::kTooMany:
      return "expected 512 visits at most";
    case RouteProblem::kNotNext:
      return "expected as `first` of a continuation the number after the last visit";
    case RouteProblem::kNotBeside:
      return "expected each place beside the one before, along X or Y";
    case RouteProblem::kTimes:
      return "expected, for each straight motion, the times of departure and arrival, one after the other, or no times";
    case RouteProblem::kNoMover:
      return "no mover has the number `after`";
    case RouteProblem::kNoVisit:
      return "the mover `after` has no visit with the number `after_visit`";
    case RouteProblem::kNumber:
      return "expected as the first visit that where the mover is, or one ahead on its route";
    case RouteProblem::kElsewhere:
      return "the mover is not in the place of the first visit, or not on its route";
    case RouteProblem::kTooLate:
      return "the mover cannot come to rest any more where its new route begins";
    case RouteProblem::kBehind:
      return "the mover goes to a place that another one visits before, and that one does not leave it";
    case RouteProblem::kMissing:
      return "the mover is on its way, and has no new route";
    case RouteProblem::kNoneTold:
      return "no mover was told a route";
    case RouteProblem::kMoves:
      return "the mover is not at rest, and not on a route";
    case RouteProblem::kNoRoute:
      return "the mover has no route";
    default:
      return {};
  }
}

void describe(Description<RouteDynamics>& d) {
  using R = RouteDynamics;
  d.about("Dynamics of the motions on a route; unset: the mover's standard.");
  d.internal<&R::velocity>(unit::mm_s, "Largest speed.");
  d.internal<&R::acceleration>(unit::mm_s2, "Largest acceleration.");
  d.internal<&R::deceleration>(unit::mm_s2, "Largest deceleration.");
  d.internal<&R::jerk>(unit::mm_s3, "Largest jerk.");
}

void describe(Description<SurfaceRoute>& d) {
  using R = SurfaceRoute;
  d.named("MoverRoute");
  d.about("State of a route of a mover over the free surface, without its visits.");
  d.internal<&R::dynamics>("Dynamics of its motions.");
  d.internal<&R::started>("Cycle of its start.");
  d.internal<&R::begin>("First known visit.");
  d.internal<&R::passed>("Last visit whose place the mover has reached with its centre.");
  d.internal<&R::granted>("Last visit whose place is granted.");
  d.internal<&R::sent>("Visit to whose place the mover was last sent.");
  d.internal<&R::aims>("True: the motion ends at the known position.");
  d.internal<&R::aim_x>(unit::mm, "X of that position.");
  d.internal<&R::aim_y>(unit::mm, "Y of that position.");
  d.internal<&R::system>("Coordinate system of the places.");
  d.internal<&R::pause>("Cycles until a refused move is tried again.");
  d.internal<&R::rests_since>("Cycle since which the mover rests before a place that is not granted; 0: it does not.");
  d.internal<&R::held>("True: no further place is granted.");
  d.internal<&R::timed>("True: the visits have planned times.");
  d.internal<&R::leg>("Visit at which the present planned motion begins.");
  d.internal<&R::leaves>("True: that motion has begun.");
  d.internal<&R::late>(unit::s, "Delay with which that motion began.");
  d.internal<&R::look_again>("Cycle in which the start of that motion is computed anew.");
  d.internal<&R::draft_ticket>("Ticket of the command that gave the next route; 0: none.");
}

}  // namespace takt::mover
