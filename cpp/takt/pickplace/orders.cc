// Targets, in sequence: profiles to them are given to the group as moves, and monitored.
//
// Invariant: a workpiece counts as picked, or a product as placed, only in a cycle in which the tool is at its target.
// Only Complete() counts. It is called for a static order whose moves have all ended as done (HasArrived: aborted moves
// do not count), and for an order over a belt while IsOnWorkpiece() holds: its moves have ended as done, and the tool
// rests on the workpiece in step. Both are checked in the cycle itself, so a group that is interrupted, halted,
// disabled or moved by other commands meanwhile never completes an order. An order that had arrived on its workpiece
// and ends otherwise counts as missed, and deletes it: whether the gripper has it is not known (ReleaseWorkpiece).
#include <algorithm>
#include <cmath>

#include "takt/group/plan.h"
#include "takt/group/switches.h"
#include "takt/group/systems.h"
#include "takt/group/track.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using group::SystemFrame;

constexpr double kLimitShare = 0.98;  // of the tool's limits, as for axes: a margin
constexpr double kOneAtATime = 0.25;  // weight of a new duration that is shorter
constexpr double kForget_s = 10;      // [s] time constant while there is nothing to learn from
constexpr double kMargin = 1.1;       // on the estimated time of the next profile

bool IsStatic(const Order& order) {
  return order.belt == 0;
}

PathRamps RampsOf(const Settings& s) {
  return {s.path_velocity, s.path_acceleration, s.path_deceleration, s.path_jerk};
}

Shape ShapeOf(const Settings& s) {
  return {s.path_mode, s.z_start_distance, s.z_target_distance, s.z_elliptical, s.blending_radius, s.keep_orientation};
}

Order MakeOrder(std::uint32_t belt, bool picks, const State& s) {
  const Settings& p = s.settings;
  Order order;
  order.belt = belt;
  order.picks = picks;
  order.target = {.system = p.target_coordinate_system,
                  .pcs = p.target_pcs,
                  .pose = {p.x_target, p.y_target, p.z_target, p.a_target, p.b_target, p.c_target},
                  .aux1 = p.aux1_target};
  order.shape = ShapeOf(p);
  if (belt != 0) order.own = s.belts[belt - 1];
  if (belt != 0) order.shape.target_distance = order.own.z_distance;
  order.ramps = RampsOf(p);
  order.rule = p.workpiece_rule;
  const bool opens = p.tracking_mode != TrackingMode::kProgram && !picks;
  order.gripper_time = opens ? p.gripper_open_time : p.gripper_closing_time;
  return order;
}

void Push(const Order& order, State& s) {
  s.orders[s.order_count++] = order;
}

// Deletes the workpiece, so that no other order gets it. `cause`: the counter of missed ones to increment.
void MissWorkpiece(const Context& c, Order& order, std::uint32_t& cause, State& s) {
  if (order.workpiece == 0) return;
  RemoveWorkpiece(c, order);
  ++s.counters.missed;
  ++cause;
}

// Releases the workpiece of an order that ends, or begins again, before it is done.
void ReleaseWorkpiece(const Context& c, Order& order, State& s) {
  if (order.phase == Phase::kStaying) {
    MissWorkpiece(c, order, s.counters.interrupted, s);
  } else {
    NoteAbandoned(order, false, s);
  }
  GiveBackWorkpiece(c, order);
}

// Returns true if its moves are over, and none of them was aborted.
bool HasArrived(const group::State& g, const Order& order) {
  return order.phase == Phase::kGoing && g.done > order.last && g.failed < order.first;
}

// Returns true if the group has aborted moves of the order, or of the way to the parking position.
bool IsLost(const group::State& g, const State& s) {
  const bool order = s.order_count > 0 && s.orders[0].phase == Phase::kGoing && g.failed >= s.orders[0].first;
  return order || (s.parking && g.failed >= s.parking_move);
}

void Drop(const Context& c, std::uint32_t index, FeedbackState feedback, ErrorId error, State& s) {
  ReleaseWorkpiece(c, s.orders[index], s);
  Report(c, s.orders[index].ticket, feedback, error);
  for (std::uint32_t i = index; i + 1 < s.order_count; ++i) s.orders[i] = s.orders[i + 1];
  s.orders[--s.order_count] = {};
}

// Limits of the tool in the world, along and about X, Y, Z, and of Aux1: they hold for all moves of a path from rest.
void TightenLimits(const Context& c, const group::State& g, const State& s) {
  trajectory::CoordinateLimits limits = group::LimitsOf(c.group, g);
  const auto tighten = [&](std::size_t k, std::size_t i) {
    const auto least = [](double limit, double own) { return own > 0 ? std::min(limit, kLimitShare * own) : limit; };
    trajectory::CoordinateLimits::One& of = limits.of[k];
    of = {least(of.velocity, s.settings.max_velocity[i]), least(of.acceleration, s.settings.max_acceleration[i]),
          least(of.jerk, s.settings.max_jerk[i])};
    limits.count = std::max(limits.count, k + 1);
  };
  for (std::size_t i = 0; i + 1 < kProfileAxes; ++i) tighten(group::kMaxAxes + i, i);
  if (const std::size_t aux1 = Aux1Of(c, g); aux1 < group::kMaxAxes) tighten(aux1, kProfileAxes - 1);
  c.group.ahead.window.SetLimits(limits);
}

ErrorId GiveLeg(const Context& c, const Leg& leg, const PathRamps& ramps, bool keep_orientation, group::State& g,
                State& s) {
  const std::size_t aux1 = Aux1Of(c, g);
  const bool from_rest = !c.group.ahead.known && !g.begun;
  const group::Command move = leg.arch ? group::Command(ArchOf(leg, ramps, keep_orientation, aux1))
                                       : group::Command(LineOf(leg, ramps, keep_orientation, aux1));
  const ErrorId error = Tell(c, move, g);
  if (from_rest && error == ErrorId::kNone) TightenLimits(c, g, s);
  return error;
}

Place StartOf(const Context& c, const group::State& g, const State& s) {
  return s.at_known ? s.at : PresentPlace(c, g);
}

struct QueuedLegs {
  ErrorId error = ErrorId::kNone;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

// Gives the legs from `from` on.
QueuedLegs CommandLegs(const Context& c, const Profile& profile, std::uint32_t from, const PathRamps& ramps,
                       bool keep_orientation, group::State& g, State& s) {
  QueuedLegs given{profile.error, g.done + g.queue.count, 0};
  const group::Directions closed = ClosedOn(c, g, profile, from, StartOf(c, g, s), keep_orientation);
  if (closed.any()) {
    s.error_axes |= AxesOf(c, g, closed);
    const ErrorId at_switch =
        closed.positive != 0 ? ErrorId::kModuleLimitSwitchPositive : ErrorId::kModuleLimitSwitchNegative;
    const bool barred = group::RefusalOf(c.group, g, closed) == ErrorId::kDirection;
    given.error = barred ? ErrorId::kDirection : at_switch;
  }
  for (std::uint32_t i = from; i < profile.count && given.error == ErrorId::kNone; ++i) {
    Leg leg = profile.legs[i];
    if (i == from) leg.radius = 0;
    given.error = GiveLeg(c, leg, ramps, keep_orientation, g, s);
  }
  s.given = g.done + g.queue.count;
  given.last = s.given - 1;
  return given;
}

Systems SystemsOf(const Context& c, const group::State& g, const Place& start, const Place& target) {
  return {c.group.mounting.base, SystemFrame(c.group, g, start.system, start.pcs - 1),
          SystemFrame(c.group, g, target.system, target.pcs - 1)};
}

// Sets the place at which the moves given so far end.
void SetPlace(const Place& at, std::uint32_t belt, double distance, State& s) {
  s.at = at;
  s.at_known = true;
  s.at_belt = belt;
  s.at_distance = distance;
  s.low = false;
  s.parked_at = 0;
}

void Park(const Context& c, std::uint32_t belt, group::State& g, State& s) {
  const BeltSettings& own = s.belts[belt - 1];
  const Place start = StartOf(c, g, s);
  const Place target = Levelled(c, g,
                                {.pose = {own.park_x, own.park_y, own.park_z, own.park_a, own.park_b, own.park_c},
                                 .aux1 = start.aux1,
                                 .parks = true});
  const Shape shape = ShapeFromHere(c, g, ShapeOf(s.settings), s);
  const Profile profile = MakeProfile(start, target, shape, SystemsOf(c, g, start, target));
  const QueuedLegs given = CommandLegs(c, profile, 0, RampsOf(s.settings), s.settings.keep_orientation, g, s);
  if (given.error != ErrorId::kNone) return Fail(c, given.error, g, s);
  const bool from_belt = s.at_belt != 0 || s.low;
  SetPlace(target, 0, 0, s);
  s.parked_at = belt;
  s.parking = true;
  s.parking_move = given.last;
  s.parking_lifts = from_belt && profile.count > 1 && !profile.legs[0].turns;
  s.parking_over = profile.legs[0].to;
}

// From the present place of the tool, which mechanisms without a wrist turn differently from the parking position.
void EndParking(const Context& c, const group::State& g, State& s) {
  s.parking = false;
  if (s.parked_at == 0) return;  // moves after it were given
  s.at = PresentPlace(c, g);
  s.at.parks = true;
}

// Gives the order's moves; an order over a belt waits if there is no workpiece.
void Begin(const Context& c, group::State& g, Order& order, State& s) {
  s.in_target = false;
  Place target = order.target;
  if (!IsStatic(order)) {
    const conveyor::Object* object = s.parking ? nullptr : ChooseWorkpiece(c, g, order, s);
    if (!object) {
      order.phase = Phase::kWaiting;
      // The learned slowness may be the reason for waiting.
      s.slowness += (1 - s.slowness) * std::min(1.0, c.group.cycle.period_s / kForget_s);
      if (s.parked_at != order.belt && !s.parking) Park(c, order.belt, g, s);
      return;
    }
    order.expected_s = TimeToMeet(c, g, order, *object, s);
    if (const ErrorId error = BindWorkpiece(c, *object, g, order, target, s); error != ErrorId::kNone) {
      return Fail(c, error, g, s);
    }
  }
  target = Levelled(c, g, target);
  order.start = StartOf(c, g, s);
  const Systems systems = SystemsOf(c, g, order.start, target);
  order.profile = MakeProfile(order.start, target, ShapeFromHere(c, g, order.shape, s), systems);
  if (IsStatic(order)) order.expected_s = TimeAlong(order.profile, order.start, order.ramps, systems);
  order.next_leg = 0;
  order.pulsed = false;
  if (&order == &s.orders[0]) s.profile_time = 0;  // not known yet
  const QueuedLegs given = CommandLegs(c, order.profile, 0, order.ramps, order.shape.keep_orientation, g, s);
  if (given.error != ErrorId::kNone) {
    NoteAbandoned(order, true, s);
    return Fail(c, given.error, g, s);
  }
  order.first = given.first;
  order.last = given.last;
  order.begin_cycle = c.group.cycle.count;
  order.phase = Phase::kGoing;
  order.from_belt = s.at_belt != 0 || s.low;
  SetPlace(target, order.belt, order.own.z_distance, s);
}

// Gives the rest of a path that was left, from the present place. An arch keeps its crest height.
void BeginAgain(const Context& c, group::State& g, Order& order, State& s) {
  Leg& leg = order.profile.legs[order.next_leg];
  if (leg.arch) {
    const auto height = [&](const Place& place) {
      const kinematics::Frame world = c.group.mounting.base * SystemFrame(c.group, g, place.system, place.pcs - 1);
      return (world * KDL::Vector(place.pose.x, place.pose.y, place.pose.z)).z();
    };
    const Place& foot = order.next_leg > 0 ? order.profile.legs[order.next_leg - 1].to : order.start;
    const double crest = std::max(height(foot), height(leg.to)) + leg.height;
    leg.height = std::max(0.0, crest - std::max(height(PresentPlace(c, g)), height(leg.to)));
    order.start = PresentPlace(c, g);
  }
  const QueuedLegs given =
      CommandLegs(c, order.profile, order.next_leg, order.ramps, order.shape.keep_orientation, g, s);
  if (given.error != ErrorId::kNone) return Fail(c, given.error, g, s);
  order.first = given.first;
  order.last = given.last;
  order.phase = Phase::kGoing;
  SetPlace(order.target, 0, 0, s);
}

void CountPick(const Context& c, const Order& order, State& s) {
  if (!order.picks) {
    ++s.counters.placed;
    if (s.held_count == 0) return;
    std::shift_left(s.held.begin(), s.held.end(), 1);
    s.held.back() = {};
    --s.held_count;
    return;
  }
  if (s.held_count < kHeld) s.held[s.held_count] = order.attributes;
  ++s.held_count;
  ++s.counters.picked;
  s.pick_cycles[s.pick_count % kPickTimes] = c.group.cycle.count;
  ++s.pick_count;
}

}  // namespace

bool IsInStep(const Context& c, const group::State& g) noexcept {
  return !g.interrupted && !g.ends && group::TrackStateOf(c.group, g) == group::TrackState::kInSync;
}

bool IsOnWorkpiece(const Context& c, const group::State& g, const State& s) noexcept {
  if (s.order_count == 0 || s.orders[0].phase != Phase::kStaying) return false;
  const bool at_end = g.done == s.orders[0].last + 1 && trajectory::Stands(g.pace);
  return at_end && IsOn(c, g) && IsInStep(c, g);
}

bool Arrive(const Context& c, const group::State& g, State& s) noexcept {
  if (s.parking && g.done > s.parking_move && g.failed < s.parking_move) EndParking(c, g, s);
  if (g.ends || g.reason != kinematics::Reason::kNone) return false;
  if (s.order_count == 0 || !HasArrived(g, s.orders[0])) return false;
  Order& order = s.orders[0];
  s.in_target = true;
  if (order.pulse_at_end && order.gripper_time > 0 && !order.pulsed) s.pulse = order.pulsed = true;
  if (IsStatic(order)) {
    Complete(c, s);
    return true;
  }
  Learn(ElapsedTime(c, order), order, s);
  order.phase = Phase::kStaying;
  order.stay_cycle = c.group.cycle.count;
  return true;
}

void Complete(const Context& c, State& s) noexcept {
  Order& order = s.orders[0];
  CountPick(c, order, s);
  RemoveWorkpiece(c, order);
  s.done = true;
  Drop(c, 0, FeedbackState::kDone, ErrorId::kNone, s);
}

namespace {

void Go(const Context& c, group::State& g, State& s) {
  Order& order = s.orders[0];
  if (g.done <= order.last) {
    // Waiting for a zone is not part of the profile's time.
    if (g.waits_for != 0) order.begin_cycle = c.group.cycle.count;
    if (IsStatic(order)) return;
    const double left_s = TimeToGo(c, g, order, s);
    const bool descends = g.done == order.last;
    const bool into_zone = descends && g.zone_near;
    if (into_zone || !StaysWithin(c, g, order, left_s + order.own.sync_time)) GiveUp(c, g, s);
    return;
  }
  if (g.reason != kinematics::Reason::kNone) return Fail(c, TroubleOf(g), g, s);
  Arrive(c, g, s);
}

void Stay(const Context& c, const group::State& g, State& s) {
  Order& order = s.orders[0];
  const bool on = IsOnWorkpiece(c, g, s);
  if (!on) ++order.stay_cycle;  // another command has interrupted the group: the workpiece moves on alone
  const double period = c.group.cycle.period_s;
  const double wanted = std::round(order.own.sync_time / period);
  const auto cycles = static_cast<std::uint64_t>(std::max(1.0, wanted));
  const std::uint64_t stayed = c.group.cycle.count - order.stay_cycle;
  if (on && (s.ack || stayed >= cycles)) return Complete(c, s);
  const bool there = conveyor::Find(*c.belts[order.belt - 1].state, order.workpiece) != nullptr;
  if (on && !there) return;
  if (there && StaysWithin(c, g, order, static_cast<double>(cycles - stayed) * period)) return;
  MissWorkpiece(c, order, s.counters.too_late, s);  // the next profile leads up
  order.phase = Phase::kNew;
}

void StepOrder(const Context& c, group::State& g, State& s) {
  Order& order = s.orders[0];
  switch (order.phase) {
    case Phase::kNew:
    case Phase::kWaiting:
      if (s.at_known || IsFree(c, g)) Begin(c, g, order, s);
      return;
    case Phase::kHeld:
      if (IsFree(c, g)) BeginAgain(c, g, order, s);
      return;
    case Phase::kGoing:
      return Go(c, g, s);
    case Phase::kStaying:
      return Stay(c, g, s);
  }
}

// Gives consecutive static targets as early as possible: their profiles join without a pause. Under an override each
// begins after the previous one: its accelerations are those of the override at its start.
void GiveAhead(const Context& c, group::State& g, State& s) {
  if (s.inputs.override_factor < 1) return;
  for (std::uint32_t i = 1; i < s.order_count && s.state != PickPlaceState::kError; ++i) {
    const Order& before = s.orders[i - 1];
    if (before.phase != Phase::kGoing || !IsStatic(before) || !IsStatic(s.orders[i])) return;
    if (s.orders[i].phase == Phase::kNew) Begin(c, g, s.orders[i], s);
  }
}

void StepLoop(const Context& c, State& s) {
  Loop& loop = s.loop;
  if (!loop.active) return;
  if (loop.ends) {
    if (s.order_count > 0) return;
    Report(c, loop.ticket, FeedbackState::kDone);
    loop = {};
    s.done = true;
    return;
  }
  while (s.order_count < 2) {
    Push(MakeOrder(loop.places ? loop.place_belt : loop.pick_belt, !loop.places, s), s);
    loop.places = !loop.places;
  }
}

void DropNew(const Context& c, State& s) {
  while (s.order_count > 1 && s.orders[s.order_count - 1].phase == Phase::kNew) {
    Drop(c, s.order_count - 1, FeedbackState::kAborted, ErrorId::kNone, s);
  }
}

void EndLoop(const Context& c, FeedbackState feedback, ErrorId error, State& s) {
  if (s.loop.active) Report(c, s.loop.ticket, feedback, error);
  s.loop = {};
}

std::pair<std::uint32_t, std::uint32_t> BeltsOf(const Settings& s) {
  switch (s.tracking_mode) {
    case TrackingMode::kStaticToBelt1:
      return {0, 1};
    case TrackingMode::kBelt1ToStatic:
      return {1, 0};
    case TrackingMode::kBelt1ToBelt2:
      return {1, 2};
    case TrackingMode::kBelt2ToBelt1:
      return {2, 1};
    default:
      return {s.pick_belt, s.place_belt};
  }
}

// Returns true if an ellipse would lead onto a belt that is turned about A or B of the world.
bool IsTilted(const Context& c, std::uint32_t belt, const State& s) {
  if (belt == 0 || s.settings.path_mode != PathMode::kElliptical) return false;
  return !IsUpright(kinematics::ToFrame(c.belts[belt - 1].params->origin));
}

bool NoMore(const group::State& g, const State& s) {
  return s.order_count == 0 && !s.loop.active && s.at_belt == 0 && !s.parking && !s.halting && g.queue.count == 0;
}

}  // namespace

Shape ShapeFromHere(const Context& c, const group::State& g, const Shape& shape, const State& s) noexcept {
  Shape from_here = shape;
  // The way up from a workpiece is determined by its belt.
  if (s.at_belt != 0) from_here.start_distance = s.at_distance;
  if (s.low) from_here.start_distance = std::max(s.at_known ? 0 : shape.start_distance, RiseTo(c, g, s.over));
  return from_here;
}

void ForgetPlace(State& s) noexcept {
  s.at_known = s.parking = false;
  s.at_belt = s.parked_at = 0;
}

// At once if it is longer, gradually if it is shorter.
void Learn(double takes_s, const Order& order, State& s) noexcept {
  if (order.expected_s <= 0 || order.gripper_off || order.pulse_at_end) return;
  const double slowness = std::max(1.0, kMargin * takes_s / order.expected_s);
  s.slowness = slowness > s.slowness ? slowness : std::lerp(s.slowness, slowness, kOneAtATime);
}

void HaltGroup(const Context& c, group::State& g, State& s, const group::Halt& halt) noexcept {
  s.lifting = s.rises = false;
  if (Tell(c, halt, g) == ErrorId::kNone) s.halting = true;
}

void Accept(const Context& c, Ticket ticket, std::uint32_t belt, State& s) noexcept {
  ErrorId error = ErrorId::kNone;
  if (s.order_count == kOrders) error = ErrorId::kBufferFull;
  if (belt > c.params.belts.size()) error = ErrorId::kUnknownTarget;
  if (error == ErrorId::kNone && IsTilted(c, belt, s)) error = ErrorId::kTiltedEllipse;
  if (error != ErrorId::kNone) {
    s.warning = error;
    return Report(c, ticket, FeedbackState::kError, error);
  }
  if (s.loop.active) {
    EndLoop(c, FeedbackState::kAborted, ErrorId::kNone, s);
    DropNew(c, s);
  }
  Order order = MakeOrder(belt, belt != 0, s);
  order.ticket = ticket;
  Push(order, s);
  s.warning = ErrorId::kNone;
  s.done = false;
  Report(c, ticket, FeedbackState::kActive);
}

void BeginLoop(const Context& c, Ticket ticket, State& s) noexcept {
  const auto [pick, place] = BeltsOf(s.settings);
  ErrorId error = ErrorId::kNone;
  if (std::max(pick, place) > c.params.belts.size()) error = ErrorId::kUnknownTarget;
  if (error == ErrorId::kNone && (IsTilted(c, pick, s) || IsTilted(c, place, s))) error = ErrorId::kTiltedEllipse;
  if (s.loop.active && s.loop.mode == s.settings.tracking_mode && s.loop.pick_belt == pick &&
      s.loop.place_belt == place && !s.loop.ends) {
    error = ErrorId::kState;
  }
  if (error != ErrorId::kNone) {
    s.warning = error;
    return Report(c, ticket, FeedbackState::kError, error);
  }
  EndLoop(c, FeedbackState::kAborted, ErrorId::kNone, s);
  DropNew(c, s);
  s.loop = {.active = true, .ticket = ticket, .mode = s.settings.tracking_mode, .pick_belt = pick, .place_belt = place};
  s.warning = ErrorId::kNone;
  s.done = false;
  Report(c, ticket, FeedbackState::kActive);
}

namespace {

// Keeps the known height when the path is lost.
void KeepHeight(State& s) {
  if (!s.may_be_low) return;
  s.low = true;
  s.over = s.over_now;
}

}  // namespace

void EndOrders(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  while (s.order_count > 0) Drop(c, s.order_count - 1, feedback, error, s);
  EndLoop(c, feedback, error, s);
  s.in_target = false;
  ForgetPlace(s);
  KeepHeight(s);
  s.given = 0;
  s.hold = {};
  s.scout = s.next_scout = {};
}

void LosePath(const Context& c, bool kept, State& s) noexcept {
  for (std::uint32_t i = 0; i < s.order_count; ++i) {
    Order& order = s.orders[i];
    if (i == 0 && kept && order.phase == Phase::kGoing && IsStatic(order)) {
      order.next_leg = std::min(order.next_leg + s.hold.legs, order.profile.count - 1);
      order.phase = Phase::kHeld;
      continue;
    }
    if (i == 0 && kept && order.phase == Phase::kHeld) continue;
    ReleaseWorkpiece(c, order, s);
    order.phase = Phase::kNew;
  }
  ForgetPlace(s);
  KeepHeight(s);
  s.given = 0;
  s.scout = s.next_scout = {};
}

void EndLoopBehindThis(const Context& c, State& s) noexcept {
  s.loop.ends = true;
  DropNew(c, s);
  const bool waits = s.order_count == 1 && s.orders[0].phase <= Phase::kWaiting;
  if (waits) Drop(c, 0, FeedbackState::kAborted, ErrorId::kNone, s);
}

void RunOrders(const Context& c, group::State& g, State& s) noexcept {
  if (s.halting) {
    if (!IsFree(c, g)) return;
    s.halting = false;
  }
  if (s.lifting && !IsLifted(c, g, s)) return;
  if (g.gets_off) {  // its belt would have carried it into a zone that it waits for: start again from here
    LosePath(c, false, s);
    return HaltGroup(c, g, s);
  }
  if (g.ends && g.reason != kinematics::Reason::kNone) return Fail(c, TroubleOf(g), g, s);
  // Other commands have ended the group's moves.
  if (g.ends || (IsLost(g, s) && g.reason == kinematics::Reason::kNone)) {
    EndOrders(c, FeedbackState::kAborted, ErrorId::kNone, s);
    return Enter(PickPlaceState::kReady, s);
  }
  if (s.given > g.done + g.queue.count) {
    s.error_axes |= AxesOf(c, g, g.refused);
    return Fail(c, TroubleOf(g), g, s);
  }
  if (s.parking && g.done > s.parking_move) EndParking(c, g, s);
  StepLoop(c, s);
  if (s.order_count > 0) StepOrder(c, g, s);
  if (s.state == PickPlaceState::kError) return;
  StepLoop(c, s);
  GiveAhead(c, g, s);
  if (s.state == PickPlaceState::kError) return;
  if (s.order_count == 0 && !s.loop.active && s.at_belt != 0) return Park(c, s.at_belt, g, s);
  const bool waits = s.order_count > 0 && s.orders[0].phase == Phase::kWaiting;
  if (s.state == PickPlaceState::kPreparingPath && (g.begun || waits || NoMore(g, s))) {
    if (s.order_count > 0) {
      const double took = static_cast<double>(c.group.cycle.count - s.prepare_cycle) * c.group.cycle.period_s;
      s.preparation_time = took;
    }
    Enter(PickPlaceState::kMovePp, s);
  }
  if (s.state == PickPlaceState::kMovePp && NoMore(g, s) && IsFree(c, g)) {
    Enter(PickPlaceState::kReady, s);
    s.at_known = false;
  }
}

}  // namespace takt::pickplace
