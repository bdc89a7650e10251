#include "takt/axis/following.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/coordinates.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

// Returns the set position of the master over all turns.
double Total(const State& master) {
  return master.setpoint.position + master.origin;
}

bool Reaches(double own, double ratio, double masters) {
  return own >= std::abs(ratio) * masters * (1 - 1e-12);
}

}  // namespace

std::string CannotFollow(const AxisParams& follower, const AxisParams& master) {
  const double ratio = follower.follows->ratio;
  const trajectory::Limits own = follower.planner_limits();
  const trajectory::Limits its = master.planner_limits();
  if (follower.limits.lower || follower.limits.upper) {
    return "expected no lower and upper: the position of an axis that follows is given by its master";
  }
  const char* what = nullptr;
  if (!Reaches(own.velocity, ratio, its.velocity)) what = "velocity";
  if (!Reaches(own.acceleration, ratio, its.acceleration)) what = "acceleration";
  if (!Reaches(own.deceleration, ratio, its.deceleration)) what = "deceleration";
  if (own.jerk != 0 && (its.jerk == 0 || !Reaches(own.jerk, ratio, its.jerk))) what = "jerk";
  if (!what) return {};
  return std::string("expected a limit of ") + what + " not below that of axis " + master.name + " times the ratio";
}

namespace {

// Visits all direct and indirect followers of this axis: visit(params, state, ratio to this axis).
template <typename Visit>
void ForFollowers(const Context& c, const AxisParams& leader, double ratio, const Visit& visit) {
  for (std::size_t i = 0; i < c.machine.params.size(); ++i) {
    const AxisParams& p = c.machine.params[i];
    if (!p.follows || p.follows->axis != leader.name) continue;
    const State& follower = c.machine.states[i];
    visit(p, follower, ratio * p.follows->ratio);
    if (follower.leads) ForFollowers(c, p, ratio * p.follows->ratio, visit);
  }
}

template <typename Visit>
void ForFollowers(const Context& c, const Visit& visit) {
  ForFollowers(c, c.params, 1, visit);
}

// Returns the position due by the master without a skew.
double Due(const Context& c, const State& s) {
  return c.params.follows->ratio * Total(*c.master) + s.follow_offset - s.origin;
}

// Returns true if the skew of the set points is within the tolerance and not being straightened.
bool IsStraight(const AxisParams& p, const State& s) {
  return std::abs(s.skew.commanded) <= p.follows->in_step && !s.skew.straightens;
}

void EndStraightening(const Context& c, FeedbackState end, State& s) {
  s.skew.straightens = false;
  s.skew.stops = false;
  if (s.skew.ticket != 0) Report(c, s.skew.ticket, end);
  s.skew.ticket = 0;
}

// Returns the skew of this cycle, with its derivatives.
KinematicState Skew(const Context& c, State& s) {
  if (!s.skew.straightens) return {s.skew.commanded, 0, 0};
  const double t = static_cast<double>(c.cycle.count - s.skew.start_cycle) * c.cycle.period_s;
  const KinematicState now = s.skew.way.At(t);
  s.skew.commanded = now.position;
  if (t >= s.skew.way.duration()) EndStraightening(c, FeedbackState::kDone, s);
  return now;
}

// Returns the sense in which straightening moves the axis; 0 if it has no skew.
int SenseOfStraightening(const State& s) {
  return s.skew.commanded < 0 ? 1 : s.skew.commanded > 0 ? -1 : 0;
}

bool BeginStraightening(const Context& c, double velocity, State& s) {
  trajectory::Limits limits = c.params.planner_limits();
  limits.velocity = velocity;
  if (c.planner.ToPosition({s.skew.commanded, 0, 0}, 0, 0, limits, s.skew.way).failed()) return false;
  s.skew.straightens = true;
  s.skew.start_cycle = c.cycle.count - 1;
  return true;
}

bool Couple(const Context& c, State& s) {
  const State& master = *c.master;
  if (s.plc != PlcState::kStandstill || !master.loop_closed || !AtRest(master) || !master.motion.arrived) return false;
  if (!s.skew.known) {
    s.skew.known = true;
    s.follow_offset =
        c.params.follows->offset.value_or(s.setpoint.position + s.origin - c.params.follows->ratio * Total(master));
  }
  s.skew.commanded = s.setpoint.position - Due(c, s);
  s.coupled = true;
  Enter(s, PlcState::kSynchronizedMotion);
  return true;
}

// While the master searches its reference switch this axis looks for its own. Once both are found they define the same
// position: the offset is the difference between them, and the remainder is the skew.
void WatchSquaring(const Context& c, State& s) {
  const HomingState& search = c.master->homing;
  SkewState& skew = s.skew;
  const bool searches = c.master->active.kind == RequestKind::kStepAbsSwitch && search.stage == HomingStage::kSearching;
  const bool fresh = skew.edge_cycle < search.begin_cycle;
  if (searches && fresh &&
      EndsSearch(c.master->active.homing.switch_mode, s.reference, skew.reference_before, search.sense)) {
    skew.edge = s.actual.position + s.origin;
    skew.edge_cycle = c.cycle.count;
  }
  skew.reference_before = s.reference;
  if (!s.coupled || search.found_cycle <= skew.squared_cycle || search.found_cycle != c.cycle.count) return;
  skew.squared_cycle = search.found_cycle;
  const double ratio = c.params.follows->ratio;
  const double offset = skew.edge - ratio * search.edge;
  skew.commanded += s.follow_offset - offset;  // nothing moves
  s.follow_offset = offset;
  ShiftCoordinates(ratio * c.master->setpoint.position - Due(c, s), s);  // is numbered like its master
  s.homing.renamed = ratio * c.master->homing.renamed;
  s.homing.homed = true;
  const Status status = MayMove(c, s, SenseOfStraightening(s));
  if (status.failed()) return Fail(c, status.error, false, s);
  BeginStraightening(c, 0.1 * c.params.limits.velocity, s);
}

// Brakes by itself: there is no set point to follow any more.
void Uncouple(const Context& c, State& s) {
  s.coupled = false;
  if (!s.loop_closed) return;
  if (s.plc == PlcState::kSynchronizedMotion) {
    return ComeToRest(c, c.params.planner_limits(), FromCycleBefore(c), s);
  }
  Brake(c, c.params.planner_limits(), FromCycleBefore(c), s);  // in a fault, or during power off
}

}  // namespace

bool Follow(const Context& c, State& s) noexcept {
  if (!c.master) return false;
  if (s.coupled && !c.master->loop_closed) Uncouple(c, s);
  // A fault that left the loop closed has been reset.
  if (s.coupled && s.plc == PlcState::kStandstill) Enter(s, PlcState::kSynchronizedMotion);
  if (!s.coupled && !Couple(c, s)) return false;
  const State& master = *c.master;
  const double ratio = c.params.follows->ratio;
  // A stop of either member also stops the straightening: it continues only while neither has a fault or is stopped.
  const bool stops = s.plc != PlcState::kSynchronizedMotion ||
                     (master.plc != PlcState::kStandstill && master.plc != PlcState::kHoming &&
                      master.plc != PlcState::kSynchronizedMotion);
  if (s.skew.straightens && stops) StopStraightening(c, StopLimits(c.params, s.error), s);
  const KinematicState skew = Skew(c, s);
  s.setpoint = {Due(c, s) + skew.position, ratio * master.setpoint.velocity + skew.velocity,
                ratio * master.setpoint.acceleration + skew.acceleration};
  if (!AtRest(s)) s.motion.arrived_cycle = c.cycle.count;
  const bool switches_off = s.active.kind == RequestKind::kPower && !s.active.enable;
  if (switches_off && AtRest(s)) Conclude(c, 0, s);
  return true;
}

bool InStep(const AxisParams& p, const State& s) noexcept {
  const double off = s.skew.measured - s.skew.commanded;
  return s.plc == PlcState::kSynchronizedMotion && IsStraight(p, s) &&
         std::abs(off) <= p.follows->largest_skew.value_or(HUGE_VAL);
}

void WatchSkew(const Context& c, State& s) noexcept {
  if (!c.master) return;
  SkewState& skew = s.skew;
  if (!s.loop_closed) s.coupled = false;
  if (!s.coupled && skew.straightens) EndStraightening(c, FeedbackState::kAborted, s);
  if (c.params.follows->square) WatchSquaring(c, s);
  if (!skew.known) return;
  const State& master = *c.master;
  // By actual positions, which are those of the previous cycle's set points: the master may have stepped already.
  const double due = c.params.follows->ratio * (master.actual.position + master.origin) + s.follow_offset - s.origin;
  skew.measured = s.actual.position - due;
  const auto& largest = c.params.follows->largest_skew;
  if (largest && s.coupled && std::abs(skew.measured - skew.commanded) > *largest) Fail(c, ErrorId::kSkew, false, s);
}

Status FollowersReady(const Context& c, const State& s) noexcept {
  bool ready = true;
  if (!s.leads) return Status::Ok();
  ForFollowers(c, [&](const AxisParams& p, const State& follower, double) {
    ready &= follower.coupled && follower.plc == PlcState::kSynchronizedMotion && IsStraight(p, follower);
  });
  return ready ? Status::Ok() : Status::Failed(ErrorId::kNotInStep);
}

bool FollowersFound(const Context& c, const State& s) noexcept {
  bool found = true;
  if (!s.leads) return found;
  ForFollowers(c, [&](const AxisParams& p, const State& follower, double) {
    found &= !p.follows->square || follower.skew.edge_cycle >= s.homing.begin_cycle;
  });
  return found;
}

bool FollowersSquared(const Context& c, const State& s) noexcept {
  bool straight = true;
  if (!s.leads || !s.homing.found) return straight;
  ForFollowers(c, [&](const AxisParams& p, const State& follower, double) {
    straight &= !p.follows->square || !follower.skew.straightens;
  });
  return straight;
}

bool FollowerOnLimit(const Context& c, const State& s, int sense, bool since_before) noexcept {
  bool on = false;
  if (!s.leads) return on;
  ForFollowers(c, [&](const AxisParams&, const State& follower, double ratio) {
    const bool positive = (ratio > 0) == (sense > 0);
    const bool before = positive ? follower.limit_positive_before : follower.limit_negative_before;
    on |= (positive ? follower.limit_positive : follower.limit_negative) && (before || !since_before);
  });
  return on;
}

std::uint32_t BlockingFollower(const Context& c, const State& s, int sense) noexcept {
  std::uint32_t found = kNoAxis;
  if (!s.leads) return found;
  ForFollowers(c, [&](const AxisParams&, const State& follower, double ratio) {
    const bool up = (ratio > 0) == (sense > 0);
    const bool bars =
        up ? follower.limit_positive || follower.bars_positive : follower.limit_negative || follower.bars_negative;
    if (bars && found == kNoAxis) found = static_cast<std::uint32_t>(&follower - c.machine.states.data());
  });
  return found;
}

Status MayMove(const Context& c, const State& s, int sense) noexcept {
  if (sense == 0) return Status::Ok();
  const bool own = sense > 0 ? s.limit_positive : s.limit_negative;
  if (own || FollowerOnLimit(c, s, sense)) return Status::Failed(ErrorId::kAwayFromLimitOnly);
  return Bars(c, s, sense) ? Status::Failed(ErrorId::kDirection) : Status::Ok();
}

bool FollowersStraighten(const Context& c, const State& s) noexcept {
  bool moves = false;
  if (!s.leads) return moves;
  ForFollowers(c, [&](const AxisParams&, const State& follower, double) { moves |= follower.skew.straightens; });
  return moves;
}

void StopStraightening(const Context& c, const trajectory::Limits& limits, State& s) noexcept {
  SkewState& skew = s.skew;
  if (!skew.straightens || skew.stops) return;
  const double t = static_cast<double>(c.cycle.count - skew.start_cycle) * c.cycle.period_s;
  const KinematicState before = skew.way.At(std::max(0.0, t - c.cycle.period_s));
  if (c.planner.Stop(before, limits, skew.way).failed()) skew.way = trajectory::Profile{{before.position, 0, 0}};
  skew.start_cycle = c.cycle.count - 1;
  skew.stops = true;
  const bool fails = s.error != ErrorId::kNone;
  if (skew.ticket != 0) {
    Report(c, skew.ticket, fails ? FeedbackState::kError : FeedbackState::kAborted, s.error);
  }
  skew.ticket = 0;
}

bool Bars(const Context& c, const State& s, int sense) noexcept {
  bool bars = sense > 0 ? s.bars_positive : s.bars_negative;
  if (!s.leads) return bars;
  ForFollowers(c, [&](const AxisParams&, const State& follower, double ratio) {
    bars |= (ratio > 0) == (sense > 0) ? follower.bars_positive : follower.bars_negative;
  });
  return bars;
}

bool Fill(const RequestBuilder& m, const Straighten& straighten) {
  double velocity = 0;
  return m.Take("velocity", straighten.velocity, m.params.limits.velocity, velocity);
}

Status CarryOut(const Context& c, Ticket ticket, const Straighten& straighten, State& s) noexcept {
  constexpr double kShare = 0.1;  // of the velocity limit, if none is given
  if (!c.params.follows || !c.master) return Status::Failed(ErrorId::kState);
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  const State& master = *c.master;
  const bool stands = AtRest(master) && master.active.kind == RequestKind::kNone && !master.superimposed;
  if (!s.coupled || s.plc != PlcState::kSynchronizedMotion || !stands) return Status::Failed(ErrorId::kState);
  if (s.skew.straightens) return Status::Failed(ErrorId::kState);
  if (const Status status = MayMove(c, s, SenseOfStraightening(s)); status.failed()) return status;
  if (!BeginStraightening(c, straighten.velocity.value_or(kShare * c.params.limits.velocity), s)) {
    return Status::Failed(ErrorId::kPlanning);
  }
  s.skew.ticket = ticket;
  Report(c, ticket, FeedbackState::kActive);
  return Status::Ok();
}

}  // namespace takt::axis
