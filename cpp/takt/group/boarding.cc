#include "takt/group/boarding.h"

#include <algorithm>
#include <cmath>

#include "takt/group/boarding_plan.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/members.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"

namespace takt::group {

namespace {

constexpr double kLastPart = 0.05;  // of the boarding time: shorter remainders are not divided
constexpr double kFirstPart = 0.5;  // of the boarding time: in it, turning back is faster than getting into sync first

const CarrierBinding& RideOf(const Context& c, std::uint64_t number) {
  return c.ahead.rides[number % kRides];
}

bool IsSteady(const Context& c, const CarriedTarget& cargo) {
  const kinematics::Carrier carrier = CarrierOf(c, cargo);
  const bool has_travel =
      carrier.kind == kinematics::CarrierKind::kStraight || carrier.kind == kinematics::CarrierKind::kTurning;
  const bool changes = std::ranges::any_of(
      c.ahead.unsteady, [&](const Unsteady& one) { return one.carrier == cargo.carrier && one.left_s > 0; });
  return has_travel && !changes && carrier.travel.velocity != 0 && carrier.travel.acceleration == 0;
}

// Returns the largest acceleration of the raw motion along the path.
double MostAcceleration(const trajectory::PathNode& node, double square) {
  return std::max(0.0, std::min(node.bounds.Most(square), node.bounds.strength.At(square)));
}

}  // namespace

bool MayBoard(const Context& c, const State& s) noexcept {
  if (!c.params.tracking.board) return false;
  const Request& move = MoveAt(s, s.planning.move);
  const bool one_way =
      move.kind == MoveKind::kLinear || move.kind == MoveKind::kDirect || move.kind == MoveKind::kCircular;
  if (!one_way || move.system == CoordinateSystem::kAcs || move.blends() || move.master != 0) return false;
  // A module needs the durations of all moves of its order in advance. Its own moves have no ticket.
  if (move.ticket == 0 || (c.carriers.modules && s.planning.move > s.done)) return false;
  if (s.track.ticket != 0 || s.velocity_factor < 1 || c.params.tracking.after_sync != AfterSync::kStay) return false;
  if (Moves(RideOf(c, c.ahead.end_ride)) || HasWorkspace(c, s) || !c.zones.of.empty()) return false;
  return move.cargo.carrier != 0 && move.ticket != s.goes_over && IsSteady(c, move.cargo);
}

bool CanBoard(const Context& c, const State& s) noexcept {
  const Stretch& next = c.ahead.next;
  const bool rests = !s.begun || IsAtRestAtEnd(c, s);
  return s.planning.move == s.done && rests && next.from_ride != next.to_ride && MayBoard(c, s);
}

bool Board(const Context& c, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  const CarrierBinding to = RideOf(c, ahead.next.to_ride);
  BoardingPlan plan;
  if (!PlanBoarding(c, s, to, plan) || TakeMembers(c, s) != ErrorId::kNone) return false;

  s.boards = MoveAt(s, s.done).ticket;
  Clutch& clutch = BindAtRest(c, to.cargo, plan.carrier.position + plan.lead, s);
  clutch.apart = {plan.lead, -plan.carrier.velocity, 0};
  clutch.catches_up = clutch.boards = true;
  SetLimits(plan.limits, clutch);
  CarrierBinding& ride = ahead.rides[clutch.ride % kRides];
  ride.speed = plan.carrier.velocity;
  ride.boarding = plan.boarding;
  ride.boarding.on = true;
  ride.boarding.begin = c.cycle.count;
  return true;
}

Boarding* BoardingOn(LookAhead& ahead, const Stretch& stretch) noexcept {
  // At most one: boarding begins at rest.
  for (const std::uint64_t ride : {stretch.from_ride, stretch.to_ride}) {
    if (ahead.rides[ride % kRides].boarding.on) return &ahead.rides[ride % kRides].boarding;
  }
  return nullptr;
}

void BeginReserve(const Context& c, Boarding& boarding) noexcept {
  if (!std::isnan(boarding.earliest_s)) return;
  boarding.earliest_s = static_cast<double>(c.cycle.count - boarding.begin) * c.cycle.period_s;
  boarding.square = 0;
  boarding.reach = HUGE_VAL;
}

void CutReserve(const Context& c, const trajectory::PathNode& last, Boarding& boarding) noexcept {
  if (last.at.s >= boarding.reach) return;
  // Bounds of the raw motion there: not earlier than now, not faster than the node allows.
  boarding.earliest_s = static_cast<double>(c.cycle.count - boarding.begin) * c.cycle.period_s;
  boarding.square = last.own;
}

double PathSpeedBound(const trajectory::PathPoint& point, const trajectory::CoordinateLimits& limits, double build_up_s,
                      const Boarding& boarding) noexcept {
  const double done_s = std::isnan(boarding.earliest_s) ? 0 : boarding.earliest_s;
  const double left_s = std::max(0.0, boarding.apart.duration() - done_s);
  const double a = std::min(trajectory::BoundsAt(point, limits, build_up_s, 1).Most(0),
                            trajectory::AccelerationCapAt(point, {}, limits, 0, build_up_s).At(0));
  return kReachMargin * (std::sqrt(boarding.square) + std::max(0.0, a) * left_s);
}

double UpdateReach(const trajectory::PathNode& last, Boarding& boarding) noexcept {
  const double left_s = std::max(0.0, boarding.apart.duration() - boarding.earliest_s);
  const double a = MostAcceleration(last, boarding.square), v = std::sqrt(boarding.square);
  const double most = std::max(std::sqrt(last.own), v);
  const double speeds_up_s = a > 0 ? std::min(left_s, (most - v) / a) : 0;
  boarding.reach = last.at.s + left_s * v + a * speeds_up_s * (left_s - 0.5 * speeds_up_s);
  // Towards a faster node the path accelerates ahead of it: a node with the reserve must be close before that one.
  const bool as_fast = speeds_up_s < left_s && left_s > kLastPart * boarding.apart.duration();
  return as_fast ? 0.5 * (last.at.s + boarding.reach) : boarding.reach;
}

void AdvanceReserve(const Context& c, const trajectory::PathNode& last, const trajectory::PathNode& node,
                    Boarding& boarding) noexcept {
  const double length = node.at.s - last.at.s;
  const double a = MostAcceleration(last, boarding.square);
  const double v = std::sqrt(boarding.square), most = std::max(std::sqrt(last.own), v);
  const double then = std::min(std::sqrt(boarding.square + 2 * a * length), most);
  const double speeds_up = a > 0 ? (then * then - boarding.square) / (2 * a) : 0;
  if (length > 0) boarding.earliest_s += (v + then > 0 ? 2 * speeds_up / (v + then) : 0) + (length - speeds_up) / then;
  boarding.square = then * then;
  if (!(boarding.apart.duration() - boarding.earliest_s > c.cycle.period_s)) boarding.reach = node.at.s;
}

bool ShouldAbortBoarding(const Context& c, const State& s, std::uint32_t carrier) noexcept {
  return std::ranges::any_of(s.clutches, [&](const Clutch& clutch) {
    if (!clutch.used || !clutch.boards) return false;
    const CarrierBinding& ride = RideOf(c, clutch.ride);
    const double passed_s = static_cast<double>(c.cycle.count - ride.boarding.begin) * c.cycle.period_s;
    return ride.cargo.carrier != carrier && passed_s < kFirstPart * ride.boarding.apart.duration();
  });
}

void GiveUpBoarding(const Context& c, State& s) noexcept {
  s.goes_over = s.boards;
  s.boards = 0;
  EndMotion(c, {}, true, s);
}

}  // namespace takt::group
