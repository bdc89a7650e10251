#include "takt/axis/following.h"

#include <cmath>

#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

// Positions of the master over all turns.
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
    return "expected no lower and upper: an axis that follows goes where its master goes";
  }
  const char* what = nullptr;
  if (!Reaches(own.velocity, ratio, its.velocity)) what = "velocity";
  if (!Reaches(own.acceleration, ratio, its.acceleration)) what = "acceleration";
  if (!Reaches(own.deceleration, ratio, its.deceleration)) what = "deceleration";
  if (own.jerk != 0 && (its.jerk == 0 || !Reaches(own.jerk, ratio, its.jerk))) what = "jerk";
  if (!what) return {};
  return std::string("expected a limit of ") + what + " not below that of axis " + master.name + " times the ratio";
}

bool Follow(const Context& c, State& s) noexcept {
  if (!c.params.follows || !c.master) return false;
  const State& master = *c.master;
  const double ratio = c.params.follows->ratio;
  if (!s.coupled && s.plc == PlcState::kStandstill && master.loop_closed && AtRest(master) && master.motion.arrived) {
    s.coupled = true;
    s.follow_offset = s.setpoint.position + s.origin - ratio * Total(master);
    Enter(s, PlcState::kSynchronizedMotion);
  }
  if (!s.coupled) return false;
  if (s.plc != PlcState::kSynchronizedMotion) {  // a fault or power off has taken over
    s.coupled = false;
    return false;
  }
  if (!master.loop_closed) {  // nothing to follow any more: come to rest
    s.coupled = false;
    ComeToRest(c, c.params.planner_limits(), FromCycleBefore(c), s);
    return false;
  }
  s.setpoint = {ratio * Total(master) + s.follow_offset - s.origin, ratio * master.setpoint.velocity,
                ratio * master.setpoint.acceleration};
  if (!AtRest(s)) s.motion.arrived_cycle = c.cycle.count;
  return true;
}

}  // namespace takt::axis
