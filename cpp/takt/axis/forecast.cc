#include "takt/axis/forecast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "takt/axis/homing.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

constexpr Ticket kAsked = std::numeric_limits<Ticket>::max();
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

bool IsPlanned(const AxisParams& p, const State& s) {
  return !p.follows && !s.superimposed && !FollowsDemand(s.active.kind) && !Homes(s.active.kind) &&
         s.active.kind != RequestKind::kTorqueControl && !s.torque.engaged;
}

// Returns the time [s] at which a motion is first exactly at `position`, at `begin_s` or later; NaN if never.
double TimeAt(const trajectory::Profile& profile, bool goes_on, double position, double begin_s) {
  const double t = profile.TimeAt(position, begin_s);
  if (!std::isnan(t) || !goes_on) return t;
  const KinematicState& end = profile.end();
  const double after = end.velocity != 0 ? profile.duration() + (position - end.position) / end.velocity : kNever;
  return after >= std::max(begin_s, profile.duration()) ? after : kNever;
}

Forecast ForecastOf(const Context& c, const State& s, double waited_s) {
  Forecast f;
  f.known = IsPlanned(c.params, s);
  f.held = s.motion.held;
  f.goes_on = s.plc == PlcState::kContinuousMotion;
  f.limited_by = s.limited_by;
  f.modulus = c.params.turn();
  f.lower = c.params.limits.lower.value_or(-HUGE_VAL);
  f.upper = c.params.limits.upper.value_or(HUGE_VAL);
  const bool stands = !s.loop_closed || (s.motion.arrived && AtRest(s));
  f.profile = stands ? trajectory::Profile{s.setpoint} : s.motion.profile;
  f.start_s = stands ? waited_s : waited_s - (Elapsed(c, s) - c.cycle.period_s);
  return f;
}

ErrorId ErrorOfAsked(const FeedbackSink& sink) {
  for (const FeedbackEvent& event : sink.events()) {
    if (event.ticket == kAsked && event.state == FeedbackState::kError) return event.error;
  }
  return ErrorId::kNone;
}

bool IsDone(const FeedbackSink& sink) {
  return std::ranges::any_of(sink.events(),
                             [](const FeedbackEvent& event) { return event.ticket == kAsked && IsFinal(event.state); });
}

bool Waits(const State& s) {
  return std::any_of(s.buffer.begin(), s.buffer.begin() + s.buffered,
                     [](const Request& r) { return r.ticket == kAsked; });
}

}  // namespace

double Forecast::duration_s() const noexcept {
  return held ? std::numeric_limits<double>::infinity() : std::max(0.0, start_s + profile.duration());
}

double Forecast::TimeTo(double position) const noexcept {
  if (goes_on && (position < lower || position > upper)) return kNever;
  const double begin = std::max(0.0, -start_s);
  const KinematicState from = profile.At(begin);
  double t = kNever;
  if (modulus > 0) {  // the next one on either side: the motion passes one of them first
    const double below = position + modulus * std::floor((from.position - position) / modulus);
    t = std::fmin(TimeAt(profile, goes_on, below, begin), TimeAt(profile, goes_on, below + modulus, begin));
  } else {
    t = TimeAt(profile, goes_on, position, begin);
  }
  return std::max(start_s, 0.0) + (t - begin);
}

KinematicState Forecast::At(double in_s) const noexcept {
  KinematicState at = profile.At(std::max(0.0, in_s) - start_s);
  if (goes_on && (at.position < lower || at.position > upper))
    at = {std::min(std::max(at.position, lower), upper), 0, 0};
  if (modulus > 0) at.position -= modulus * std::floor(at.position / modulus);
  return at;
}

Forecast Foresee(const Context& context, const State& state) {
  return ForecastOf(context, state, 0);
}

Forecast Foresee(const Context& context, const Command& command, const State& state) {
  State s = state;
  AxisParams params = context.params;
  trajectory::Planner planner;
  std::array<FeedbackEvent, 8 * (kBufferSize + 4)> storage;
  FeedbackSink sink(storage);
  Context c = {params, context.cycle, planner, sink, context.master, context.machine};
  Apply(c, kAsked, 0, command, s);
  const std::uint64_t begin = c.cycle.count;
  const auto waited_s = [&] { return static_cast<double>(c.cycle.count - begin) * c.cycle.period_s; };
  do {
    s.actual = s.setpoint;
    s.following_error = 0;
    Move(c, s);
    ++c.cycle.count;
  } while (Waits(s) && waited_s() < kLongestWait_s);
  Forecast f;
  f.error = ErrorOfAsked(sink);
  const bool has_turn = s.active.ticket == kAsked || IsDone(sink);
  if (f.error == ErrorId::kNone && has_turn) f = ForecastOf(c, s, waited_s());
  return f;
}

}  // namespace takt::axis
