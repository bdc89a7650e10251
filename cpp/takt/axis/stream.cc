#include "takt/axis/stream.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kClockGain = 1e-3;     // of the deviation of a set point's arrival from the delay
constexpr double kFastestClock = 5e-3;  // largest relative deviation of the stream's clock from the cycle's

// Returns the slope of the curve at point i, from its neighbours unless it is fixed.
double Slope(const StreamState& k, std::size_t i) {
  const StreamedPoint& here = k.points[i];
  if (here.fixed) return here.velocity;
  const StreamedPoint& from = k.points[i > 0 ? i - 1 : i];
  const StreamedPoint& to = k.points[i + 1u < k.count ? i + 1 : i];
  return to.time > from.time ? (to.position - from.position) / (to.time - from.time) : 0;
}

void Fix(StreamState& k, std::size_t i) {
  k.points[i].velocity = Slope(k, i);
  k.points[i].fixed = true;
}

void DropFirst(StreamState& k) {
  std::move(k.points.begin() + 1, k.points.begin() + k.count, k.points.begin());
  k.points[--k.count] = {};
}

KinematicState Between(const StreamedPoint& a, const StreamedPoint& b, double time) {
  const double h = b.time - a.time;
  const double x = (time - a.time) / h;
  const double rise = b.position - a.position;
  const double c2 = 3 * rise - (2 * a.velocity + b.velocity) * h;
  const double c3 = (a.velocity + b.velocity) * h - 2 * rise;
  return {a.position + x * (a.velocity * h + x * (c2 + x * c3)), a.velocity + x * (2 * c2 + 3 * x * c3) / h,
          (2 * c2 + 6 * x * c3) / (h * h)};
}

// Returns the turn of a rotary position that is nearest to `near`.
double Unwrapped(const Context& c, double position, double near) {
  if (!c.params.rotary()) return position;
  return near + std::remainder(position - near, c.params.modulus);
}

}  // namespace

KinematicState DemandAt(StreamState& k) noexcept {
  while (k.count > 1 && k.points[1].time <= k.clock) {
    Fix(k, 1);
    DropFirst(k);
  }
  const StreamedPoint& first = k.points[0];
  if (k.clock <= first.time) return {first.position, 0, 0};
  Fix(k, 0);
  if (k.count == 1) return {first.position + first.velocity * (k.clock - first.time), first.velocity, 0};
  Fix(k, 1);
  return Between(first, k.points[1], k.clock);
}

StreamSlot SlotOf(const StreamState& k, double time) noexcept {
  std::size_t place = k.count;
  while (place > 0 && k.points[place - 1].time >= time) --place;
  if (k.count == 0) return {ErrorId::kNone, place};
  const bool doubled = place < k.count && k.points[place].time == time;
  // No set point can be inserted within the curve in use.
  const bool in_use = place < std::min<std::size_t>(k.count, 2) && k.clock > k.points[0].time;
  if (doubled || in_use || time <= k.clock) return {ErrorId::kStreamLate, place};
  return {k.count == kStreamed ? ErrorId::kBufferFull : ErrorId::kNone, place};
}

void Keep(const Cycle& cycle, const StreamedPoint& point, std::size_t place, double delay, StreamState& k) noexcept {
  const bool begins = k.count == 0;
  if (begins) k.clock = point.time - delay - cycle.period_s;
  std::move_backward(k.points.begin() + static_cast<std::ptrdiff_t>(place), k.points.begin() + k.count,
                     k.points.begin() + k.count + 1);
  k.points[place] = point;
  ++k.count;
  k.heard_cycle = cycle.count;
  // The two clocks drift apart: the stream is played slightly faster or slower, so that it keeps its delay.
  if (!begins && place + 1u == k.count) {
    const double early = point.time - k.clock - delay;
    const double most = kFastestClock * (point.time - k.points[place - 1].time);
    k.clock += std::clamp(kClockGain * early, -most, most);
  }
}

bool Fill(const RequestBuilder& m, const Stream& c) {
  m.r.kind = RequestKind::kStream;
  m.r.value = c.delay;
  m.r.timeout_s = c.timeout;
  m.r.key = c.key;
  return m.In("delay", c.delay, 0, 10) && m.In("timeout", c.timeout, 0.001, 60) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

bool Fill(const RequestBuilder& m, const StreamPoint& c) {
  const bool turns = m.params.rotary();
  return m.In("position", c.position, turns ? 0 : -kMaxPosition, turns ? m.params.modulus : kMaxPosition) &&
         m.In("velocity", c.velocity.value_or(0), -m.params.limits.velocity, m.params.limits.velocity) &&
         m.In("time", c.time.value_or(0), -kMaxPosition, kMaxPosition);
}

void BeginStream(const Context& c, const Request& r, State& s) noexcept {
  Grant(c, r, s);
  s.stream = StreamState{};
  s.limited_by = LimitedBy::kNothing;
  s.motion.profile = trajectory::Profile{s.setpoint};
  s.motion.target = s.setpoint.position;
  s.motion.arrived = false;
  Enter(s, PlcState::kSynchronizedMotion);
}

bool FollowStream(const Context& c, State& s) noexcept {
  StreamState& k = s.stream;
  const double period = c.cycle.period_s;
  if (k.count > 0) k.clock += period;
  const double silent_s = static_cast<double>(c.cycle.count - k.heard_cycle) * period;
  if (k.count > 0 && silent_s > s.active.timeout_s) {
    const trajectory::Limits ramps = s.active.limits();
    EndActive(c, FeedbackState::kError, ErrorId::kStreamEnded, s);
    AbortBuffer(c, s);
    ComeToRest(c, ramps, FromCycleBefore(c), s);
    return false;
  }
  // Without a set point yet, the axis comes to rest.
  KinematicState demand{s.setpoint.position + s.origin + s.setpoint.velocity * period, 0, 0};
  if (k.count > 0) demand = DemandAt(k);
  demand.position -= s.origin;
  const auto mode = k.count > 0 ? trajectory::DemandMode::kPosition : trajectory::DemandMode::kVelocity;
  const trajectory::Limits own = c.params.planner_limits();
  s.setpoint = FollowDemand({own, c.planner, s.active.limits(), period}, mode, s.setpoint, demand, k.chase);
  s.limited_by = k.count > 0 ? Beyond(own, demand, k.chase.in_step) : LimitedBy::kNothing;
  if (k.count > 0 && k.chase.in_step) Conclude(c, 0, s);
  if (!AtRest(s)) s.motion.arrived_cycle = c.cycle.count;
  return true;
}

Status CarryOut(const Context& c, Ticket ticket, const StreamPoint& command, State& s) noexcept {
  StreamState& k = s.stream;
  if (!Streams(s.active.kind)) return Status::Failed(ErrorId::kState);
  if (command.key != s.active.key) return Status::Failed(ErrorId::kStreamKey);
  const double now = static_cast<double>(c.cycle.count) * c.cycle.period_s;
  StreamedPoint point{command.time.value_or(now), 0, command.velocity.value_or(0), command.velocity.has_value()};
  const auto [error, place] = SlotOf(k, point.time);
  if (error != ErrorId::kNone) return Status::Failed(error);
  const double near = place > 0 ? k.points[place - 1].position : s.setpoint.position + s.origin;
  point.position = Unwrapped(c, command.position + s.origin, near);
  if (!Inside(c.params.limits, point.position - s.origin)) return Status::Failed(ErrorId::kTargetBehindLimit);
  if (place > 0) {
    const double way = kStreamJumpFactor * c.params.limits.velocity * (point.time - k.points[place - 1].time);
    if (std::abs(point.position - near) > way) return Status::Failed(ErrorId::kStreamJump);
  }
  Keep(c.cycle, point, place, s.active.value, k);
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}

void describe(Description<StreamedPoint>& d) {
  using P = StreamedPoint;
  d.about("A set point from outside.");
  d.internal<&P::time>(unit::s, "Time at which it is due, by the sender's clock.");
  d.internal<&P::position>(unit::u, "Position over all turns.");
  d.internal<&P::velocity>(unit::u_s, "Velocity of the curve at this point.");
  d.internal<&P::fixed>("The velocity is fixed.");
}

void describe(Description<StreamState>& d) {
  using K = StreamState;
  d.about("Set points that are streamed from outside.");
  d.internal<&K::points>("Buffered set points, by time.");
  d.internal<&K::count>("Number of buffered set points.");
  d.internal<&K::clock>(unit::s, "Time at the end of this cycle, by the sender's clock.");
  d.internal<&K::heard_cycle>("Cycle of the last accepted set point.");
  d.internal<&K::chase>("State of the follower that keeps the limits.");
}

}  // namespace takt::axis
