#include "takt/group/plan.h"

#include <algorithm>
#include <cmath>

#include "takt/group/ask.h"
#include "takt/group/boarding.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/jog.h"
#include "takt/group/join.h"
#include "takt/group/make_stretch.h"
#include "takt/group/queue.h"
#include "takt/group/sample.h"
#include "takt/group/switches.h"
#include "takt/group/track.h"
#include "takt/group/zones.h"
#include "takt/path/make.h"

namespace takt::group {

namespace {

// Inverse kinematics per cycle; each takes up to a µs with closed forms.
constexpr int kBudget = 40;
constexpr int kBudgetAtRest = 80;
// Share of the members' limits; the rest covers what the timing takes for linear.
constexpr double kLimitShare = 0.98;
constexpr std::size_t kSweepNodes = 512;
constexpr int kRehearsed = 24;         // cycles of the motion ahead
constexpr int kRehearsedIfCostly = 4;  // with an inverse of a serial chain for each
constexpr int kLeastPlaces = 4;
constexpr int kMostPlaces = 64;
constexpr double kPlaceWay = 8;           // [mm] between two points at which a path is verified
constexpr double kFreeBefore = 1;         // [mm or deg] distance kept by a jog from an obstacle
constexpr double kMostLoad = 0.8;         // largest share of a velocity limit for carriers
constexpr double kLatency_s = 0.004;      // from planning to motion
constexpr double kStraightEnough = 1;     // [mm] displacement of a target by early or late arrival that is ignored
constexpr std::uint64_t kLookAgain = 64;  // cycles between tries of a carried move that waits for a zone

// Returns the number of steps for verification, at least `least`.
int PlacesOf(const Stretch& stretch, int least) {
  return std::clamp(static_cast<int>(std::ceil(stretch.segment.length / kPlaceWay)), least, kMostPlaces);
}

ErrorId ErrorOf(kinematics::Reason reason) {
  return reason == kinematics::Reason::kSingular ? ErrorId::kSingular : ErrorId::kUnreachable;
}

// Returns true if the move has elements.
bool IsPath(const State& s) {
  const MoveKind kind = MoveAt(s, s.planning.move).kind;
  return kind == MoveKind::kPath || kind == MoveKind::kArch;
}

// Returns true if the elements of a path are being verified; all are before the first one is planned.
bool Tries(const State& s) {
  return IsPath(s) && !s.planning.tried;
}

void BeginAgain(bool tried, State& s) {
  s.planning.tried = tried;
  s.planning.element = 0;
  s.planning.stage = Stage::kIdle;
}

void NextMove(State& s) {
  ++s.planning.move;
  BeginAgain(false, s);
}

void GoBackToTrial(LookAhead& ahead) {
  ahead.end_joints = ahead.tried_from;
  ahead.end_tool = ahead.tried_from_tool;
  ahead.end_ride = ahead.tried_from_ride;
  ahead.end_eta = ahead.tried_from_eta;
  ahead.tried_way = 0;
}

void EndTrial(const Context& c, State& s) {
  GoBackToTrial(c.ahead);
  BeginAgain(true, s);
  if (CanBeChecked(c, s)) Ask(c, s);
}

void NextElement(const Context& c, State& s) {
  const bool more = s.planning.element + 1 < ElementsOf(c, MoveAt(s, s.planning.move));
  if (more && !c.ahead.cut_short) {
    ++s.planning.element;
    s.planning.stage = Stage::kIdle;
  } else if (Tries(s)) {
    EndTrial(c, s);
  } else {
    NextMove(s);
  }
}

void Refuse(const Context& c, ErrorId error, State& s) {
  if (s.boards != 0 && s.boards == MoveAt(s, s.planning.move).ticket) {
    GiveUpBoarding(c, s);
    return BeginAgain(false, s);
  }
  if (s.planning.tried && s.planning.element > 0) {
    c.ahead.cut_short = true;
    AbortBehind(c, s.planning.move, s);
    return NextMove(s);
  }
  if (Tries(s)) GoBackToTrial(c.ahead);
  RefuseFrom(c, s.planning.move, error, s.blocked_element, s);
  BeginAgain(false, s);
}

void BeginStretch(const Context& c, double time_s, State& s);

// Returns true if part of the plan has not yet been executed.
bool LiesAhead(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  return ahead.known && ahead.count > 0 && !(s.begun && s.pace.now.position >= ahead[ahead.end() - 1].end());
}

void Begin(const Context& c, State& s) {
  s.reason = kinematics::Reason::kNone;
  c.ahead.failures = 0;
  s.problem = path::Problem::kNone;
  s.blocked_at = 0;
  s.blocked_element = 0;
  s.answer = {};
  s.refused = {};
  s.zone_circle = false;
  if (s.planning.element == 0) {
    if (!c.ahead.known) {
      const End end = Present(c, s);
      c.ahead.end_joints = end.joints;
      c.ahead.end_tool = end.tool;
    }
    if (!LiesAhead(c, s)) c.ahead.end_eta = 0;
    c.ahead.end_eta = std::max(c.ahead.end_eta, Now(c) + kLatency_s);
    c.ahead.tried_from = c.ahead.end_joints;
    c.ahead.tried_from_tool = c.ahead.end_tool;
    c.ahead.tried_from_ride = c.ahead.end_ride;
    c.ahead.tried_from_eta = c.ahead.end_eta;
    c.ahead.tried_way = 0;
    c.ahead.arch_pieces = 0;
    if (!s.planning.tried) c.ahead.tried_zones = 0;
  }
  BeginStretch(c, 0, s);
}

// `time_s`: expected duration; 0: not yet known.
void BeginStretch(const Context& c, double time_s, State& s) {
  const Request& move = MoveAt(s, s.planning.move);
  c.ahead.next = {};
  c.ahead.next_time_s = time_s;
  c.ahead.load = 0;
  c.ahead.next.move = s.planning.move;
  const ErrorId error = MakeStretch(c, move, s.planning.element, c.ahead, s);
  if (s.problem == path::Problem::kLengthZero) {  // already there
    s.problem = path::Problem::kNone;
    return NextElement(c, s);
  }
  if (error != ErrorId::kNone) {
    s.blocked_element = ElementOf(s);
    return Refuse(c, error, s);
  }
  Stretch& next = c.ahead.next;
  next.to = next.segment.length;
  next.begin = (c.ahead.count > 0 ? c.ahead[c.ahead.end() - 1].end() : 0) + c.ahead.tried_way;
  next.bends_at_ends = move.kind == MoveKind::kArch;
  const double left = move.kind == MoveKind::kArch ? c.ahead.arch_left : 0;
  if (s.planning.element == 0) {
    c.ahead.from_ride = next.from_ride;
    if (next.from_ride != next.to_ride) {
      CarrierBinding& ride = c.ahead.rides[next.to_ride % kRides];
      ride.begin = next.begin;
      ride.end = next.begin + next.to + left;
    }
  }
  const double time = time_s > 0 ? time_s : TimeFor(c, next.to + left, next.limits);
  next.eta_begin = c.ahead.end_eta;
  next.eta_end = next.eta_begin + time * next.to / (next.to + left);
  c.ahead.build_up = {};
  c.ahead.near = c.ahead.end_joints;
  s.planning.verifying = false;
  s.planning.verified = 0;
  s.planning.stage = Stage::kVerify;
}

// Returns true if the stretch was verified with the expected pose of its target; else it is refused or begun again.
bool Settled(const Context& c, State& s) {
  Stretch& next = c.ahead.next;
  if (c.ahead.load > kMostLoad) {
    s.blocked_element = ElementOf(s);
    Refuse(c, ErrorId::kTooFast, s);
    return false;
  }
  const trajectory::AlongPath limits = trajectory::Least(next.limits, c.ahead.build_up.Mean());
  const bool arch = MoveAt(s, s.planning.move).kind == MoveKind::kArch;
  const double whole = next.to + (arch ? c.ahead.arch_left : 0);
  const double time = TimeFor(c, whole, limits);
  const double expected = (next.eta_end - next.eta_begin) * whole / next.to;
  const double late = std::abs(time - expected);
  next.eta_end = next.eta_begin + time * next.to / whole;
  if (c.ahead.next_time_s > 0 || next.from_ride == next.to_ride || s.planning.element > 0) return true;
  const CarrierBinding& ride = c.ahead.rides[next.to_ride % kRides];
  const CarrierBinding& before = c.ahead.rides[next.from_ride % kRides];
  const auto speed = [&](const CarrierBinding& one) { return DisplacementOf(c, one, 0).p.v.Norm(); };
  if (late * (speed(ride) + speed(before)) < kStraightEnough) return true;
  BeginStretch(c, time, s);
  return false;
}

// Sets the tool at the end of the stretch, in the planning frame.
void TakeNextTool(const Context& c, const State& s) {
  LookAhead& ahead = c.ahead;
  if (!HasTool(c, s)) return;
  if (IsCarried(ahead, ahead.next)) {
    ahead.next_tool = path::PointAt(ahead.next.segment, ahead.next.segment.length).frame;
    return;
  }
  ToolAt(c, ahead.next_joints, ahead.next_tool);
  const CarrierBinding& ride = ahead.rides[ahead.next.to_ride % kRides];
  if (ride.displaces) ahead.next_tool = ReferenceOf(ride) * ahead.next_tool;
}

// Per mm or unit of the length: less is rounding.
constexpr double kTowardsAlong = 1e-6;

// Returns true if the path leads towards an active limit switch there; sets State::refused.
bool IsClosed(const Context& c, const Stretch& stretch, double way, const trajectory::PathSlopes& slopes, State& s) {
  const Directions closed = ClosedNow(c, s);
  if (!closed.any()) return false;
  kinematics::Joints velocity{};
  std::copy_n(slopes.first.begin(), kMaxAxes, velocity.begin());
  if (stretch.joints) {
    s.refused = TakenOf(closed, s, velocity, nullptr, kTowardsAlong);
  } else {
    const path::MovingFrame tool =
        IsCarried(c.ahead, stretch) ? PredictedTool(c, stretch, {way, 1, 0}, true) : path::At(stretch.segment, way);
    s.refused = TakenOf(closed, s, velocity, &tool, kTowardsAlong);
  }
  return s.refused.any();
}

// The next stretch is known: adds the zones of the blend into it.
void EnterNext(const Context& c, State& s) {
  NoteBlend(c, s);
  s.planning.stage = Stage::kEnter;
}

// Verifies points all along the stretch before anything moves.
void Verify(const Context& c, int& budget, State& s) {
  const Stretch& stretch = c.ahead.next;
  const double length = stretch.segment.length;
  Planning& p = s.planning;
  const bool carried = IsCarried(c.ahead, stretch);
  // A path has many elements: fewer points on each suffice for them.
  const double full = length / PlacesOf(stretch, Tries(s) ? 1 : kLeastPlaces);
  for (; budget > 0 && p.verified < length; budget -= carried ? 3 : 1) {
    const double way = p.verifying ? p.verified + p.step : 0;
    const double to = way > length - 0.01 * full ? length : way;
    trajectory::PathPoint point;
    point.limits = stretch.limits;
    kinematics::JointMotion motion;
    kinematics::Reason reason = SlopesOn(c, s, stretch, to, c.ahead.near, point, motion);
    const bool even = !p.verifying || reason != kinematics::Reason::kNone || carried ||
                      GoesEvenly(c.ahead.near, c.ahead.tried, motion.position, point.slopes, to - p.verified);
    if (!even && p.step > kLeastTry) {
      p.step *= 0.5;
      continue;
    }
    if (!even) reason = kinematics::Reason::kSingular;
    if (reason != kinematics::Reason::kNone) {
      if (p.verifying && ShortenJog(p.verified, ErrorOf(reason), s)) return BeginAgain(false, s);
      s.reason = reason;
      c.ahead.failures = FailuresOn(c, s, stretch, to, reason, c.ahead.near);
      s.blocked_at = to;
      s.blocked_element = ElementOf(s);
      return Refuse(c, ErrorOf(reason), s);
    }
    if (IsClosed(c, stretch, to, point.slopes, s)) {
      s.blocked_at = to;
      s.blocked_element = ElementOf(s);
      return Refuse(c, RefusalOf(c, s), s);
    }
    NoteZones(c, s, motion.position, to, !p.verifying);
    c.ahead.near = motion.position;
    c.ahead.tried = point.slopes;
    // Points before Boarding::reach do not count: accelerations build up there as fast as after it.
    const Boarding& boarding = c.ahead.rides[stretch.to_ride % kRides].boarding;
    const bool boards = boarding.on && stretch.begin + to < boarding.reach && to < length;
    if ((!p.verifying || p.step == full) && !boards) c.ahead.build_up.Add(point, c.ahead.window.limits());
    p.step = p.verifying ? std::min(full, 2 * p.step) : full;
    p.verified = to;
    p.verifying = true;
  }
  if (p.verified < length) return;
  c.ahead.next_joints = c.ahead.near;
  if (carried && !Settled(c, s)) return;
  if (ElementsOf(c, MoveAt(s, s.planning.move)) <= s.planning.element + 1) NoteRide(c, s);
  TakeNextTool(c, s);
  if (Tries(s)) {
    c.ahead.end_joints = c.ahead.next_joints;
    c.ahead.end_tool = c.ahead.next_tool;
    c.ahead.end_ride = c.ahead.next.to_ride;
    c.ahead.end_eta = c.ahead.next.eta_end;
    c.ahead.tried_way += c.ahead.next.to;
    c.ahead.tried_zones |= ZonesOf(c.ahead.next);
    NextElement(c, s);
  } else if (!IsPath(s) && CanBeChecked(c, s)) {
    Ask(c, s);
  } else {
    EnterNext(c, s);
  }
}

// Evaluates the answer to a path check. Returns false if it has not arrived.
bool Check(const Context& c, State& s) {
  if (!HasAnswer(c, s)) return false;
  const PathChecked& answer = s.answer;
  if (answer.trouble == workspace::Trouble::kNone) {
    if (IsPath(s)) {
      s.planning.stage = Stage::kIdle;
    } else {
      EnterNext(c, s);
    }
    return true;
  }
  const double free = answer.place - kFreeBefore;
  if (answer.trouble != workspace::Trouble::kNoPose && ShortenJog(free, ErrorId::kCollision, s)) {
    s.jog.met = answer;
    BeginAgain(false, s);
    return true;
  }
  s.reason = answer.reason;
  s.blocked_at = answer.place;
  s.blocked_element = answer.element;
  const bool lost = answer.trouble == workspace::Trouble::kNoPose;
  Refuse(c, lost ? ErrorOf(answer.reason) : ErrorId::kCollision, s);
  return true;
}

void Sweep(const Context& c, State& s) {
  if (!c.ahead.window.Sweep(kSweepNodes)) return;
  c.ahead.rehearsal.GoOn(c.ahead.window);
  if (c.ahead.sampling >= SampledTo(c, s)) {
    s.planning.stage = Stage::kIdle;
  } else if (c.ahead.window.room() > kNodes / 4) {
    s.planning.stage = Stage::kSample;
  }
}

// Returns false if the move waits for a zone. The plan before it is then sampled to its end, where the tool waits.
bool MayEnter(const Context& c, State& s) {
  const bool waited = s.waits_for != 0;
  switch (EnterZones(c, s)) {
    case Entry::kWaits:
      if (IsJog(MoveAt(s, s.planning.move))) {  // a jog does not wait: it ends before the zone
        const double length = c.ahead.next.segment.length, from = ZonesBeginAt(c.ahead.next, s.zones_wanted);
        // Verified again over a shorter distance, where the points lie closer together.
        const double nearer = from + 1.25 * length / kMostPlaces;
        const bool shorter = ShortenJog(nearer < 0.9 * length ? nearer : from, ErrorId::kZoneTaken, s);
        s.zones_claimed = s.zones_wanted = s.waits_for = s.waits_zone = 0;
        shorter ? BeginAgain(false, s) : Refuse(c, ErrorId::kZoneTaken, s);
        return true;
      }
      c.ahead.corner.open = false;
      if (IsCarried(c.ahead, c.ahead.next) && s.planning.element == 0 && c.cycle.count % kLookAgain == 0) {
        BeginAgain(false, s);  // the carrier has moved its target
        return false;
      }
      if (c.ahead.sampling >= SampledTo(c, s)) return false;
      s.planning.stage = Stage::kSample;
      return true;
    case Entry::kCircle:
      s.zone_circle = true;
      Refuse(c, ErrorId::kZoneCircle, s);
      return true;
    case Entry::kFree:
      break;
  }
  // The carrier has moved its target meanwhile.
  const bool stale = waited && s.planning.element == 0 && IsCarried(c.ahead, c.ahead.next);
  if (stale) {
    BeginAgain(false, s);
  } else {
    s.planning.stage = Stage::kJoin;
  }
  return true;
}

bool HasRoom(const LookAhead& ahead) {
  if (ahead.count > 0 && ahead.rides_end - ahead[ahead.first].from_ride + 2 > kRides) return false;
  return ahead.count + 2 < ahead.stretches.size() && ahead.window.room() > kNodes / 4;
}

}  // namespace

trajectory::CoordinateLimits LimitsOf(const Context& c, const State& s) noexcept {
  trajectory::CoordinateLimits limits;
  const auto set = [&](std::size_t k, double velocity, double acceleration, double jerk) {
    limits.of[k] = {velocity, acceleration, jerk};
    limits.count = std::max(limits.count, k + 1);
  };
  const double none = trajectory::CoordinateLimits::kNone;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const trajectory::Limits own = c.axes.params[s.members[k] - 1].planner_limits();
    set(k, kLimitShare * own.velocity, kLimitShare * std::min(own.acceleration, own.deceleration),
        own.jerk > 0 ? kLimitShare * own.jerk : none);
  }
  const ToolLimits& tool = c.params.tool_limits;
  if (HasTool(c, s)) {
    const auto set_three = [&](std::size_t k, const auto& v, const auto& a, const auto& j) {
      if (!v && !a && !j) return;
      for (std::size_t i = k; i < k + 3; ++i) {
        set(i, kLimitShare * v.value_or(none), kLimitShare * a.value_or(none), kLimitShare * j.value_or(none));
      }
    };
    set_three(kMaxAxes, tool.velocity, tool.acceleration, tool.jerk);
    set_three(kMaxAxes + 3, tool.angular_velocity, tool.angular_acceleration, tool.angular_jerk);
  }
  return limits;
}

void Plan(const Context& c, State& s) noexcept {
  int budget = s.begun ? kBudget : kBudgetAtRest;
  while (budget > 0) {
    switch (s.planning.stage) {
      case Stage::kIdle:
        if (s.ends) return;
        if (c.ahead.sampling < SampledTo(c, s)) {
          s.planning.stage = Stage::kSample;
          break;
        }
        if (s.planning.move >= s.done + s.queue.count || c.ahead.cut_short) return;
        if (WaitsForTracking(s, MoveAt(s, s.planning.move))) return;
        // Boarding begins at the end of what is planned before.
        if (c.ahead.count > 0 && s.planning.move > s.done && MayBoard(c, s)) return;
        if (!Tries(s) && !HasRoom(c.ahead)) return;
        if (c.ahead.corner.open && !IsPath(s) && HasWorkspace(c, s)) {  // an open corner does not wait for an answer
          c.ahead.corner.open = false;
          break;
        }
        Begin(c, s);
        --budget;
        break;
      case Stage::kVerify:
        Verify(c, budget, s);
        break;
      case Stage::kCheck:
        if (!Check(c, s)) return;
        --budget;
        break;
      case Stage::kEnter:
        if (!MayEnter(c, s)) return;
        break;
      case Stage::kJoin:
        if (CanBoard(c, s) && Board(c, s)) break;  // the move is planned anew from there
        budget -= Join(c, s);
        s.planning.joined = c.cycle.count;
        NextElement(c, s);
        s.planning.stage = Stage::kSample;
        break;
      case Stage::kSample:
        Sample(c, budget, s);
        break;
      case Stage::kSweep:
        Sweep(c, s);
        --budget;
        break;
    }
  }
}

std::uint32_t ElementOf(const State& s) noexcept {
  return IsPath(s) ? s.planning.element + 1 : 0;
}

void ForgetPlan(const Context& c, State& s) noexcept {
  c.ahead.window.Clear();
  c.ahead.rehearsal.Clear();
  c.ahead.timing.Clear();
  c.ahead.keep_up = {};
  c.ahead.first = c.ahead.end();
  c.ahead.sampling = c.ahead.first;
  c.ahead.count = 0;
  c.ahead.known = c.ahead.cut_short = c.ahead.corner.open = false;
  c.ahead.end_ride = c.ahead.rides_end++;
  c.ahead.rides[c.ahead.end_ride % kRides] = {};
  s.planning.move = s.done;
  BeginAgain(false, s);
}

bool IsPlanned(const Context& c, const State& s) noexcept {
  return s.planning.stage == Stage::kIdle && c.ahead.sampling >= c.ahead.end() &&
         (s.planning.move >= s.done + s.queue.count || c.ahead.cut_short);
}

void Rehearse(const Context& c, const State& s) noexcept {
  if (trajectory::PathTiming& timing = c.ahead.timing; timing.active()) {
    timing.Ask(c.ahead.window, s.velocity_factor, s.pace);
    if (c.plans_elsewhere) return;
    if (const auto number = timing.MakePlan()) timing.TakePlan(*number);
    return;
  }
  struct Owner {
    const Context& c;
    const State& s;
  };
  const Owner owner{c, s};
  if (s.velocity_factor < 1 || WaitsForClutch(s) || c.ahead.keep_up.on || Jogs(s)) {
    c.ahead.delayed = true;
  } else if (c.ahead.delayed) {  // it is later than rehearsed
    c.ahead.delayed = false;
    c.ahead.rehearsal.Clear();
    c.ahead.rehearsal.GoOn(c.ahead.window);
  }
  if (c.ahead.keep_up.on) return;  // points ahead are checked there
  const auto look = [](const void* with, const KinematicState& along, double ahead_s,
                       trajectory::PathCoordinateValues& positions, trajectory::PathCoordinateValues& velocities,
                       trajectory::PathCoordinateValues& accelerations) noexcept {
    const auto& [context, state] = *static_cast<const Owner*>(with);
    return Foresee(context, state, along, ahead_s, positions, velocities, accelerations);
  };
  const bool costly = c.kinematics && std::holds_alternative<kinematics::Serial>(c.kinematics->mechanism) &&
                      c.ahead.rides[c.ahead.end_ride % kRides].displaces;
  c.ahead.rehearsal.Run(c.ahead.window, s.pace, costly ? kRehearsedIfCostly : kRehearsed, c.cycle.count,
                        c.cycle.period_s, {look, &owner});
}

double TimeLeft(const Context& c, const State& s) noexcept {
  if (const trajectory::PathTiming& timing = c.ahead.timing; timing.active()) {
    const double end = c.ahead[c.ahead.end() - 1].end();
    const bool known = s.begun && !s.ends && !s.interrupted && IsPlanned(c, s) && timing.IsFinalTo(end);
    return known ? c.cycle.period_s * static_cast<double>(timing.rest_cycles()) : kNotGiven;
  }
  std::uint64_t end = c.ahead.rehearsal.end_cycle();
  const Boarding& boarding = c.ahead.rides[c.ahead.end_ride % kRides].boarding;
  if (boarding.on && end > 0) {
    const double cycles = std::ceil(boarding.apart.duration() / c.cycle.period_s);
    end = std::max(end, boarding.begin - 1 + static_cast<std::uint64_t>(cycles));
  }
  const bool slowed = Jogs(s) || s.velocity_factor < 1 || s.ends || s.interrupted || WaitsForClutch(s) ||
                      c.ahead.keep_up.on || s.master.axis != 0;
  if (!s.begun || slowed || !IsPlanned(c, s) || end == 0) return kNotGiven;
  return end > c.cycle.count ? static_cast<double>(end - c.cycle.count) * c.cycle.period_s : 0;
}

bool MayBegin(const Context& c) noexcept {
  const trajectory::PathWindow& window = c.ahead.window;
  return window.swept() && window.known() > window.begin() + 1;
}

}  // namespace takt::group
