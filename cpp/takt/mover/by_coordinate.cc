#include "takt/mover/by_coordinate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "takt/mover/admission.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/course.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

using trajectory::Limits;
using trajectory::Profile;

namespace {

constexpr double kRoom = 0.1;   // [mm] accuracy to which the room is used
constexpr double kLittle = 1;   // [mm] less room counts as none
constexpr int kDoublings = 31;  // of kLittle, up to kFar

// Returns the parameters of X or Y by itself.
PlaneParams ParamsOfEach(const PlaneParams& p) {
  const auto as = [](const Limits& l) { return Dynamics{l.velocity, l.acceleration, l.deceleration, l.jerk}; };
  const Limits most = LimitsOfEach(p.maximum.limits());
  return {as(most), as(SmallerOf(StandardOf(p), most))};
}

KinematicState& Of(PlaneState& at, Coordinate which) {
  return which == kX ? at.x : at.y;
}
Profile& Of(PlaneMotion& motion, Coordinate which) {
  return which == kX ? motion.along : motion.across;
}

// Plans to the goal within its limits, or with the maximum dynamics if the jerk of the goal would end the acceleration
// too late to keep the maximum velocity of the coordinate.
bool PlanToGoal(const Context& c, const KinematicState& from, const Goal& goal, Profile& out) {
  const Limits maximum = LimitsOfEach(c.params.xy.maximum.limits());
  const auto plan = [&](const Limits& limits) {
    if (!goal.active) return c.planner.Stop(from, limits, out).ok();
    return c.planner.ToPosition(from, goal.target, 0, limits, out).ok();
  };
  if (!plan(goal.limits)) return false;
  return KeepsVelocity(out, maximum.velocity) || plan(WithMaximumDynamics(goal.limits, maximum));
}

std::array<Goal, 2> RestingGoals(const Context& c) {
  const Goal rest{.limits = StandardOf(ParamsOfEach(c.params.xy))};
  return {rest, rest};
}

void PutNext(PlaneMove& move) {
  move.next = {.x = move.goals[0].active ? move.goals[0].target : move.motion.end_x,
               .y = move.goals[1].active ? move.goals[1].target : move.motion.end_y};
}

// The motion of X and Y after a command of one of them, and how long that one takes.
struct Plan {
  PlaneMove move;
  double duration = 0;  // [s]
};
std::optional<Plan> PlanEach(const Context& c, const State& s, Coordinate which, const Goal& goal) {
  const PlaneMove& old = s.plane;
  const double now = Elapsed(c, old.begin);
  const Limits maximum = c.params.xy.maximum.limits(), each = LimitsOfEach(maximum);
  PlaneState at = At(old.motion, now);
  Plan plan;
  PlaneMove& move = plan.move;
  move.begin = c.cycle.count;
  move.each = true;
  move.goals = old.each ? old.goals : RestingGoals(c);
  move.goals[which] = goal;
  move.goes = move.goals[0].active || move.goals[1].active;
  if (old.each && !old.waits) {
    Profile x = old.motion.along, y = old.motion.across;
    x.Skip(now);
    y.Skip(now);
    move.motion = MotionOfEach(x, y);
    Profile& its = Of(move.motion, which);
    if (!PlanToGoal(c, Of(at, which), goal, its)) return {};
    plan.duration = its.duration();
    move.motion = MotionOfEach(move.motion.along, move.motion.across);
    return plan;
  }
  if (FitsEach(at, each)) {
    if (!PlanToGoals(c, at, move)) return {};
    plan.duration = Of(move.motion, which).duration();
    return plan;
  }
  // Too fast for independent motions: the mover first comes to rest on its line.
  const auto rests = [&](const Limits& limits) { return PlanRest(c.planner, old.motion, now, limits, move.motion); };
  if (!rests(StandardOf(c.params.xy)) || SpeedBound(move.motion) > maximum.velocity * (1 + 1e-9)) {
    if (!rests(maximum)) return {};
    move.hard = true;
  }
  PlaneMove then = move;
  const double rest = DurationOf(move.motion);
  at = At(move.motion, rest);
  if (!PlanToGoals(c, at, then)) return {};
  move.waits = true;
  PutNext(move);
  plan.duration = rest + Of(then.motion, which).duration();
  return plan;
}

// Returns why X and Y may not move like this; kNone if they may.
planar::Verdict WhyNotSo(const Context& c, const State& s, const PlaneMove& move) {
  if (const ErrorId why = DiagnoseCover(c, s, CoverOf(c, move, s.others.back())); why != ErrorId::kNone) {
    const AdmissionResult answer = RefusedThere(s, why);
    return {why, answer.object};
  }
  if (const ObjectInfo object = FindObstacle(c, move, s.others.back(), false)) return {ErrorId::kCollision, object};
  return {ErrorId::kNone, {}};
}

Slot SlotOf(Coordinate which) {
  return which == kX ? kMoveX : kMoveY;
}

// X and Y make this motion from now on, by a command of one of them.
void Put(const CommandContext& g, Coordinate which, const PlaneMove& move, const VelocityMove& endless) {
  State& s = g.s;
  if (s.plane.turns) {  // that turn belonged to the preceding move
    CoordinateMove& turn = s.others.back();
    const CoordinateParams& c = g.c.params.c;
    PlanRest(g.c.planner, Now(g.c, turn), StandardOf(c), ParamsOf(g.c, s, kOthers.size() - 1), turn.profile);
    turn.begin = g.c.cycle.count;
  }
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  End(g.c, kPlane, FeedbackState::kAborted, ErrorId::kNone, s);
  if (!s.plane.each) EndEach(g.c, s);
  Take(g, SlotOf(which));
  s.plane = move;
  s.endless[which] = endless;
  Reserve(g.c, s, false);
}

AdmissionResult MoveEach(const CommandContext& g, Coordinate which, const Goal& goal) {
  const std::optional<Plan> plan = PlanEach(g.c, g.s, which, goal);
  if (!plan) return Refused(ErrorId::kPlanning);
  if (const planar::Verdict why = WhyNotSo(g.c, g.s, plan->move); why.error != ErrorId::kNone) return Refused(why);
  Put(g, which, plan->move, {});
  return {Status::Ok(), plan->duration};
}

// Moves in a direction as far as there is room. If there is room for a target, there is room for nearer ones, so
// bisection finds the end.
AdmissionResult MoveEndlessly(const CommandContext& g, Coordinate which, double velocity, const Limits& limits) {
  const Context& c = g.c;
  const double sense = std::copysign(1.0, velocity);
  const PlaneState at = At(g.s.plane.motion, Elapsed(c, g.s.plane.begin));
  const KinematicState from = which == kX ? at.x : at.y;
  Profile rest;
  if (!PlanToGoal(c, from, {.limits = limits}, rest)) return Refused(ErrorId::kPlanning);
  const double stop = rest.end().position;
  std::optional<Plan> best;
  planar::Verdict end{ErrorId::kTargetBehindLimit, {}};
  const auto reaches = [&](double way) {
    const double target = std::clamp(stop + sense * way, -kFar, kFar);
    std::optional<Plan> plan = PlanEach(c, g.s, which, {true, target, limits});
    if (!plan) return false;
    const planar::Verdict why = WhyNotSo(c, g.s, plan->move);
    if (why.error != ErrorId::kNone) {
      end = why;
      return false;
    }
    best = plan;
    return true;
  };
  if (!reaches(2 * kFar)) {
    double room = 0, wanted = kLittle;
    for (int i = 0; i < kDoublings && reaches(wanted); ++i) {
      room = wanted;
      wanted *= 2;
    }
    if (!best) return end.error == ErrorId::kTargetBehindLimit ? Refused(ErrorId::kPlanning) : Refused(end);
    while (wanted - room > kRoom) {
      const double middle = 0.5 * (room + wanted);
      (reaches(middle) ? room : wanted) = middle;
    }
  }
  Put(g, which, best->move, {.on = true, .velocity = sense * limits.velocity, .end = end.error, .object = end.object});
  return {Status::Ok(), best->duration};
}

// Returns the dynamics of a command of X or Y by itself, clamped to its maximum.
template <typename Command>
Limits LimitsOfEachIn(const CommandContext& g, const Command& command) {
  return LimitsOf(command, ParamsOfEach(g.c.params.xy), g.s.limited_by);
}

// Returns a command with the speed, as LimitsOf requires, instead of the signed velocity.
template <typename Command>
MoveToPosition Unsigned(const Command& command) {
  return {.velocity = command.velocity == 0 ? std::nullopt : std::optional(std::abs(command.velocity)),
          .acceleration = command.acceleration,
          .deceleration = command.deceleration,
          .jerk = command.jerk};
}

AdmissionResult MoveTo(const CommandContext& g, Coordinate which, const auto& command) {
  if (const ErrorId why = Diagnose(g.s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  double x = command.position, y = command.position;
  if (const ErrorId why = ToMoverSystem(g.c, g.s, command.reference, x, y); why != ErrorId::kNone) return Refused(why);
  return MoveEach(g, which, {true, which == kX ? x : y, LimitsOfEachIn(g, command)});
}

AdmissionResult MoveBy(const CommandContext& g, Coordinate which, const auto& command) {
  if (const ErrorId why = Diagnose(g.s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  PlaneState at = At(g.s.plane.motion, Elapsed(g.c, g.s.plane.begin));
  return MoveEach(g, which, {true, Of(at, which).position + command.distance, LimitsOfEachIn(g, command)});
}

AdmissionResult MoveOn(const CommandContext& g, Coordinate which, const auto& command) {
  if (const ErrorId why = Diagnose(g.s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  const Limits limits = LimitsOfEachIn(g, Unsigned(command));
  if (command.velocity == 0) return MoveEach(g, which, {.limits = limits});
  return MoveEndlessly(g, which, command.velocity, limits);
}

// Returns the stop of X and Y on their present line.
PlaneMove RestOnLine(const Context& c, const State& s, const Limits& limits) {
  PlaneMove move;
  move.begin = c.cycle.count;
  const Limits maximum = c.params.xy.maximum.limits();
  const double now = Elapsed(c, s.plane.begin);
  const bool found = PlanRest(c.planner, s.plane.motion, now, limits, move.motion);
  if (!found || SpeedBound(move.motion) > maximum.velocity * (1 + 1e-9)) {
    PlanRest(c.planner, s.plane.motion, now, maximum, move.motion);
  }
  return move;
}

// The mover is already stopping, or at rest, and only the other coordinate may continue from there.
Plan LeaveAtRest(const Context& c, const State& s, Coordinate which) {
  Plan plan;
  plan.duration = std::max(0.0, DurationOf(s.plane.motion) - Elapsed(c, s.plane.begin));
  if (s.plane.goals[which == kX ? 1 : 0].active) {
    plan.move = s.plane;
    plan.move.goals[which].active = false;
    PutNext(plan.move);
    return plan;
  }
  plan.move.motion = s.plane.motion;
  plan.move.begin = s.plane.begin;
  plan.move.hard = s.plane.hard;
  return plan;
}

// If the commanded dynamics would lead the mover where it must not be, the maximum ones are used: with these it comes
// to rest within the area that it has reserved.
AdmissionResult HaltEach(const CommandContext& g, Coordinate which, const auto& command) {
  State& s = g.s;
  const Context& c = g.c;
  if (const ErrorId why = Diagnose(s, Ask::kMoveToPosition); why != ErrorId::kNone) return Refused(why);
  const MoveToPosition as{.deceleration = command.deceleration, .jerk = command.jerk};
  if (!s.plane.each) {
    const PlaneMove soft = RestOnLine(c, s, LimitsOf(as, c.params.xy, s.limited_by));
    const bool may = WhyNotSo(c, s, soft).error == ErrorId::kNone;
    const PlaneMove& move = may ? soft : RestOnLine(c, s, c.params.xy.maximum.limits());
    Put(g, which, move, {});
    return {Status::Ok(), DurationOf(move.motion)};
  }
  std::optional<Plan> plan;
  if (s.plane.waits) {
    plan = LeaveAtRest(c, s, which);
  } else {
    plan = PlanEach(c, s, which, {.limits = LimitsOfEachIn(g, as)});
    if (!plan || WhyNotSo(c, s, plan->move).error != ErrorId::kNone) {
      plan = PlanEach(c, s, which, {.limits = LimitsOfEach(c.params.xy.maximum.limits())});
    }
  }
  if (!plan) return Refused(ErrorId::kPlanning);
  Put(g, which, plan->move, {});
  return {Status::Ok(), plan->duration};
}

constexpr Slot kSlotOfEndless[] = {kMoveX, kMoveY, kMoveC};

}  // namespace

bool PlanToGoals(const Context& c, const PlaneState& from, PlaneMove& move) noexcept {
  Profile x, y;
  if (!PlanToGoal(c, from.x, move.goals[0], x) || !PlanToGoal(c, from.y, move.goals[1], y)) return false;
  move.motion = MotionOfEach(x, y);
  return true;
}

void EndEach(const Context& c, State& s) noexcept {
  for (const Slot slot : {kMoveX, kMoveY}) End(c, slot, FeedbackState::kAborted, ErrorId::kNone, s);
  s.endless[kX].on = s.endless[kY].on = false;
}

void NoteVelocity(const Context& c, std::uint64_t cycle, State& s) noexcept {
  const PlaneState at = At(s.plane.motion, Elapsed(c, s.plane.begin));
  const std::array now = {at.x, at.y, Now(c, s.others.back())};
  for (std::size_t i = 0; i < kVelocityCoordinates.size(); ++i) {
    VelocityMove& e = s.endless[i];
    const Ticket ticket = s.tickets[kSlotOfEndless[i]];
    e.on = e.on && ticket != 0;
    if (!e.on || e.reached || now[i].acceleration != 0) continue;
    e.reached = std::abs(now[i].velocity - e.velocity) <= 1e-9 * std::abs(e.velocity);
    if (e.reached) c.feedback.Report({ticket, cycle, FeedbackState::kActive, true, ErrorId::kNone, 0});
  }
}

void Conclude(const Context& c, Slot slot, State& s) noexcept {
  const auto* const found = std::find(std::begin(kSlotOfEndless), std::end(kSlotOfEndless), slot);
  if (found == std::end(kSlotOfEndless) || s.tickets[slot] == 0) {
    return End(c, slot, FeedbackState::kDone, ErrorId::kNone, s);
  }
  VelocityMove& e = s.endless[static_cast<std::size_t>(found - std::begin(kSlotOfEndless))];
  End(c, slot, e.on ? FeedbackState::kError : FeedbackState::kDone, e.on ? e.end : ErrorId::kNone, s, e.object);
  if (e.on) AbortBuffered(c, s);
  e = {};
}

AdmissionResult CarryOut(const CommandContext& g, const MoveX& command) noexcept {
  return MoveTo(g, kX, command);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveY& command) noexcept {
  return MoveTo(g, kY, command);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeX& command) noexcept {
  return MoveBy(g, kX, command);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveRelativeY& command) noexcept {
  return MoveBy(g, kY, command);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityX& command) noexcept {
  return MoveOn(g, kX, command);
}
AdmissionResult CarryOut(const CommandContext& g, const MoveVelocityY& command) noexcept {
  return MoveOn(g, kY, command);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltX& command) noexcept {
  return HaltEach(g, kX, command);
}
AdmissionResult CarryOut(const CommandContext& g, const HaltY& command) noexcept {
  return HaltEach(g, kY, command);
}

}  // namespace takt::mover
