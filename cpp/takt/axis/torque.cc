#include "takt/axis/torque.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

constexpr double kAtSpeedLimit = 0.99;  // of the velocity limit
constexpr double kAtTorque = 0.999;     // of the set torque: the torque determines the motion
constexpr double kMostLead = 4;      // cycles at the command's acceleration: lead of the ramp over the actual velocity
constexpr double kMostSteps = 2;     // increments per cycle, in addition
constexpr double kCorrection = 0.1;  // of the distance to the actual position, per cycle

bool InControl(const State& s) {
  return s.loop_closed && s.active.kind == RequestKind::kTorqueControl;
}

// Predicts the state of the axis in the next cycle. The measured velocity is that of half a cycle ago.
KinematicState Foreseen(const Context& c, const State& s) {
  const double period = c.cycle.period_s;
  const double measured = (s.actual.velocity - s.torque.velocity_before) / period;
  const double sense = s.active.value < 0 ? -1 : 1;
  const bool up = s.actual.velocity != 0 ? s.actual.velocity > 0 : sense > 0;
  const double own = c.params.limits.acceleration;
  const double acceleration = up ? std::max(measured, sense > 0 ? own : 0) : std::min(measured, sense < 0 ? -own : 0);
  const double velocity = s.actual.velocity + 0.5 * acceleration * period;
  return {s.actual.position + (velocity + 0.5 * acceleration * period) * period, velocity + acceleration * period, 0};
}

void Ramp(const Context& c, State& s) {
  TorqueState& t = s.torque;
  const double step = s.active.torque_ramp > 0 ? s.active.torque_ramp * c.cycle.period_s : HUGE_VAL;
  t.set_torque_nm += std::clamp(s.active.value - t.set_torque_nm, -step, step);
}

void PlanRamp(const Context& c, const KinematicState& from, double sense, State& s) {
  trajectory::Limits limits = s.active.limits();
  limits.velocity = c.params.limits.velocity;  // the command's own may be exceeded when it begins
  trajectory::Profile ramp{from};
  if (c.planner.ToVelocity(from, sense * s.active.velocity, limits, ramp).failed()) ramp = trajectory::Profile{from};
  StartMotion(ramp, from.position, FromCycleBefore(c), s);
}

// The ramp in this cycle; `left`: the axis has got too far from it.
struct Bound {
  KinematicState at;
  double step = 0;  // [u] of this cycle
  bool left = false;
};

// Returns the acceleration of the set point on its way to `wanted`, limited by the jerk.
double Slewed(const Context& c, double acceleration, double wanted) {
  const double jerk = c.params.limits.jerk;
  const double step = jerk > 0 ? jerk * c.cycle.period_s : HUGE_VAL;
  return acceleration + std::clamp(wanted - acceleration, -step, step);
}

Bound NextBound(const Context& c, double sense, State& s) {
  TorqueState& t = s.torque;
  if (t.ticket != s.active.ticket) {
    t.ticket = s.active.ticket;
    PlanRamp(c, s.setpoint, sense, s);
  }
  const double period = c.cycle.period_s;
  const double most =
      kMostLead * s.active.acceleration * period + kMostSteps / (c.params.encoder.increments_per_unit * period);
  KinematicState bound = s.motion.profile.At(Elapsed(c, s));
  const double lead = sense * (bound.velocity - s.actual.velocity);
  const bool turns = sense * bound.velocity < 0;  // friction may be faster than the ramp
  if (lead <= most && !(turns && lead < -most))
    return {bound, bound.position - s.motion.profile.At(Elapsed(c, s) - period).position, false};
  bound.velocity = s.actual.velocity + std::copysign(most, sense * lead);
  PlanRamp(c, bound, sense, s);
  s.motion.start_cycle = c.cycle.count;
  return {bound, 0.5 * (s.setpoint.velocity + bound.velocity) * period, true};
}

}  // namespace

bool Fill(const RequestBuilder& m, const TorqueControl& c) {
  m.r.kind = RequestKind::kTorqueControl;
  m.r.buffer_mode = c.buffer_mode;
  m.r.value = c.torque;
  const double most = m.params.limits.torque.value_or(kMaxTorque);
  if (!m.In("torque", c.torque, -most, most)) return false;
  if (c.torque_ramp && !m.Take("torque_ramp", c.torque_ramp, kMaxTorque, m.r.torque_ramp)) return false;
  return m.Ramps(c) && m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity);
}

bool FollowsTorque(const State& s) noexcept {
  return InControl(s) && s.torque.engaged;
}

void SenseTorque(State& s) noexcept {
  if (FollowsTorque(s) && s.torque.holds) {
    s.setpoint = {s.actual.position, s.actual.velocity, s.setpoint.acceleration};
  }
}

bool MoveTorque(const Context& c, State& s) noexcept {
  TorqueState& t = s.torque;
  if (!InControl(s)) {
    t = TorqueState{};
    return false;
  }
  if (!t.engaged) t = {true, false, s.torque_nm, s.actual.velocity, s.setpoint.velocity};
  const KinematicState foreseen = Foreseen(c, s);
  t.velocity_before = s.actual.velocity;
  if (!CanStopInside(c.params, s.setpoint, foreseen)) {
    const bool upwards = foreseen.position > s.setpoint.position;
    Fail(c, upwards ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
    return false;
  }
  const double sense = s.active.value < 0 ? -1 : 1;
  const bool begins = t.set_torque_nm == 0 && s.active.value != 0;
  const bool pushes = !begins && sense * s.torque_nm >= kAtTorque * std::abs(t.set_torque_nm);
  Ramp(c, s);
  const auto [bound, step, left] = NextBound(c, sense, s);
  t.until = bound.velocity;
  const bool at_speed_limit = std::abs(bound.velocity) >= kAtSpeedLimit * s.active.velocity;
  t.holds = left || (pushes && sense * (bound.velocity - s.actual.velocity) >= 0);
  if (t.holds) {
    const double fastest = std::max(std::abs(bound.velocity), s.active.velocity);
    const double velocity = std::clamp(s.actual.velocity, -fastest, fastest);
    s.setpoint = {s.actual.position + velocity * c.cycle.period_s, velocity, Slewed(c, s.setpoint.acceleration, 0)};
  } else {
    const double correction = kCorrection * (s.actual.position - s.due);
    s.setpoint = {s.setpoint.position + step + correction, bound.velocity,
                  Slewed(c, s.setpoint.acceleration, bound.acceleration)};
  }
  s.limited_by = t.holds ? LimitedBy::kNothing : at_speed_limit ? LimitedBy::kVelocity : LimitedBy::kAcceleration;
  if (s.actual.velocity != 0) s.last_sense = s.actual.velocity > 0 ? 1 : -1;
  if (t.set_torque_nm == s.active.value) Conclude(c, 0, s);
  return true;
}

void describe(Description<TorqueState>& d) {
  using T = TorqueState;
  d.about("Torque control.");
  d.internal<&T::engaged>("The drive gets a torque.");
  d.internal<&T::holds>("The torque determines the motion.");
  d.internal<&T::set_torque_nm>(unit::nm, "Torque of this cycle.");
  d.internal<&T::velocity_before>(unit::u_s, "Measured velocity in the previous cycle.");
  d.internal<&T::until>(unit::u_s, "Velocity up to which the torque acts in this cycle.");
  d.internal<&T::ticket>("Ticket of the command in control.");
}

}  // namespace takt::axis
