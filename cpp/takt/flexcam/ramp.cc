#include "takt/flexcam/ramp.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

double Elapsed(const Ramp& ramp, const Cycle& cycle) {
  return (static_cast<double>(cycle.count) - static_cast<double>(ramp.start_cycle)) * cycle.period_s;
}

double WayOn(const Ramp& ramp, const KinematicState& way) {
  return ramp.sense * (way.position - ramp.way_begin);
}

// Sums are kept this far from standing still against a master that moves.
constexpr double kShare = 0.999;

trajectory::Limits OverWayLimits(const WayRamp& ramp, const Ramp& before) {
  const trajectory::Limits& l = ramp.limits;
  const double v = ramp.speed;
  double jerk = l.jerk / (v * v * v);
  // No weaker than that of the ramp it takes over from: what that one could still ease out, this one can.
  for (int i = 0; before.kind == RampKind::kWay && i < before.profile.size(); ++i) {
    jerk = std::max(jerk, std::abs(before.profile.pieces[static_cast<std::size_t>(i)].jerk));
  }
  return {std::min(kShare * ramp.slope, l.velocity / v), l.acceleration / (v * v), l.deceleration / (v * v), jerk};
}

KinematicState Turned(const KinematicState& shift, double sense) {
  return {shift.position, sense * shift.velocity, shift.acceleration};
}

}  // namespace

KinematicState At(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept {
  const double t = Elapsed(ramp, cycle);
  switch (ramp.kind) {
    case RampKind::kProfile:
      return ramp.profile.At(t);
    case RampKind::kTime:
      return t >= ramp.curve.length ? KinematicState{} : ramp.curve.At(t);
    case RampKind::kWay:
      return trajectory::AlongWay(OverWay(ramp, cycle, way), way);
    default:
      return {};
  }
}

KinematicState OverWay(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept {
  if (ramp.kind == RampKind::kWay) {
    return Turned(ramp.profile.At(WayOn(ramp, way)), ramp.sense);
  }
  const KinematicState at = At(ramp, cycle, way);
  if (way.velocity == 0) return {at.position, 0, 0};
  const double slope = at.velocity / way.velocity;
  return {at.position, slope, (at.acceleration - slope * way.acceleration) / (way.velocity * way.velocity)};
}

bool IsOver(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept {
  switch (ramp.kind) {
    case RampKind::kProfile:
      return Elapsed(ramp, cycle) >= ramp.profile.duration();
    case RampKind::kTime:
      return Elapsed(ramp, cycle) >= ramp.curve.length;
    case RampKind::kWay:
      return WayOn(ramp, way) >= ramp.profile.duration();
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

bool BeginWay(const KinematicState& shift, const WayRamp& ramp, double way, trajectory::Planner& planner,
              Ramp& out) noexcept {
  const KinematicState from = Turned(shift, ramp.sense);
  trajectory::Profile profile{from};
  if (planner.ToPosition(from, 0, 0, OverWayLimits(ramp, out), profile).failed()) return false;
  out.kind = RampKind::kWay;
  out.profile = profile;
  out.way_begin = way;
  out.sense = ramp.sense;
  return true;
}

bool BeginWaySlope(const KinematicState& shift, const WayRamp& ramp, double way, trajectory::Planner& planner,
                   double& begin, Ramp& out) noexcept {
  const KinematicState from = Turned({0, shift.velocity, shift.acceleration}, ramp.sense);
  trajectory::Profile profile{from};
  trajectory::Limits limits = OverWayLimits(ramp, out);
  limits.velocity = std::max(limits.velocity, std::abs(from.velocity));
  if (planner.ToVelocity(from, 0, limits, profile).failed()) return false;
  begin = -profile.end().position;
  profile.Shift(begin);
  out.kind = RampKind::kWay;
  out.profile = profile;
  out.way_begin = way;
  out.sense = ramp.sense;
  return true;
}

void TurnRound(const WayRamp& ramp, double way, trajectory::Planner& planner, Ramp& out) noexcept {
  if (out.kind != RampKind::kWay || out.sense * (way - out.way_begin) >= 0) return;
  WayRamp back = ramp;
  back.sense = -out.sense;
  BeginWay(Turned(out.profile.start(), out.sense), back, out.way_begin, planner, out);
}

void describe(Enumeration<RampKind>& e) {
  e.about("What a shift goes by on its way to zero.");
  e.value(RampKind::kNone, "none", "It is zero.");
  e.value(RampKind::kProfile, "profile", "Limits of its own.");
  e.value(RampKind::kTime, "time", "A quintic over a time.");
  e.value(RampKind::kWay, "way", "The same over the way of a master.");
}

void describe(Description<Ramp>& d) {
  using R = Ramp;
  d.about("A shift on its way to zero.");
  d.internal<&R::kind>("What it goes by.");
  d.internal<&R::profile>("Over time or way.");
  d.internal<&R::curve>("Over time.");
  d.internal<&R::start_cycle>("Cycle its time counts from.");
  d.internal<&R::way_begin>("Master's position where it begins.");
  d.internal<&R::sense>("In which the master goes on it.");
}

}  // namespace takt::flexcam
