#include "takt/conveyor/belt.h"

#include <cmath>
#include <limits>

namespace takt::conveyor {

namespace {

// Returns the state of the axis, over all turns, in the belt's unit.
KinematicState OfAxis(const Context& c) {
  const KinematicState& x = IsMeasured(c.params) ? c.axis.actual : c.axis.setpoint;
  const double ratio = c.params.ratio;
  return {ratio * (x.position + c.axis.origin), ratio * x.velocity, ratio * x.acceleration};
}

trajectory::TrackingFilter Filter(const Context& c) {
  const double increments = c.axis_params.encoder.increments_per_unit;
  return FilterOf(c.params, increments > 0 ? std::abs(c.params.ratio) / increments : 0, c.cycle.period_s);
}

KinematicState Travelled(const Context& c, State& s) {
  const double period = c.cycle.period_s;
  const bool lost = IsMeasured(c.params) ? !axis::IsKnown(c.axis, c.params.source) : c.axis.encoder_error;
  if (lost && s.started) {
    s.filter.running = false;  // the position may jump when it is known again
    return {s.travel.position + period * s.travel.velocity, s.travel.velocity, 0};
  }
  s.started = true;
  const KinematicState x = OfAxis(c);
  const trajectory::TrackingFilter filter = Filter(c);
  if (IsMeasured(c.params) || filter.filter_s > 0) {
    return trajectory::Track(filter, period, x.position, x.velocity, s.filter);
  }
  const double dead_time = filter.dead_time_s;
  return {x.position + dead_time * (x.velocity + 0.5 * dead_time * x.acceleration),
          x.velocity + dead_time * x.acceleration, x.acceleration};
}

// Returns true if the object has left the range, or has waited for its pose for too long.
bool IsGone(const BeltParams& p, const State& s, const Object& object) {
  switch (object.state) {
    case ObjectState::kDetected:
      return p.forget_after && std::abs(s.travel.position - object.latch) > *p.forget_after;
    case ObjectState::kVisible:
      return p.upper_limit && PlaceOf(p, s, object) > *p.upper_limit;
    default:
      return false;
  }
}

}  // namespace

void Step(const Context& c, State& s) noexcept {
  s.known = axis::IsKnown(c.axis, c.params.source);
  s.travel = Travelled(c, s);
  if (s.travel.velocity != 0) s.sense = s.travel.velocity > 0 ? 1 : -1;
  for (std::uint32_t i = s.count; i-- > 0;) {
    if (IsGone(c.params, s, s.objects[i])) Lose(s.objects[i].number, s);
  }
}

double TravelAt(const Context& c, const State& s, double position) noexcept {
  const double ratio = c.params.ratio;
  double there = position + c.axis.origin;
  if (const double turn = c.axis_params.turn(); turn > 0) {
    const double now = s.travel.position / ratio;
    // The delay of the filtered travel must not count as a whole turn.
    const double ahead_s = Filter(c).filter_s + c.params.dead_time_s + 2 * c.cycle.period_s;
    const double slack = std::abs(s.travel.velocity / ratio) * ahead_s + 1e-9 * turn;
    const bool upwards = (s.sense > 0) == (ratio > 0);
    const double turns = upwards ? std::floor((now + slack - there) / turn) : std::ceil((now - slack - there) / turn);
    there += turns * turn;
  }
  return ratio * there;
}

void Publish(const Context& c, const State& s, Outputs& out) noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  out = {};
  out.position = s.travel.position;
  out.velocity = s.travel.velocity;
  out.acceleration = s.travel.acceleration;
  out.known = s.known;
  out.object_count = s.count;
  for (const Object& object : ObjectsOf(s)) {
    out.visible_count += object.state != ObjectState::kDetected ? 1 : 0;
    out.taken_count += object.state == ObjectState::kTaken ? 1 : 0;
    out.in_range_count += InRange(c.params, s, object) ? 1 : 0;
  }
  out.last_number = s.last_number;
  out.lost_count = s.lost;
  out.refused_count = s.refused;
  out.first_pose = {kNone, kNone, kNone, kNone, kNone, kNone};
  out.first_quality = out.first_place = out.first_time_left = kNone;
  if (const Object* first = FirstFree(c.params, s)) {
    out.first_number = first->number;
    out.first_kind = first->attributes.kind;
    out.first_colour = first->attributes.colour;
    out.first_quality = first->attributes.quality;
    out.first_place = PlaceOf(c.params, s, *first);
    out.first_time_left = TimeLeft(c.params, s, *first);
    out.first_pose = kinematics::ToPose(PoseOf(c.params, s, *first).GetFrame());
  }
}

}  // namespace takt::conveyor
