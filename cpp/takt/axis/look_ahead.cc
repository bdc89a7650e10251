// Look-ahead over buffered commands by a backward pass, as in the velocity profiles of path planners (LinuxCNC's tp.c
// does it for lines): from the last command, which ends at rest, computes the highest speed at each border between two
// commands from which the next border is reached with no more than its speed. The acceleration at borders is 0.
//
// What is ours: between blending commands with the same limits nothing requires a border. They are planned as one
// motion to the end of their run, and the profile is cut at the target. Each command of the run plans the same motion
// anew from where the previous one was cut; a time-optimal motion planned anew from one of its own states is itself. So
// a run of short moves takes the same time as one long move.
#include "takt/axis/look_ahead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "takt/axis/fit.h"
#include "takt/axis/planning.h"
#include "takt/axis/state.h"

namespace takt::axis {

using trajectory::Limits;

namespace {

constexpr int kBisections = 12;  // of a speed: to 1/4096 of the speed asked for

// Returns the distance [u] for slowing down from one speed to another.
double BrakingDistance(double from, double to, const Limits& limits) {
  const double change = from - to;
  if (change <= 0) return 0;
  double time = change / limits.deceleration;
  if (limits.jerk > 0) {
    const bool full = change * limits.jerk >= limits.deceleration * limits.deceleration;
    time = full ? time + limits.deceleration / limits.jerk : 2 * std::sqrt(change / limits.jerk);
  }
  return 0.5 * (from + to) * time;
}

// Returns the distance [u] of the positioning command `next` from `position` in this sense; 0 or less: no room.
double RoomToTarget(const AxisParams& params, double position, double sense, const Request& next) {
  const double target = next.by_distance() ? position + next.value
                                           : ResolveTarget(params, {position, 0, 0}, next.limits(), next.value,
                                                           next.direction, static_cast<std::int8_t>(sense));
  return Inside(params.limits, target) ? sense * (target - position) : 0;
}

// Returns the speed at which `next` is to take over at the end of `request`, by its buffer mode.
double AskedFor(const Request& request, const Request& next) {
  switch (next.buffer_mode) {
    case BufferMode::kBlendingLow:
      return std::min(request.velocity, next.velocity);
    case BufferMode::kBlendingPrevious:
      return request.velocity;
    case BufferMode::kBlendingNext:
      return next.velocity;
    case BufferMode::kBlendingHigh:
      return std::max(request.velocity, next.velocity);
    default:
      return 0;
  }
}

// Returns the speed at a border to a command without a target: a gear takes over at any velocity, an endless motion at
// one of its sense; homing and tables over time begin at rest.
double TakeOverSpeed(const AxisParams& params, const Request& request, double position, double sense,
                     const Request& next) {
  const Limits own = params.planner_limits();
  const double room = RoomToLimit(params.limits, position, sense);
  if (next.kind == RequestKind::kGearIn) return FastestWithin(request.velocity, 0, own, room);
  const bool onwards = next.kind == RequestKind::kMoveVelocity &&
                       SenseOf(next, static_cast<std::int8_t>(sense)) == static_cast<int>(sense);
  return onwards && room > 0 ? FastestWithin(AskedFor(request, next), 0, own, room) : 0;
}

bool SameLimits(const Request& a, const Request& b) {
  return a.velocity == b.velocity && a.acceleration == b.acceleration && a.deceleration == b.deceleration &&
         a.jerk == b.jerk;
}

// The border between two commands.
struct Border {
  double position = 0;
  double speed = 0;     // as asked for, then as possible
  double room = 0;      // of the next command, to its target
  Limits limits;        // of the next command
  bool inside = false;  // inside a run: nothing changes here
};

}  // namespace

double RoomToLimit(const AxisLimits& limits, double position, double sense) noexcept {
  const std::optional<double>& limit = sense > 0 ? limits.upper : limits.lower;
  return limit ? sense * (*limit - position) : std::numeric_limits<double>::infinity();
}

double FastestWithin(double speed, double end_speed, const Limits& limits, double room) noexcept {
  if (BrakingDistance(speed, end_speed, limits) <= room) return speed;
  double low = std::min(end_speed, speed);
  double high = speed;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (BrakingDistance(middle, end_speed, limits) <= room ? low : high) = middle;
  }
  return low;
}

LookAhead LookAheadOf(const AxisParams& params, const Override& factors, const KinematicState& from,
                      const Request& request, double target, std::span<const Request> queue) noexcept {
  LookAhead out;
  out.run_end = target;
  out.sense = target < from.position ? -1 : 1;
  if (queue.empty() || !request.positions() || request.continuous()) return out;
  std::array<Border, kBufferSize + 1> borders;
  std::size_t count = 0;
  double position = target;
  double last_speed = 0;  // at the end of the last command
  Request before = request;
  bool ends = true;
  for (const Request& commanded : queue.first(std::min<std::size_t>(queue.size(), kBufferSize))) {
    LimitedBy clamped = LimitedBy::kNothing;
    const Request next = Scaled(params, factors, commanded, clamped);
    if (!out.blends) out.next = next.limits();
    out.blends = true;
    Border& border = borders[count++];
    border = {position, 0, 0, next.limits(), false};
    if (!next.positions()) {
      border.speed = TakeOverSpeed(params, before, position, out.sense, next);
      ends = border.speed == 0;
      if (count == 1) out.asked = AskedFor(before, next);
      break;
    }
    border.room = RoomToTarget(params, position, out.sense, next);
    if (count == 1) out.asked = AskedFor(before, next);
    if (border.room <= 0) break;
    border.speed = AskedFor(before, next);
    border.inside = !next.continuous() && SameLimits(before, next);
    position += out.sense * border.room;
    if (next.continuous()) break;  // its end velocity is planned once it is in control
    before = next;
  }
  double behind = last_speed;
  for (std::size_t i = count; i-- > 0;) {
    Border& border = borders[i];
    // A command that is entered above its own velocity slows down to that first.
    const double down_to = std::min(behind, border.limits.velocity);
    if (border.room > 0) border.speed = FastestWithin(border.speed, down_to, border.limits, border.room);
    behind = border.speed;
  }
  out.speed = borders[0].speed;
  if (ends && borders[0].room > 0) out.stops_at = position;
  std::size_t run = 0;
  while (run < count && borders[run].inside) ++run;
  out.run_end = run < count ? borders[run].position : position;
  out.run_end_speed = run < count ? borders[run].speed : last_speed;
  return out;
}

}  // namespace takt::axis
