#include "takt/group/boarding.h"

#include <algorithm>
#include <cmath>

#include "takt/group/ask.h"
#include "takt/group/clutch.h"
#include "takt/group/make_stretch.h"
#include "takt/group/members.h"
#include "takt/group/queue.h"
#include "takt/group/rides.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

// What boarding may take of the limits of an axis, and how far the clutch begins ahead, of the way on which it speeds
// up: of all of them the best is taken.
constexpr std::array kParts = {0.3, 0.5, 0.7, 0.9};
constexpr std::array kLeads = {0.0, 0.5, 1.0, 1.5, 2.5};
constexpr double kReachesFurther = 1.2;  // than it would at the acceleration it begins with

const Ride& RideOf(const Context& c, std::uint64_t number) {
  return c.ahead.rides[number % kRides];
}

bool IsSteady(const Context& c, const Cargo& cargo) {
  const kinematics::Carrier carrier = CarrierOf(c, cargo);
  const bool has_travel =
      carrier.kind == kinematics::CarrierKind::kStraight || carrier.kind == kinematics::CarrierKind::kTurning;
  return has_travel && carrier.travel.velocity != 0 && carrier.travel.acceleration == 0;
}

// The tool at rest on its seat, about to board.
struct Start {
  const Stretch* seat = nullptr;
  KinematicState carrier;                         // its travel, a cycle ago
  trajectory::Limits limits;                      // of the clutch, with what the axes can
  MovingFrame taken;                              // the tool per unit of the travel
  trajectory::PathCoordinateValues by_carrier{};  // the coordinates per unit of the travel
  KDL::Vector target;                             // where its place is now
  trajectory::AlongPath path;                     // limits of the move
};

// A way to board.
struct Way {
  trajectory::Limits limits;
  double lead = 0;  // of the clutch's travel before the carrier's, at the beginning
  trajectory::Profile apart;
  double left = 0;           // of the acceleration along the path meanwhile [mm/s²]
  double time_s = HUGE_VAL;  // until the tool is at its place, about
};

// Velocities of all coordinates for a motion of the tool. False: the axes cannot follow it.
bool SlopesFor(const Context& c, const State& s, const Stretch& seat, const MovingFrame& tool,
               trajectory::PathCoordinateValues& slopes) {
  kinematics::JointMotion motion;
  if (AxesFor(c, s, seat, tool, {seat.from, 0, 0}, s.joints, motion) != kinematics::Reason::kNone) return false;
  slopes = CoordinatesOf(c, motion, tool).first;
  return true;
}

// About how long a motion from rest to rest takes that has less acceleration at first, for so long.
double TimeAlong(double length, double first, double first_s, const trajectory::AlongPath& then) {
  const double a = then.acceleration, build_up_s = a / then.jerk;
  const double v = std::min(first * first_s, then.velocity);
  const double left = length - 0.5 * v * first_s;
  if (left <= 0.5 * v * v / a) return build_up_s + 2 * std::sqrt(length / first);
  const double most = std::min(std::sqrt(a * left + 0.5 * v * v), then.velocity);
  const double at_speed = left - (most * most - 0.5 * v * v) / a;
  return build_up_s + first_s + (2 * most - v) / a + at_speed / most;
}

Way WayWith(const Context& c, const State& s, const Start& start, double part, double lead_share) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const double speed = std::abs(start.carrier.velocity);
  Way way;
  trajectory::Limits& limits = way.limits = start.limits;
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(start.by_carrier[k]);
    if (slope == 0) continue;
    limits.acceleration = std::min(limits.acceleration, part * own.of[k].acceleration / slope);
    limits.jerk = std::min(limits.jerk, part * own.of[k].jerk / slope);
  }
  limits.deceleration = limits.acceleration;
  way.lead = lead_share * trajectory::StopPosition({0, start.carrier.velocity, 0}, limits);
  const KinematicState apart = {way.lead, -start.carrier.velocity, 0};
  if (ComeCloser(c.axes.Of(0).planner, start.carrier, limits, apart, way.apart).failed()) return way;
  const double boards_s = way.apart.duration();

  const KDL::Vector to = start.target + way.lead * start.taken.p.v - start.taken.p.p;
  const double length = to.Norm();
  trajectory::AlongPath full = start.path;
  double& left = way.left = start.path.acceleration;
  trajectory::PathCoordinateValues by_path{};
  if (length > 0) {
    MovingFrame along(start.taken.GetFrame());
    along.p.v = to / length;
    if (!SlopesFor(c, s, *start.seat, along, by_path)) return way;
  }
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(by_path[k]), carrier = std::abs(start.by_carrier[k]);
    if (slope == 0) continue;
    const trajectory::CoordinateLimits::One& of = own.of[k];
    const double v = std::max(0.0, of.velocity - carrier * speed) / slope;
    const double a = std::max(0.0, of.acceleration - carrier * limits.acceleration) / slope;
    full = trajectory::Least(full, {v, of.acceleration / slope, of.acceleration / slope, of.jerk / slope});
    left = std::min(left, a);
  }
  way.time_s = std::max(boards_s, TimeAlong(length, left, std::sqrt(kReachesFurther) * boards_s, full));
  return way;
}

}  // namespace

bool MayBoard(const Context& c, const State& s) noexcept {
  const Request& move = MoveAt(s, s.planning.move);
  const bool one_way =
      move.kind == MoveKind::kLinear || move.kind == MoveKind::kDirect || move.kind == MoveKind::kCircular;
  if (!one_way || move.system == CoordinateSystem::kAcs || move.blends() || move.master != 0) return false;
  // A module wants to know how long all moves of its order take.
  if (c.carriers.modules && s.planning.move > s.done) return false;
  if (s.track.ticket != 0 || s.velocity_factor < 1 || c.params.tracking.after_sync != AfterSync::kStay) return false;
  if (Moves(RideOf(c, c.ahead.end_ride)) || HasWorkspace(c, s) || !c.zones.of.empty()) return false;
  return move.cargo.carrier != 0 && IsSteady(c, move.cargo);
}

bool CanBoard(const Context& c, const State& s) noexcept {
  const Stretch& next = c.ahead.next;
  const bool rests = !s.begun || StandsAtEnd(c, s);
  return s.planning.move == s.done && rests && next.from_ride != next.to_ride && MayBoard(c, s) && !IsUnsteady(c, next);
}

bool Board(const Context& c, State& s) noexcept {
  if (TakeMembers(c, s) != ErrorId::kNone) return false;
  LookAhead& ahead = c.ahead;
  const Ride to = RideOf(c, ahead.next.to_ride);
  Start start;
  start.path = ahead.next.limits;
  start.target = DisplacementOf(c, to, 0).GetFrame() * path::PointAt(ahead.next.segment, ahead.next.to).frame.p;
  const KinematicState travel = CarrierOf(c, to.cargo).travel;
  start.carrier = travel;
  start.carrier.position -= c.cycle.period_s * travel.velocity;

  Clutch& clutch = SitDown(c, to.cargo, start.carrier.position, s);
  Ride& ride = ahead.rides[clutch.ride % kRides];
  start.seat = &ahead[ahead.first];
  const Stretch& seat = *start.seat;
  start.limits = LimitsAlong(c, s, seat, seat.from, clutch.ride, travel, kAhead_s * travel.velocity);
  start.taken = ToolWith(c, seat, {seat.from, 0, 0}, [&](std::uint64_t, kinematics::Carrier carrier) {
    carrier.travel = {start.carrier.position, 1, 0};
    return carrier;
  });
  Way best;
  if (SlopesFor(c, s, seat, start.taken, start.by_carrier)) {
    for (const double part : kParts) {
      for (const double lead : kLeads) {
        const Way way = WayWith(c, s, start, part, lead);
        if (way.time_s < best.time_s) best = way;
      }
    }
  }
  ride.speed = travel.velocity;
  s.boards = s.done;
  if (best.time_s == HUGE_VAL) {  // as fast as it can, and the path waits
    SetLimits(start.limits, clutch);
    return true;
  }
  ride.reference_inverse = RideAtRest(c, to.cargo, start.carrier.position + best.lead).reference_inverse;
  clutch.travel.position = start.carrier.position + best.lead;
  clutch.apart = {best.lead, -travel.velocity, 0};
  clutch.catches_up = clutch.boards = true;
  SetLimits(best.limits, clutch);
  const double speed = std::abs(travel.velocity), time_s = best.apart.duration();
  ride.boarding = {.on = true,
                   .begin = c.cycle.count,
                   .apart = best.apart,
                   .acceleration = best.limits.acceleration / speed,
                   .jerk = best.limits.jerk / speed};
  ride.boarding.reach = kReachesFurther * std::min(0.5 * best.left * time_s * time_s, start.path.velocity * time_s);
  return true;
}

void WatchBoarding(const Context& c, State& s) noexcept {
  if (s.boards == 0) return;
  const bool refused = s.done > s.boards && s.failed == s.boards;
  if (refused && s.begun && !s.ends && s.queue.count == 0) EndMotion(c, {}, true, s);
  if (s.done > s.boards || s.ends || (s.queue.count > 0 && s.active == MoveAt(s, s.boards).ticket)) s.boards = 0;
}

}  // namespace takt::group
