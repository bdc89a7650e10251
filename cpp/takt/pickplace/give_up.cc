// A pick is given up in time: the tool is never left low over the belt, in the way of what comes (PP-44).
#include <cmath>
#include <limits>
#include <optional>

#include "takt/group/plan.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

kinematics::Frame ToolFrom(const Context& c, const group::State& g, const Place& place) {
  return group::SystemFrame(c.group, g, place.system, place.pcs - 1).Inverse() * group::Present(c.group, g).tool;
}

// Along the path, where the tool comes to rest if it is braked now.
double RestOf(const group::State& g, const Order& order) {
  const double v = g.pace.raw.velocity;
  return g.pace.raw.position + 0.5 * v * v / order.ramps.deceleration;
}

// Along the path, where the way down begins, in step with the workpiece.
double WayDown(const Context& c, const Order& order) {
  const group::LookAhead& ahead = c.group.ahead;
  for (std::uint64_t i = ahead.first; i < ahead.end(); ++i) {
    if (ahead[i].move == order.last) return ahead[i].begin;
  }
  return std::numeric_limits<double>::infinity();
}

// The point over what the tool is low on, or will be before it is braked; nothing: it is on the way across.
std::optional<Place> PointOver(const Context& c, const group::State& g, const Order& order) {
  const Profile& profile = order.profile;
  const std::uint64_t leg = g.done > order.first ? g.done - order.first : 0;
  if (leg == 0 && !profile.legs[0].turns) return profile.legs[0].to;
  const bool lowers = profile.count > 1 && !profile.legs[profile.count - 1].turns;
  if (!lowers || RestOf(g, order) < WayDown(c, order)) return std::nullopt;
  return profile.legs[profile.count - 2].to;
}

}  // namespace

double TimeToGo(const Context& c, const group::State& g, const Order& order, const State& s) noexcept {
  const double known_s = group::TimeLeft(c.group, g);
  if (!std::isnan(known_s)) return known_s;
  // It is being planned, or was stopped.
  const group::LookAhead& ahead = c.group.ahead;
  const double way = g.begun && ahead.count > 0 ? ahead[ahead.end() - 1].end() - g.pace.now.position : 0;
  const double stopped_s = TimeFor(std::max(0.0, way), order.ramps);
  return std::max(LongerBy(s) * order.expected_s - TimeGone(c, order), LongerBy(s) * stopped_s);
}

void GiveUp(const Context& c, group::State& g, State& s) noexcept {
  Order& order = s.orders[0];
  if (const double left_s = group::TimeLeft(c.group, g); !std::isnan(left_s)) {
    Learn(TimeGone(c, order) + left_s, order, s);
  }
  const std::optional<Place> over = PointOver(c, g, order);
  const std::uint32_t belt = order.belt;
  const PathRamps ramps = order.ramps;
  GiveBackWorkpiece(c, order);
  LosePath(c, g, false, s);
  if (!over || !g.begun) return HaltGroup(c, g, s);
  // It is braked in step with what it is over; then it rises.
  const group::MoveLinearAbsolute lift{.z = over->pose.z,
                                       .coordinate_system = over->system,
                                       .pcs = over->pcs,
                                       .velocity = ramps.velocity,
                                       .acceleration = ramps.acceleration,
                                       .deceleration = ramps.deceleration,
                                       .jerk = ramps.jerk};
  if (Tell(c, lift, g) != ErrorId::kNone) return HaltGroup(c, g, s);
  s.lifting = true;
  s.lifting_move = g.done + g.queue.count - 1;
  s.at = *over;
  s.at_belt = belt;
}

void GiveUpAtRest(const Context& c, group::State& g, State& s) noexcept {
  const std::optional<Place> over = PointOver(c, g, s.orders[0]);
  const double rise = over ? over->pose.z - ToolFrom(c, g, *over).p.z() : 0;
  LosePath(c, g, false, s);
  HaltGroup(c, g, s);
  if (rise > 0) s.at_rise = std::max(rise, s.settings.z_start_distance);
}

bool IsLifted(const Context& c, const group::State& g, State& s) noexcept {
  if (g.queue.count > 0) return false;
  s.lifting = false;
  if (g.ends || !group::IsOnRide(c.group, g)) {
    ForgetPlace(s);
    return true;
  }
  s.at.pose = kinematics::ToPose(ToolFrom(c, g, s.at));
  s.at.aux1 = PresentPlace(c, g).aux1;
  s.at_known = true;
  s.at_rise = 0;
  return true;
}

}  // namespace takt::pickplace
