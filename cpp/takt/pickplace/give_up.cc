// Gives up a pick in time: the tool is never left low over the belt, where the following workpieces pass (PP-44).
#include <cmath>
#include <limits>
#include <optional>

#include "takt/group/plan.h"
#include "takt/group/rise.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

constexpr double kUp = 1e-6;   // [mm]
constexpr double kLetsGo = 8;  // times the braking distance along the path, at most, for a tool that leaves its belt

kinematics::Frame ToolFrom(const Context& c, const group::State& g, const Place& place) {
  return group::SystemFrame(c.group, g, place.system, place.pcs - 1).Inverse() * group::Present(c.group, g).tool;
}

// Returns the arc length on the path at which the way down begins, in step with the workpiece; infinite if it is not
// planned.
double WayDown(const Context& c, const Order& order) {
  const group::LookAhead& ahead = c.group.ahead;
  for (std::uint64_t i = ahead.first; i < ahead.end(); ++i) {
    if (ahead[i].move == order.last) return ahead[i].begin;
  }
  return std::numeric_limits<double>::infinity();
}

// Returns true if the tool is on the way up from the belt on which the order began.
bool Lifts(const group::State& g, const Order& order) {
  return order.from_belt && g.done <= order.first && !order.profile.legs[0].turns;
}

bool Lowers(const Order& order) {
  const Profile& profile = order.profile;
  return order.belt != 0 && profile.count > 1 && !profile.legs[profile.count - 1].turns;
}

bool ParkingLifts(const group::State& g, const State& s) {
  return s.parking && s.parking_lifts && g.done < s.parking_move;
}

// Returns the point below which the tool is low, or may be low when it comes to rest; nothing if there is none.
std::optional<Place> PointOver(const group::State& g, const Order& order) {
  if (Lifts(g, order)) return order.profile.legs[0].to;
  if (!Lowers(order)) return std::nullopt;
  return order.profile.legs[order.profile.count - 2].to;
}

// Gives the move up to `over`, in step.
ErrorId GiveLift(const Context& c, group::State& g, const State& s) {
  const PathRamps& ramps = s.lifting_ramps;
  return Tell(c,
              group::MoveLinearAbsolute{.z = s.over.pose.z,
                                        .coordinate_system = s.over.system,
                                        .pcs = s.over.pcs,
                                        .velocity = ramps.velocity,
                                        .acceleration = ramps.acceleration,
                                        .deceleration = ramps.deceleration,
                                        .jerk = ramps.jerk},
              g);
}

bool IsUnderWay(const State& s) {
  return s.order_count > 0 && (s.orders[0].phase == Phase::kGoing || s.orders[0].phase == Phase::kStaying);
}

}  // namespace

void NoteHeight(const group::State& g, State& s) noexcept {
  if (s.lifting) {
    s.may_be_low = true;
    s.over_now = s.over;
  } else if (IsUnderWay(s)) {
    const std::optional<Place> over = PointOver(g, s.orders[0]);
    s.may_be_low = over.has_value();
    if (over) s.over_now = *over;
  } else if (s.parking) {
    s.may_be_low = ParkingLifts(g, s);
    if (s.may_be_low) s.over_now = s.parking_over;
  }
}

// If braked now, the tool would rest in step with the carrier over which it is low.
bool IsLow(const Context& c, const group::State& g, const State& s) noexcept {
  if (!g.begun || g.ends || g.interrupted || g.lets_go || !group::IsOnCarrier(c.group, g)) return false;
  if (ParkingLifts(g, s)) return true;
  if (s.at_known && s.at_belt != 0 && g.queue.count == 0) return s.may_be_low;  // on its workpiece
  if (!IsUnderWay(s)) return false;
  const Order& order = s.orders[0];
  if (Lifts(g, order)) return true;
  // A tool that leaves its belt may need more.
  const double place = g.pace.raw.position, rest = group::RestAt(c.group, g);
  return Lowers(order) && place + kLetsGo * (rest - place) >= WayDown(c, order);
}

void ComeToRest(const Context& c, const PathRamps& ramps, group::State& g, State& s) noexcept {
  if (s.lifting) return;
  const bool low = IsLow(c, g, s);
  const std::uint32_t belt = s.at_belt != 0 ? s.at_belt : s.parked_at;
  LosePath(c, false, s);
  if (!low) return HaltGroup(c, g, s);
  // A moving tool is braked in step and rises meanwhile; IsLifted gives the rest of the way up.
  const bool moves = g.pace.now.velocity > 0 || s.over.system != group::CoordinateSystem::kPcs;
  s.lifting_ramps = ramps;
  if (moves) {
    const group::MoveLinearRelative stay{.z = 0, .coordinate_system = s.over.system, .pcs = s.over.pcs};
    if (Tell(c, stay, g) != ErrorId::kNone) return HaltGroup(c, g, s);
    group::BeginRise({ramps.velocity, ramps.acceleration, ramps.deceleration, ramps.jerk}, s.over.pose.z, g);
    s.rises = true;
  } else if (GiveLift(c, g, s) != ErrorId::kNone) {
    return HaltGroup(c, g, s);
  }
  s.lifting = true;
  s.at = s.over;
  s.at_belt = belt;
}

void StepLift(const Context& c, group::State& g, State& s) noexcept {
  if (!s.lifting || !IsLifted(c, g, s)) return;
  const std::uint32_t belt = s.at_belt;
  ForgetPlace(s);
  s.at_belt = belt;  // parks there if nothing else is to be done
  if (IsOn(c, g) && !IsFree(c, g)) HaltGroup(c, g, s);
}

double RiseTo(const Context& c, const group::State& g, const Place& over) noexcept {
  return std::max(0.0, over.pose.z - ToolFrom(c, g, over).p.z());
}

double TimeToGo(const Context& c, const group::State& g, const Order& order, const State& s) noexcept {
  const double known_s = group::TimeLeft(c.group, g);
  if (!std::isnan(known_s)) return known_s;
  // The path is being planned, or was stopped.
  const group::LookAhead& ahead = c.group.ahead;
  const double way = g.begun && ahead.count > 0 ? ahead[ahead.end() - 1].end() - g.pace.now.position : 0;
  const double stopped_s = TimeFor(std::max(0.0, way), order.ramps);
  return std::max(TimeFactor(g, s) * order.expected_s - ElapsedTime(c, order), TimeFactor(g, s) * stopped_s);
}

void GiveUp(const Context& c, group::State& g, State& s) noexcept {
  Order& order = s.orders[0];
  if (const double left_s = group::TimeLeft(c.group, g); !std::isnan(left_s)) {
    Learn(ElapsedTime(c, order) + left_s, order, s);
  }
  const PathRamps ramps = order.ramps;
  GiveBackWorkpiece(c, order);
  ComeToRest(c, ramps, g, s);
}

bool IsLifted(const Context& c, group::State& g, State& s) noexcept {
  if (g.queue.count > 0) return false;
  const bool sits = !g.ends && group::IsOnCarrier(c.group, g);
  if (s.rises && sits) {
    s.rises = false;
    if (RiseTo(c, g, s.over) > kUp && GiveLift(c, g, s) == ErrorId::kNone) return false;
  }
  s.lifting = s.rises = false;
  if (!sits) {
    s.at_belt = 0;
    return true;
  }
  s.at.pose = kinematics::ToPose(ToolFrom(c, g, s.at));
  s.at.aux1 = PresentPlace(c, g).aux1;
  s.at_known = true;
  return true;
}

}  // namespace takt::pickplace
