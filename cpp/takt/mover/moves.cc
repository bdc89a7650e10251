// Moves of X and Y in the plane, and of the other coordinates.
#include <algorithm>
#include <cmath>
#include <optional>

#include "takt/mover/admission.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/by_coordinate.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/course.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

using trajectory::Limits;

namespace {

// Returns the limits with which a motion from rest takes 1 / `share` of the time.
Limits Slower(const Limits& l, double share) {
  const double square = share * share;
  return {share * l.velocity, square * l.acceleration, square * l.deceleration, square * share * l.jerk};
}

MoveToPosition WithLimits(MoveToPosition move, const Limits& limits) {
  move.velocity = limits.velocity;
  move.acceleration = limits.acceleration;
  move.deceleration = limits.deceleration;
  move.jerk = limits.jerk;
  return move;
}

// Plans from the motion in progress to another target: at once if that is faster, else after a stop. Returns nothing if
// there is no such motion.
std::optional<PlaneMove> PlanPlane(const CommandContext& g, const MoveToPosition& to, const Limits& limits,
                                   double& duration) {
  const Context& c = g.c;
  if (IsAtCorner(c, g.s.plane)) {
    const PlaneMove& from = g.s.plane;
    Limits even = limits;
    even.acceleration = even.deceleration = std::min(limits.acceleration, limits.deceleration);
    PlaneMove round;
    round.begin = c.cycle.count;
    const PlaneState corner{{from.corner_x, 0, 0}, {from.corner_y, 0, 0}};
    const PlaneState now = At(from.motion, Elapsed(c, from.begin));
    if (PlanRound(c.planner, now, corner, to.x, to.y, from.share, even, round.motion) &&
        DiagnoseCover(c, g.s, CoverOf(c, round, g.s.others.back())) == ErrorId::kNone) {
      duration = DurationOf(round.motion);
      return round;
    }
    // If the corner cannot be blended, the mover can stop there.
    PlaneMotion line;
    if (PlanMove(c.planner, now, from.corner_x, from.corner_y, from.limits, round.motion) &&
        PlanMove(c.planner, corner, to.x, to.y, limits, line)) {
      round.waits = true;
      round.next = WithLimits(to, limits);
      duration = DurationOf(round.motion) + DurationOf(line);
      return round;
    }
  }
  const double most = c.params.xy.maximum.velocity * (1 + 1e-9);
  const double now = Elapsed(c, g.s.plane.begin);
  PlaneMove at_once;
  at_once.begin = c.cycle.count;
  const bool found = PlanMove(c.planner, At(g.s.plane.motion, now), to.x, to.y, limits, at_once.motion) &&
                     SpeedBound(at_once.motion) <= most;
  duration = DurationOf(at_once.motion);
  if (found && at_once.motion.share == 0) return at_once;

  PlaneMove stops;
  stops.begin = c.cycle.count;
  stops.waits = true;
  stops.next = to;
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
  stops.next = WithLimits(to, limits);
  return stops;
}

template <typename Move>
AdmissionResult MoveOne(const CommandContext& g, const Move& command, std::size_t other, Ask ask) {
  if (const ErrorId why = Diagnose(g.s, ask); why != ErrorId::kNone) return Refused(why);
  const CoordinateParams params = ParamsOf(g.c, g.s, other);
  const Limits limits = LimitsOf(command, params, g.s.limited_by);
  if (command.position < params.lower || command.position > params.upper) {
    return Refused(ErrorId::kTargetBehindLimit, ObjectAt(ObjectKind::kMover, g.c.index),
                   std::clamp(command.position, params.lower, params.upper));
  }
  CoordinateMove& move = g.s.others[other];
  if (!PlanCoordinate(g.c.planner, Now(g.c, move), command.position, limits, params, move.profile)) {
    return Refused(ErrorId::kPlanning);
  }
  move.begin = g.c.cycle.count;
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, g.s);
  Take(g, static_cast<Slot>(kMoveZ + other));
  return {Status::Ok(), move.profile.duration()};
}

}  // namespace

AdmissionResult MoveTo(const CommandContext& g, const MoveToPosition& command) noexcept {
  State& s = g.s;
  const Limits limits = LimitsOf(command, g.c.params.xy, s.limited_by);
  double duration = 0;
  std::optional<PlaneMove> move = PlanPlane(g, command, limits, duration);
  if (!move) return Refused(ErrorId::kPlanning);

  CoordinateMove turn = s.others.back();
  const KinematicState turned = Now(g.c, turn);
  const CoordinateParams free = Windowed(g.c.params.c, turned.position, false);
  const bool turns_along = HasOrientationTarget(command);
  if (turns_along) {
    const auto plan = [&](const Limits& as) {
      return PlanCoordinate(g.c.planner, turned, *command.c, as, free, turn.profile);
    };
    if (!plan(StandardOf(free))) return Refused(ErrorId::kPlanning);
    const trajectory::Profile::Range range = turn.profile.PositionRange();
    if (!InOneWindow(g.c.params.c, range.min, range.max)) return Refused(ErrorId::kOutsideWindow);
    // From rest, both arrive at the same time.
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
  } else if (s.plane.turns) {  // that turn belonged to the preceding move
    PlanRest(g.c.planner, turned, StandardOf(free), ParamsOf(g.c, s, kOthers.size() - 1), turn.profile);
    turn.begin = g.c.cycle.count;
  }
  if (const ErrorId why = DiagnoseCover(g.c, s, CoverOf(g.c, *move, turn)); why != ErrorId::kNone) {
    return RefusedThere(s, why);
  }
  if (const ObjectInfo object = FindObstacle(g.c, *move, turn, false)) return Refused(ErrorId::kCollision, object);
  if (const ObjectInfo object = FindTurnObstacle(g.c, s, turn)) return Refused(ErrorId::kCollision, object);
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  if (turns_along) End(g.c, kMoveC, FeedbackState::kAborted, ErrorId::kNone, s);
  EndEach(g.c, s);
  Take(g, kPlane);
  s.others.back() = turn;
  if (turns_along) SetCourse(g.c, s);
  s.plane = *move;
  s.plane.turns = turns_along;
  s.plane.limits = limits;
  s.plane.goes = true;
  Reserve(g.c, s, false);
  return {Status::Ok(), duration};
}

AdmissionResult CarryOut(const CommandContext& g, const MoveToPosition& command) noexcept {
  if (const ErrorId why = Diagnose(g.s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  MoveToPosition to = command;
  const ErrorId why = ToMoverSystem(g.c, g.s, command.reference, to.x, to.y);
  return why == ErrorId::kNone ? MoveTo(g, to) : Refused(why);
}

AdmissionResult CarryOut(const CommandContext& g, const MoveZ& command) noexcept {
  return MoveOne(g, command, 0, Ask::kMoveAuxiliary);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveA& command) noexcept {
  return MoveOne(g, command, 1, Ask::kMoveAuxiliary);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveB& command) noexcept {
  return MoveOne(g, command, 2, Ask::kMoveAuxiliary);
}

namespace {

// Returns why C cannot be commanded alone, as `ask` says; kNone if it can.
ErrorId WhyNotTurn(const State& s, Ask ask) {
  const ErrorId why = Diagnose(s, ask);
  if (why != ErrorId::kNone) return why;
  return s.plane.turns ? ErrorId::kCommandMode : ErrorId::kNone;  // C belongs to another move then
}

bool IsInside(const Context& c, const CoordinateMove& turn) {
  const trajectory::Profile::Range range = turn.profile.PositionRange();
  return InOneWindow(c.params.c, range.min, range.max);
}

// Returns why C may not make this motion; Ok if it may.
AdmissionResult WhyNotTurning(const CommandContext& g, const CoordinateMove& move) {
  const State& s = g.s;
  if (!IsInside(g.c, move) && (IsStar(g.c) || !IsPlaneResting(g.c, s))) return Refused(ErrorId::kOutsideWindow);
  if (!IsOnTrack(s)) {
    const ErrorId why = DiagnoseCover(g.c, s, CoverOf(g.c, s.plane, move));
    if (why != ErrorId::kNone) return RefusedThere(s, why);
  } else if (const ErrorId why = DiagnoseRoute(g.c, s, g.c.rider(), move); why != ErrorId::kNone) {
    return Refused(why);
  }
  if (const ObjectInfo object = FindObstacle(g.c, s.plane, move, IsOnTrack(s)))
    return Refused(ErrorId::kCollision, object);
  if (const ObjectInfo object = FindTurnObstacle(g.c, s, move)) return Refused(ErrorId::kCollision, object);
  return {};
}

// C makes this motion from now on.
AdmissionResult PutTurn(const CommandContext& g, const CoordinateMove& move, const VelocityMove& endless) {
  State& s = g.s;
  if (!IsInside(g.c, move)) {
    if (s.mode == CommandMode::kFreeMovement) s.mode = CommandMode::kCRotationFreeMovement;
    if (s.mode == CommandMode::kOnTrack) s.mode = CommandMode::kCRotationOnTrack;
  }
  s.others.back() = move;
  SetCourse(g.c, s);
  Reserve(g.c, s, IsOnTrack(s));
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kMoveC);
  s.endless.back() = endless;
  return {Status::Ok(), move.profile.duration()};
}

// Turns to `target`, a function of the state of C and of the limits.
template <typename Command, typename Target>
AdmissionResult TurnTo(const CommandContext& g, const Command& command, Ask ask, const Target& target,
                       const VelocityMove& endless = {}) {
  State& s = g.s;
  if (const ErrorId why = WhyNotTurn(s, ask); why != ErrorId::kNone) return Refused(why);
  CoordinateMove move = s.others.back();
  const KinematicState from = Now(g.c, move);
  const CoordinateParams free = Windowed(g.c.params.c, from.position, false);
  const Limits limits = LimitsOf(command, free, s.limited_by);
  const double to = target(from, limits);
  if (!PlanCoordinate(g.c.planner, from, to, limits, free, move.profile)) return Refused(ErrorId::kPlanning);
  move.begin = g.c.cycle.count;
  if (const AdmissionResult why = WhyNotTurning(g, move); why.status.failed()) return why;
  return PutTurn(g, move, endless);
}

// If the commanded dynamics would turn the mover further than it may, the maximum ones are used: with these it comes to
// rest within the area that it has reserved.
AdmissionResult HaltTurn(const CommandContext& g, const MoveC& command) {
  State& s = g.s;
  if (const ErrorId why = WhyNotTurn(s, Ask::kMoveC); why != ErrorId::kNone) return Refused(why);
  CoordinateMove move = s.others.back();
  const KinematicState from = Now(g.c, move);
  const CoordinateParams params = ParamsOf(g.c, s, kOthers.size() - 1);
  move.begin = g.c.cycle.count;
  const auto plan = [&](const Limits& limits) { return PlanRest(g.c.planner, from, limits, params, move.profile); };
  const bool soft = plan(LimitsOf(command, params, s.limited_by)) && !WhyNotTurning(g, move).status.failed();
  if (!soft && !plan(params.maximum.limits())) return Refused(ErrorId::kPlanning);
  return PutTurn(g, move, {});
}

// Brings Z, A or B to rest.
AdmissionResult HaltOne(const CommandContext& g, const MoveToPosition& command, std::size_t other) {
  State& s = g.s;
  if (const ErrorId why = Diagnose(s, Ask::kMoveAuxiliary); why != ErrorId::kNone) return Refused(why);
  const CoordinateParams params = ParamsOf(g.c, s, other);
  const Limits limits = LimitsOf(command, params, s.limited_by);
  CoordinateMove& move = s.others[other];
  if (!PlanRest(g.c.planner, Now(g.c, move), limits, params, move.profile)) return Refused(ErrorId::kPlanning);
  move.begin = g.c.cycle.count;
  Take(g, static_cast<Slot>(kMoveZ + other));
  return {Status::Ok(), move.profile.duration()};
}

}  // namespace

AdmissionResult Turn(const CommandContext& g, const MoveC& command, Ask ask) noexcept {
  return TurnTo(g, command, ask, [&](const KinematicState& from, const Limits& limits) {
    return TargetOf(g.c.params, from, trajectory::StopPosition(from, limits), command);
  });
}

AdmissionResult CarryOut(const CommandContext& g, const MoveC& command) noexcept {
  return Turn(g, command, Ask::kMoveC);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeC& command) noexcept {
  return TurnTo(g, command, Ask::kMoveC,
                [&](const KinematicState& from, const Limits&) { return from.position + command.distance; });
}
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityC& command) noexcept {
  if (command.velocity == 0) return HaltTurn(g, {.deceleration = command.deceleration, .jerk = command.jerk});
  const MoveC as{.velocity = std::abs(command.velocity),
                 .acceleration = command.acceleration,
                 .deceleration = command.deceleration,
                 .jerk = command.jerk};
  const double sense = std::copysign(1.0, command.velocity);
  const VelocityMove endless{.on = true,
                             .velocity = sense * std::min(*as.velocity, g.c.params.c.maximum.velocity),
                             .end = ErrorId::kTargetBehindLimit};
  return TurnTo(
      g, as, Ask::kMoveC, [&](const KinematicState&, const Limits&) { return sense * kFar; }, endless);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltZ& command) noexcept {
  return HaltOne(g, {.deceleration = command.deceleration, .jerk = command.jerk}, 0);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltA& command) noexcept {
  return HaltOne(g, {.deceleration = command.deceleration, .jerk = command.jerk}, 1);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltB& command) noexcept {
  return HaltOne(g, {.deceleration = command.deceleration, .jerk = command.jerk}, 2);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltC& command) noexcept {
  return HaltTurn(g, {.deceleration = command.deceleration, .jerk = command.jerk});
}

}  // namespace takt::mover
