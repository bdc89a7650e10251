#include "takt/mover/mover.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/by_coordinate.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/course.h"
#include "takt/mover/follow.h"
#include "takt/mover/follow_route.h"
#include "takt/mover/formation.h"
#include "takt/mover/gear.h"
#include "takt/mover/on_parts.h"
#include "takt/mover/run.h"

namespace takt::mover {

namespace {

using planar::ObjectState;

// Returns the context at the beginning of the next cycle.
Context NextTo(const Context& c) {
  Context next = c;
  ++next.cycle.count;
  return next;
}

// Returns true if X and Y of a mover on a track were moving when this cycle began, or move in it.
bool MovesOnTrack(const Context& c, const State& s) {
  return IsMovingAlongTrack(c, s) || !planar::Rests(s.set_point[kX]) || !planar::Rests(s.set_point[kY]);
}

// Begins the motion that waits for a stop: to the target, at rest on the old line; back onto the track, at rest along
// it.
void GoOn(const Context& c, State& s) {
  if (!s.plane.waits || Elapsed(c, s.plane.begin) < DurationOf(s.plane.motion)) return;
  if (IsOnTrack(s) ? MovesOnTrack(c, s) : IsHeld(c, s)) return;
  const PlaneState from = At(s.plane.motion, Elapsed(c, s.plane.begin));
  if (s.plane.each) {
    if (!PlanToGoals(c, from, s.plane)) return Fail(c, ErrorId::kPlanning, s);
    s.plane.begin = c.cycle.count;
    s.plane.waits = s.plane.hard = false;
    return;
  }
  const MoveToPosition next = s.plane.next;
  const trajectory::Limits limits{*next.velocity, *next.acceleration, *next.deceleration, *next.jerk};
  PlaneMotion motion;
  if (!PlanMove(c.planner, from, next.x, next.y, limits, motion)) return Fail(c, ErrorId::kPlanning, s);
  s.plane.motion = motion;
  s.plane.begin = c.cycle.count;
  s.plane.waits = s.plane.hard = false;
}

// Returns X and Y at the end of this cycle as planned; on a track, the state there plus the remaining displacement from
// it.
PlaneState PlaneOf(const Context& c, const State& s) {
  if (IsOnTrack(s)) {
    const KinematicState& way = c.rider().at;
    const planar::TrackPoint at = c.streets.At(s.track, way.position);
    const auto [sine, cosine] = maths::SinCos(at.direction);
    const double across = way.velocity * way.velocity * at.curvature;
    PlaneState off = At(s.plane.motion, Elapsed(c, s.plane.begin) + c.cycle.period_s);
    off.x.position += at.place.x;
    off.x.velocity += way.velocity * cosine;
    off.x.acceleration += way.acceleration * cosine - across * sine;
    off.y.position += at.place.y;
    off.y.velocity += way.velocity * sine;
    off.y.acceleration += way.acceleration * sine + across * cosine;
    return off;
  }
  return At(s.plane.motion, Elapsed(c, s.plane.begin) + c.cycle.period_s);
}

// Returns the set point at the end of this cycle as planned, without external set points.
SetPoint Planned(const Context& c, const State& s) {
  SetPoint at;
  const PlaneState plane = PlaneOf(c, s);
  at[kX] = plane.x;
  at[kY] = plane.y;
  for (std::size_t i = 0; i < kOthers.size(); ++i) {
    const CoordinateMove& other = s.others[i];
    at[kOthers[i]] = other.profile.At(Elapsed(c, other.begin) + c.cycle.period_s);
  }
  return at;
}

// Returns true if X, Y or C moves, from the set point of the state to `at`.
bool Moves(const State& s, const SetPoint& at) {
  return std::ranges::any_of(std::array{kX, kY, kC}, [&](Coordinate i) {
    return at[i].position != s.set_point[i].position || !planar::Rests(at[i]) || !planar::Rests(s.set_point[i]);
  });
}

// In the plane, brakes the mover instead of letting it enter the course of another mover.
void AvoidOthers(const Context& c, SetPoint& at, State& s) {
  if (IsOnTrack(s) || !Moves(s, at)) return;
  const ObjectInfo other = TryCourse(c, at, s);
  if (!other) return;
  Hold(c, other.number - 1, s);
  at = Planned(c, s);
}

void MoveOn(const Context& c, State& s) {
  GoOn(c, s);
  SetPoint at = Planned(c, s);
  if (IsPlanet(s)) {
    Compose(StateOfStar(c, s).set_point, s.formation, at);
    s.set_point = at;
    return;
  }
  if (s.external.mode != SetpointMode::kNone) {
    ObjectInfo object;
    const ErrorId error = Follow(c, at, s, object);
    if (error != ErrorId::kNone) {
      Fail(c, error, s, false, object);
      at = Planned(c, s);
    }
  }
  if (s.external.mode == SetpointMode::kNone) AvoidOthers(c, at, s);
  s.set_point = at;
  if (s.external.mode == SetpointMode::kNone && IsOver(NextTo(c), s.plane)) c.rider().off = 0;
}

// Returns the mode that matches the angle of the mover at rest.
CommandMode Settled(const Context& c, const State& s) {
  const double turned = s.set_point[kC].position;
  const bool inside = InOneWindow(c.params.c, turned, turned);
  switch (s.mode) {
    case CommandMode::kFreeMovement:
    case CommandMode::kCRotationFreeMovement:
    case CommandMode::kExternalSetpointGeneration:
      return inside ? CommandMode::kFreeMovement : CommandMode::kCRotationFreeMovement;
    case CommandMode::kCRotationOnTrack:
      return inside ? CommandMode::kOnTrack : s.mode;
    default:
      return s.mode;
  }
}

// Ends a move onto or from a track.
void TargetPosition(const Context& c, State& s) {
  if (s.mode == CommandMode::kJoiningTrack) {
    s.mode = CommandMode::kOnTrack;
    s.plane = {};
  }
  if (s.mode == CommandMode::kLeavingTrack) {
    LeaveTrackNetwork(c, s);
    s.mode = CommandMode::kFreeMovement;
  }
}

// Returns true if X or Y has reached the goal of its own command, or rest, when this cycle begins.
bool IsOver(const Context& c, const State& s, Coordinate which) {
  const PlaneMove& p = s.plane;
  const double t = Elapsed(c, p.begin);
  if (p.waits) return p.each && !p.goals[which].active && t >= DurationOf(p.motion);
  return t >= (p.each ? which == kX ? p.motion.along.duration() : p.motion.across.duration() : DurationOf(p.motion));
}

// Ends the commands that have reached their goals. The next cycle begins where this one ends.
void Finish(const Context& now, State& s) {
  const Context c = NextTo(now);
  const auto done = [&](Slot slot) { End(now, slot, FeedbackState::kDone, ErrorId::kNone, s); };
  const bool turned = IsOver(c, s.others.back());
  NoteVelocity(c, now.cycle.count, s);
  if (s.external.mode != SetpointMode::kAbsolute) {
    const bool there = IsOnTrack(s) ? c.rider().there : IsOver(c, s.plane);
    if (there && (!s.plane.turns || turned)) {
      done(kPlane);
      s.plane.turns = false;
      TargetPosition(c, s);
    }
    for (std::size_t i = 0; i < kOthers.size(); ++i) {
      if (IsOver(c, s.others[i])) Conclude(now, static_cast<Slot>(kMoveZ + i), s);
    }
    if (IsOver(c, s, kX)) Conclude(now, kMoveX, s);
    if (IsOver(c, s, kY)) Conclude(now, kMoveY, s);
    if (!IsMovingAlongTrack(c, s)) done(kHaltOnTrack);
    const bool rests = IsResting(c, s);
    if (rests) {
      done(kHalt);
      done(kStopExternal);
    }
    const bool settles = s.mode == CommandMode::kExternalSetpointGeneration ? rests : turned;
    if (settles && s.external.mode == SetpointMode::kNone) s.mode = Settled(c, s);
  }
}

void Change(const Context& c, State& s) {
  if (s.since == c.cycle.count) return;
  const bool rests = AtRest(s) && !s.plane.waits;
  const auto done = [&](ObjectState state) {
    Enter(c, state, s);
    End(c, kPower, FeedbackState::kDone, ErrorId::kNone, s);
  };
  switch (s.state) {
    case ObjectState::kEnabling:
      if (rests && IsPartReady(c, s)) done(ObjectState::kEnabled);
      return;
    case ObjectState::kDisabling:
      if (rests) done(ObjectState::kDisabled);
      return;
    case ObjectState::kErrorPending:
      if (rests) Enter(c, ObjectState::kError, s);
      return;
    case ObjectState::kResetting:
      // The reset of its part comes first, and the mover returns to Enabled only on an enabled part.
      if (!IsPartSound(c, s)) return;
      s.aborts |= !CanPartBeReady(c, s);
      if (!s.aborts && !IsPartReady(c, s)) return;
      s.error = ErrorId::kNone;
      done(s.aborts ? ObjectState::kDisabled : ObjectState::kEnabled);
      s.aborts = false;
      return;
    default:
      return;
  }
}

// Compares the actual position with the set point of the preceding cycle; not in the cycle in which the mover leaves
// Disabled, where set_position may have moved the set point since the measurement.
void Watch(const Context& c, const Inputs& inputs, State& s) {
  if (!c.params.deviation || s.state == ObjectState::kDisabled) return;
  if (s.state == ObjectState::kEnabling && s.since == c.cycle.count) return;
  const double off =
      maths::Hypot(inputs.actual.x - s.set_point[kX].position, inputs.actual.y - s.set_point[kY].position);
  if (!(off <= *c.params.deviation)) Fail(c, ErrorId::kMoverDeviation, s);
}

Delay DelayOf(planar::Waits waits) {
  switch (waits) {
    case planar::Waits::kMover:
      return Delay::kMover;
    case planar::Waits::kRoute:
      return Delay::kTrackEnd;
    case planar::Waits::kMaster:
      return Delay::kMaster;
    default:
      return Delay::kNone;
  }
}

bool IsHeldInPlane(const State& s) {
  return !IsOnTrack(s) && s.plane.held_by != planar::kNobody;
}

void Block(ObjectKind kind, std::uint32_t index, Outputs& out) {
  out.blocker_kind = kind;
  out.blocker = index + 1;
}

// On a track: publishes why the mover does not move on.
void PublishWaiting(const Context& c, const State& s, Outputs& out) {
  const planar::Rider& rider = c.rider();
  out.delay = DelayOf(rider.waits);
  out.delay_since = rider.waits_since;
  switch (rider.waits) {
    case planar::Waits::kMover:
      if (IsGeared(c, s) && rider.gear.master == rider.waits_for) out.delay = Delay::kMaster;
      if (!out.deadlocked && planar::LeadsToDeadlock(c.streets.riders, c.index)) out.delay = Delay::kDeadlock;
      return Block(ObjectKind::kMover, rider.waits_for, out);
    case planar::Waits::kMaster:
      if (s.gear.axis != kNoMaster) Block(ObjectKind::kAxis, s.gear.axis, out);
      return;
    case planar::Waits::kRoute:
      return Block(ObjectKind::kTrack, rider.route.last(), out);
    default:
      return;
  }
}

// Returns true if a geared mover is at rest, and its master, a mover, is delayed.
bool IsHeldUpWithMaster(const Context& c, const State& s) {
  const planar::Rider& rider = c.rider();
  if (!IsGeared(c, s) || rider.gear.master == planar::kNobody || !planar::Rests(rider.at)) return false;
  return c.streets.riders[rider.gear.master].waits != planar::Waits::kNot;
}

// Returns true if the part below the mover delays its enabling or its reset.
bool IsHeldUpByPart(const Context& c, const State& s) {
  const bool wants = s.state == ObjectState::kEnabling || s.state == ObjectState::kResetting;
  return wants && s.part != planar::kNoPart && !IsPartReady(c, s);
}

// Publishes what the next buffered command waits for.
void PublishHeld(const Buffer& buffer, Outputs& out) {
  const ObjectInfo& object = buffer.held_by;
  const bool mover = object.kind == ObjectKind::kMover;
  out.delay = mover ? Delay::kMover : object.kind == ObjectKind::kTrack ? Delay::kTrack : Delay::kPart;
  out.delay_since = buffer.held_since;
  if (mover) out.waits_for = object.number;
  Block(object.kind, object.number - 1, out);
}

// Publishes a deadlock: movers that wait for one another, this one among them or behind them, if not all are on tracks.
void PublishDeadlock(const Context& c, Outputs& out) {
  if (out.waits_for == 0 || out.deadlocked || out.delay == Delay::kDeadlock) return;
  std::uint32_t at = c.index;
  for (std::size_t i = 0; i <= c.fleet.states.size(); ++i) {
    at = WaitsFor(c, at);
    if (at == planar::kNobody) return;
    if (at == c.index) {
      out.deadlocked = true;
      return;
    }
  }
  out.delay = Delay::kDeadlock;
}

// Publishes why the mover does not move on.
void PublishDelay(const Context& c, const State& s, Outputs& out) {
  const planar::Rider& rider = c.rider();
  if (s.tickets[kWait] != 0) {
    const bool for_time = c.cycle.count < s.buffer.until;
    out.delay = for_time ? Delay::kTime : Delay::kRelease;
    out.delay_since = s.begun[kWait];
  } else if (IsHeldInPlane(s)) {
    out.delay = Delay::kMover;
    out.delay_since = s.plane.held_since;
    out.waits_for = s.plane.held_by + 1;
    Block(ObjectKind::kMover, s.plane.held_by, out);
  } else if (IsOnTrack(s) && rider.waits != planar::Waits::kNot) {
    PublishWaiting(c, s, out);
  } else if (IsOnTrack(s) && IsHeldUpWithMaster(c, s)) {
    out.delay = Delay::kMaster;
    out.delay_since = c.streets.riders[rider.gear.master].waits_since;
    Block(ObjectKind::kMover, rider.gear.master, out);
  } else if (s.buffer.held_by) {
    PublishHeld(s.buffer, out);
  } else if (IsPlanet(s) && s.buffer.count > 0) {
    out.delay = Delay::kFormation;
    out.delay_since = s.begun[kFormation];
    Block(ObjectKind::kMover, s.formation.star, out);
  } else if (IsHeldUpByPart(c, s)) {
    out.delay = Delay::kPart;
    out.delay_since = s.since;
    Block(ObjectKind::kPart, s.part, out);
  } else if (const RestInPlace rest = WhyResting(c, s); rest.held) {
    out.delay = Delay::kRelease;
    out.delay_since = rest.since;
  } else if (rest.mover != planar::kNobody) {
    out.delay = Delay::kPlace;
    out.delay_since = rest.since;
    Block(ObjectKind::kMover, rest.mover, out);
  }
}

// Publishes the target, and the reserved area.
void PublishWay(const Context& c, const State& s, Outputs& out) {
  const planar::Pose goal = GoalOf(c, s);
  out.target_x = goal.place.x;
  out.target_y = goal.place.y;
  out.target_c = goal.c;
  out.gap = c.params.gap;
  const planar::Rider& rider = c.rider();
  if (IsOnTrack(s)) {
    out.gap = rider.gap;
    if (rider.aim == planar::Aim::kTarget) {
      const planar::Road& road = c.streets.network[rider.route.last()];
      out.target_track = rider.route.last() + 1;
      out.target_position = road.closed ? std::fmod(rider.target, road.length) : rider.target;
      if (out.target_position < 0) out.target_position += road.length;
    }
  }
  if (const std::uint32_t group = c.grounds.Watching(c.grounds.group_of_mover[c.index])) {
    const planar::Extent& reserved = c.grounds.grounds[group - 1].reserved.movers[c.index].extent;
    out.reserved_lower_x = reserved.lower.x;
    out.reserved_lower_y = reserved.lower.y;
    out.reserved_upper_x = reserved.upper.x;
    out.reserved_upper_y = reserved.upper.y;
  }
}

}  // namespace

Inputs Simulate(const State& s) noexcept {
  const auto at = [&](Coordinate i) { return s.set_point[i].position; };
  return {{at(kX), at(kY), at(kZ), at(kA), at(kB), at(kC)}};
}

void Step(const Context& c, const Inputs& inputs, State& s) noexcept {
  if (IsOnTrack(s)) s.track = c.rider().route.first();
  NoteGear(c, s);
  Watch(c, inputs, s);
  CheckPlanets(c, s);
  BeginNext(c, s);
  MoveOn(c, s);
  CheckStar(c, s);
  Locate(c, s);
  FinishPassed(c, s);
  Finish(c, s);
  Change(c, s);
  Stand(NextTo(c), s);
}

void Arrive(const Context& c, const State& s) noexcept {
  Stand(c, s);
}

bool AtRest(const State& s) noexcept {
  return std::ranges::all_of(s.set_point,
                             [](const KinematicState& k) { return k.velocity == 0 && k.acceleration == 0; });
}

bool IsOff(const State& s) noexcept {
  return AtRest(s) && (s.state == ObjectState::kDisabled || (s.state == ObjectState::kError && s.aborts));
}

void Publish(const Context& c, const Inputs& inputs, const State& s, Outputs& out) noexcept {
  const Context next = NextTo(c);
  const SetPoint& at = s.set_point;
  out = {};
  out.state = s.state;
  out.command_mode = s.mode;
  out.error = s.error;
  out.limited_by = s.limited_by;
  const std::array positions = {&out.x, &out.y, &out.z, &out.a, &out.b, &out.c};
  const std::array velocities = {&out.velocity_x, &out.velocity_y, &out.velocity_z,
                                 &out.velocity_a, &out.velocity_b, &out.velocity_c};
  const std::array accelerations = {&out.acceleration_x, &out.acceleration_y, &out.acceleration_z,
                                    &out.acceleration_a, &out.acceleration_b, &out.acceleration_c};
  for (std::size_t i = 0; i < kCoordinates; ++i) {
    *positions[i] = at[i].position;
    *velocities[i] = at[i].velocity;
    *accelerations[i] = at[i].acceleration;
  }
  out.actual_x = inputs.actual.x;
  out.actual_y = inputs.actual.y;
  out.actual_z = inputs.actual.z;
  out.actual_a = inputs.actual.a;
  out.actual_b = inputs.actual.b;
  out.actual_c = inputs.actual.c;
  if (s.external.mode != SetpointMode::kAbsolute) {
    out.busy_xyc = !IsPlaneResting(next, s) || s.plane.turns;
    out.busy_z = !IsOver(next, s.others[0]);
    out.busy_a = !IsOver(next, s.others[1]);
    out.busy_b = !IsOver(next, s.others[2]);
    out.busy_c = !IsOver(next, s.others[3]);
  }
  out.external = s.external.mode;
  const planar::Rider& rider = c.rider();
  out.track = s.track == planar::kNoTrack ? 0 : s.track + 1;
  if (IsOnTrack(s)) {
    out.track_position = rider.at.position;
    out.track_velocity = rider.at.velocity;
    out.track_acceleration = rider.at.acceleration;
    out.in_sync = IsGeared(c, s) && rider.gear.in_step;
    out.sync_error = IsGeared(c, s) ? rider.gear.error : 0;
    out.waits_for = rider.waits == planar::Waits::kMover ? rider.waits_for + 1 : 0;
    out.deadlocked = out.waits_for != 0 && planar::IsDeadlocked(c.streets.riders, c.index);
  }
  if (IsPlanet(s)) {
    out.busy_c = at[kC].velocity != 0 || at[kC].acceleration != 0;
    out.in_sync = true;
  }
  out.formation = BodyOf(c, s);
  PublishDelay(c, s, out);
  PublishDeadlock(c, out);
  PublishWay(c, s, out);
  out.buffered = s.buffer.count;
  out.group = c.grounds.group_of_mover[c.index];
  out.coordinate_system = c.streets.parts->none() ? 0 : s.system + 1;
  out.part = s.part == planar::kNoPart ? 0 : s.part + 1;
  out.commands = s.history.count;
  out.on_route = IsOnRoute(s);
  if (c.fleet.routes) {
    const SurfaceRoute& route = c.fleet.routes->of[c.index];
    out.route_visit = route.passed;
    out.route_granted = route.granted;
  }
}

void describe(Description<Inputs>& d) {
  d.named("MoverInputs");
  d.about("Measured values of a mover.");
  d.internal<&Inputs::actual>("Actual pose at the beginning of the cycle.");
}

}  // namespace takt::mover
