#include "takt/flexcam/conversion.h"

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

WayRamp WayRampOf(const ConversionTarget& target, const KinematicState& before, const Conversion& c) {
  return {c.factor, target.ramps, target.speed, before.velocity < 0 ? -1.0 : 1.0};
}

// What the output was under the old law, as a shift that goes to zero under the new one.
void Ramped(const ConversionTarget& target, const Cycle& cycle, const KinematicState& before, const Conversion& old,
            trajectory::Planner& planner, Conversion& c) {
  const Cycle earlier = {cycle.count - 1, cycle.period_s};
  if (target.with_master) {
    KinematicState shift = OverWay(old.ramp, earlier, before);
    shift.position += Law(old, before).position - Law(c, before).position;
    shift.velocity += old.factor - c.factor;
    if (!BeginWay(shift, WayRampOf(target, before, c), before.position, planner, c.ramp)) c = old;
    return;
  }
  const KinematicState shift = Difference(Convert(old, earlier, before), Law(c, before));
  if (!BeginProfile(shift, target.ramps, cycle, planner, c.ramp)) c = old;
}

// Only the speed is to change: the place where the ramp of the speed ends is the place that counts.
void RampSpeed(const ConversionTarget& target, const Cycle& cycle, const KinematicState& before, const Conversion& old,
               trajectory::Planner& planner, Conversion& c) {
  const Cycle earlier = {cycle.count - 1, cycle.period_s};
  const KinematicState was = Convert(old, earlier, before);
  double begin = 0;
  bool good = false;
  if (target.with_master) {
    KinematicState shift = OverWay(old.ramp, earlier, before);
    shift.velocity += old.factor - c.factor;
    good = BeginWaySlope(shift, WayRampOf(target, before, c), before.position, planner, begin, c.ramp);
  } else {
    const KinematicState shift = Difference(was, Law(c, before));
    good = BeginSpeed(shift, target.ramps, cycle, planner, begin, c.ramp);
  }
  if (!good) {
    c = old;
    return;
  }
  c.out_zero += was.position - begin - Law(c, before).position;
}

// A ramp over the way of the master counts on the slope beneath it: a smaller one has to wait for its end.
bool MustWait(const Conversion& c, double factor) {
  return c.ramp.kind == RampKind::kWay && factor < c.factor;
}

void TakeFactor(const ConversionTarget& target, const Cycle& cycle, const KinematicState& before,
                trajectory::Planner& planner, Conversion& c) {
  const Conversion old = c;
  const ScalingMode mode = target.at_once ? ScalingMode::kAbsolute : target.scaling_mode;
  switch (mode) {
    case ScalingMode::kXZero:
      return;
    case ScalingMode::kAbsolute:
      if (MustWait(c, target.factor)) return;
      CountFrom(target.absolute_zero, c);
      c.factor = target.factor;
      return;
    case ScalingMode::kRelative:
      if (MustWait(c, target.factor)) return;
      CountFrom(before.position, c);
      c.factor = target.factor;
      return;
    case ScalingMode::kRampAbsolute:
      CountFrom(target.absolute_zero, c);
      c.factor = target.factor;
      return Ramped(target, cycle, before, old, planner, c);
    case ScalingMode::kRampRelative:
      CountFrom(before.position, c);
      c.factor = target.factor;
      return RampSpeed(target, cycle, before, old, planner, c);
  }
}

void TakeOffset(const ConversionTarget& target, const Cycle& cycle, const KinematicState& before,
                trajectory::Planner& planner, Conversion& c) {
  const Conversion old = c;
  const OffsetMode mode = target.at_once ? OffsetMode::kDirect : target.offset_mode;
  if (mode == OffsetMode::kXZero) return;
  c.offset = target.offset;
  if (mode == OffsetMode::kRampIn) Ramped(target, cycle, before, old, planner, c);
}

}  // namespace

KinematicState Convert(const Conversion& c, const Cycle& cycle, const KinematicState& in) noexcept {
  KinematicState out = Law(c, in);
  if (c.ramp.kind == RampKind::kNone) return out;
  const KinematicState shift = At(c.ramp, cycle, in);
  return {out.position + shift.position, out.velocity + shift.velocity, out.acceleration + shift.acceleration};
}

double InverseOf(const Conversion& c, double out) noexcept {
  return c.factor == 0 ? c.in_zero : c.in_zero + (out - c.out_zero - c.offset) / c.factor;
}

void CountFrom(double in_zero, Conversion& c) noexcept {
  c.out_zero += c.factor * (in_zero - c.in_zero);
  c.in_zero = in_zero;
}

void Approach(const ConversionTarget& target, const Cycle& cycle, const KinematicState& before,
              const KinematicState& now, trajectory::Planner& planner, Conversion& c) noexcept {
  if (c.ramp.kind != RampKind::kNone && IsOver(c.ramp, cycle, before)) c.ramp.kind = RampKind::kNone;
  if (target.factor != c.factor) TakeFactor(target, cycle, before, planner, c);
  if (target.offset != c.offset) TakeOffset(target, cycle, before, planner, c);
  if (c.ramp.kind == RampKind::kWay) TurnRound(WayRampOf(target, before, c), now.position, planner, c.ramp);
}

void ApproachAtZero(const ConversionTarget& target, double at, Conversion& c) noexcept {
  if (target.scaling_mode == ScalingMode::kXZero && target.factor != c.factor && !MustWait(c, target.factor)) {
    CountFrom(at, c);
    c.factor = target.factor;
  }
  if (target.offset_mode == OffsetMode::kXZero) c.offset = target.offset;
}

void describe(Description<Conversion>& d) {
  using C = Conversion;
  d.about("Scaling and offset.");
  d.internal<&C::factor>(unit::one, "In force.");
  d.internal<&C::offset>("In force.");
  d.internal<&C::in_zero>("Input that is counted from.");
  d.internal<&C::out_zero>("Output there, without offset.");
  d.internal<&C::ramp>("What is left of what was in force before.");
}

}  // namespace takt::flexcam
