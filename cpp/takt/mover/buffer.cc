#include "takt/mover/buffer.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/mover/admission.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

constexpr std::uint32_t BitOf(std::size_t slot) {
  return 1u << slot;
}

// Returns true if no command given before `next` is in progress, apart from the slot `but`, a move that has been passed
// (kPassing) and relative external set points.
bool IsFree(const State& s, const Queued& next, Slot but) {
  for (std::size_t slot = kPlane; slot < kSlots; ++slot) {
    if (slot == kPassing || slot == but || (next.beside & BitOf(slot)) != 0) continue;
    if (slot == kExternal && s.external.mode == SetpointMode::kRelative) continue;
    if (s.tickets[slot] != 0) return false;
  }
  return true;
}

// Calls `what` with the bit of each slot of Z, A, B and C that the command holds.
void EachBeside(Ticket ticket, const State& s, const auto& what) {
  for (std::size_t slot = kMoveZ; slot <= kMoveC; ++slot) {
    if (ticket != 0 && s.tickets[slot] == ticket) what(BitOf(slot));
  }
}

// Returns the move of X and Y in the coordinate system of the mover; nothing for other commands and other systems.
std::optional<MoveToPosition> MoveOf(const Context& c, const Command& command, const State& s) {
  const auto* move = std::get_if<MoveToPosition>(&command);
  if (!move) return {};
  MoveToPosition to = *move;
  if (ToMoverSystem(c, s, move->reference, to.x, to.y) != ErrorId::kNone) return {};
  return to;
}

void Pop(Buffer& buffer) {
  std::shift_left(buffer.waiting.begin(), buffer.waiting.begin() + buffer.count, 1);
  buffer.waiting[--buffer.count] = {};
}

// Returns true if the next line continues the present one within 5 deg, so that there is no corner to blend.
bool IsStraightOn(const PlaneMove& plane, const MoveToPosition& next) {
  const double x = next.x - plane.motion.end_x, y = next.y - plane.motion.end_y;
  const double ahead = plane.motion.direction_x * x + plane.motion.direction_y * y;
  return ahead > 0.996 * maths::Hypot(x, y);  // 5 deg
}

// Returns true if `next` takes over now without a stop: where a blended corner is left, or straight on, just before the
// move in progress would brake.
bool LeadsInto(const Context& c, const MoveToPosition& next, const State& s) {
  const PlaneMove& plane = s.plane;
  if (plane.passes) return IsAtCorner(c, plane);
  const double t = Elapsed(c, plane.begin);
  if (next.blending == 0 || plane.waits || plane.turns || s.mode != CommandMode::kFreeMovement) return false;
  if (t < plane.motion.across.duration() || !IsStraightOn(plane, next)) return false;
  const KinematicState now = plane.motion.along.At(t);
  const double left = plane.motion.along.end().position - now.position;
  const double rest = planar::Brake(now, {plane.limits.deceleration, plane.limits.jerk}).rest - now.position;
  return left <= next.blending && left <= rest + 4 * now.velocity * c.cycle.period_s;
}

// Blends the corner at the end of the move of X and Y in progress. Tried once: later there is less room, and it takes
// some 10 to 70 plans.
void PrepareCorner(const Context& c, const Queued& queued, State& s) {
  PlaneMove& plane = s.plane;
  if (plane.tried || plane.waits || plane.turns) return;
  if (s.mode != CommandMode::kFreeMovement || s.tickets[kPlane] == 0 || !IsFree(s, queued, kPlane)) return;
  const std::optional<MoveToPosition> to = MoveOf(c, queued.command, s);
  if (!to || to->blending == 0 || IsStraightOn(plane, *to)) return;
  const MoveToPosition& next = *to;
  plane.tried = true;
  LimitedBy unused;
  const trajectory::Limits then = LimitsOf(next, c.params.xy, unused);
  PlaneMotion motion = plane.motion;
  Corner corner;
  if (!PlanCorner(c.planner, next.x, next.y, next.blending, plane.limits, then, Elapsed(c, plane.begin), motion,
                  corner)) {
    return;
  }
  plane.corner_x = motion.end_x;
  plane.corner_y = motion.end_y;
  plane.motion = motion;
  plane.share = corner.share;
  plane.passes = true;
}

// The corner is not blended after all: the mover stops there.
void StopAtCorner(const Context& c, State& s) {
  PlaneMotion motion;
  const PlaneState now = At(s.plane.motion, Elapsed(c, s.plane.begin));
  if (!PlanMove(c.planner, now, s.plane.corner_x, s.plane.corner_y, s.plane.limits, motion)) {
    return Fail(c, ErrorId::kPlanning, s);
  }
  s.plane.motion = motion;
  s.plane.begin = c.cycle.count;
  s.plane.passes = false;
}

// Returns the distance [mm] from a mover to its target, in its direction.
double WayLeft(const planar::Network& network, const planar::Rider& r) {
  double left = r.target - r.at.position;
  for (std::uint32_t i = 0; i + 1 < r.route.count; ++i) left += network[r.route.tracks[i]].length;
  return r.direction * left;
}

// Returns true if the move along tracks in progress has to brake now, and the next one continues beyond its end.
bool LeadsInto(const Context& c, const MoveOnTrack& next, const State& s) {
  const planar::Rider& rider = c.rider();
  if (s.mode != CommandMode::kOnTrack || s.tickets[kPassing] != 0) return false;
  if (rider.aim != planar::Aim::kTarget || rider.there) return false;
  const planar::Brakes brakes = planar::WithShare(rider.pace.brakes(), rider.pace, rider.share);
  const double rest = std::abs(planar::Brake(rider.at, brakes).rest - rider.at.position);
  // It begins to brake within a cycle or two.
  const double in_time = 4 * std::abs(rider.at.velocity) * c.cycle.period_s;
  const double left = WayLeft(c.streets.network, rider);
  if (left > rest + in_time) return false;
  planar::Rider then = rider;
  if (ComputeRoute(c, next, s, then).error != ErrorId::kNone) return false;
  const auto old = rider.route.all();
  return then.route.count >= old.size() && std::ranges::equal(old, then.route.all().first(old.size())) &&
         WayLeft(c.streets.network, then) >= left;
}

// Returns true if the next command may begin, with or without a stop.
bool IsNext(const Context& c, const Queued& next, const State& s) {
  if (IsFree(s, next, kSlots)) return true;
  if (s.tickets[kPlane] == 0 || !IsFree(s, next, kPlane)) return false;
  if (const std::optional<MoveToPosition> move = MoveOf(c, next.command, s)) return LeadsInto(c, *move, s);
  if (const auto* move = std::get_if<MoveOnTrack>(&next.command)) return LeadsInto(c, *move, s);
  return false;
}

void Wake(const Context& c, State& s) {
  Buffer& b = s.buffer;
  if (s.tickets[kWait] == 0 || c.cycle.count < b.until || (b.for_release && b.releases == 0)) return;
  if (b.for_release) --b.releases;
  End(c, kWait, FeedbackState::kDone, ErrorId::kNone, s);
}

// Ends Waits for a release, without a time, for which there is a release already.
void PassReleases(const Context& c, State& s) {
  Buffer& b = s.buffer;
  while (b.count > 0 && b.releases > 0 && s.tickets[kWait] == 0) {
    const auto* wait = std::get_if<Wait>(&b.waiting[0].command);
    if (!wait || wait->duration > 0 || !wait->for_release) return;
    --b.releases;
    Report(c, b.waiting[0].ticket, FeedbackState::kActive, ErrorId::kNone, 0, s);
    Report(c, b.waiting[0].ticket, FeedbackState::kDone, ErrorId::kNone, 0, s);
    Pop(b);
  }
}

// Records the object for which the next command waits; an empty one: it does not wait.
void HoldFor(const Context& c, const ObjectInfo& object, Buffer& b) {
  if (object && !b.held_by) b.held_since = c.cycle.count;
  b.held_by = object;
  const bool mover = object.kind == ObjectKind::kMover;
  if (mover) b.held_at = c.grounds.movers[object.number - 1].pose;
  planar::Turn* turn = planar::TurnOf(c.index, c.grounds);
  if (!turn) return;
  if (mover) turn->blocker = object.number - 1;
  turn->since = mover ? b.held_since + 1 : 0;
}

// Returns the move of a command that is refused before its own is planned: the area that the mover covers.
planar::Move UnknownMove(const Context& c) {
  return {.target = c.grounds.movers[c.index].pose, .on_track = true};
}

// Begins the next command in its turn. Returns false if it was refused, or waits for `in_the_way`.
bool BeginInTurn(const Context& c, const Queued& next, State& s, ObjectInfo& in_the_way) {
  planar::Turn* turn = planar::TurnOf(c.index, c.grounds);
  if (turn) {
    turn->asks = true;
    turn->move = UnknownMove(c);
  }
  const bool begun = Begin(c, next.ticket, next.command, s, &in_the_way);
  if (turn) turn->asks = false;
  HoldFor(c, in_the_way, s.buffer);
  return begun;
}

// Returns true if the next command waits for a part that is moving.
bool HoldForPart(const Context& c, State& s) {
  const std::uint32_t part = PartAwaited(c, s.buffer.waiting[0].command, s);
  if (part == planar::kNoPart) return false;
  HoldFor(c, ObjectAt(ObjectKind::kPart, part), s.buffer);
  return true;
}

// Returns true if the mover in the way of the next command rests at the pose at which it blocked it, and so still does:
// a request takes a plan and a check of the whole group. The request is still repeated now and then, as this mover
// itself may have changed.
bool StandsInTheWay(const Context& c, const State& s) {
  constexpr std::uint64_t kAskAnyway = 64;  // cycles
  const Buffer& b = s.buffer;
  const std::uint32_t group = c.grounds.Watching(c.grounds.group_of_mover[c.index]);
  if (b.held_by.kind != ObjectKind::kMover || group == 0 || !IsResting(c, s)) return false;
  if ((c.cycle.count - b.held_since) % kAskAnyway == 0) return false;
  const planar::Reservation& its = c.grounds.grounds[group - 1].reserved.movers[b.held_by.number - 1];
  const planar::Pose& at = its.pose;
  return its.present && !its.moving && at.place.x == b.held_at.place.x && at.place.y == b.held_at.place.y &&
         at.c == b.held_at.c;
}

// Begins the next command if it is its turn.
void GiveTurn(const Context& c, State& s) {
  Buffer& b = s.buffer;
  if (b.count == 0) return;
  PrepareCorner(c, b.waiting[0], s);
  if (!IsNext(c, b.waiting[0], s)) return HoldFor(c, {}, b);
  if (HoldForPart(c, s) || StandsInTheWay(c, s)) return;
  const Queued next = b.waiting[0];
  // A move that is continued without a stop is done when its end is passed; in the plane that is now.
  const Ticket before = std::exchange(s.tickets[kPlane], 0);
  const std::uint64_t begun = s.begun[kPlane];
  const bool on_track = IsOnTrack(s);
  const planar::Rider& rider = c.rider();
  const double passing_at = rider.origin + rider.at.position + rider.direction * WayLeft(c.streets.network, rider);
  const std::int8_t direction = rider.direction;
  ObjectInfo in_the_way;
  const bool begun_now = BeginInTurn(c, next, s, in_the_way);
  if (!begun_now) s.tickets[kPlane] = before;
  if (in_the_way) return;
  Pop(b);
  if (!begun_now) return AbortBuffered(c, s);
  EachBeside(next.ticket, s, [&](std::uint32_t bit) {
    for (Queued& waiting : b.waiting) waiting.beside &= ~bit;  // they do wait for this command
  });
  if (before == 0) return;
  s.tickets[kPassing] = before;
  s.begun[kPassing] = begun;
  if (on_track) {
    b.passing_at = passing_at;
    b.direction = direction;
  } else {
    End(c, kPassing, FeedbackState::kDone, ErrorId::kNone, s);
  }
}

}  // namespace

bool IsBuffered(const Command& command) noexcept {
  return std::visit(
      [](const auto& body) {
        if constexpr (requires { body.buffer_mode; }) {
          return body.buffer_mode == Buffering::kBuffered;
        } else {
          return std::is_same_v<std::decay_t<decltype(body)>, Wait>;
        }
      },
      command);
}

bool Push(Ticket ticket, const Command& command, Buffer& buffer) noexcept {
  if (buffer.count == kBuffered) return false;
  buffer.waiting[buffer.count++] = {ticket, command};
  return true;
}

void WaitInTurn(const Context& c, Ticket ticket, const Command& command, const ObjectInfo& in_the_way,
                State& s) noexcept {
  if (IsPlaneResting(c, s)) {
    for (const Slot slot : {kPlane, kPassing, kWait}) End(c, slot, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortBuffered(c, s);
  } else {
    const trajectory::Limits limits = StandardOf(c.params.xy);
    const std::uint32_t releases = s.buffer.releases;
    EndAll(c, false, FeedbackState::kAborted, ErrorId::kNone, s);
    s.buffer.releases = releases;
    BringToRest(c, &limits, s);
  }
  if (planar::Turn* turn = planar::TurnOf(c.index, c.grounds)) turn->move = UnknownMove(c);
  Push(ticket, command, s.buffer);
  HoldFor(c, in_the_way, s.buffer);
  Report(c, ticket, FeedbackState::kBusy, ErrorId::kNone, 0, s);
}

void GoBeside(Ticket ticket, State& s) noexcept {
  EachBeside(ticket, s, [&](std::uint32_t bit) {
    for (std::uint32_t i = 0; i < s.buffer.count; ++i) s.buffer.waiting[i].beside |= bit;
  });
}

void AbortBuffered(const Context& c, State& s) noexcept {
  for (std::uint32_t i = 0; i < s.buffer.count; ++i) {
    Report(c, s.buffer.waiting[i].ticket, FeedbackState::kAborted, ErrorId::kNone, 0, s);
  }
  s.plane.tried = s.plane.passes;
  s.buffer.waiting = {};
  s.buffer.count = 0;
  HoldFor(c, {}, s.buffer);
}

std::uint32_t WaitsFor(const Context& c, std::uint32_t mover) noexcept {
  if (mover >= c.fleet.states.size()) return planar::kNobody;
  const State* s = &c.fleet.states[mover];
  if (IsPlanet(*s)) mover = s->formation.star, s = &c.fleet.states[mover];
  if (!AtRest(*s)) return planar::kNobody;
  const planar::Rider& rider = c.streets.riders[mover];
  if (IsOnTrack(*s) && rider.waits == planar::Waits::kMover) return rider.waits_for;
  if (!IsOnTrack(*s) && s->plane.held_by != planar::kNobody) return s->plane.held_by;
  const bool waits = s->tickets[kPlane] == 0 && s->buffer.held_by.kind == ObjectKind::kMover;
  return waits ? s->buffer.held_by.number - 1 : planar::kNobody;
}

void BeginNext(const Context& c, State& s) noexcept {
  if (s.state != planar::ObjectState::kEnabled) return;
  Wake(c, s);
  PassReleases(c, s);
  GiveTurn(c, s);
  if (IsAtCorner(c, s.plane)) StopAtCorner(c, s);
}

void FinishPassed(const Context& c, State& s) noexcept {
  if (s.tickets[kPassing] == 0) return;
  const planar::Rider& rider = c.rider();
  if (s.buffer.direction * (rider.origin + rider.at.position - s.buffer.passing_at) < -1e-9) return;
  End(c, kPassing, FeedbackState::kDone, ErrorId::kNone, s);
}

AdmissionResult CarryOut(const CommandContext& g, const Wait& command) noexcept {
  g.s.buffer.until = g.c.cycle.count + static_cast<std::uint64_t>(std::llround(command.duration / g.c.cycle.period_s));
  g.s.buffer.for_release = command.for_release;
  Take(g, kWait);
  return {};
}

AdmissionResult CarryOut(const CommandContext& g, const Release&) noexcept {
  if (g.s.state != planar::ObjectState::kEnabled) return Refused(ErrorId::kMoverDisabled);
  ++g.s.buffer.releases;
  return Done();
}

void describe(Description<Queued>& d) {
  d.about("A buffered command of a mover.");
  d.internal<&Queued::ticket>("Ticket of the command.");
  d.internal<&Queued::command>("Command and its arguments.");
  d.internal<&Queued::beside>("Bits of the slots that the command does not wait for.");
}

void describe(Description<Buffer>& d) {
  using B = Buffer;
  d.named("MoverBuffer");
  d.about("Buffered commands of a mover.");
  d.internal<&B::waiting>("Buffered commands, the next one first.");
  d.internal<&B::count>("Number of buffered commands.");
  d.internal<&B::releases>("Number of releases that no wait has consumed.");
  d.internal<&B::until>("Cycle in which the time of a wait is over.");
  d.internal<&B::for_release>("True: the wait ends with a release only.");
  d.internal<&B::passing_at>("End of the move along tracks that continued into the next one, over all tracks.");
  d.internal<&B::direction>("Direction of that move.");
  d.internal<&B::held_by>("Part, mover or track that blocks the next command.");
  d.internal<&B::held_at>("Pose of that mover when the request was refused.");
  d.internal<&B::held_since>("Cycle since which the next command is blocked.");
}

}  // namespace takt::mover
