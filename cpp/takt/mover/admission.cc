// Commands as they arrive.
#include <algorithm>
#include <cmath>
#include <optional>

#include "takt/core/in_range.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/run.h"
#include "takt/planar/nearest.h"

namespace takt::mover {

namespace {

using planar::ObjectState;
using trajectory::Limits;

struct Given {
  const Context& c;
  Ticket ticket;
  State& s;
};

struct Answer {
  Status status;
  double value = 0;     // s that it takes, as planned
  bool goes_on = true;  // it is done later
};

Answer Refused(ErrorId error) {
  return {Status::Failed(error)};
}
Answer Done() {
  return {Status::Ok(), 0, false};
}

// The command gets this slot; who had it is aborted.
void Take(const Given& g, Slot slot) {
  End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, g.s);
  g.s.tickets[slot] = g.ticket;
}

// Why the mover does not do this now.
ErrorId WhyNot(const State& s, Ask ask) {
  if (s.state != ObjectState::kEnabled) return ErrorId::kMoverDisabled;
  return Accepts(s.mode, ask) ? ErrorId::kNone : ErrorId::kCommandMode;
}

// Dynamics of a command, no more than the maximum.
template <typename Move, typename Params>
Limits LimitsOf(const Move& m, const Params& params, LimitedBy& limited_by) {
  const Limits standard = StandardOf(params);
  const Limits most = params.maximum.limits();
  limited_by = LimitedBy::kNothing;
  const auto take = [&](const std::optional<double>& given, double otherwise, double maximum, LimitedBy what) {
    const double wanted = given.value_or(otherwise);
    if (wanted > maximum && limited_by == LimitedBy::kNothing) limited_by = what;
    return std::min(wanted, maximum);
  };
  return {take(m.velocity, standard.velocity, most.velocity, LimitedBy::kVelocity),
          take(m.acceleration, standard.acceleration, most.acceleration, LimitedBy::kAcceleration),
          take(m.deceleration, standard.deceleration, most.deceleration, LimitedBy::kAcceleration),
          take(m.jerk, standard.jerk, most.jerk, LimitedBy::kJerk)};
}

// As slow as a motion from rest that takes `share` of the time.
Limits Slower(const Limits& l, double share) {
  const double square = share * share;
  return {share * l.velocity, square * l.acceleration, square * l.deceleration, square * share * l.jerk};
}

// --- enabled or not ---

Answer CarryOut(const Given& g, const Enable&) {
  switch (g.s.state) {
    case ObjectState::kEnabled:
      return Done();
    case ObjectState::kDisabled:
    case ObjectState::kDisabling:
    case ObjectState::kEnabling:
      Take(g, kPower);
      if (g.s.state != ObjectState::kEnabling) Enter(g.c, ObjectState::kEnabling, g.s);
      return {};
    default:
      return Refused(ErrorId::kState);
  }
}

Answer CarryOut(const Given& g, const Disable&) {
  switch (g.s.state) {
    case ObjectState::kDisabled:
      return Done();
    case ObjectState::kErrorPending:
    case ObjectState::kError:
    case ObjectState::kResetting:
      g.s.aborts = true;
      return Done();
    default:
      break;
  }
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, g.s);
  Take(g, kPower);
  if (g.s.state == ObjectState::kEnabled) BringToRest(g.c, nullptr, g.s);
  if (g.s.state != ObjectState::kDisabling) Enter(g.c, ObjectState::kDisabling, g.s);
  return {};
}

Answer CarryOut(const Given& g, const Reset&) {
  switch (g.s.state) {
    case ObjectState::kErrorPending:
      return Refused(ErrorId::kState);
    case ObjectState::kError:
      Take(g, kPower);
      Enter(g.c, ObjectState::kResetting, g.s);
      return {};
    case ObjectState::kResetting:
      Take(g, kPower);
      return {};
    default:
      return Done();  // nothing to reset
  }
}

Answer CarryOut(const Given& g, const SetPosition& command) {
  if (g.s.state != ObjectState::kDisabled) return Refused(ErrorId::kState);
  g.s.set_point[kX].position = command.x;
  g.s.set_point[kY].position = command.y;
  g.s.set_point[kC].position = command.c;
  g.s.plane.motion = StandingAt(command.x, command.y);
  if (IsOnTrack(g.s)) g.s.mode = CommandMode::kFreeMovement;
  LeaveStreets(g.c, g.s);
  CoordinateMove& turn = g.s.others.back();
  turn.profile = {g.s.set_point[kC], g.s.set_point[kC]};
  return Done();
}

Answer CarryOut(const Given& g, const Halt& command) {
  if (g.s.state != ObjectState::kEnabled) return Refused(ErrorId::kMoverDisabled);
  const MoveToPosition as{.deceleration = command.deceleration, .jerk = command.jerk};
  const Limits limits = LimitsOf(as, g.c.params.xy, g.s.limited_by);
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, g.s);
  BringToRest(g.c, &limits, g.s);
  g.s.tickets[kHalt] = g.ticket;
  return {Status::Ok(), DurationOf(g.s.plane.motion)};
}

// --- moves ---

// From one motion to another place: at once if that is quicker, else by way of rest. Nothing: no such motion.
std::optional<PlaneMove> PlanPlane(const Given& g, const MoveToPosition& to, const Limits& limits, double& duration) {
  const Context& c = g.c;
  const double most = c.params.xy.maximum.velocity * (1 + 1e-9);
  const double now = Elapsed(c, g.s.plane.begin);
  PlaneMove at_once{.motion = {}, .begin = c.cycle.count, .waits = false, .next = {}, .turns = false};
  const bool found = PlanMove(c.planner, At(g.s.plane.motion, now), to.x, to.y, limits, at_once.motion) &&
                     SpeedBound(at_once.motion) <= most;
  duration = DurationOf(at_once.motion);
  if (found && at_once.motion.share == 0) return at_once;

  PlaneMove stops{.motion = {}, .begin = c.cycle.count, .waits = true, .next = to, .turns = false};
  bool can_stop = PlanRest(c.planner, g.s.plane.motion, now, limits, stops.motion);
  if (can_stop && SpeedBound(stops.motion) > most) {
    can_stop = PlanRest(c.planner, g.s.plane.motion, now, c.params.xy.maximum.limits(), stops.motion);
  }
  const double rests = DurationOf(stops.motion);
  PlaneMotion line;
  can_stop = can_stop && PlanMove(c.planner, At(stops.motion, rests), to.x, to.y, limits, line);
  if (!can_stop || (found && duration <= rests + DurationOf(line))) {
    return found ? std::optional(at_once) : std::nullopt;
  }
  duration = rests + DurationOf(line);
  stops.next.velocity = limits.velocity;
  stops.next.acceleration = limits.acceleration;
  stops.next.deceleration = limits.deceleration;
  stops.next.jerk = limits.jerk;
  return stops;
}

Answer MoveTo(const Given& g, const MoveToPosition& command) {
  State& s = g.s;
  LimitedBy limited_by;
  const Limits limits = LimitsOf(command, g.c.params.xy, limited_by);
  double duration = 0;
  std::optional<PlaneMove> move = PlanPlane(g, command, limits, duration);
  if (!move) return Refused(ErrorId::kPlanning);

  CoordinateMove turn = s.others.back();
  const KinematicState turned = Now(g.c, turn);
  const CoordinateParams free = Windowed(g.c.params.c, turned.position, false);
  if (command.use_orientation) {
    const auto plan = [&](const Limits& as) {
      return PlanCoordinate(g.c.planner, turned, command.c, as, free, turn.profile);
    };
    if (!plan(StandardOf(free))) return Refused(ErrorId::kPlanning);
    const trajectory::Profile::Range range = turn.profile.PositionRange();
    if (!InOneWindow(g.c.params.c, range.min, range.max)) return Refused(ErrorId::kOutsideWindow);
    // From rest both arrive together.
    const double turns = turn.profile.duration();
    if (IsOver(g.c, s.plane) && IsOver(g.c, s.others.back()) && turns > 0 && duration > 0) {
      if (turns > duration) {
        if (std::optional<PlaneMove> slow = PlanPlane(g, command, Slower(limits, duration / turns), duration)) {
          move = slow;
        }
      } else {
        plan(Slower(StandardOf(free), turns / duration));
      }
    }
    duration = std::max(duration, turn.profile.duration());
    turn.begin = g.c.cycle.count;
    End(g.c, kMoveC, FeedbackState::kAborted, ErrorId::kNone, s);
  } else if (s.plane.turns) {  // that turn belonged to the move before
    PlanRest(g.c.planner, turned, StandardOf(free), ParamsOf(g.c, s, kOthers.size() - 1), turn.profile);
    turn.begin = g.c.cycle.count;
  }
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kPlane);
  s.others.back() = turn;
  s.plane = *move;
  s.plane.turns = command.use_orientation;
  s.limited_by = limited_by;
  return {Status::Ok(), duration};
}

Answer CarryOut(const Given& g, const MoveToPosition& command) {
  if (const ErrorId why = WhyNot(g.s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  return MoveTo(g, command);
}

template <typename Move>
Answer MoveOne(const Given& g, const Move& command, std::size_t other, Ask ask) {
  if (const ErrorId why = WhyNot(g.s, ask); why != ErrorId::kNone) return Refused(why);
  const CoordinateParams params = ParamsOf(g.c, g.s, other);
  LimitedBy limited_by;
  const Limits limits = LimitsOf(command, params, limited_by);
  if (command.position < params.lower || command.position > params.upper) return Refused(ErrorId::kTargetBehindLimit);
  CoordinateMove& move = g.s.others[other];
  if (!PlanCoordinate(g.c.planner, Now(g.c, move), command.position, limits, params, move.profile)) {
    return Refused(ErrorId::kPlanning);
  }
  move.begin = g.c.cycle.count;
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, g.s);
  Take(g, static_cast<Slot>(kMoveZ + other));
  g.s.limited_by = limited_by;
  return {Status::Ok(), move.profile.duration()};
}

Answer CarryOut(const Given& g, const MoveZ& command) {
  return MoveOne(g, command, 0, Ask::kMoveAuxiliary);
}
Answer CarryOut(const Given& g, const MoveA& command) {
  return MoveOne(g, command, 1, Ask::kMoveAuxiliary);
}
Answer CarryOut(const Given& g, const MoveB& command) {
  return MoveOne(g, command, 2, Ask::kMoveAuxiliary);
}

Answer Turn(const Given& g, const MoveC& command, Ask ask) {
  State& s = g.s;
  if (const ErrorId why = WhyNot(s, ask); why != ErrorId::kNone) return Refused(why);
  if (s.plane.turns) return Refused(ErrorId::kCommandMode);  // C belongs to another move
  CoordinateMove move = s.others.back();
  const KinematicState from = Now(g.c, move);
  const CoordinateParams free = Windowed(g.c.params.c, from.position, false);
  LimitedBy limited_by;
  const Limits limits = LimitsOf(command, free, limited_by);
  const double target = TargetOf(g.c.params, from, trajectory::StopPosition(from, limits), command);
  if (!PlanCoordinate(g.c.planner, from, target, limits, free, move.profile)) return Refused(ErrorId::kPlanning);
  const trajectory::Profile::Range range = move.profile.PositionRange();
  const bool inside = InOneWindow(g.c.params.c, range.min, range.max);
  if (!inside && !IsPlaneResting(g.c, s)) return Refused(ErrorId::kOutsideWindow);
  if (!inside && s.mode == CommandMode::kFreeMovement) s.mode = CommandMode::kCRotationFreeMovement;
  if (!inside && s.mode == CommandMode::kOnTrack) s.mode = CommandMode::kCRotationOnTrack;
  move.begin = g.c.cycle.count;
  s.others.back() = move;
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kMoveC);
  s.limited_by = limited_by;
  return {Status::Ok(), move.profile.duration()};
}

Answer CarryOut(const Given& g, const MoveC& command) {
  return Turn(g, command, Ask::kMoveC);
}

// --- on tracks ---

Answer CarryOut(const Given& g, const AdoptTrackOrientation& command) {
  return Turn(g,
              {.position = 0,
               .direction = command.direction,
               .additional_turns = command.additional_turns,
               .velocity = command.velocity,
               .acceleration = command.acceleration,
               .deceleration = command.deceleration,
               .jerk = command.jerk},
              Ask::kAdoptTrackOrientation);
}

// Too near to others on a track to stand there, or to one that is to stand on a track that meets it.
bool IsTaken(const Context& c, std::uint32_t track, double s) {
  const Streets& streets = c.streets;
  const planar::Road& road = streets.network[track];
  const planar::Place place = planar::At(*road.track, s).place;
  for (std::uint32_t i = 0; i < streets.riders.size(); ++i) {
    const planar::Rider& other = streets.riders[i];
    if (!other.on || i == c.index) continue;
    const double gap = std::max(c.params.gap, other.gap);
    if (other.route.first() == track) {
      const double apart = std::abs(other.at.position - s);
      if (std::min(apart, road.closed ? road.length - apart : apart) < gap) return true;
      continue;
    }
    const planar::Place its = planar::At(*streets.network[other.route.first()].track, other.at.position).place;
    if (std::hypot(its.x - place.x, its.y - place.y) < streets.tracks[track].reach) return true;
  }
  return false;
}

Answer CarryOut(const Given& g, const JoinTrack& command) {
  State& s = g.s;
  Streets& streets = g.c.streets;
  if (const ErrorId why = WhyNot(s, Ask::kJoinTrack); why != ErrorId::kNone) return Refused(why);
  if (!IsPlaneResting(g.c, s)) return Refused(ErrorId::kCommandMode);
  const std::uint32_t track = streets.Find(command.track.view());
  if (track == planar::kNoTrack) return Refused(ErrorId::kParameter);
  if (!streets.tracks[track].enabled || streets.uses[track].moving > 0) return Refused(ErrorId::kTrackMode);
  const planar::Nearest nearest =
      planar::NearestTo(*streets.network[track].track, {s.set_point[kX].position, s.set_point[kY].position});
  if (IsTaken(g.c, track, nearest.s)) return Refused(ErrorId::kCollision);
  const KinematicState turned = Now(g.c, s.others.back());
  const double c = TargetOf(g.c.params, turned, turned.position, {.direction = TurnDirection::kShortestWay});
  const Answer answer = MoveTo(g, {nearest.place.x, nearest.place.y, c, command.use_orientation, command.velocity,
                                   command.acceleration, command.deceleration, command.jerk});
  if (answer.status.failed()) return answer;
  // The place is its own from now on.
  planar::Rider& rider = g.c.rider();
  rider = {};
  rider.on = true;
  rider.at.position = nearest.s;
  rider.route.tracks[0] = track;
  rider.route.count = 1;
  rider.gap = g.c.params.gap;
  rider.pace = {StandardOf(g.c.params.xy), g.c.params.lateral_acceleration};
  const Limits most = g.c.params.xy.maximum.limits();
  rider.brakes = {most.deceleration, most.jerk};
  s.track = track;
  s.mode = CommandMode::kJoiningTrack;
  ++streets.uses[track].configuring;
  return answer;
}

Answer CarryOut(const Given& g, const LeaveTrack& command) {
  State& s = g.s;
  Streets& streets = g.c.streets;
  if (const ErrorId why = WhyNot(s, Ask::kLeaveTrack); why != ErrorId::kNone) return Refused(why);
  if (!IsPlaneResting(g.c, s)) return Refused(ErrorId::kCommandMode);
  if (streets.uses[s.track].moving > 0) return Refused(ErrorId::kTrackMode);
  s.plane = {};
  s.plane.motion = StandingAt(s.set_point[kX].position, s.set_point[kY].position);
  s.plane.begin = g.c.cycle.count;
  const Answer answer = MoveTo(g, {command.x, command.y, command.c, command.use_orientation, command.velocity,
                                   command.acceleration, command.deceleration, command.jerk});
  if (answer.status.failed()) return answer;
  s.mode = CommandMode::kLeavingTrack;
  ++streets.uses[s.track].configuring;
  return answer;
}

planar::Way WayOf(TurnDirection direction) {
  switch (direction) {
    case TurnDirection::kPositive:
      return planar::Way::kPositive;
    case TurnDirection::kShortestWay:
      return planar::Way::kShortestWay;
    case TurnDirection::kNegative:
      return planar::Way::kNegative;
    default:
      return planar::Way::kNonModulo;
  }
}

Answer CarryOut(const Given& g, const MoveOnTrack& command) {
  State& s = g.s;
  Streets& streets = g.c.streets;
  if (const ErrorId why = WhyNot(s, Ask::kMoveOnTrack); why != ErrorId::kNone) return Refused(why);
  const std::uint32_t track = command.track.empty() ? s.track : streets.Find(command.track.view());
  if (track == planar::kNoTrack) return Refused(ErrorId::kParameter);
  const planar::Road& road = streets.network[track];
  const bool turns_count = road.closed && command.direction == TurnDirection::kNonModulo;
  const bool outside = !(command.position >= 0 && command.position <= road.length);
  if (outside && !turns_count) return Refused(ErrorId::kTargetBehindLimit);
  planar::Rider next = g.c.rider();
  const planar::Destination to{track, command.position, WayOf(command.direction), command.additional_turns,
                               command.modulo_tolerance};
  if (!planar::Send(streets.network, streets.search, to, next)) return Refused(ErrorId::kNoRoute);
  for (const std::uint32_t on : next.route.all()) {
    if (!streets.tracks[on].enabled || streets.uses[on].configuring > 0) return Refused(ErrorId::kTrackMode);
  }
  next.pace = {LimitsOf(command, g.c.params.xy, s.limited_by), g.c.params.lateral_acceleration};
  next.gap = command.gap.value_or(g.c.params.gap);
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kPlane);
  g.c.rider() = next;
  for (const std::uint32_t on : next.route.all()) ++streets.uses[on].moving;
  return {};
}

// --- set points from outside ---

Answer CarryOut(const Given& g, const StartExternalSetpointGeneration& command) {
  State& s = g.s;
  const bool alone = command.mode == SetpointMode::kAbsolute;
  if (command.mode == SetpointMode::kNone) return Refused(ErrorId::kParameter);
  const ErrorId why = WhyNot(s, alone ? Ask::kExternalAbsolute : Ask::kExternalRelative);
  if (why != ErrorId::kNone) return Refused(why);
  if (s.external.mode != SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  if (alone && !IsResting(g.c, s)) return Refused(ErrorId::kCommandMode);
  s.external = {};
  s.external.mode = command.mode;
  if (alone) s.mode = CommandMode::kExternalSetpointGeneration;
  Take(g, kExternal);
  return {};
}

Answer CarryOut(const Given& g, const SetExternalSetpoint& p) {
  External& external = g.s.external;
  if (external.mode == SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  external.given = {{{p.x, p.velocity_x, p.acceleration_x},
                     {p.y, p.velocity_y, p.acceleration_y},
                     {p.z, p.velocity_z, p.acceleration_z},
                     {p.a, p.velocity_a, p.acceleration_a},
                     {p.b, p.velocity_b, p.acceleration_b},
                     {p.c, p.velocity_c, p.acceleration_c}}};
  external.begun = external.fresh = true;
  return Done();
}

Answer CarryOut(const Given& g, const StopExternalSetpointGeneration&) {
  State& s = g.s;
  if (s.external.mode == SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  End(g.c, kExternal, FeedbackState::kDone, ErrorId::kNone, s);
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, s);
  BringToRest(g.c, nullptr, s);
  s.tickets[kStopExternal] = g.ticket;
  return {Status::Ok(), DurationOf(s.plane.motion)};
}

}  // namespace

void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  if (ticket != 0 && !std::holds_alternative<SetExternalSetpoint>(command)) {
    s.history.Begin(ticket, c.cycle.count, static_cast<std::uint8_t>(command.index()));
  }
  const Given given{c, ticket, s};
  const Answer answer = std::visit(
      [&](const auto& body) { return InRange(body) ? CarryOut(given, body) : Refused(ErrorId::kParameter); }, command);
  if (answer.status.failed()) return Report(c, ticket, FeedbackState::kError, answer.status.error, 0, s);
  Report(c, ticket, FeedbackState::kActive, ErrorId::kNone, answer.value, s);
  if (!answer.goes_on) Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, 0, s);
}

}  // namespace takt::mover
