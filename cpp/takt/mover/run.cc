#include "takt/mover/run.h"

#include <algorithm>

#include "takt/mover/coordinate.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

namespace {

const CoordinateParams& Described(const MoverParams& p, std::size_t other) {
  const std::array all = {&p.z, &p.a, &p.b, &p.c};
  return *all[other];
}

}  // namespace

void Report(const Context& c, Ticket ticket, FeedbackState state, ErrorId error, double value, State& s) noexcept {
  const FeedbackEvent event{ticket, c.cycle.count, state, false, error, value};
  c.feedback.Report(event);
  if (ticket != 0) s.history.Note(event);
}

void End(const Context& c, Slot slot, FeedbackState state, ErrorId error, State& s) noexcept {
  if (s.tickets[slot] != 0) Report(c, s.tickets[slot], state, error, 0, s);
  s.tickets[slot] = 0;
}

void EndAll(const Context& c, bool power, FeedbackState state, ErrorId error, State& s) noexcept {
  for (std::size_t slot = power ? 0 : kPower + 1; slot < kSlots; ++slot) {
    End(c, static_cast<Slot>(slot), state, error, s);
  }
}

void Enter(const Context& c, planar::ObjectState state, State& s) noexcept {
  s.state = state;
  s.since = c.cycle.count;
}

bool IsPlaneResting(const Context& c, const State& s) noexcept {
  const auto rests = [](const KinematicState& k) { return k.velocity == 0 && k.acceleration == 0; };
  const planar::Rider& rider = c.rider();
  const bool goes = IsOnTrack(s) && rider.aim != planar::Aim::kRest && !rider.there;
  return !goes && IsOver(c, s.plane) && rests(s.set_point[kX]) && rests(s.set_point[kY]);
}

void LeaveStreets(const Context& c, State& s) noexcept {
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
  const bool bound = s.mode == CommandMode::kFreeMovement || s.mode == CommandMode::kOnTrack;
  return Windowed(params, s.set_point[kC].position, bound);
}

namespace {

// A motion on the plane that begins now, and does not lead off the stators.
bool Stays(const Context& c, const State& s, const PlaneMotion& motion) {
  if (c.streets.parts->none() || IsOnTrack(s)) return true;
  PlaneMove move;
  move.motion = motion;
  move.begin = c.cycle.count;
  return WhyNotOn(c, s, CoverOf(c, move, s.others.back())) == ErrorId::kNone;
}

}  // namespace

void BringToRest(const Context& c, const trajectory::Limits* plane, State& s) noexcept {
  const trajectory::Limits maximum = c.params.xy.maximum.limits();
  const SetPoint& at = s.set_point;
  PlaneMotion rest = StandingAt(at[kX].position, at[kY].position);
  const auto plan = [&](const trajectory::Limits& limits) {
    const bool found = s.external.mode == SetpointMode::kNone
                           ? PlanRest(c.planner, s.plane.motion, Elapsed(c, s.plane.begin), limits, rest)
                           : PlanRest(c.planner, {at[kX], at[kY]}, limits, rest);
    return found && SpeedBound(rest) <= maximum.velocity * (1 + 1e-9) && Stays(c, s, rest);
  };
  if (IsOnTrack(s)) {
    c.rider().aim = planar::Aim::kRest;  // with its greatest dynamics, as all others reckon
  } else {
    if (plane == nullptr || !plan(*plane)) plan(maximum);
    if (s.mode == CommandMode::kJoiningTrack || s.mode == CommandMode::kLeavingTrack) {
      LeaveStreets(c, s);
      s.mode = CommandMode::kFreeMovement;
    }
  }
  s.plane = {};
  s.plane.motion = rest;
  s.plane.begin = c.cycle.count;
  for (std::size_t i = 0; i < kOthers.size(); ++i) {
    const CoordinateParams params = ParamsOf(c, s, i);
    // C turns no further than it was to, where that counts.
    const bool hard = plane == nullptr || (kOthers[i] == kC && !c.streets.parts->none());
    const trajectory::Limits limits = hard ? params.maximum.limits() : StandardOf(params);
    PlanRest(c.planner, at[kOthers[i]], limits, params, s.others[i].profile);
    s.others[i].begin = c.cycle.count;
  }
  s.external = {};
}

void Fail(const Context& c, ErrorId error, State& s, bool aborts) noexcept {
  using enum planar::ObjectState;
  if (s.state == kResetting || s.state == kErrorPending || s.state == kError) return;
  EndAll(c, true, FeedbackState::kError, error, s);
  s.error = error;
  s.aborts = aborts || s.state == kDisabled || s.state == kDisabling;
  BringToRest(c, nullptr, s);
  Enter(c, kErrorPending, s);
}

}  // namespace takt::mover
