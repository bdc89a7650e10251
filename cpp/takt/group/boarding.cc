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
constexpr double kBoardingShare = 0.9;   // of the coordinates', for boarding at most
constexpr double kLess = 0.7;            // of acceleration and jerk, where that is exceeded, ...
constexpr int kTries = 4;                // ... so often
constexpr int kPlacesLookedAt = 24;      // at the profile
constexpr int kPlacesIfCostly = 10;      // with an inverse of a chain for each
constexpr double kMost = 0.96;           // of them, as seen
constexpr double kMore = 1.05;           // than was seen
constexpr double kReachesFurther = 1.2;  // than it would at the acceleration it begins with

const Ride& RideOf(const Context& c, std::uint64_t number) {
  return c.ahead.rides[number % kRides];
}

bool IsSteady(const Context& c, const Cargo& cargo) {
  const kinematics::Carrier carrier = CarrierOf(c, cargo);
  const bool has_travel =
      carrier.kind == kinematics::CarrierKind::kStraight || carrier.kind == kinematics::CarrierKind::kTurning;
  const bool changes = std::ranges::any_of(
      c.ahead.unsteady, [&](const Unsteady& one) { return one.carrier == cargo.carrier && one.left_s > 0; });
  return has_travel && !changes && carrier.travel.velocity != 0 && carrier.travel.acceleration == 0;
}

// The tool at rest, about to board.
struct Start {
  Cargo cargo;
  KinematicState carrier;  // its travel, a cycle ago
  End tool;
  trajectory::PathCoordinateValues by_carrier{};  // the coordinates per unit of the travel
  MovingFrame taken;                              // the tool likewise
  KDL::Vector target;                             // where its place is now
};

// A way to board.
struct Way {
  trajectory::Limits limits;
  double lead = 0;           // of the clutch's travel before the carrier's, at the beginning
  double time_s = HUGE_VAL;  // until the tool is at its place, about
  Boarding boarding;
};

// The tool taken along from rest by a carrier with this travel, which was at `rest` before.
MovingFrame TakenBy(const Context& c, const Start& start, double rest, const KinematicState& travel) {
  kinematics::Carrier carrier = CarrierOf(c, start.cargo);
  carrier.travel = travel;
  const MovingFrame place = kinematics::PoseOn(carrier, start.cargo.from, kinematics::ToFrame(start.cargo.lies));
  return place * (RideAtRest(c, start.cargo, rest).reference_inverse * start.tool.tool);
}

// Velocities and accelerations of all coordinates for a motion of the tool. False: the axes cannot follow it.
bool CoordinatesFor(const Context& c, const State& s, const MovingFrame& tool, kinematics::Joints& near,
                    trajectory::PathSlopes& out) {
  const Stretch& next = c.ahead.next;
  kinematics::JointMotion motion;
  if (AxesFor(c, s, next, tool, {next.from, 0, 0}, near, motion) != kinematics::Reason::kNone) return false;
  near = motion.position;
  out = CoordinatesOf(c, motion, tool);
  return true;
}

// About how long a motion from rest to rest takes that has less acceleration at first, for so long.
double TimeAlong(double length, double first, double first_s, const trajectory::AlongPath& then) {
  if (!(length > 0)) return 0;
  const double a = then.acceleration, build_up_s = a / then.jerk;
  const double v = std::min(first * first_s, then.velocity);
  const double left = length - 0.5 * v * first_s;
  if (left <= 0.5 * v * v / a) return build_up_s + 2 * std::sqrt(length / first);
  const double most = std::min(std::sqrt(a * left + 0.5 * v * v), then.velocity);
  const double at_speed = left - (most * most - 0.5 * v * v) / a;
  return build_up_s + first_s + (2 * most - v) / a + at_speed / most;
}

// The profile of the clutch for what `way.limits` says. False: there is none.
bool PlanBoarding(const Context& c, const Start& start, double lead_share, Way& way) {
  const double v = start.carrier.velocity;
  way.lead = lead_share * trajectory::StopPosition({0, v, 0}, way.limits);
  return !ComeAboard(c.axes.Of(0).planner, v, way.limits, {way.lead, -v, 0}, way.boarding.apart).failed();
}

// Estimates the time of the path while the tool boards and after that, and the reach.
void WeighPath(const Context& c, const State& s, const Start& start, Way& way) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const Stretch& next = c.ahead.next;
  const KDL::Vector to = start.target + way.lead * start.taken.p.v - start.tool.tool.p;
  // Where the tool only turns, the way is counted otherwise.
  const double length = std::max(to.Norm(), next.segment.measure == path::Measure::kWay ? 0.0 : next.segment.length);
  trajectory::AlongPath full = next.limits;
  double left = next.limits.acceleration;
  if (length > 0) {
    MovingFrame along(start.tool.tool);
    along.p.v = to / length;
    along.M.w = path::At(next.segment, next.from).M.w * (next.segment.length / length);
    trajectory::PathSlopes by_path;
    kinematics::Joints near = start.tool.joints;
    if (!CoordinatesFor(c, s, along, near, by_path)) return;
    for (std::size_t k = 0; k < own.count; ++k) {
      const double slope = std::abs(by_path.first[k]);
      if (slope == 0) continue;
      const trajectory::CoordinateLimits::One& of = own.of[k];
      const double v = std::max(0.0, of.velocity - std::abs(start.by_carrier[k] * start.carrier.velocity)) / slope;
      full = trajectory::Least(full, {v, of.acceleration / slope, of.acceleration / slope, of.jerk / slope});
      left = std::min(left, std::max(0.0, of.acceleration - way.boarding.acceleration[k]) / slope);
    }
  }
  const double boards_s = way.boarding.apart.duration();
  way.time_s = std::max(boards_s, TimeAlong(length, left, std::sqrt(kReachesFurther) * boards_s, full));
  way.boarding.reach = kReachesFurther * std::min(0.5 * left * boards_s * boards_s, next.limits.velocity * boards_s);
}

// What boarding takes if the coordinates go with the tool evenly.
Way WayWith(const Context& c, const State& s, const Start& start, const trajectory::Limits& limits, double part,
            double lead_share) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  Way way;
  way.limits = limits;
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(start.by_carrier[k]);
    if (slope == 0) continue;
    way.limits.acceleration = std::min(way.limits.acceleration, part * own.of[k].acceleration / slope);
    way.limits.jerk = std::min(way.limits.jerk, part * own.of[k].jerk / slope);
  }
  way.limits.deceleration = way.limits.acceleration;
  if (!PlanBoarding(c, start, lead_share, way)) return way;
  for (std::size_t k = 0; k < own.count; ++k) {
    way.boarding.acceleration[k] = std::abs(start.by_carrier[k]) * way.limits.acceleration;
  }
  WeighPath(c, s, start, way);
  return way;
}

// What boarding takes of the coordinates as they are, by places along its profile. The largest part of a limit.
double LookAt(const Context& c, const State& s, const Start& start, Boarding& boarding, double lead) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const bool costly = std::holds_alternative<kinematics::Serial>(c.kinematics->mechanism);
  const int looks = costly ? kPlacesIfCostly : kPlacesLookedAt;
  const double v = start.carrier.velocity, step_s = boarding.apart.duration() / looks;
  kinematics::Joints near = start.tool.joints;
  trajectory::PathSlopes before{};
  double most = 0;
  boarding.velocity = boarding.acceleration = boarding.jerk = {};
  for (int i = 0; i <= looks; ++i) {
    const KinematicState apart = boarding.apart.At(i * step_s);
    const KinematicState travel = {start.carrier.position + i * step_s * v + apart.position, v + apart.velocity,
                                   apart.acceleration};
    trajectory::PathSlopes now;
    const MovingFrame tool = TakenBy(c, start, start.carrier.position + lead, travel);
    if (!CoordinatesFor(c, s, tool, near, now)) return HUGE_VAL;
    boarding.faster = std::max(boarding.faster, std::abs(travel.velocity / v));
    for (std::size_t k = 0; k < own.count; ++k) {
      const auto take = [&](double value, double limit, double& taken) {
        taken = std::max(taken, kMore * std::abs(value));
        most = std::max(most, taken / limit);
      };
      take(now.first[k], own.of[k].velocity, boarding.velocity[k]);
      take(now.second[k], own.of[k].acceleration, boarding.acceleration[k]);
      if (i > 0) take((now.second[k] - before.second[k]) / step_s, own.of[k].jerk, boarding.jerk[k]);
    }
    before = now;
  }
  return most;
}

// The best way that keeps the limits. False: there is none.
bool FindWay(const Context& c, const State& s, const Start& start, Way& best) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const trajectory::AlongPath& path = c.ahead.next.limits;
  const double length = start.taken.p.v.Norm(), scale = length > 0 ? 1 / length : 1;
  trajectory::Limits limits = {HUGE_VAL, scale * path.acceleration, scale * path.acceleration, scale * path.jerk};
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(start.by_carrier[k]);
    if (slope > 0) limits.velocity = std::min(limits.velocity, kBoardingShare * own.of[k].velocity / slope);
  }
  if (!(limits.velocity < kUnlimited)) return false;
  double lead_share = 0;
  for (const double part : kParts) {
    for (const double lead : kLeads) {
      const Way way = WayWith(c, s, start, limits, part, lead);
      if (way.time_s < best.time_s) {
        best = way;
        lead_share = lead;
      }
    }
  }
  if (best.time_s == HUGE_VAL) return false;
  for (int i = 0; i < kTries; ++i) {
    if (LookAt(c, s, start, best.boarding, best.lead) <= kMost) {
      WeighPath(c, s, start, best);
      return best.time_s < HUGE_VAL;
    }
    best.limits.acceleration *= kLess;
    best.limits.deceleration *= kLess;
    best.limits.jerk *= kLess;
    if (!PlanBoarding(c, start, lead_share, best)) return false;
  }
  return false;
}

}  // namespace

bool MayBoard(const Context& c, const State& s) noexcept {
  if (!c.params.tracking.board) return false;
  const Request& move = MoveAt(s, s.planning.move);
  const bool one_way =
      move.kind == MoveKind::kLinear || move.kind == MoveKind::kDirect || move.kind == MoveKind::kCircular;
  if (!one_way || move.system == CoordinateSystem::kAcs || move.blends() || move.master != 0) return false;
  // A module wants to know how long all moves of its order take.
  if (c.carriers.modules && s.planning.move > s.done) return false;
  if (s.track.ticket != 0 || s.velocity_factor < 1 || c.params.tracking.after_sync != AfterSync::kStay) return false;
  if (Moves(RideOf(c, c.ahead.end_ride)) || HasWorkspace(c, s) || !c.zones.of.empty()) return false;
  return move.cargo.carrier != 0 && move.ticket != s.goes_over && IsSteady(c, move.cargo);
}

bool CanBoard(const Context& c, const State& s) noexcept {
  const Stretch& next = c.ahead.next;
  const bool rests = !s.begun || StandsAtEnd(c, s);
  return s.planning.move == s.done && rests && next.from_ride != next.to_ride && MayBoard(c, s);
}

bool Board(const Context& c, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  const Ride to = RideOf(c, ahead.next.to_ride);
  Start start;
  start.cargo = to.cargo;
  start.carrier = CarrierOf(c, to.cargo).travel;
  start.carrier.position -= c.cycle.period_s * start.carrier.velocity;
  start.tool = Present(c, s);
  start.target = DisplacementOf(c, to, 0).GetFrame() * path::PointAt(ahead.next.segment, ahead.next.to).frame.p;
  start.taken = TakenBy(c, start, start.carrier.position, {start.carrier.position, 1, 0});
  trajectory::PathSlopes slopes;
  kinematics::Joints near = start.tool.joints;
  if (!CoordinatesFor(c, s, start.taken, near, slopes)) return false;
  start.by_carrier = slopes.first;
  Way way;
  if (!FindWay(c, s, start, way) || TakeMembers(c, s) != ErrorId::kNone) return false;

  s.boards = MoveAt(s, s.done).ticket;
  Clutch& clutch = SitDown(c, to.cargo, start.carrier.position + way.lead, s);
  clutch.apart = {way.lead, -start.carrier.velocity, 0};
  clutch.catches_up = clutch.boards = true;
  SetLimits(way.limits, clutch);
  Ride& ride = ahead.rides[clutch.ride % kRides];
  ride.speed = start.carrier.velocity;
  ride.boarding = way.boarding;
  ride.boarding.on = true;
  ride.boarding.begin = c.cycle.count;
  return true;
}

void GiveUpBoarding(const Context& c, State& s) noexcept {
  s.goes_over = s.boards;
  s.boards = 0;
  EndMotion(c, {}, true, s);
}

}  // namespace takt::group
