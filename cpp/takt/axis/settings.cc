#include "takt/axis/settings.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/coordinates.h"
#include "takt/axis/fit.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

Status Done(const Context& c, Ticket ticket, double value = 0) {
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, false, value);
  return Status::Ok();
}

// Returns true if the axis could keep these limits from its present state: it can stop inside them, and the rest of its
// planned motion is inside them.
bool Fits(const Context& c, const AxisLimits& limits, const State& s) {
  if (!s.loop_closed) return true;
  const trajectory::Profile::Range braking = RangeOfStop(c.params, s.setpoint);
  if (!Inside(limits, braking.min) || !Inside(limits, braking.max)) return false;
  if (s.motion.held && s.active.positions() && !Inside(limits, s.motion.target + AddedAtEnd(s))) return false;
  // Motions that go on with a velocity are watched each cycle, except from one blended move to the next.
  const bool watched = s.plc == PlcState::kContinuousMotion || FollowsDemand(s.active.kind);
  if (s.motion.arrived || watched) return true;
  const trajectory::Profile::Range range = s.motion.profile.PositionRange(Elapsed(c, s) - c.cycle.period_s);
  const double added = AddedAtEnd(s);
  const double end = trajectory::StopPosition(s.motion.profile.end(), c.params.planner_limits());
  return Inside(limits, std::min(range.min, end) + std::min(0.0, added)) &&
         Inside(limits, std::max(range.max, end) + std::max(0.0, added));
}

Status MayPutOut(const Context& c, double voltage, const State& s) {
  if (c.params.drive.mode != DriveMode::kAnalog) return Status::Failed(ErrorId::kState);
  if (s.plc != PlcState::kDisabled || s.enable) return Status::Failed(ErrorId::kPowerOn);
  const bool barred = (s.bars_positive && voltage > 0) || (s.bars_negative && voltage < 0);
  return barred ? Status::Failed(ErrorId::kDirection) : Status::Ok();
}

void EndPulse(const Context& c, FeedbackState feedback, State& s) {
  if (!s.pulsing) return;
  s.pulsing = false;
  Report(c, s.pulse.ticket, feedback);
}

Status CheckLimits(const Context& c, const AxisLimits& limits, const State& s) {
  if (c.params.rotary() && (limits.lower || limits.upper)) return Status::Failed(ErrorId::kParameter);
  if (limits.lower && limits.upper && !(*limits.lower < *limits.upper)) return Status::Failed(ErrorId::kParameter);
  return Fits(c, limits, s) ? Status::Ok() : Status::Failed(ErrorId::kTargetBehindLimit);
}

// A supervised value that can be switched off and on again: while off it is kept in `asleep`.
struct Watch {
  std::optional<double> value;
  std::optional<double> asleep;

  void Choose(bool enable, const std::optional<double>& wanted) {
    const std::optional<double> known = wanted ? wanted : value ? value : asleep;
    value = enable ? known : std::nullopt;
    asleep = enable ? std::nullopt : known;
  }
};

Status SetLimits(const Context& c, Ticket ticket, const Watch& lower, const Watch& upper, State& s) {
  AxisLimits limits = c.params.limits;
  limits.lower = lower.value;
  limits.upper = upper.value;
  if (const Status status = CheckLimits(c, limits, s); status.failed()) return status;
  c.params.limits = limits;
  s.dormant.lower = lower.asleep;
  s.dormant.upper = upper.asleep;
  return Done(c, ticket);
}

// Sets a limit of the application (PLCopen's ...Appl), at most that of the machine file. Motions are planned with the
// limits in force, so only while there is no motion; a follower keeps the limits that were checked against its
// master's.
Status SetLimit(const Context& c, const WriteParameter& w, const State& s) {
  if (c.params.follows || !AtRest(s) || s.active.kind != RequestKind::kNone || s.superimposed) {
    return Status::Failed(ErrorId::kState);
  }
  AxisLimits& limits = c.params.limits;
  const auto within = [&](double most) { return w.value > 0 && w.value <= most; };
  switch (static_cast<Parameter>(w.number)) {
    case Parameter::kMaxVelocity:
      if (!within(s.system.velocity)) break;
      limits.velocity = w.value;
      return Status::Ok();
    case Parameter::kMaxAcceleration:
      if (!within(s.system.acceleration)) break;
      limits.deceleration = limits.deceleration.value_or(limits.acceleration);  // keeps its value
      limits.acceleration = w.value;
      return Status::Ok();
    case Parameter::kMaxDeceleration:
      if (!within(s.system.deceleration)) break;
      limits.deceleration = w.value;
      return Status::Ok();
    default: {
      const bool unlimited = s.system.jerk == 0;
      if (!(unlimited ? w.value >= 0 : within(s.system.jerk))) break;
      limits.jerk = w.value;
      return Status::Ok();
    }
  }
  return Status::Failed(ErrorId::kParameter);
}

bool IsYesOrNo(double value) {
  return value == 0 || value == 1;
}

double OrInfinity(const std::optional<double>& limit, const std::optional<double>& asleep = {}) {
  return limit ? *limit : asleep.value_or(HUGE_VAL);
}

}  // namespace

std::optional<double> ValueOf(const AxisParams& p, const State& s, std::int32_t number) noexcept {
  const trajectory::Limits own = p.planner_limits();
  switch (static_cast<Parameter>(number)) {
    case Parameter::kCommandedPosition:
      return s.setpoint.position;
    case Parameter::kLimitPositive:
      return OrInfinity(p.limits.upper, s.dormant.upper);
    case Parameter::kLimitNegative:
      return p.limits.lower ? *p.limits.lower : s.dormant.lower.value_or(-HUGE_VAL);
    case Parameter::kEnableLimitPositive:
      return p.limits.upper ? 1 : 0;
    case Parameter::kEnableLimitNegative:
      return p.limits.lower ? 1 : 0;
    case Parameter::kEnableLagMonitoring:
      return p.supervision.deviation_moving ? 1 : 0;
    case Parameter::kMaxPositionLag:
      return OrInfinity(p.supervision.deviation_moving, s.dormant.lag);
    case Parameter::kMaxVelocitySystem:
      return s.system.velocity;
    case Parameter::kMaxVelocity:
      return own.velocity;
    case Parameter::kActualVelocity:
      return s.actual.velocity;
    case Parameter::kCommandedVelocity:
      return s.setpoint.velocity;
    case Parameter::kMaxAccelerationSystem:
      return s.system.acceleration;
    case Parameter::kMaxAcceleration:
      return own.acceleration;
    case Parameter::kMaxDecelerationSystem:
      return s.system.deceleration;
    case Parameter::kMaxDeceleration:
      return own.deceleration;
    case Parameter::kMaxJerkSystem:
      return s.system.jerk;
    case Parameter::kMaxJerk:
      return own.jerk;
    case Parameter::kLoopKp:
      return p.loop.kp;
    case Parameter::kLoopKi:
      return p.loop.ki;
    case Parameter::kLoopKd:
      return p.loop.kd;
    case Parameter::kLoopKc:
      return p.loop.kc;
    case Parameter::kLoopFf:
      return p.loop.ff;
    case Parameter::kLoopVmax:
      return p.loop.velocity_at_10v;
    case Parameter::kMaxPositionLagStandstill:
      return OrInfinity(p.supervision.deviation_standstill);
    case Parameter::kTorqueLimit:
      return OrInfinity(p.limits.torque);
  }
  return std::nullopt;
}

Status CarryOut(const Context& c, Ticket ticket, const SetConstants& k, State& s) noexcept {
  AxisLimits limits = c.params.limits;
  if (k.lower) limits.lower = k.lower;
  if (k.upper) limits.upper = k.upper;
  if (const Status status = CheckLimits(c, limits, s); status.failed()) return status;
  c.params.limits = limits;
  ControlLoop& loop = c.params.loop;
  loop.kp = k.kp.value_or(loop.kp);
  loop.ki = k.ki.value_or(loop.ki);
  loop.kd = k.kd.value_or(loop.kd);
  loop.kc = k.kc.value_or(loop.kc);
  loop.ff = k.ff.value_or(loop.ff);
  loop.velocity_at_10v = k.velocity_at_10v.value_or(loop.velocity_at_10v);
  s.constants_set = true;
  return Done(c, ticket);
}

// Allowed at any time: the drive adds it to the torque of its own loops, and a payload changes during operation.
Status CarryOut(const Context& c, Ticket ticket, const SetLoad& load, State&) noexcept {
  std::optional<TorqueOffset>& offset = c.params.drive.torque_offset;
  if (!offset) return Status::Failed(ErrorId::kState);
  offset->inertia = load.inertia.value_or(offset->inertia);
  offset->coulomb_friction = load.coulomb_friction.value_or(offset->coulomb_friction);
  offset->viscous_friction = load.viscous_friction.value_or(offset->viscous_friction);
  offset->load_torque = load.load_torque.value_or(offset->load_torque);
  return Done(c, ticket);
}

Status CarryOut(const Context& c, Ticket ticket, const WriteParameter& w, State& s) noexcept {
  const auto parameter = static_cast<Parameter>(w.number);
  Watch lower{c.params.limits.lower, s.dormant.lower};
  Watch upper{c.params.limits.upper, s.dormant.upper};
  Watch lag{c.params.supervision.deviation_moving, s.dormant.lag};
  const auto enable = [&](Watch& watch) {
    const bool possible = IsYesOrNo(w.value) && (w.value == 0 || watch.value || watch.asleep);
    if (possible) watch.Choose(w.value != 0, std::nullopt);
    return possible;
  };
  bool good = true;
  switch (parameter) {
    case Parameter::kLimitPositive:
      upper.Choose(true, w.value);
      break;
    case Parameter::kLimitNegative:
      lower.Choose(true, w.value);
      break;
    case Parameter::kEnableLimitPositive:
      good = enable(upper);
      break;
    case Parameter::kEnableLimitNegative:
      good = enable(lower);
      break;
    case Parameter::kMaxPositionLag:
      good = w.value > 0;
      lag.Choose(true, w.value);
      break;
    case Parameter::kEnableLagMonitoring:
      good = enable(lag);
      break;
    case Parameter::kMaxPositionLagStandstill:
      if (!(w.value > 0)) return Status::Failed(ErrorId::kParameter);
      c.params.supervision.deviation_standstill = w.value;
      return Done(c, ticket);
    case Parameter::kTorqueLimit:
      if (!(w.value > 0 && w.value <= s.most_torque)) return Status::Failed(ErrorId::kParameter);
      c.params.limits.torque = w.value;
      return Done(c, ticket);
    case Parameter::kMaxVelocity:
    case Parameter::kMaxAcceleration:
    case Parameter::kMaxDeceleration:
    case Parameter::kMaxJerk: {
      const Status status = SetLimit(c, w, s);
      return status.failed() ? status : Done(c, ticket);
    }
    default:
      good = false;
  }
  if (!good) return Status::Failed(ErrorId::kParameter);
  if (parameter != Parameter::kMaxPositionLag && parameter != Parameter::kEnableLagMonitoring) {
    return SetLimits(c, ticket, lower, upper, s);
  }
  c.params.supervision.deviation_moving = lag.value;
  s.dormant.lag = lag.asleep;
  return Done(c, ticket);
}

Status CarryOut(const Context& c, Ticket ticket, const ReadParameter& r, State& s) noexcept {
  const std::optional<double> value = ValueOf(c.params, s, r.number);
  return value ? Done(c, ticket, *value) : Status::Failed(ErrorId::kParameter);
}

Status CarryOut(const Context& c, Ticket ticket, const SetSoftLimits& l, State& s) noexcept {
  Watch lower{c.params.limits.lower, s.dormant.lower};
  Watch upper{c.params.limits.upper, s.dormant.upper};
  lower.Choose(l.enable_lower, l.lower);
  upper.Choose(l.enable_upper, l.upper);
  return SetLimits(c, ticket, lower, upper, s);
}

Status CarryOut(const Context& c, Ticket ticket, const DirectOutput& d, State& s) noexcept {
  if (const Status status = MayPutOut(c, d.voltage, s); status.failed()) return status;
  EndPulse(c, FeedbackState::kAborted, s);
  s.direct_voltage_v = d.voltage;
  return Done(c, ticket);
}

Status CarryOut(const Context& c, Ticket ticket, const PulseOutput& p, State& s) noexcept {
  if (const Status status = MayPutOut(c, p.voltage, s); status.failed()) return status;
  EndPulse(c, FeedbackState::kAborted, s);
  const double cycles = std::max(1.0, std::round(p.duration / c.cycle.period_s));
  s.direct_voltage_v = p.voltage;
  s.pulse = {ticket, p.voltage, c.cycle.count + static_cast<std::uint64_t>(cycles)};
  s.pulsing = true;
  Report(c, ticket, FeedbackState::kActive);
  return Status::Ok();
}

void WatchPulse(const Context& c, State& s) noexcept {
  const bool cut_off = s.plc != PlcState::kDisabled || s.enable || s.direct_voltage_v != s.pulse.voltage;
  if (!cut_off && c.cycle.count < s.pulse.end_cycle) return;
  if (!cut_off) s.direct_voltage_v = 0;
  EndPulse(c, cut_off ? FeedbackState::kAborted : FeedbackState::kDone, s);
}

Status CarryOut(const Context& c, Ticket ticket, const WriteOutput& w, State& s) noexcept {
  const std::uint32_t bit = 1U << (w.number - 1);
  s.written_outputs = w.value ? s.written_outputs | bit : s.written_outputs & ~bit;
  return Done(c, ticket);
}

Status CarryOut(const Context& c, Ticket ticket, const SetPosition& p, State& s) noexcept {
  if (s.plc == PlcState::kHoming || s.plc == PlcState::kStopping || s.plc == PlcState::kErrorStop) {
    return Status::Failed(ErrorId::kState);
  }
  // The present position is the set point; with the loop open that is the actual position.
  const double by = p.relative ? p.position : p.position - s.setpoint.position;
  State shifted = s;
  ShiftCoordinates(by, shifted);
  shifted.homing.renamed += by;
  if (!BlendingQueue(shifted).empty()) ReplanActive(c, shifted);  // to the same point, which has another number now
  if (!Fits(c, c.params.limits, shifted)) return Status::Failed(ErrorId::kTargetBehindLimit);
  s = shifted;
  return Done(c, ticket);
}

bool Fill(const RequestBuilder& m, const SetConstants& k) {
  const auto not_negative_if = [&](const char* field, const std::optional<double>& value, double high) {
    return !value || m.In(field, *value, 0, high);
  };
  const auto position_if = [&](const char* field, const std::optional<double>& value) {
    return !value || m.In(field, *value, -kMaxPosition, kMaxPosition);
  };
  constexpr double kLargestGain = 1e6;  // as in a machine file
  return not_negative_if("kp", k.kp, kLargestGain) && not_negative_if("ki", k.ki, kLargestGain) &&
         not_negative_if("kd", k.kd, kLargestGain) && not_negative_if("kc", k.kc, 1) &&
         not_negative_if("ff", k.ff, 10) &&
         (!k.velocity_at_10v ||
          m.In("velocity_at_10v", *k.velocity_at_10v, std::numeric_limits<double>::min(), kMaxPosition)) &&
         position_if("lower", k.lower) && position_if("upper", k.upper);
}

bool Fill(const RequestBuilder& m, const SetLoad& load) {
  const auto in_if = [&](const char* field, const std::optional<double>& value, double low) {
    return !value || m.In(field, *value, low, kMaxTorque);
  };
  return in_if("inertia", load.inertia, 0) && in_if("coulomb_friction", load.coulomb_friction, 0) &&
         in_if("viscous_friction", load.viscous_friction, 0) && in_if("load_torque", load.load_torque, -kMaxTorque);
}

constexpr auto kLastParameter = static_cast<std::int32_t>(Parameter::kTorqueLimit);

bool Fill(const RequestBuilder& m, const WriteParameter& w) {
  return m.In("value", w.value, -kMaxPosition, kMaxPosition) && m.In("number", w.number, 1, kLastParameter);
}

bool Fill(const RequestBuilder& m, const ReadParameter& r) {
  return m.In("number", r.number, 1, kLastParameter);
}

bool Fill(const RequestBuilder& m, const SetSoftLimits& l) {
  return m.In("lower", l.lower.value_or(0), -kMaxPosition, kMaxPosition) &&
         m.In("upper", l.upper.value_or(0), -kMaxPosition, kMaxPosition);
}

bool Fill(const RequestBuilder& m, const DirectOutput& d) {
  return m.In("voltage", d.voltage, -kVoltageLimit, kVoltageLimit);
}

bool Fill(const RequestBuilder& m, const PulseOutput& p) {
  constexpr double kLongest = 1e6;  // [s]
  return m.In("voltage", p.voltage, -kVoltageLimit, kVoltageLimit) &&
         m.In("duration", p.duration, std::numeric_limits<double>::min(), kLongest);
}

bool Fill(const RequestBuilder& m, const WriteOutput& w) {
  return m.In("number", w.number, 1, 32);
}

bool Fill(const RequestBuilder& m, const SetPosition& p) {
  const bool within_turn = m.params.rotary() && !p.relative;
  return m.In("position", p.position, within_turn ? 0 : -kMaxPosition, within_turn ? m.params.modulus : kMaxPosition);
}

}  // namespace takt::axis
