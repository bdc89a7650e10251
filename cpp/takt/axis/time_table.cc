#include "takt/axis/time_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

using trajectory::Limits;
using trajectory::Profile;

namespace {

// The scaled table of a request over the time since its start.
struct Curve {
  const cam::Table& table;
  const TableRequest& request;

  double duration() const { return request.time_scale * table.length(); }  // [s]
  cam::Value At(double t) const {
    const cam::Value at = table.At(table.begin() + t / request.time_scale);
    const double slope = request.scale / request.time_scale;
    return {request.scale * at.y + request.offset, slope * at.dy, slope / request.time_scale * at.ddy,
            slope / (request.time_scale * request.time_scale) * at.dddy};
  }
};

Curve CurveOf(const Context& c, const Request& r) {
  return {c.machine.cams[r.table.index], r.table};
}

struct Range {
  double low, high;
};

Range RangeOf(const Curve& curve) {
  const double a = curve.request.scale * curve.table.lowest() + curve.request.offset;
  const double b = curve.request.scale * curve.table.highest() + curve.request.offset;
  return {std::min(a, b), std::max(a, b)};
}

// Gauss' formula with four points: exact for tables of the fifth degree, and for their second integral.
struct Node {
  double at, weight;  // over 0 to 1
};
constexpr std::array kNodes = {
    Node{0.06943184420297371239, 0.17392742256872692869}, Node{0.33000947820757186760, 0.32607257743127307131},
    Node{0.66999052179242813240, 0.32607257743127307131}, Node{0.93056815579702628761, 0.17392742256872692869}};

// Velocity and position that a table of velocities (accelerations) adds from `from` to `to`, both within it.
struct Added {
  double velocity, position;
};
Added Integral(const Curve& curve, bool accelerations, double from, double to) {
  Added sum = {0, 0};
  const double h = to - from;
  for (const Node& node : kNodes) {
    const double y = curve.At(from + node.at * h).y;
    sum.velocity += accelerations ? node.weight * h * y : 0;
    sum.position += node.weight * h * (accelerations ? (1 - node.at) * h : 1) * y;
  }
  return sum;
}

KinematicState PositionDemand(const Curve& curve, double t, const State& s) {
  const cam::Value at = curve.At(std::min(t, curve.duration()));
  const double position = s.time_table.turns + at.y;
  return t < curve.duration() ? KinematicState{position, at.dy, at.ddy} : KinematicState{position, 0, 0};
}

// Returns the demand of a table of velocities or accelerations, integrated from that of the previous cycle.
KinematicState SummedDemand(const Context& c, const Curve& curve, double t, const State& s) {
  const KinematicState& before = s.time_table.demand;
  const bool accelerations = s.active.kind == RequestKind::kAccelerationProfile;
  const double end = curve.duration();
  const double from = std::clamp(t - c.cycle.period_s, 0.0, end);
  const double to = std::min(t, end);
  const double rest = std::min(t - to, c.cycle.period_s);  // beyond the end
  const Added added = Integral(curve, accelerations, from, to);
  KinematicState demand;
  const cam::Value at = curve.At(to);
  demand.velocity = accelerations ? before.velocity + added.velocity : at.y;
  demand.acceleration = t >= end ? 0 : accelerations ? at.y : at.dy;
  demand.position = before.position + (accelerations ? before.velocity * (to - from) : 0) + added.position;
  if (t >= end) demand.velocity = std::clamp(demand.velocity, -c.params.limits.velocity, c.params.limits.velocity);
  demand.position += rest * demand.velocity;
  return demand;
}

template <typename T>
bool Table(const RequestBuilder& m, RequestKind kind, const T& c, const char* scale_field, double scale) {
  m.r.kind = kind;
  m.r.buffer_mode = c.buffer_mode;
  m.r.velocity = m.params.limits.velocity;
  m.r.table = {.name = c.profile, .index = kNoTable, .time_scale = c.time_scale, .scale = scale, .offset = c.offset};
  if (c.profile.empty()) m.why.field = "profile";
  return !c.profile.empty() && m.In("time_scale", c.time_scale, 1 / kMaxPosition, kMaxPosition) &&
         m.In(scale_field, scale, -kMaxPosition, kMaxPosition) &&
         m.In("offset", c.offset, -kMaxPosition, kMaxPosition) && m.Ramps(MoveVelocity{});
}

}  // namespace

bool Fill(const RequestBuilder& m, const PositionProfile& c) {
  return Table(m, RequestKind::kPositionProfile, c, "position_scale", c.position_scale);
}
bool Fill(const RequestBuilder& m, const VelocityProfile& c) {
  return Table(m, RequestKind::kVelocityProfile, c, "velocity_scale", c.velocity_scale);
}
bool Fill(const RequestBuilder& m, const AccelerationProfile& c) {
  return Table(m, RequestKind::kAccelerationProfile, c, "acceleration_scale", c.acceleration_scale);
}

Status MayFollowTable(const Context& c, const Request& r, const State& s) noexcept {
  const Range range = RangeOf(CurveOf(c, r));
  if (r.kind == RequestKind::kPositionProfile) {
    if (c.params.requires_reference && !s.homing.homed) return Status::Failed(ErrorId::kNoReference);
    const bool inside = Inside(c.params.limits, range.low) && Inside(c.params.limits, range.high);
    return inside ? Status::Ok() : Status::Failed(ErrorId::kTargetBehindLimit);
  }
  const Limits own = c.params.planner_limits();
  const double limit =
      r.kind == RequestKind::kVelocityProfile ? own.velocity : std::max(own.acceleration, own.deceleration);
  const double most = limit + Rounding(limit);
  const bool inside = range.low >= -most && range.high <= most;
  return inside ? Status::Ok() : Status::Failed(ErrorId::kParameter);
}

void BeginTable(const Context& c, const Request& r, const MotionStart& start, State& s) noexcept {
  const Curve curve = CurveOf(c, r);
  Grant(c, r, s, curve.duration());
  StartMotion(Profile{s.setpoint}, s.setpoint.position, start, s);
  s.limited_by = LimitedBy::kNothing;
  TimeTableState& k = s.time_table;
  k = TimeTableState{};
  const double own = s.setpoint.position + s.origin;
  const double turn = c.params.turn();
  k.turns = s.origin + (turn == 0 ? 0 : turn * std::round((own - s.origin - curve.At(0).y) / turn));
  k.demand = {own, s.setpoint.velocity, s.setpoint.acceleration};
  k.chase.in_step = true;  // until the first demand shows otherwise
  Enter(s, RulesOf(r.kind).state);
}

void UpdateTable(const Context& c, const Request& r, State& s) noexcept {
  const double stretch = r.table.time_scale / s.active.table.time_scale;
  const Curve curve = CurveOf(c, r);
  // Continues at the same point of the table; a table that is over continues at its end.
  const double elapsed = s.time_table.over ? curve.duration() : stretch * (Elapsed(c, s) - c.cycle.period_s);
  Grant(c, r, s, std::max(0.0, curve.duration() - elapsed));
  MotionStart start = FromCycleBefore(c);
  start.offset_s = elapsed;
  StartMotion(Profile{s.setpoint}, s.setpoint.position, start, s);
  s.time_table.over = false;
}

bool FollowTime(const Context& c, State& s) noexcept {
  TimeTableState& k = s.time_table;
  if (k.over) return false;
  const Curve curve = CurveOf(c, s.active);
  const double t = Elapsed(c, s);
  const bool positions = s.active.kind == RequestKind::kPositionProfile;
  KinematicState demand = positions ? PositionDemand(curve, t, s) : SummedDemand(c, curve, t, s);
  k.demand = demand;
  demand.position -= s.origin;
  if (positions) demand.position += k.chase.offset;
  const trajectory::DemandFollower chaser = {c.params.planner_limits(), c.planner, s.active.limits(), c.cycle.period_s};
  s.setpoint = FollowDemand(chaser, positions ? trajectory::DemandMode::kPosition : trajectory::DemandMode::kVelocity,
                            s.setpoint, demand, k.chase);
  s.limited_by = Beyond(c.params.planner_limits(), demand, k.chase.in_step);
  if (t >= curve.duration() && k.chase.in_step) {
    k.over = true;
    StartMotion(Profile{s.setpoint}, s.setpoint.position, FromThisCycle(c), s);
  }
  return true;
}

void describe(Description<TimeTableState>& d) {
  using T = TimeTableState;
  d.about("A table over time that an axis follows.");
  d.internal<&T::chase>("State of the follower that keeps the limits.");
  d.internal<&T::turns>(unit::u, "Position 0 of the table's turn, over all turns.");
  d.internal<&T::demand>("Demand of the table in the previous cycle.");
  d.internal<&T::over>("The end of the table was reached.");
}

void describe(Description<TableRequest>& d) {
  using T = TableRequest;
  d.about("A table and its scaling.");
  d.internal<&T::name>("Name of the table.");
  d.internal<&T::index>("Index among the machine's cams.");
  d.internal<&T::time_scale>("Factor of the duration.");
  d.internal<&T::scale>("Factor of the values.");
  d.internal<&T::offset>("Offset added to the scaled values.");
}

}  // namespace takt::axis
