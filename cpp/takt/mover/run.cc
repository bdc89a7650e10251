#include "takt/mover/run.h"

#include <algorithm>
#include <cmath>

#include "takt/mover/area_reservation.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/follow.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

const CoordinateParams& Described(const MoverParams& p, std::size_t other) {
  const std::array all = {&p.z, &p.a, &p.b, &p.c};
  return *all[other];
}

}  // namespace

void Report(const Context& c, Ticket ticket, FeedbackState state, ErrorId error, double value, State& s,
            const ObjectInfo& object) noexcept {
  const FeedbackEvent event{ticket, c.cycle.count, state, false, error, value, object};
  c.feedback.Report(event);
  if (ticket != 0) s.history.Note(event);
}

void End(const Context& c, Slot slot, FeedbackState state, ErrorId error, State& s, const ObjectInfo& object) noexcept {
  const bool done = state == FeedbackState::kDone;
  if (s.tickets[slot] != 0) Report(c, s.tickets[slot], state, error, done ? Elapsed(c, s.begun[slot]) : 0, s, object);
  s.tickets[slot] = 0;
}

void EndAll(const Context& c, bool power, FeedbackState state, ErrorId error, State& s,
            const ObjectInfo& object) noexcept {
  for (std::size_t slot = power ? 0 : kPower + 1; slot < kSlots; ++slot) {
    End(c, static_cast<Slot>(slot), state, error, s, object);
  }
  AbortBuffered(c, s);
  s.buffer.releases = 0;
}

void Enter(const Context& c, planar::ObjectState state, State& s) noexcept {
  s.state = state;
  s.since = c.cycle.count;
}

bool IsMovingAlongTrack(const Context& c, const State& s) noexcept {
  const planar::Rider& rider = c.rider();
  return IsOnTrack(s) && ((rider.aim != planar::Aim::kRest && !rider.there) || !planar::Rests(rider.at));
}

bool IsPlaneResting(const Context& c, const State& s) noexcept {
  return !IsMovingAlongTrack(c, s) && IsOver(c, s.plane) && planar::Rests(s.set_point[kX]) &&
         planar::Rests(s.set_point[kY]);
}

void LeaveTrackNetwork(const Context& c, State& s) noexcept {
  c.rider() = {};
  s.track = planar::kNoTrack;
}

bool IsResting(const Context& c, const State& s) noexcept {
  const auto over = [&](const CoordinateMove& move) { return IsOver(c, move); };
  return s.external.mode == SetpointMode::kNone && IsPlaneResting(c, s) && std::ranges::all_of(s.others, over) &&
         AtRest(s);
}

CoordinateParams ParamsOf(const Context& c, const State& s, std::size_t other) noexcept {
  const CoordinateParams& params = Described(c.params, other);
  if (kOthers[other] != kC) return params;
  const bool moves = !planar::Rests(s.set_point[kX]) || !planar::Rests(s.set_point[kY]);
  const bool bound = s.mode == CommandMode::kFreeMovement || s.mode == CommandMode::kOnTrack ||
                     (s.mode == CommandMode::kExternalSetpointGeneration && moves);
  return Windowed(params, s.set_point[kC].position, bound);
}

namespace {

// The stops of X and Y, and of the other coordinates.
struct Rest {
  PlaneMove plane;
  std::array<CoordinateMove, kOthers.size()> others;
};

bool MoveAlike(const KinematicState& a, const KinematicState& b) {
  constexpr double kAlike = 1e-9;  // [mm/s, mm/s²] rounding
  return std::abs(a.velocity - b.velocity) <= kAlike && std::abs(a.acceleration - b.acceleration) <= kAlike;
}

// Returns true if a motion in the plane that begins now does not leave the stators.
bool Stays(const Context& c, const State& s, const PlaneMotion& motion) {
  if (c.streets.parts->none() || IsOnTrack(s)) return true;
  PlaneMove move;
  move.motion = motion;
  move.begin = c.cycle.count;
  return DiagnoseCover(c, s, CoverOf(c, move, s.others.back())) == ErrorId::kNone;
}

// On a track: plans the stop of the displacement by external set points, and its return to 0 once the mover rests along
// the track.
PlaneMove PlanBack(const Context& c, const State& s) {
  PlaneMove back;
  back.begin = c.cycle.count;
  const bool more = s.external.mode == SetpointMode::kRelative;
  const PlaneState off = OffTrack(s, more ? s.external.taken : SetPoint{}, Elapsed(c, s.plane.begin));
  const trajectory::Limits maximum = c.params.xy.maximum.limits();
  if (off.x.position == 0 && off.y.position == 0 && planar::Rests(off.x) && planar::Rests(off.y)) return back;
  PlanRest(c.planner, off, maximum, back.motion);
  back.waits = true;
  back.next = {.velocity = maximum.velocity,
               .acceleration = maximum.acceleration,
               .deceleration = maximum.deceleration,
               .jerk = maximum.jerk};
  return back;
}

}  // namespace

bool PlanStop(const Context& c, const State& s, const SetPoint& at, const trajectory::Limits& limits,
              PlaneMotion& rest) noexcept {
  if (s.external.mode == SetpointMode::kNone) {
    return PlanRest(c.planner, s.plane.motion, Elapsed(c, s.plane.begin), limits, rest);
  }
  // While external set points do not move it, the mover brakes along its planned motion, and so within what it has
  // reserved.
  const PlaneState planned = At(s.plane.motion, Elapsed(c, s.plane.begin));
  const bool beside =
      s.external.mode == SetpointMode::kRelative && MoveAlike(planned.x, at[kX]) && MoveAlike(planned.y, at[kY]);
  if (!beside) return PlanRest(c.planner, {at[kX], at[kY]}, limits, rest);
  if (!PlanRest(c.planner, s.plane.motion, Elapsed(c, s.plane.begin), limits, rest)) return false;
  Shift(at[kX].position - planned.x.position, at[kY].position - planned.y.position, rest);
  return true;
}

namespace {

// Plans a stop of X and Y within `plane`; null: all with the maximum dynamics.
Rest PlanRest(const Context& c, const trajectory::Limits* plane, const State& s) {
  const trajectory::Limits maximum = c.params.xy.maximum.limits();
  const SetPoint& at = s.set_point;
  Rest all;
  PlaneMotion& rest = all.plane.motion;
  rest = StandingAt(at[kX].position, at[kY].position);
  all.plane.begin = c.cycle.count;
  const auto plan = [&](const trajectory::Limits& limits) {
    const bool found = PlanStop(c, s, at, limits, rest);
    return found && SpeedBound(rest) <= maximum.velocity * (1 + 1e-9) && Stays(c, s, rest);
  };
  if (IsOnTrack(s)) {
    all.plane = PlanBack(c, s);
  } else if (plane == nullptr || !plan(*plane)) {
    plan(maximum);
  }
  for (std::size_t i = 0; i < kOthers.size(); ++i) {
    const CoordinateParams params = ParamsOf(c, s, i);
    // With parts, C stops with the maximum dynamics, so it turns no further than planned.
    const bool hard = plane == nullptr || (kOthers[i] == kC && !c.streets.parts->none());
    const trajectory::Limits limits = hard ? params.maximum.limits() : StandardOf(params);
    all.others[i] = s.others[i];
    PlanRest(c.planner, at[kOthers[i]], limits, params, all.others[i].profile);
    all.others[i].begin = c.cycle.count;
  }
  return all;
}

}  // namespace

namespace {

void RestOnTrack(const trajectory::Limits* softly, planar::Rider& rider) {
  rider.aim = planar::Aim::kRest;
  rider.softly = softly != nullptr;
  if (!softly) return;
  rider.pace.limits.deceleration = softly->deceleration;
  rider.pace.limits.jerk = softly->jerk;
}

// Returns whether a stop on a track with these dynamics would leave the stators.
bool LeadsAway(const Context& c, const trajectory::Limits& softly, const CoordinateMove& turn, const State& s) {
  if (!IsOnTrack(s)) return false;
  planar::Rider then = c.rider();
  RestOnTrack(&softly, then);
  return DiagnoseRoute(c, s, then, turn) != ErrorId::kNone;
}

}  // namespace

void BringToRest(const Context& c, const trajectory::Limits* plane, State& s) noexcept {
  if (s.mode == CommandMode::kJoiningTrack || s.mode == CommandMode::kLeavingTrack) {
    LeaveTrackNetwork(c, s);
    s.mode = CommandMode::kFreeMovement;
  }
  Rest rest = PlanRest(c, plane, s);
  if (IsPlanet(s)) {  // X, Y and C belong to the star
    std::copy_n(rest.others.begin(), rest.others.size() - 1, s.others.begin());
    return;
  }
  // With the maximum dynamics the mover stays within what it has reserved.
  const bool hard = !plane || FindObstacle(c, rest.plane, rest.others.back(), IsOnTrack(s)) ||
                    LeadsAway(c, *plane, rest.others.back(), s);
  if (plane && hard) rest = PlanRest(c, nullptr, s);
  // The stop that the guard knows.
  if (hard && !IsOnTrack(s) && s.escape.cycle == c.cycle.count) {
    rest.plane.motion = s.escape.motion;
    rest.plane.begin = s.escape.begin;
  }
  s.plane = rest.plane;
  s.plane.hard = hard;
  s.others = rest.others;
  if (IsOnTrack(s)) RestOnTrack(hard ? nullptr : plane, c.rider());
  s.external = {};
  if (IsStar(c)) s.formation.whole = &c.params == &c.fleet.bodies[c.index].alone;
  Reserve(c, s, IsOnTrack(s));
}

void BringToRestOnTrack(const Context& c, const trajectory::Limits& limits, State& s) noexcept {
  RestOnTrack(LeadsAway(c, limits, s.others.back(), s) ? nullptr : &limits, c.rider());
}

void Fail(const Context& c, ErrorId error, State& s, bool aborts, const ObjectInfo& object) noexcept {
  using enum planar::ObjectState;
  if (s.state == kResetting || s.state == kErrorPending || s.state == kError) return;
  EndAll(c, true, FeedbackState::kError, error, s, object);
  s.error = error;
  s.aborts = aborts || s.state == kDisabled || s.state == kDisabling;
  BringToRest(c, nullptr, s);
  Enter(c, kErrorPending, s);
}

}  // namespace takt::mover
