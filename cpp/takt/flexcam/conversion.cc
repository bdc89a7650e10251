#include "takt/flexcam/conversion.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

KinematicState Law(const Conversion& c, const KinematicState& in) {
  return {c.factor * (in.position - c.in_zero) + c.out_zero + c.offset, c.factor * in.velocity,
          c.factor * in.acceleration};
}

KinematicState Difference(const KinematicState& a, const KinematicState& b) {
  return {a.position - b.position, a.velocity - b.velocity, a.acceleration - b.acceleration};
}

Cycle Earlier(const Cycle& cycle) {
  return {cycle.count - 1, cycle.period_s};
}

RampMaster RideOf(const ConversionTarget& target, const ConversionInputs& in, const Conversion& c) {
  return {in.ride_before, in.before.velocity, c.factor, target.ramps};
}

// Returns the remaining share of a ramp, from 1 to 0.
double ShareLeft(const Conversion& c, const Cycle& cycle) {
  if (c.ramp_begin == 0) return 0;
  const KinematicState shift = At(c.ramp, cycle);
  return std::clamp((c.by_speed ? shift.velocity : shift.position) / c.ramp_begin, 0.0, 1.0);
}

// After `old` has become `c`: notes which part of the ramp is due to offset and factor, relative to the values in
// force.
void NoteRamp(const Cycle& cycle, const ConversionInputs& in, const Conversion& old, bool by_speed, Conversion& c) {
  const Cycle earlier = Earlier(cycle);
  const KinematicState begin = At(c.ramp, earlier);
  c.offset_left = OffsetInForce(old, earlier) - c.offset;
  c.factor_left = FactorInForce(old, earlier, in.before) - c.factor;
  c.by_speed = by_speed;
  c.ramp_begin = by_speed ? begin.velocity : begin.position;
}

// The acceleration that a factor transmits from its input is no part of the ramp's motion: with the ramp's own jerk it
// would last long, and the ramp would drift away meanwhile.
KinematicState WithOwnAcceleration(const KinematicState& shift, const trajectory::Limits& limits) {
  const double most = std::max(limits.acceleration, limits.deceleration);
  return {shift.position, shift.velocity, std::clamp(shift.acceleration, -most, most)};
}

// Begins the ramp from `old` to the new values of `c`.
bool RampFrom(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in, const Conversion& old,
              trajectory::Planner& planner, Conversion& c) {
  const KinematicState shift = Difference(Convert(old, Earlier(cycle), in.before), Law(c, in.before));
  if (!target.with_master)
    return BeginProfile(WithOwnAcceleration(shift, target.ramps), target.ramps, cycle, planner, c.ramp);
  if (old.ramp.kind == RampKind::kWithMaster && old.factor == c.factor) {
    return MoveZero(Law(old, in.before).position - Law(c, in.before).position, planner, c.ramp);
  }
  return BeginWithMaster(shift, RideOf(target, in, c), planner, c.ramp);
}

// Ramps the difference of the outputs under the old and the new law to zero.
void TakeRamped(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in, const Conversion& old,
                trajectory::Planner& planner, Conversion& c) {
  if (!RampFrom(target, cycle, in, old, planner, c)) {
    c = old;
    return;
  }
  NoteRamp(cycle, in, old, false, c);
}

// Only the velocity changes: the position at the end of its ramp becomes the reference.
void RampSlope(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in, const Conversion& old,
               trajectory::Planner& planner, Conversion& c) {
  const KinematicState was = Convert(old, Earlier(cycle), in.before);
  const KinematicState shift = WithOwnAcceleration(Difference(was, Law(c, in.before)), target.ramps);
  double begin = 0;
  const bool good = target.with_master ? BeginSpeedWithMaster(shift, RideOf(target, in, c), planner, begin, c.ramp)
                                       : BeginSpeed(shift, target.ramps, cycle, planner, begin, c.ramp);
  if (!good) {
    c = old;
    return;
  }
  c.out_zero += was.position - begin - Law(c, in.before).position;
  NoteRamp(cycle, in, old, true, c);
}

// A ramp with the master relies on the factor of the motion to which it is added: a smaller factor must wait for its
// end.
bool MustWait(const Conversion& c, double factor) {
  return c.ramp.kind == RampKind::kWithMaster && factor < c.factor;
}

ScalingMode ModeOf(const ConversionTarget& target) {
  return target.with_master && target.scaling_mode == ScalingMode::kAbsolute ? ScalingMode::kRampAbsolute
                                                                             : target.scaling_mode;
}

void TakeFactor(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in,
                trajectory::Planner& planner, Conversion& c) {
  const Conversion old = c;
  switch (ModeOf(target)) {
    case ScalingMode::kXZero:
      return;
    case ScalingMode::kAbsolute:
      CountFrom(target.absolute_zero, c);
      c.factor = target.factor;
      return;
    case ScalingMode::kRelative:
      if (MustWait(c, target.factor)) return;
      CountFrom(in.before.position, c);
      c.factor = target.factor;
      return;
    case ScalingMode::kRampAbsolute:
      CountFrom(target.absolute_zero, c);
      c.factor = target.factor;
      return TakeRamped(target, cycle, in, old, planner, c);
    case ScalingMode::kRampRelative:
      CountFrom(in.before.position, c);
      c.factor = target.factor;
      return RampSlope(target, cycle, in, old, planner, c);
  }
}

void TakeOffset(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in, bool ramped,
                trajectory::Planner& planner, Conversion& c) {
  const Conversion old = c;
  c.offset = target.offset;
  if (ramped) TakeRamped(target, cycle, in, old, planner, c);
}

}  // namespace

KinematicState Convert(const Conversion& c, const Cycle& cycle, const KinematicState& in) noexcept {
  KinematicState out = Law(c, in);
  if (c.ramp.kind == RampKind::kNone) return out;
  const KinematicState shift = At(c.ramp, cycle);
  return {out.position + shift.position, out.velocity + shift.velocity, out.acceleration + shift.acceleration};
}

double InverseOf(const Conversion& c, double out) noexcept {
  return c.factor == 0 ? c.in_zero : c.in_zero + (out - c.out_zero - c.offset) / c.factor;
}

void CountFrom(double in_zero, Conversion& c) noexcept {
  c.out_zero += c.factor * (in_zero - c.in_zero);
  c.in_zero = in_zero;
}

void EndRamp(const Cycle& cycle, Conversion& c) noexcept {
  if (c.ramp.kind == RampKind::kNone || !IsOver(c.ramp, cycle)) return;
  c.ramp.kind = RampKind::kNone;
  c.offset_left = c.factor_left = 0;
}

void Approach(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in,
              trajectory::Planner& planner, Conversion& c) noexcept {
  if (target.factor != c.factor) TakeFactor(target, cycle, in, planner, c);
  if (target.offset == c.offset) return;
  if (target.offset_mode != OffsetMode::kXZero) {
    TakeOffset(target, cycle, in, target.with_master || target.offset_mode == OffsetMode::kRampIn, planner, c);
  }
}

void ApproachAtZero(const ConversionTarget& target, double at, const Cycle& cycle, const ConversionInputs& in,
                    trajectory::Planner& planner, Conversion& c) noexcept {
  if (target.scaling_mode == ScalingMode::kXZero && target.factor != c.factor && !MustWait(c, target.factor)) {
    CountFrom(at, c);
    c.factor = target.factor;
  }
  if (target.offset_mode == OffsetMode::kXZero && target.offset != c.offset) {
    TakeOffset(target, cycle, in, target.with_master, planner, c);
  }
}

double OffsetInForce(const Conversion& c, const Cycle& cycle) noexcept {
  if (c.ramp.kind == RampKind::kNone || c.offset_left == 0) return c.offset;
  if (c.factor_left == 0 && !c.by_speed) return c.offset + At(c.ramp, cycle).position;
  return c.offset + c.offset_left * ShareLeft(c, cycle);
}

double FactorInForce(const Conversion& c, const Cycle& cycle, const KinematicState& in) noexcept {
  if (c.ramp.kind == RampKind::kNone || c.factor_left == 0) return c.factor;
  const KinematicState shift = At(c.ramp, cycle);
  const double from_zero = in.position - c.in_zero;
  double left = 0;
  if (c.offset_left == 0 && c.by_speed && in.velocity != 0) {
    left = shift.velocity / in.velocity;
  } else if (c.offset_left == 0 && !c.by_speed && from_zero != 0) {
    left = shift.position / from_zero;
  } else {
    left = c.factor_left * ShareLeft(c, cycle);
  }
  return c.factor + std::clamp(left, std::min(c.factor_left, 0.0), std::max(c.factor_left, 0.0));
}

void describe(Description<Conversion>& d) {
  using C = Conversion;
  d.about("Scaling and offset.");
  d.internal<&C::factor>(unit::one, "Factor in force.");
  d.internal<&C::offset>("Offset in force.");
  d.internal<&C::in_zero>("Input from which the factor counts.");
  d.internal<&C::out_zero>("Output at that input, without offset.");
  d.internal<&C::ramp>("Ramp from the values in force before.");
  d.internal<&C::offset_left>("Difference of the offset at the begin of the ramp.");
  d.internal<&C::factor_left>(unit::one, "Difference of the factor at the begin of the ramp.");
  d.internal<&C::by_speed>("The ramp blends the velocity only.");
  d.internal<&C::ramp_begin>("Shift at the begin of the ramp; its velocity if by_speed.");
}

}  // namespace takt::flexcam
