#include "takt/group/sync.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/guidance.h"
#include "takt/group/queue.h"

namespace takt::group {

namespace {

// [mm] largest distance from the demanded position that counts as in sync.
constexpr double kInStep = 0.01;
// A small distance to the master is made up in this number of build-up times: an acceleration can be taken back only
// after one of them.
constexpr double kCatchUpTimes = 3;
// Share of the deceleration for catching up; the rest is for what the master does meanwhile.
constexpr double kCatchUpShare = 0.5;

// Returns the motion of the master in units of the path.
KinematicState WayOf(const Context& c, const State& s) {
  const axis::State& master = c.axes.states[s.master.axis - 1];
  return {s.master.ratio * (master.setpoint.position + master.origin - s.master.begin),
          s.master.ratio * master.setpoint.velocity, s.master.ratio * master.setpoint.acceleration};
}

// Returns the path speed above the master's at this distance behind it: such that this speed v can be taken back with a
// deceleration d, v + v²/(2 d) in units of the times above.
double Closing(double behind, const trajectory::PathNode& node) {
  const double deceleration = kCatchUpShare * node.bounds.deceleration;
  const double offset = deceleration * kCatchUpTimes * node.build_up_s;
  return std::copysign(std::sqrt(offset * offset + 2 * deceleration * std::abs(behind)) - offset, behind);
}

axis::Context ContextOf(const Context& c, const SyncedAxis& synced) {
  return c.axes.Of(synced.axis - 1);
}
axis::State& StateOf(const Context& c, const SyncedAxis& synced) {
  return c.axes.states[synced.axis - 1];
}

}  // namespace

void BeginFollowing(const Context& c, const Request& move, std::uint64_t number, State& s) noexcept {
  if (s.master.axis != 0 && s.master.move == number) return;  // after a stop within the move
  s.master = {};
  if (move.master == 0) return;
  const axis::State& master = c.axes.states[move.master - 1];
  s.master.axis = move.master;
  s.master.move = number;
  s.master.ratio = move.ratio;
  s.master.begin = master.setpoint.position + master.origin;
}

bool Follows(const Context& c, const State& s) noexcept {
  if (s.master.axis == 0 || c.ahead.count == 0) return false;
  return c.ahead.At(s.pace.raw.position)->move == s.master.move;
}

double WishOfMaster(const Context& c, State& s) noexcept {
  const double period = c.cycle.period_s;
  const KinematicState way = WayOf(c, s);
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  // The raw motion whose mean is the motion of the master, as long as its jerk is constant.
  const double half = 0.5 * s.pace.cycles * period;
  const double third = half * half / 3;
  const double jerk = (way.acceleration - s.master.before) / period;
  s.master.before = way.acceleration;
  const double wanted = way.position + half * way.velocity + third * way.acceleration;
  const double velocity = way.velocity + half * way.acceleration + third * jerk;
  const double behind = wanted - (s.pace.raw.position + 0.5 * period * (s.pace.raw.velocity + velocity));
  return std::clamp(velocity + Closing(behind, node), 0.0, node.at.limits.velocity);
}

void WatchMaster(const Context& c, State& s) noexcept {
  if (s.master.axis == 0) return;
  if (s.done != s.master.move) {  // later moves do not follow
    s.master = {};
    return;
  }
  s.master.in_step = std::abs(WayOf(c, s).position - s.pace.now.position) <= kInStep;
  if (!s.master.in_step || s.master.reached || s.queue.count == 0) return;
  s.master.reached = true;
  c.feedback.Report({MoveAt(s, s.done).ticket, c.cycle.count, FeedbackState::kActive, true, ErrorId::kNone, 0});
}

ErrorId Sync(const Context& c, Ticket ticket, const SyncAxis& command, State& s) noexcept {
  const std::uint32_t found = axis::FindAxis(c.axes.params, command.axis.view());
  if (found == axis::kNoAxis) return ErrorId::kUnknownTarget;
  const std::uint32_t axis = found + 1;
  if (c.group_of[axis - 1] != 0) return ErrorId::kGroupMember;
  const auto known = std::ranges::find(s.synced, axis, &SyncedAxis::axis);
  // Another component guides it: a cam module, another group.
  if (known == s.synced.end() && axis::IsGuided(c.axes.states[found])) return ErrorId::kState;
  const auto place = known != s.synced.end() ? known : std::ranges::find(s.synced, 0u, &SyncedAxis::axis);
  if (place == s.synced.end()) return ErrorId::kBufferFull;
  if (place->axis != 0) Report(c, place->ticket, FeedbackState::kAborted);
  *place = {ticket, axis, command.ratio_numerator / command.ratio_denominator, 0, false};
  axis::State& state = StateOf(c, *place);
  const Status status = axis::Guide(ContextOf(c, *place), state);
  if (status.failed()) {
    *place = {};
    return status.error;
  }
  place->offset = state.setpoint.position + state.origin - place->ratio * (s.way_before + s.pace.now.position);
  return ErrorId::kNone;
}

void LeadSynced(const Context& c, State& s) noexcept {
  for (SyncedAxis& synced : s.synced) {
    if (synced.axis == 0) continue;
    axis::State& state = StateOf(c, synced);
    if (!axis::IsGuided(state)) {  // another component or command has taken it
      const bool failed = state.plc == axis::PlcState::kErrorStop;
      Report(c, synced.ticket, failed ? FeedbackState::kError : FeedbackState::kAborted,
             failed ? ErrorId::kAxisFault : ErrorId::kNone);
      synced = {};
      continue;
    }
    if (!synced.reached && state.guidance.chase.in_step) {
      synced.reached = true;
      c.feedback.Report({synced.ticket, c.cycle.count, FeedbackState::kActive, true, ErrorId::kNone, 0});
    }
    state.guidance.demand = {synced.offset + synced.ratio * (s.way_before + s.pace.now.position),
                             synced.ratio * s.pace.now.velocity, synced.ratio * s.pace.now.acceleration};
  }
}

void ReleaseSynced(const Context& c, FeedbackState feedback, State& s) noexcept {
  for (SyncedAxis& synced : s.synced) {
    if (synced.axis == 0) continue;
    axis::EndGuidance(ContextOf(c, synced), StateOf(c, synced));
    Report(c, synced.ticket, feedback);
    synced = {};
  }
}

}  // namespace takt::group
