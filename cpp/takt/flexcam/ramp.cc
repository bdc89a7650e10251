#include "takt/flexcam/ramp.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

double Elapsed(const Ramp& ramp, const Cycle& cycle) {
  return (static_cast<double>(cycle.count) - static_cast<double>(ramp.start_cycle)) * cycle.period_s;
}

// Margin by which sums are kept from standstill while the master moves.
constexpr double kShare = 0.999;
// Speeds of the master below this share of the reference count as standstill.
constexpr double kStandstill = 1e-9;

double RateAt(const RampClock& clock, double speed) {
  const double q = speed / clock.reference;
  return q < 2 ? q * (1 - 0.25 * q) : 1;
}
double RateSlope(const RampClock& clock, double speed) {
  const double q = speed / clock.reference;
  return q < 2 ? (1 - 0.5 * q) / clock.reference : 0;
}

double SignOf(double x) {
  return x < 0 ? -1 : 1;
}

// Returns the rate of change of the master's speed.
double SpeedChange(const KinematicState& master) {
  return master.velocity == 0 ? std::abs(master.acceleration) : SignOf(master.velocity) * master.acceleration;
}

trajectory::Limits LimitsOf(const RampClock& clock) {
  return {clock.velocity, clock.acceleration, clock.acceleration, clock.jerk};
}

// Returns a clock for a shift with this motion, and that motion on the profile.
RampClock ClockFor(const KinematicState& shift, const RampMaster& ride, KinematicState& on_profile) {
  const trajectory::Limits& limits = ride.limits;
  const KinematicState& master = ride.master;
  RampClock clock;
  clock.velocity = limits.velocity;
  clock.acceleration = std::min(limits.acceleration, limits.deceleration);
  clock.jerk = limits.jerk;
  clock.sense = SignOf(master.velocity);
  const double speed = std::abs(master.velocity);
  const double bound = kShare * ride.factor;
  clock.reference = limits.velocity / bound;
  const bool against = shift.velocity * ride.base_velocity < 0 && speed > kStandstill * clock.reference;
  const double left = against ? 1 - std::abs(shift.velocity) / (speed * bound) : 1;
  clock.reference = std::max(clock.reference, 0.25 * speed / std::max(left, 1e-3));
  // A shift that runs ahead is slowed down at the full rate, at the price of less velocity on its return.
  if (shift.velocity * ride.base_velocity > 0) clock.reference = std::min(clock.reference, 2 * speed);
  clock.velocity = std::min(clock.velocity, bound * clock.reference);
  on_profile = {shift.position, 0, 0};
  if (speed <= kStandstill * clock.reference) return clock;
  clock.rate = RateAt(clock, speed);
  clock.rate_change = RateSlope(clock, speed) * SpeedChange(master);
  on_profile.velocity = shift.velocity / clock.rate;
  const double own = (shift.acceleration - clock.rate_change * on_profile.velocity) / (clock.rate * clock.rate);
  on_profile.acceleration = std::clamp(own, -clock.acceleration, clock.acceleration);
  return clock;
}

// An acceleration that would lead beyond the velocity limit, until it has ended with the jerk, is cut: the sense of the
// sum depends on that velocity.
KinematicState WithinSpeed(KinematicState from, const trajectory::Limits& limits) {
  if (from.velocity * from.acceleration <= 0) return from;
  const double room = std::max(limits.velocity - std::abs(from.velocity), 0.0);
  const double most = limits.jerk > 0 ? std::sqrt(2 * limits.jerk * room) : limits.acceleration;
  from.acceleration = std::clamp(from.acceleration, -most, most);
  return from;
}

bool PlanToZero(KinematicState from, const trajectory::Limits& limits, trajectory::Planner& planner,
                trajectory::Profile& out) {
  from = WithinSpeed(from, limits);
  trajectory::Profile profile{from};
  if (planner.ToPosition(from, 0, 0, limits, profile).failed()) return false;
  out = profile;
  return true;
}

// Plans the velocity of `from` to zero; the position at the end is defined as zero.
bool PlanToRest(KinematicState from, trajectory::Limits limits, trajectory::Planner& planner, double& begin,
                trajectory::Profile& out) {
  from = WithinSpeed(from, limits);
  limits.velocity = std::max(limits.velocity, std::abs(from.velocity));
  trajectory::Profile profile{from};
  if (planner.ToVelocity(from, 0, limits, profile).failed()) return false;
  begin = -profile.end().position;
  profile.Shift(begin);
  out = profile;
  return true;
}

void Reverse(RampClock& clock) {
  clock.rate = -clock.rate;
  clock.rate_change = -clock.rate_change;
  clock.sense = -clock.sense;
}

// The clock has run back beyond its begin: the ramp is for the other sense of the master now.
void TurnRound(trajectory::Planner& planner, Ramp& ramp) {
  RampClock& clock = ramp.clock;
  const KinematicState& start = ramp.profile.start();
  if (!PlanToZero({start.position, -start.velocity, start.acceleration}, LimitsOf(clock), planner, ramp.profile))
    return;
  clock.time_s = -clock.time_s;
  Reverse(clock);
}

}  // namespace

KinematicState At(const Ramp& ramp, const Cycle& cycle) noexcept {
  const double t = Elapsed(ramp, cycle);
  switch (ramp.kind) {
    case RampKind::kProfile:
      return ramp.profile.At(t);
    case RampKind::kTime:
      return t >= ramp.curve.length ? KinematicState{} : ramp.curve.At(t);
    case RampKind::kWithMaster: {
      const KinematicState at = ramp.profile.At(ramp.clock.time_s);
      const double rate = ramp.clock.rate;
      return {at.position, rate * at.velocity, rate * rate * at.acceleration + ramp.clock.rate_change * at.velocity};
    }
    default:
      return {};
  }
}

bool IsOver(const Ramp& ramp, const Cycle& cycle) noexcept {
  switch (ramp.kind) {
    case RampKind::kProfile:
      return Elapsed(ramp, cycle) >= ramp.profile.duration();
    case RampKind::kTime:
      return Elapsed(ramp, cycle) >= ramp.curve.length;
    case RampKind::kWithMaster:
      return ramp.clock.time_s >= ramp.profile.duration();
    default:
      return true;
  }
}

bool BeginProfile(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                  trajectory::Planner& planner, Ramp& out) noexcept {
  trajectory::Profile profile{shift};
  if (planner.ToPosition(shift, 0, 0, limits, profile).failed()) return false;
  out.kind = RampKind::kProfile;
  out.profile = profile;
  out.start_cycle = cycle.count - 1;
  return true;
}

bool BeginSpeed(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                trajectory::Planner& planner, double& begin, Ramp& out) noexcept {
  const KinematicState from = {0, shift.velocity, shift.acceleration};
  trajectory::Limits wide = limits;
  wide.velocity = std::max(limits.velocity, std::abs(from.velocity));
  trajectory::Profile profile{from};
  if (planner.ToVelocity(from, 0, wide, profile).failed()) return false;
  begin = -profile.end().position;
  profile.Shift(begin);
  out.kind = RampKind::kProfile;
  out.profile = profile;
  out.start_cycle = cycle.count - 1;
  return true;
}

void BeginTime(const KinematicState& shift, double duration_s, const Cycle& cycle, Ramp& out) noexcept {
  out.kind = RampKind::kTime;
  out.curve = trajectory::Connect(duration_s, shift, {});
  out.start_cycle = cycle.count - 1;
}

bool BeginWithMaster(const KinematicState& shift, const RampMaster& ride, trajectory::Planner& planner,
                     Ramp& out) noexcept {
  if (!(ride.factor > 0)) return false;
  KinematicState from;
  const RampClock clock = ClockFor(shift, ride, from);
  if (!PlanToZero(from, LimitsOf(clock), planner, out.profile)) return false;
  out.kind = RampKind::kWithMaster;
  out.clock = clock;
  return true;
}

bool BeginSpeedWithMaster(const KinematicState& shift, const RampMaster& ride, trajectory::Planner& planner,
                          double& begin, Ramp& out) noexcept {
  if (!(ride.factor > 0)) return false;
  KinematicState from;
  const RampClock clock = ClockFor({0, shift.velocity, shift.acceleration}, ride, from);
  if (!PlanToRest(from, LimitsOf(clock), planner, begin, out.profile)) return false;
  out.kind = RampKind::kWithMaster;
  out.clock = clock;
  return true;
}

bool MoveZero(double distance, trajectory::Planner& planner, Ramp& ramp) noexcept {
  Ramp moved = ramp;
  KinematicState from = ramp.profile.At(ramp.clock.time_s);
  from.position += distance;
  if (ramp.clock.rate < 0) {  // it runs back with its master: that is forwards for the new ramp
    from.velocity = -from.velocity;
    Reverse(moved.clock);
  }
  moved.clock.time_s = 0;
  if (!PlanToZero(from, LimitsOf(moved.clock), planner, moved.profile)) return false;
  ramp = moved;
  return true;
}

void Advance(const KinematicState& before, const KinematicState& now, double displacement, const Cycle& cycle,
             trajectory::Planner& planner, Ramp& ramp) noexcept {
  if (ramp.kind != RampKind::kWithMaster) return;
  RampClock& clock = ramp.clock;
  const double t = cycle.period_s;
  const double speed_before = std::abs(before.velocity), speed = std::abs(now.velocity);
  const double most_before = RateAt(clock, speed_before), most = RateAt(clock, speed);
  const double sign = clock.sense * SignOf(now.velocity == 0 ? before.velocity : now.velocity);
  const bool turns = before.velocity * now.velocity < 0;
  const double size = turns ? 0 : std::abs(clock.rate);
  const double room = 1 - clock.share * clock.share;
  const double growth = clock.acceleration / clock.velocity * (1 - size * size) * room;
  double next = 0, next_change = 0;
  if (!turns && speed < speed_before) {
    next = size * most / most_before + t * growth;
    next_change = clock.share * RateSlope(clock, speed) * SpeedChange(now) + growth;
  } else {
    // The part of the master's acceleration that remains from a reversal ends with the ramp's jerk.
    next_change = std::max(growth, sign * clock.rate_change - t * clock.jerk / clock.velocity);
    next = size + t * next_change;
  }
  if (next >= most) {
    next = most;
    next_change = std::min(next_change, RateSlope(clock, speed) * SpeedChange(now));
  }
  clock.share = most > 0 ? next / most : clock.share;
  const double rate_before = clock.rate, change_before = clock.rate_change;
  clock.rate = sign * next;
  clock.rate_change = sign * next_change;
  // The integral of the rate, limited to what the master's displacement allows.
  const double step = 0.5 * t * (rate_before + clock.rate) + t * t / 12 * (change_before - clock.rate_change);
  const double most_step = clock.sense * displacement / clock.reference;
  clock.time_s += std::clamp(step, std::min(most_step, 0.0), std::max(most_step, 0.0));
  if (clock.time_s < 0) TurnRound(planner, ramp);
}

void describe(Enumeration<RampKind>& e) {
  e.about("Law by which a shift decreases to zero.");
  e.value(RampKind::kNone, "none", "The shift is zero.");
  e.value(RampKind::kProfile, "profile", "Motion with limits of its own.");
  e.value(RampKind::kTime, "time", "Quintic over a time.");
  e.value(RampKind::kWithMaster, "with_master", "Motion with limits of its own, never against a master.");
}

void describe(Description<RampClock>& d) {
  using C = RampClock;
  d.about("Clock of a ramp with a master.");
  d.internal<&C::time_s>(unit::s, "Time on the profile.");
  d.internal<&C::rate>(unit::one, "Rate of the clock.");
  d.internal<&C::rate_change>(unit::one_s, "Rate of change of the rate.");
  d.internal<&C::share>(unit::one, "Share of the largest rate at the master's speed.");
  d.internal<&C::reference>("Reference speed of the master.");
  d.internal<&C::sense>("Sense of the master in which the clock advances.");
  d.internal<&C::velocity>("Velocity limit of the ramp.");
  d.internal<&C::acceleration>("Acceleration limit of the ramp.");
  d.internal<&C::jerk>("Jerk limit of the ramp.");
}

void describe(Description<Ramp>& d) {
  using R = Ramp;
  d.about("A shift that decreases to zero.");
  d.internal<&R::kind>("Law of the decrease.");
  d.internal<&R::profile>("Profile over time.");
  d.internal<&R::curve>("Quintic over time.");
  d.internal<&R::start_cycle>("Cycle from which its time counts.");
  d.internal<&R::clock>("Clock of the profile, with a master.");
}

}  // namespace takt::flexcam
