#include "takt/trajectory/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/maths.h"
#include "takt/trajectory/ramp.h"
#include "takt/trajectory/reversal.h"
#include "takt/trajectory/ruckig_solver.h"

namespace takt::trajectory {

namespace {

constexpr double kOnCurve = 1e-6;   // share of the distance to standstill
constexpr double kSteepest = 1e9;   // [1/s] jerk over acceleration: jerk times below 1 ns are lost in rounding
constexpr double kAbsurd = 1e30;    // [1/s] the same; problems beyond it may fail
constexpr double kFarApart = 1e-5;  // tolerance of the velocity limit where limits lie far apart

bool IsFinite(const KinematicState& s) noexcept {
  return std::isfinite(s.position) && std::isfinite(s.velocity) && std::isfinite(s.acceleration);
}
bool IsPositive(double x) noexcept {
  return x > 0 && std::isfinite(x);
}
bool IsSound(const Bounds& b) noexcept {
  return IsPositive(b.up) && IsPositive(b.down) && b.jerk >= 0 && std::isfinite(b.jerk);
}
bool CanStop(const Limits& l) noexcept {
  return IsPositive(l.deceleration) && l.jerk >= 0 && std::isfinite(l.jerk);
}
bool IsSound(const Limits& l) noexcept {
  return IsPositive(l.velocity) && IsPositive(l.acceleration) && CanStop(l);
}

// Units in which a problem is solved. The unit of time is free; the others follow from it so that the jerk (unlimited:
// the larger acceleration) is 1.
struct Scale {
  double time;
  double acceleration;
  double velocity;
  double length;
};

Scale ScaleOf(double time, const PositionProblem& q) noexcept {
  const double acceleration = q.bounds.jerk > 0 ? q.bounds.jerk * time : std::max(q.bounds.up, q.bounds.down);
  return {time, acceleration, acceleration * time, acceleration * time * time};
}

// Returns the duration of the motion if only the jerk (unlimited: the acceleration) bounded it. In this unit no number
// of the start and the target exceeds 1, however small or large the motion, and however far away the limits.
double MotionTime(const PositionProblem& q) noexcept {
  const double speed = std::max(std::abs(q.velocity), std::abs(q.end_velocity));
  const double distance = std::abs(q.distance);
  if (q.bounds.jerk == 0) {
    const double a = std::max(q.bounds.up, q.bounds.down);
    return std::max(std::sqrt(distance / a), speed / a);
  }
  const double j = q.bounds.jerk;
  const double time = std::max(std::sqrt(speed / j), std::abs(q.acceleration) / j);
  return distance > j * time * time * time ? maths::Cbrt(distance / j) : time;
}

// Returns the time to reach the velocity limit from rest: the second unit. It helps where a start far beyond the
// limits, with a long braking distance, makes the limits too small in the first unit.
double RampTime(const PositionProblem& q) noexcept {
  const double a = std::max(q.bounds.up, q.bounds.down);
  return q.velocity_limit / a + (q.bounds.jerk > 0 ? a / q.bounds.jerk : 0);
}

bool IsUsable(const Scale& s) noexcept {
  return std::isnormal(s.time) && std::isnormal(s.length) && std::isnormal(s.velocity) && std::isnormal(s.acceleration);
}

PositionProblem InScale(const PositionProblem& q, const Scale& s) noexcept {
  const double velocity = 1 / s.velocity;
  const double acceleration = 1 / s.acceleration;
  return {q.distance / s.length,
          q.velocity * velocity,
          q.acceleration * acceleration,
          q.end_velocity * velocity,
          q.velocity_limit * velocity,
          {q.bounds.up * acceleration, q.bounds.down * acceleration, q.bounds.jerk > 0 ? 1.0 : 0.0}};
}

// Returns true if the speed is within its limit and stays so while the initial acceleration is reduced to 0.
bool StartsWithin(const PositionProblem& q) noexcept {
  const double taken = q.bounds.jerk > 0 ? q.acceleration * std::abs(q.acceleration) / (2 * q.bounds.jerk) : 0;
  const double limit = q.velocity_limit * (1 + 1e-9);
  return std::abs(q.velocity) <= limit && std::abs(q.velocity + taken) <= limit;
}

// Clears `out`, which is empty or left by an earlier attempt. Cheaper than a new one.
void Begin(const KinematicState& from, Profile& out) noexcept {
  for (; out.piece_count > 0; --out.piece_count) {
    const auto last = static_cast<std::size_t>(out.piece_count - 1);
    out.pieces[last] = {};
    out.piece_ends_s[last] = 0;
  }
  out.start_state = out.end_state = from;
}

double PositionTolerance(const KinematicState& from, const KinematicState& target, const Scale& scale) noexcept {
  const double farthest = std::max(std::abs(from.position), std::abs(target.position));
  return kPositionTolerance * scale.length + 32 * std::numeric_limits<double>::epsilon() * farthest;
}

bool SnapTo(const KinematicState& target, const PositionProblem& q, const Scale& scale, Profile& out) noexcept {
  const KinematicState& end = out.end_state;
  const bool hits = std::abs(end.position - target.position) <= PositionTolerance(out.start_state, target, scale) &&
                    std::abs(end.velocity - target.velocity) <= kVelocityTolerance * scale.velocity &&
                    (q.bounds.jerk == 0 || std::abs(end.acceleration) <= kAccelerationTolerance * scale.acceleration);
  if (hits) out.SnapEnd(target);
  return hits;
}

// Integrates the solution found with the time unit `time` anew in user units from the exact start. Returns false if it
// misses the target.
bool Build(const KinematicState& from, const KinematicState& target, const PositionProblem& q, double time,
           const Scale& tolerance, const Solution& solution, Profile& out) noexcept {
  Begin(from, out);
  for (const Stretch& s : solution.all()) {
    if (q.bounds.jerk > 0) {
      out.Append(s.duration * time, s.jerk * q.bounds.jerk);
    } else {
      const double a = s.acceleration > 0 ? q.bounds.up : s.acceleration < 0 ? -q.bounds.down : 0;
      out.AppendWithAcceleration(s.duration * time, a, 0);
    }
  }
  return SnapTo(target, q, tolerance, out);
}

void Append(const Ramp& ramp, Profile& out) noexcept {
  for (const Stretch& s : ramp) out.AppendWithAcceleration(s.duration, s.acceleration, s.jerk);
}

double Distance(double velocity, double acceleration, const Ramp& ramp) noexcept {
  KinematicState state{0, velocity, acceleration};
  for (const Stretch& s : ramp) state = Advance(state, s);
  return state.position;
}

// Motions that need no solver: the quickest ramp to the end velocity if it reaches the target by itself, and a ramp to
// the velocity limit, a cruise and a ramp to the end velocity where there is room. Not only cheaper: a motion in
// progress that is planned again runs along its limits to rounding, and there a solver may find that it must reverse
// first.
bool BuildOfRamps(const KinematicState& from, const KinematicState& target, const PositionProblem& q,
                  const Scale& scale, Profile& out) noexcept {
  const Ramp at_once = QuickestRamp(q.velocity, q.acceleration, q.end_velocity, q.bounds);
  const double over = q.distance - Distance(q.velocity, q.acceleration, at_once);
  if (std::abs(over) <= PositionTolerance(from, target, scale)) {
    Begin(from, out);
    Append(at_once, out);
    if (SnapTo(target, q, scale, out)) return true;
  }
  const double cruise = over >= 0 ? q.velocity_limit : -q.velocity_limit;
  const Ramp to_cruise = QuickestRamp(q.velocity, q.acceleration, cruise, q.bounds);
  const Ramp to_end = QuickestRamp(cruise, 0, q.end_velocity, q.bounds);
  const double room = q.distance - Distance(q.velocity, q.acceleration, to_cruise) - Distance(cruise, 0, to_end);
  if (!(room / cruise >= 0)) return false;
  Begin(from, out);
  Append(to_cruise, out);
  out.AppendWithAcceleration(room / cruise, 0, 0);
  Append(to_end, out);
  return SnapTo(target, q, scale, out);
}

Ramp StopRamp(const KinematicState& from, const Limits& limits) noexcept {
  return QuickestRamp(from.velocity, from.acceleration, 0, {limits.deceleration, limits.deceleration, limits.jerk});
}

Status Follow(const KinematicState& from, const Ramp& ramp, double velocity, Profile& out) noexcept {
  Profile built(from);
  Append(ramp, built);
  built.SnapEnd({built.end_state.position, velocity, 0});
  if (!IsFinite(built.end_state) || !std::isfinite(built.duration())) return Status::Failed(ErrorId::kParameter);
  out = built;
  return Status::Ok();
}

}  // namespace

bool Planner::Solve(const KinematicState& from, double position, double end_velocity, double velocity_limit,
                    const Bounds& bounds, Profile& out) noexcept {
  PositionProblem problem{
      position - from.position, from.velocity, bounds.jerk > 0 ? from.acceleration : 0, end_velocity,
      velocity_limit,           bounds};
  const double acceleration = std::max(bounds.up, bounds.down);
  if (bounds.jerk < kAbsurd * acceleration) problem.bounds.jerk = std::min(bounds.jerk, kSteepest * acceleration);
  const KinematicState target{position, end_velocity, 0};
  const Scale first = ScaleOf(MotionTime(problem), problem);
  if (!IsUsable(first)) return false;
  if (BuildOfRamps(from, target, problem, first, out)) return true;
  const Scale second = ScaleOf(RampTime(problem), problem);
  const auto solve = [&](const Scale& scale) {
    Solution solution;
    return SolveWithRuckig(InScale(problem, scale), solution) &&
           Build(from, target, problem, scale.time, first, solution, out);
  };
  const auto solve_at_a_scale = [&] {
    if (solve(first)) return true;
    if (!IsUsable(second) || !solve(second)) return false;
    ++counters_.second_scale;
    return true;
  };
  // Usually the ramps failed because the distance is too short to reach the velocity limit: with a larger limit the
  // solver cannot mistake a rounding error for an excess. If they failed due to rounding, the result exceeds the limit.
  if (StartsWithin(problem)) {
    problem.velocity_limit *= 2;
    const bool found = solve_at_a_scale();
    const Profile::Range range = found ? out.VelocityRange() : Profile::Range{};
    if (found && std::max(-range.min, range.max) <= velocity_limit * (1 + kFarApart)) return true;
    problem.velocity_limit = velocity_limit;
  }
  return solve_at_a_scale();
}

Status Planner::ToPosition(const KinematicState& from, double position, double end_velocity, const Limits& limits,
                           Profile& out) noexcept {
  ++counters_.plans;
  const double distance = position - from.position;
  const bool sound =
      IsFinite(from) && IsSound(limits) && std::isfinite(distance) && std::abs(end_velocity) <= limits.velocity;
  if (!sound) return Status::Failed(ErrorId::kParameter);
  if (distance == 0 && from.velocity == end_velocity && (from.acceleration == 0 || limits.jerk == 0)) {
    out = Profile(from);
    out.SnapEnd({position, end_velocity, 0});
    return Status::Ok();
  }

  Bounds bounds{limits.acceleration, limits.deceleration, limits.jerk};
  if (limits.acceleration != limits.deceleration) {
    // A motion on its braking curve stops at the target except for rounding: it does not reverse.
    const double stop = StopPosition(from, limits);
    const bool on_curve = std::abs(position - stop) <= kOnCurve * std::abs(stop - from.position);
    bounds = DirectedBounds(from, on_curve ? from.velocity : position - stop, limits);
  }
  // A plan with an unexpected reversal exceeds a limit there; each round can only lower a bound.
  for (int round = 0; round < 3; ++round) {
    Profile plan;
    if (!Solve(from, position, end_velocity, limits.velocity, bounds, plan)) break;
    if (LowerWhereExceeded(plan, limits, bounds)) continue;
    out = plan;
    return Status::Ok();
  }
  ++counters_.failures;
  return Status::Failed(ErrorId::kPlanning);
}

Status Planner::ToVelocity(const KinematicState& from, double velocity, const Limits& limits, Profile& out) noexcept {
  ++counters_.plans;
  if (!(IsFinite(from) && IsSound(limits) && std::abs(velocity) <= limits.velocity)) {
    return Status::Failed(ErrorId::kParameter);
  }
  const Bounds bounds = VelocityBounds(from, velocity, limits);
  return Follow(from, QuickestRamp(from.velocity, from.acceleration, velocity, bounds), velocity, out);
}

Status Planner::ToPosition(const KinematicState& from, double position, double velocity_limit, const Bounds& bounds,
                           Profile& out) noexcept {
  ++counters_.plans;
  const bool sound =
      IsFinite(from) && IsSound(bounds) && IsPositive(velocity_limit) && std::isfinite(position - from.position);
  if (!sound) return Status::Failed(ErrorId::kParameter);
  Profile plan{from};
  const bool there = position == from.position && from.velocity == 0 && (from.acceleration == 0 || bounds.jerk == 0);
  if (there) {
    plan.SnapEnd({position, 0, 0});
  } else if (!Solve(from, position, 0, velocity_limit, bounds, plan)) {
    ++counters_.failures;
    return Status::Failed(ErrorId::kPlanning);
  }
  out = plan;
  return Status::Ok();
}

Status Planner::ToVelocity(const KinematicState& from, double velocity, const Bounds& bounds, Profile& out) noexcept {
  ++counters_.plans;
  if (!IsFinite(from) || !IsSound(bounds) || !std::isfinite(velocity)) return Status::Failed(ErrorId::kParameter);
  return Follow(from, QuickestRamp(from.velocity, from.acceleration, velocity, bounds), velocity, out);
}

Status Planner::Stop(const KinematicState& from, const Limits& limits, Profile& out) noexcept {
  ++counters_.plans;
  if (!IsFinite(from) || !CanStop(limits)) return Status::Failed(ErrorId::kParameter);
  return Follow(from, StopRamp(from, limits), 0, out);
}

double StopPosition(const KinematicState& from, const Limits& limits) noexcept {
  KinematicState state = from;
  for (const Stretch& s : StopRamp(from, limits)) state = Advance(state, s);
  return state.position;
}

}  // namespace takt::trajectory
