#include "takt/axis/torque.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/request_maker.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

constexpr double kAtSpeedLimit = 0.99;  // of it
constexpr double kMaxTorque = 1e9;      // Nm

bool InControl(const State& s) {
  return s.loop_closed && s.active.kind == RequestKind::kTorqueControl;
}

// Where the axis may be in the cycle after this one. What is measured as velocity is that of half a cycle ago.
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

}  // namespace

bool Fill(const Maker& m, const TorqueControl& c) {
  m.r.kind = RequestKind::kTorqueControl;
  m.r.buffer_mode = c.buffer_mode;
  m.r.value = c.torque;
  if (!m.In("torque", c.torque, -kMaxTorque, kMaxTorque)) return false;
  if (c.torque_ramp && !m.Take("torque_ramp", c.torque_ramp, kMaxTorque, m.r.torque_ramp)) return false;
  return m.Braking(Halt{}) && m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity);
}

bool FollowsTorque(const State& s) noexcept {
  return InControl(s) && s.torque.engaged;
}

void SenseTorque(State& s) noexcept {
  if (FollowsTorque(s)) s.setpoint = {s.actual.position, s.actual.velocity, 0};
}

bool MoveTorque(const Context& c, State& s) noexcept {
  TorqueState& t = s.torque;
  if (!InControl(s)) {
    t = TorqueState{};
    return false;
  }
  if (!t.engaged) t = {true, s.torque_nm, s.actual.velocity};
  const KinematicState foreseen = Foreseen(c, s);
  t.velocity_before = s.actual.velocity;
  if (!CanStopInside(c.params, s.setpoint, foreseen)) {
    const bool upwards = foreseen.position > s.setpoint.position;
    Fail(c, upwards ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
    return false;
  }
  Ramp(c, s);
  const bool at_speed_limit = std::abs(s.actual.velocity) >= kAtSpeedLimit * s.active.velocity;
  s.limited_by = at_speed_limit ? LimitedBy::kVelocity : LimitedBy::kNothing;
  if (s.actual.velocity != 0) s.last_sense = s.actual.velocity > 0 ? 1 : -1;
  s.setpoint.position += s.setpoint.velocity * c.cycle.period_s;
  if (t.set_torque_nm == s.active.value) Conclude(c, 0, s);
  return true;
}

void describe(Description<TorqueState>& d) {
  using T = TorqueState;
  d.about("Torque control.");
  d.internal<&T::engaged>("The drive is told a torque.");
  d.internal<&T::set_torque_nm>(unit::nm, "Torque of this cycle.");
  d.internal<&T::velocity_before>(unit::u_s, "Measured in the cycle before.");
}

}  // namespace takt::axis
