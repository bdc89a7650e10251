#include "takt/group/rise.h"

#include <algorithm>

#include "takt/group/carrier_bindings.h"
#include "takt/group/members.h"
#include "takt/group/run.h"

namespace takt::group {

namespace {

constexpr double kShare = 0.7;    // of the limits; the path is braked with the rest
constexpr double kLook_s = 0.06;  // [s] over which the descent of the path is anticipated

}  // namespace

void BeginRise(const trajectory::Limits& limits, double height, State& s) noexcept {
  s.rise = {};
  s.rise.used = true;
  s.rise.height = height;
  s.rise.velocity = limits.velocity;
  s.rise.acceleration = kShare * limits.acceleration;
  s.rise.jerk = kShare * limits.jerk;
}

bool RiseStands(const State& s) noexcept {
  return !s.rise.used || (s.rise.offset.velocity == 0 && s.rise.offset.acceleration == 0);
}

void StepRise(const Context& c, const Stretch& stretch, kinematics::MovingFrame& tool, State& s) noexcept {
  Rise& rise = s.rise;
  if (!rise.used) return;
  const CarrierBinding& to = c.ahead.rides[stretch.to_ride % kRides];
  const CarrierBinding& ride = Moves(to) ? to : c.ahead.rides[stretch.from_ride % kRides];
  if (!Moves(ride)) return;
  const MovingFrame object = PlaceOf(c, ride.cargo);
  const KDL::Vector up = object.M.R.UnitZ();
  const double height = KDL::dot(up, tool.p.p - object.p.p);
  const double change = KDL::dot(up, tool.p.v - object.p.v);
  rise.target = std::max(rise.target, rise.height - height - std::min(0.0, kLook_s * change));
  if (rise.offset.position != rise.target || !RiseStands(s)) {
    std::size_t place = 0;
    while (s.members[place] == 0) ++place;
    const trajectory::Limits limits = {rise.velocity, rise.acceleration, rise.acceleration, rise.jerk};
    trajectory::Profile profile;
    if (!ContextOf(c, s, place).planner.ToPosition(rise.offset, rise.target, 0, limits, profile).failed()) {
      const double period = c.cycle.period_s;
      rise.offset = profile.duration() > period ? profile.At(period) : KinematicState{rise.target, 0, 0};
    }
  }
  tool.p.p += rise.offset.position * up;
  tool.p.v += rise.offset.velocity * up;
  tool.p.dv += rise.offset.acceleration * up;
}

}  // namespace takt::group
