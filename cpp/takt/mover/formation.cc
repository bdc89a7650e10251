#include "takt/mover/formation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/mover/admission.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

using planar::ObjectState;
using trajectory::Limits;

constexpr int kShares = 8;  // fractions of the dynamics that are tried where both begin at once

ObjectInfo MoverNumbered(std::uint32_t index) {
  return {ObjectKind::kMover, index + 1};
}

bool IsMoving(const KinematicState& k) {
  return k.velocity != 0 || k.acceleration != 0;
}
bool Turns(const Context& c, const State& s) {
  return !IsOver(c, s.others.back()) || IsMoving(s.set_point[kC]);
}

Dynamics DynamicsOf(const Limits& l) {
  return {l.velocity, l.acceleration, l.deceleration, l.jerk};
}

// Returns the limits [deg] of the rotation of the body with which a planet at this distance keeps its limits in the
// plane.
Limits TurningAt(double distance, const Limits& l) {
  const double v = l.velocity / distance, a = std::min(l.acceleration, l.deceleration) / distance / std::numbers::sqrt2;
  const double j = std::sqrt(3.0 / 20) * l.jerk / distance;
  return trajectory::ShareOf(1 / kDegree, {std::min({v, std::sqrt(a), maths::Cbrt(j)}), a, a, j});
}

// Restricts C of the body to the window of a planet that leaves most to both; the star is at `here`, within that of
// `c`.
void KeepWindow(const CoordinateParams& its, const FormationState& f, double here, CoordinateParams& c) {
  const double lower = its.lower - f.c, upper = its.upper - f.c;
  const double least = std::ceil((here - upper - 1e-9) / kWindow), most = std::floor((here - lower + 1e-9) / kWindow);
  const double best = std::round((c.lower + c.upper - lower - upper) / 2 / kWindow);
  const double off = kWindow * std::max(least, std::min(best, most));
  c.lower = std::max(c.lower, std::min(here, lower + off));
  c.upper = std::min(c.upper, std::max(here, upper + off));
}

// Computes the parameters that the planets leave to a star, if turning has the share `turning` of the dynamics, and X
// and Y the share `moving`.
void MakeParams(const Context& c, double turning, double moving, MoverParams& body) {
  const MoverParams& own = c.fleet.params[c.index];
  const double turned = c.fleet.states[c.index].set_point[kC].position, middle = (own.c.lower + own.c.upper) / 2;
  const double here = turned - kWindow * std::round((turned - middle) / kWindow);
  Limits plane = own.xy.maximum.limits(), turn = own.c.maximum.limits();
  body.c = own.c;
  EachPlanet(c, [&](std::uint32_t i) {
    const MoverParams& its = c.fleet.params[i];
    const FormationState& f = c.fleet.states[i].formation;
    const Limits most = its.xy.maximum.limits();
    const double distance = maths::Hypot(f.x, f.y);
    plane = SmallerOf(plane, trajectory::ShareOf(distance > 0 ? moving : 1, most));
    turn = SmallerOf(turn, its.c.maximum.limits());
    if (distance > 0) turn = SmallerOf(turn, TurningAt(distance, trajectory::ShareOf(turning, most)));
    KeepWindow(its.c, f, here, body.c);
  });
  body.xy.standard = DynamicsOf(SmallerOf(plane, StandardOf(own.xy)));
  body.xy.maximum = DynamicsOf(plane);
  body.c.standard = DynamicsOf(SmallerOf(turn, StandardOf(own.c)));
  body.c.maximum = DynamicsOf(turn);
}

void Share(const Context& c, double turning, Body& body) {
  MakeParams(c, turning, 1 - turning, body.both);
}

// Updates the body of a star from its present planets.
void MakeBody(const Context& c) {
  Body& body = c.fleet.bodies[c.index];
  body.planets.clear();
  for (std::uint32_t i = 0; i < c.fleet.states.size(); ++i) {
    if (c.fleet.states[i].formation.star == c.index) body.planets.push_back(i);
  }
  MakeParams(c, 1, 1, body.alone);
  Share(c, c.fleet.states[c.index].formation.share, body);
}

// Returns the share for turning with which a move from rest has the shortest duration.
double QuickestShare(const Context& c, const MoveToPosition& move, const planar::Place& to, const State& s,
                     Body& body) {
  const KinematicState turned = s.set_point[kC];
  double best = 0.5, least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kShares; ++i) {
    const double share = static_cast<double>(i) / kShares;
    Share(c, share, body);
    LimitedBy unused;
    PlaneMotion way;
    trajectory::Profile turn;
    const bool found = PlanMove(c.planner, {s.set_point[kX], s.set_point[kY]}, to.x, to.y,
                                LimitsOf(move, body.both.xy, unused), way) &&
                       PlanCoordinate(c.planner, turned, *move.c, StandardOf(body.both.c),
                                      Windowed(body.both.c, turned.position, false), turn);
    const double takes = std::max(DurationOf(way), turn.duration());
    if (!found || takes >= least) continue;
    least = takes;
    best = share;
  }
  return best;
}

// Returns a planet that cannot continue, or has been commanded to halt; kNoStar: none.
std::uint32_t LostPlanet(const Context& c) {
  std::uint32_t lost = kNoStar;
  EachPlanet(c, [&](std::uint32_t i) {
    const State& its = c.fleet.states[i];
    const bool goes = its.state == ObjectState::kEnabled && its.tickets[kHalt] == 0;
    if (!goes && lost == kNoStar) lost = i;
  });
  return lost;
}

bool MovesOne(const Command& command) {
  return std::visit(
      []<typename T>(const T&) {
        return kIsOneOf<T, MoveX, MoveY, MoveRelativeX, MoveRelativeY, MoveVelocityX, MoveVelocityY>;
      },
      command);
}
bool TurnsAlone(const Command& command) {
  return std::visit([]<typename T>(const T&) { return kIsOneOf<T, MoveC, MoveRelativeC, MoveVelocityC>; }, command);
}

// Takes a planet out of its formation, at rest where it is.
void Leave(const Context& c, State& s) {
  const Context star = StarOf(c, s);
  s.formation = {};
  s.mode = CommandMode::kFreeMovement;
  s.plane = {};
  s.plane.motion = StandingAt(s.set_point[kX].position, s.set_point[kY].position);
  s.plane.begin = c.cycle.count;
  s.others.back() = {{s.set_point[kC], s.set_point[kC]}, c.cycle.count};
  MakeBody(star);
  Stand(star, star.fleet.states[star.index]);
  Stand(c, s);
}

}  // namespace

Context StarOf(const Context& c, const State& s) noexcept {
  Context star = With(c, ParamsIn(c.fleet, c.cycle, s.formation.star));
  star.index = s.formation.star;
  return star;
}

planar::Arm ArmOf(const MoverParams& params, const FormationState& f) noexcept {
  return {{f.x, f.y}, f.c, {params.width, params.height}};
}

const MoverParams& ParamsIn(const Fleet& fleet, const Cycle& cycle, std::uint32_t index) noexcept {
  if (index >= fleet.bodies.size() || fleet.bodies[index].planets.empty()) return fleet.params[index];
  const State& s = fleet.states[index];
  const auto lasts = [&](std::uint64_t begin, double duration) {
    return static_cast<double>(cycle.count - begin) * cycle.period_s < duration;
  };
  const bool moves = s.plane.waits || s.plane.passes || lasts(s.plane.begin, DurationOf(s.plane.motion)) ||
                     IsMoving(s.set_point[kX]) || IsMoving(s.set_point[kY]);
  const bool turns = lasts(s.others.back().begin, s.others.back().profile.duration()) || IsMoving(s.set_point[kC]);
  return moves && turns ? fleet.bodies[index].both : fleet.bodies[index].alone;
}

Terms TermsOf(const Context& c, const Command& command, State& s) noexcept {
  Terms terms{c.params};
  if (!IsStar(c)) return terms;
  if (std::holds_alternative<JoinTrack>(command)) terms.error = ErrorId::kFormationOnTrack;
  const auto* move = std::get_if<MoveToPosition>(&command);
  const bool one = MovesOne(command);  // X or Y
  const bool turn = TurnsAlone(command);
  const bool is_move = move || one || turn;
  if (!is_move && !std::holds_alternative<StartExternalSetpointGeneration>(command)) return terms;
  if (const std::uint32_t lost = LostPlanet(c); lost != kNoStar) {
    return {.params = c.params, .error = ErrorId::kPlanetLost, .object = MoverNumbered(lost)};
  }
  if (!is_move) return terms;
  const planar::Place from{s.set_point[kX].position, s.set_point[kY].position};
  planar::Place to = move ? planar::Place{move->x, move->y} : from;
  if (move && ToMoverSystem(c, s, move->reference, to.x, to.y) != ErrorId::kNone) return terms;
  const bool moves = !IsPlaneResting(c, s), turns = Turns(c, s);
  const bool is_to_move = one || to.x != from.x || to.y != from.y;
  const bool is_to_turn = turn || (move && HasOrientationTarget(*move) && *move->c != s.set_point[kC].position);
  const bool both = (moves || is_to_move) && (turns || is_to_turn);
  Body& body = c.fleet.bodies[c.index];
  if (moves || turns) {
    if (both && s.formation.whole) return {.params = c.params, .error = ErrorId::kFormationShare};
  } else {  // at rest: the windows follow from the present angles
    if (both) s.formation.share = QuickestShare(c, *move, to, s, body);
    MakeBody(c);
  }
  return {.params = both ? body.both : body.alone, .sets = true, .whole = !both};
}

void ShareOut(const Context& c, double turning, State& s) noexcept {
  s.formation.share = turning;
  Share(c, turning, c.fleet.bodies[c.index]);
}

void Compose(const SetPoint& star, const FormationState& f, SetPoint& at) noexcept {
  const KinematicState& c = star[kC];
  const auto [sine, cosine] = maths::SinCos(c.position * kDegree);
  const double x = cosine * f.x - sine * f.y, y = sine * f.x + cosine * f.y;
  const double w = c.velocity * kDegree, u = c.acceleration * kDegree;
  at[kX] = {star[kX].position + x, star[kX].velocity - w * y, star[kX].acceleration - u * y - w * w * x};
  at[kY] = {star[kY].position + y, star[kY].velocity + w * x, star[kY].acceleration + u * x - w * w * y};
  at[kC] = {c.position + f.c, c.velocity, c.acceleration};
}

void CheckPlanets(const Context& c, State& s) noexcept {
  if (!IsStar(c)) return;
  const bool lost = LostPlanet(c) != kNoStar, before = s.formation.brakes;
  s.formation.brakes = lost;
  if (!lost || before || s.state != ObjectState::kEnabled) return;
  EndAll(c, false, FeedbackState::kError, ErrorId::kPlanetLost, s);
  BringToRest(c, nullptr, s);
}

void CheckStar(const Context& c, State& s) noexcept {
  if (!IsPlanet(s)) return;
  if (!s.formation.joined) {
    s.formation.joined = true;
    c.feedback.Report({s.tickets[kFormation], c.cycle.count, FeedbackState::kActive, true, ErrorId::kNone, 0});
  }
  const bool lost = StateOfStar(c, s).state != ObjectState::kEnabled;
  if ((!lost && s.state == ObjectState::kEnabled) || !c.grounds.movers[s.formation.star].rests) return;
  End(c, kFormation, FeedbackState::kError, ErrorId::kStarLost, s);
  AbortBuffered(c, s);
  Context next = c;
  ++next.cycle.count;
  Leave(next, s);
}

AdmissionResult CarryOut(const CommandContext& g, const JoinFormation& command) noexcept {
  State& s = g.s;
  const Fleet& fleet = g.c.fleet;
  if (const ErrorId why = Diagnose(s, Ask::kJoinFormation); why != ErrorId::kNone) return Refused(why);
  const auto& names = g.c.streets.movers;
  const auto found = std::ranges::find(names, command.star.view(), &MasterMover::name);
  if (found == names.end()) return Refused(ErrorId::kUnknownTarget);
  const auto index = static_cast<std::uint32_t>(found - names.begin());
  const ObjectInfo itself = MoverNumbered(g.c.index), object = MoverNumbered(index);
  if (IsStar(g.c) || index == g.c.index) return Refused(ErrorId::kFormationChain, itself);
  const State& star = fleet.states[index];
  if (IsPlanet(star)) return Refused(ErrorId::kFormationChain, object);
  if (const ErrorId why = Diagnose(star, Ask::kJoinFormation); why != ErrorId::kNone) return Refused(why, object);
  if (IsAway(g.c, star)) return Refused(ErrorId::kPartDisabled, ObjectAt(ObjectKind::kPart, star.part));
  if (star.system != s.system) return Refused(ErrorId::kReference, object);
  if (!IsResting(g.c, s)) return Refused(ErrorId::kObjectMoves, itself);
  if (!IsResting(g.c, star)) return Refused(ErrorId::kObjectMoves, object);
  const double c = star.set_point[kC].position;
  const double x = s.set_point[kX].position - star.set_point[kX].position;
  const double y = s.set_point[kY].position - star.set_point[kY].position;
  const auto [sine, cosine] = maths::SinCos(c * kDegree);
  s.formation = {
      .star = index, .x = cosine * x + sine * y, .y = cosine * y - sine * x, .c = s.set_point[kC].position - c};
  s.mode = CommandMode::kFormation;
  s.plane.turns = false;
  End(g.c, kHalt, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kFormation);
  const Context of_star = StarOf(g.c, s);
  MakeBody(of_star);
  Stand(of_star, star);
  Stand(g.c, s);
  return {};
}

AdmissionResult CarryOut(const CommandContext& g, const LeaveFormation&) noexcept {
  State& s = g.s;
  if (const ErrorId why = Diagnose(s, Ask::kLeaveFormation); why != ErrorId::kNone) return Refused(why);
  if (!IsResting(StarOf(g.c, s), StateOfStar(g.c, s))) {
    return Refused(ErrorId::kObjectMoves, MoverNumbered(s.formation.star));
  }
  End(g.c, kFormation, FeedbackState::kDone, ErrorId::kNone, s);
  Leave(g.c, s);
  return Done();
}

}  // namespace takt::mover
