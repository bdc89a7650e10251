#include "takt/group/run.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/guidance.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/jog.h"
#include "takt/group/join.h"
#include "takt/group/keep_up.h"
#include "takt/group/make_stretch.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/rise.h"
#include "takt/group/switches.h"
#include "takt/group/sync.h"
#include "takt/group/track.h"

namespace takt::group {

namespace {

// Returns the stretch at an arc length of the path, and forgets those before it.
const Stretch* GoOnTo(LookAhead& ahead, double s) {
  while (ahead.count > 1 && ahead[ahead.first].end() <= s) {
    ++ahead.first;
    --ahead.count;
  }
  return ahead.count > 0 ? &ahead[ahead.first] : nullptr;
}

constexpr double kTowardsThen = 1;   // [u/s]: a motion that comes to rest there stays below
constexpr double kTowards_s = 1e-6;  // [u/s, mm/s or rad/s]: less is rounding

// Returns true if the next set points lead towards an active limit switch; sets State::refused.
bool GoesToClosed(const Context& c, const kinematics::JointMotion& motion, const MovingFrame* tool, State& s) {
  if (s.state == GroupState::kErrorStop) return false;  // braked for a switch, along the path
  const Directions closed = ClosedNow(c, s);
  if (!closed.any()) return false;
  s.refused = TakenOf(closed, s, motion.velocity, tool, kTowards_s);
  if (s.refused.any()) return true;
  // An acceleration towards it is taken back within the jerk of the axis: by then the axis would move towards it.
  kinematics::Joints then = motion.velocity;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const double jerk = s.members[k] != 0 ? c.axes.params[s.members[k] - 1].planner_limits().jerk : 0;
    const double a = motion.acceleration[k];
    if (jerk > 0) then[k] += a * std::abs(a) / (2 * jerk);
  }
  s.refused = TakenOf(closed, s, then, nullptr, kTowardsThen);
  return s.refused.any();
}

void Demand(const Context& c, const kinematics::JointMotion& motion, State& s) {
  s.joints = motion.position;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    axis::GuidanceState& guidance = MemberOf(c, s, k).guidance;
    guidance.demand = {motion.position[k] + s.origins[k], motion.velocity[k], motion.acceleration[k]};
    guidance.comes_to_rest = s.ends || s.interrupted;
  }
}

bool FollowCarried(const Context& c, const Stretch& stretch, double way, State& s) {
  const KinematicState along = {way, s.pace.now.velocity, s.pace.now.acceleration};
  kinematics::JointMotion motion;
  MovingFrame tool = ToolNow(c, s, stretch, along);
  StepRise(c, stretch, tool, s);
  if (const auto reason = AxesFor(c, s, stretch, tool, along, s.joints, motion); reason != kinematics::Reason::kNone) {
    s.reason = reason;
    c.ahead.failures = FailuresOn(c, s, stretch, way, reason, s.joints);
    return false;
  }
  if (GoesToClosed(c, motion, &tool, s)) return false;
  Demand(c, motion, s);
  // If the tool could no longer be braked in the next cycles, it is braked now.
  if (!s.lets_go && !CanRelease(c, s)) {
    EndTracking(c, FeedbackState::kError, ErrorId::kUnreachable, s);
    AbortMoves(c, ErrorId::kUnreachable, s);
    EndMotion(c, {}, true, s);
  }
  return true;
}

bool Follow(const Context& c, State& s) {
  const KinematicState& now = s.pace.now;
  const Stretch* stretch = GoOnTo(c.ahead, now.position);
  if (!stretch) return true;
  StepClutches(c, *stretch, s);
  const double way = std::clamp(stretch->from + now.position - stretch->begin, stretch->from, stretch->to);
  if (IsCarried(c.ahead, *stretch)) return FollowCarried(c, *stretch, way, s);
  kinematics::JointMotion by_way;
  if (const auto reason = AxesOn(c, s, *stretch, way, s.joints, by_way); reason != kinematics::Reason::kNone) {
    s.reason = reason;
    c.ahead.failures = FailuresOn(c, s, *stretch, way, reason, s.joints);
    return false;
  }
  kinematics::JointMotion motion = by_way;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const KinematicState at =
        trajectory::ComposeWithMaster({by_way.position[k], by_way.velocity[k], by_way.acceleration[k]}, now);
    motion.velocity[k] = at.velocity;
    motion.acceleration[k] = at.acceleration;
  }
  if (stretch->joints) {
    if (GoesToClosed(c, motion, nullptr, s)) return false;
  } else {
    MovingFrame tool = path::At(stretch->segment, way);
    tool.p.v = tool.p.v * now.velocity;
    tool.M.w = tool.M.w * now.velocity;
    if (GoesToClosed(c, motion, &tool, s)) return false;
  }
  Demand(c, motion, s);
  return true;
}

// Returns true if the path is at the end of a move on a carrier but the tool is not: a clutch slips, or the axes lag.
bool ToolLags(const Context& c, const State& s) {
  const bool at_end = s.pace.raw_stands && c.ahead.window[s.pace.node].stop;
  const bool rides = std::ranges::any_of(s.ridden, [](std::uint32_t carrier) { return carrier != 0; });
  return at_end && rides && (s.lets_go || IsUncoupled(s) || !AreAtDemand(c, s));
}

// Reports moves whose last stretch is complete as done, and the one in execution as active.
void TellMoves(const Context& c, State& s) {
  if (c.ahead.count == 0) return;
  std::uint64_t at = c.ahead[c.ahead.first].move;
  if (at > s.done && ToolLags(c, s)) --at;
  while (s.queue.count > 0 && s.done < at) Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (s.queue.count > 0 && s.done == at && s.active != MoveAt(s, at).ticket) {
    s.active = MoveAt(s, at).ticket;
    Report(c, s.active, FeedbackState::kActive);
  }
}

double Braked(const Context& c, const trajectory::PathNode& node, const Brake& brake, const State& s) {
  double deceleration = brake.full               ? trajectory::CoordinateLimits::kNone
                        : brake.deceleration > 0 ? brake.deceleration
                                                 : node.bounds.deceleration;
  // The deceleration that builds up with this jerk within the build-up time of the path.
  if (brake.jerk > 0) deceleration = std::min(deceleration, brake.jerk * node.build_up_s);
  // What the axes have left while carriers are braked, too. Bends are accounted for by the pace.
  if (s.lets_go || IsUncoupled(s)) {
    const double square = s.pace.raw.velocity * s.pace.raw.velocity;
    deceleration = std::min(deceleration, BrakeShare(s) * node.bounds.strength.Gentle(square));
  }
  return std::max(0.0, s.pace.raw.velocity - deceleration * c.cycle.period_s);
}

double WishOf(const Context& c, State& s) {
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  if (!s.ends && !s.interrupted) {
    if (WaitsForClutch(s)) return SlowDown(c, s, Braked(c, node, {}, s));
    if (Follows(c, s)) return SlowDown(c, s, WishOfMaster(c, s));
    const double own = node.at.limits.velocity;
    const double full = own < kUnlimited ? own : std::sqrt(node.own);  // up to the limits of the axes
    if (Jogs(s)) return SlowDown(c, s, s.velocity_factor * std::min(full, JogSpeed(s)));
    return SlowDown(c, s, s.velocity_factor < 1 ? s.velocity_factor * full : trajectory::kFullSpeed);
  }
  return SlowDown(c, s, Braked(c, node, s.brake, s));
}

// Discards the nodes behind the motion.
void Forget(const Context& c, State& s) {
  trajectory::PathWindow& window = c.ahead.window;
  if (s.pace.passed > window.begin() + 1) window.DropBefore(s.pace.passed - 1);
}

}  // namespace

ErrorId TakeMembers(const Context& c, State& s) noexcept {
  if (s.guides) return ErrorId::kNone;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    axis::State& member = MemberOf(c, s, k);
    const Status status = axis::Guide(ContextOf(c, s, k), member);
    if (status.failed()) {
      ReleaseMembers(c, s);
      return status.error;
    }
    member.guidance.brakes_with_others = true;
    s.origins[k] = member.origin;
    s.joints[k] = member.setpoint.position;
  }
  s.guides = true;
  return ErrorId::kNone;
}

void ReleaseMembers(const Context& c, State& s) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    axis::EndGuidance(ContextOf(c, s, k), MemberOf(c, s, k));
  }
  s.guides = false;
}

bool IsTimed(const Context& c, const Request& move, const Stretch& stretch) noexcept {
  return move.cargo.carrier == 0 && move.master == 0 && !IsCarried(c.ahead, stretch);
}

namespace {

bool CanBeTimed(const Context& c, const State& s) {
  if (!c.params.path.planned_ahead || Jogs(s) || s.master.axis != 0 || s.track.ticket != 0) return false;
  // The moves up to the next stop.
  std::uint64_t behind = s.done + 1;
  while (behind < s.done + s.queue.count && MoveAt(s, behind).blends()) ++behind;
  // The time is known to the next stop only, and a module needs it to the end of its order. Without modules a later
  // move may blend onto a carrier.
  const bool to_the_end = c.carriers.modules;
  if (!to_the_end && std::ranges::any_of(s.cargoes, [](const CarriedTarget& cargo) { return cargo.carrier != 0; }))
    return false;
  if (to_the_end && behind == s.done + 1 && behind < s.done + s.queue.count) return false;
  for (std::uint64_t i = s.done; i < behind; ++i) {
    const Request& move = MoveAt(s, i);
    if (move.cargo.carrier != 0 || move.master != 0) return false;
  }
  for (std::uint64_t i = c.ahead.first; i < c.ahead.end() && c.ahead[i].move < behind; ++i) {
    if (IsCarried(c.ahead, c.ahead[i])) return false;
    if (to_the_end && c.ahead[i].stops && i + 1 < c.ahead.end() && c.ahead[i + 1].move < behind) return false;
  }
  return true;
}

}  // namespace

void BeginTiming(const Context& c, State& s) noexcept {
  if (CanBeTimed(c, s)) {
    c.ahead.timing.Begin(s.pace);
  } else {
    c.ahead.timing.Clear();
  }
}

bool Advance(const Context& c, State& s) noexcept {
  if (s.pace.raw_stands && trajectory::Stands(s.pace) && !s.ends) {
    // After a stop the next motion begins.
    const std::uint64_t next = s.pace.node + 1;
    const trajectory::PathWindow& window = c.ahead.window;
    // The move for which the tool boards begins meanwhile, others when it is in sync.
    const bool begins = s.pace.now.position == 0 && s.queue.count > 0 && s.boards == MoveAt(s, s.done).ticket;
    const bool boards = begins && std::ranges::any_of(s.clutches, &Clutch::boards);
    const bool waits = !boards && ToolLags(c, s);
    if (window[s.pace.node].stop && next + 1 < window.known() && window.swept() && !waits) {
      trajectory::BeginAt(window, next, c.cycle.period_s, s.pace);
      const std::uint64_t move = c.ahead[c.ahead.first].move;
      BeginFollowing(c, MoveAt(s, move), move, s);
      // A module has announced the end of its order by the timing in use when the order began.
      if (!c.carriers.modules || c.ahead.timing.active()) BeginTiming(c, s);
    }
  }
  trajectory::PathTiming& timing = c.ahead.timing;
  if (!timing.active()) {
    const double wish = WishOf(c, s);
    trajectory::Advance(c.ahead.window, wish, c.cycle.period_s, s.pace, s.ends && s.brake.full);
  } else if (s.ends || s.interrupted || s.velocity_factor == 0) {
    timing.Stop(c.ahead.window, s.brake, s.pace);
  } else {
    timing.Advance(c.ahead.window, s.velocity_factor, s.pace);
  }
  if (!Follow(c, s)) return false;
  TellMoves(c, s);
  WatchMaster(c, s);
  Forget(c, s);
  return true;
}

bool IsAtRestAtEnd(const Context& c, const State& s) noexcept {
  const trajectory::PathWindow& window = c.ahead.window;
  const bool last = s.pace.node + 1 >= window.known();
  return s.pace.raw_stands && last && window.swept() && c.ahead.sampling >= c.ahead.end();
}

bool Rests(const State& s) noexcept {
  return trajectory::Stands(s.pace) && RiseStands(s) && (!s.lets_go || ClutchesAtRest(s));
}

double RestAt(const Context& c, const State& s) noexcept {
  if (c.ahead.timing.active()) return c.ahead.timing.EstimatedStop(c.ahead.window, s.pace);
  // The mean comes to rest where the raw motion does.
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  const double v = s.pace.raw.velocity;
  const bool full = s.ends && s.brake.full;
  const double deceleration = std::min(node.bounds.Gentle(v * v, full), c.ahead.keep_up.brake);
  const double way = deceleration > 0 ? 0.5 * v * v / deceleration : kNoEnd;
  // Its acceleration is taken back first.
  const bool speeds_up = s.pace.last[s.pace.oldest].acceleration > 0 || s.pace.raw.acceleration > 0;
  return s.pace.raw.position + way + v * (speeds_up ? node.build_up_s : c.cycle.period_s);
}

const Stretch* Here(const Context& c, const State& s) noexcept {
  return c.ahead.At(s.pace.now.position);
}

bool IsOnCarrier(const Context& c, const State& s) noexcept {
  const Stretch* stretch = s.begun ? Here(c, s) : nullptr;
  if (!stretch || stretch->joints) return false;
  const double share = ShareAt(c.ahead, *stretch, stretch->from + s.pace.now.position - stretch->begin).position;
  const auto moves = [&](std::uint64_t ride) { return Moves(c.ahead.rides[ride % kRides]); };
  return (share < 1 && moves(stretch->from_ride)) || (share > 0 && moves(stretch->to_ride));
}

bool IsInTransition(const Context& c, const State& s) noexcept {
  const Stretch* stretch = Here(c, s);
  if (!stretch || stretch->from_ride == stretch->to_ride) return false;
  const double share = ShareAt(c.ahead, *stretch, stretch->from + s.pace.now.position - stretch->begin).position;
  return share > 0 && share < 1;
}

void RestOnBinding(const Context& c, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  const Stretch* stretch = Here(c, s);
  const double way = std::clamp(stretch->from + s.pace.now.position - stretch->begin, stretch->from, stretch->to);
  const std::uint64_t number = ShareAt(c.ahead, *stretch, way).position > 0 ? stretch->to_ride : stretch->from_ride;
  CarrierBinding ride = ahead.rides[number % kRides];
  ride.boarding.earliest_s = NAN;
  path::Point place = path::PointAt(stretch->segment, way);
  if (s.rise.used) {  // at its present height
    const KDL::Vector up = PlaceOf(c, ride.cargo).M.R.UnitZ();
    place.frame.p += DisplacementOf(c, ride, 0).M.R.Inverse() * (s.rise.offset.position * up);
    s.rise = {};
  }
  const Clutch* found = std::ranges::find_if(s.clutches, [&](const Clutch& k) { return k.used && k.ride == number; });
  Clutch clutch = found != s.clutches.end() ? *found : Clutch{};
  s.way_before += s.pace.now.position;
  ForgetPlan(c, s);
  RestOn(c, ride, place, s);
  clutch.ride = ahead.end_ride;
  s.clutches = {};
  s.clutches[0] = clutch;
}

void RestOn(const Context& c, const CarrierBinding& ride, const path::Point& place, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  ahead.end_ride = ahead.rides_end++;
  ahead.rides[ahead.end_ride % kRides] = ride;
  Stretch seat;
  seat.segment = path::Still(place);
  seat.from_ride = seat.to_ride = ahead.end_ride;
  seat.begun = seat.stops = true;
  seat.move = s.done - 1;
  seat.build_up_s = c.cycle.period_s;
  const PathLimits& path = c.params.path;
  seat.limits = {path.velocity, path.acceleration, path.deceleration.value_or(path.acceleration), path.jerk};
  ahead.count = 1;
  ahead[ahead.first] = seat;
  ahead.sampling = ahead.end();
  ahead.end_joints = ahead.last_joints = s.joints;
  ahead.end_tool = place.frame;
  ahead.known = true;
  ahead.last = {};
  ahead.last.limits = seat.limits;
  ahead.window.SetBuildUp(seat.build_up_s);
  ahead.window.Append(ahead.last, true);
  ahead.window.Close();
  ahead.window.Sweep(1);
  ahead.timing.Clear();
  trajectory::BeginAt(ahead.window, ahead.window.begin(), c.cycle.period_s, s.pace);
  s.begun = true;
  s.ends = s.lets_go = false;
  s.brake = {};
}

Clutch& BindAtRest(const Context& c, const CarriedTarget& cargo, double travel, State& s) noexcept {
  const End end = Present(c, s);
  s.joints = end.joints;
  if (s.begun) s.way_before += s.pace.now.position;
  ForgetPlan(c, s);
  path::Point place{end.tool, {}};
  for (std::size_t k = c.kinematics->count; k < kMaxAxes; ++k) {
    place.auxiliaries[k - c.kinematics->count] = end.joints[k];
  }
  c.ahead.window.SetLimits(LimitsOf(c, s));
  RestOn(c, BindingAtRest(c, cargo, travel), place, s);
  s.clutches = {};
  Clutch& clutch = s.clutches[0];
  clutch.used = true;
  clutch.ride = c.ahead.end_ride;
  clutch.travel.position = travel;
  if (s.state == GroupState::kStandby) Enter(GroupState::kMoving, s);
  return clutch;
}

void GiveUpPath(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept {
  if (s.begun || s.planning.stage != Stage::kIdle || c.ahead.known) {
    EndMotion(c, brake, lets_go || s.lets_go, s);
  } else {
    ForgetPlan(c, s);
    s.lets_go = false;
  }
  s.interrupted = false;
}

void EndMotion(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept {
  // The harder brake applies: 0 is the path's own.
  const double own = s.begun && c.ahead.known ? c.ahead.window[s.pace.node].bounds.deceleration : 0;
  const auto strength = [&](const Brake& b) { return b.full ? HUGE_VAL : b.deceleration > 0 ? b.deceleration : own; };
  const bool softer = s.ends && s.begun && strength(brake) < strength(s.brake);
  s.ends = true;
  s.lets_go = lets_go;
  for (Clutch& clutch : s.clutches) clutch.law_length = 0;  // the next motion does not wait for the carrier
  s.interrupted = false;
  if (!softer) s.brake = brake;
}

}  // namespace takt::group
