#include "takt/group/sample.h"

#include <algorithm>
#include <cmath>

#include "takt/group/boarding.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/failures.h"
#include "takt/group/make_stretch.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"

namespace takt::group {

namespace {

constexpr std::size_t kSpareNodes = 4;
constexpr double kLeastStep = 1e-3;  // [mm]
// Stretches that wait are sampled once the motion might have to brake for them within this number of nodes, or this
// time [s]: early enough to rehearse them.
constexpr std::uint64_t kNodesAhead = 256;
constexpr double kTimeAhead = 0.2;
constexpr double kTrifle_s = 0.02;    // time in which a next move may come, and largest duration of what waits
constexpr double kFarAhead_s = 0.05;  // at the present speed, least distance to what waits
constexpr double kUneven = 0.25;      // [mm or deg]
constexpr double kUnevenShare = 0.1;

// Ends a path that has begun and cannot be continued, and aborts the moves after it.
void CutShort(const Context& c, const Stretch& stretch, kinematics::Reason reason, double at, State& s) {
  s.reason = reason;
  c.ahead.failures = FailuresOn(c, s, stretch, stretch.from + at, reason, c.ahead.last_joints);
  s.blocked_at = at;
  s.blocked_element = ElementOf(s);
  c.ahead.cut_short = true;
  c.ahead.sampling = c.ahead.end();
  AbortBehind(c, stretch.move, s);
}

bool SampleBegin(const Context& c, const Stretch& stretch, State& s) {
  trajectory::PathPoint point;
  point.s = stretch.begin;
  point.limits = stretch.limits;
  const trajectory::PathWindow& window = c.ahead.window;
  Boarding* boarding = BoardingOn(c.ahead, stretch);
  // After a stop the path begins when the tool is in sync.
  const bool behind_stop = window.end() > window.begin() && window[window.end() - 1].stop;
  if (boarding && boarding->square > 0 && behind_stop) boarding->reach = point.s;
  kinematics::JointMotion motion;
  if (SlopesOn(c, s, stretch, stretch.from, c.ahead.last_joints, point, motion) != kinematics::Reason::kNone) {
    return false;
  }
  // Predictions of carriers differ from time to time: that is no corner.
  if (stretch.goes_on) point.slopes.first = c.ahead.last.slopes.first;
  c.ahead.last_joints = motion.position;
  c.ahead.last = point;
  c.ahead.window.Append(point);
  if (boarding) BeginReserve(c, *boarding);
  ++s.planning.nodes;
  return true;
}

// Appends one node. Returns false if the path cannot be followed.
bool SampleNext(const Context& c, const Stretch& stretch, int& budget, State& s) {
  kinematics::Reason reason = kinematics::Reason::kNone;
  double failed_at = 0;
  kinematics::JointMotion motion, before;  // at the last two points: the node, then the middle before it
  const bool carried = IsCarried(c.ahead, stretch);
  const auto slopes_at = [&](double at, trajectory::PathPoint& point) {
    budget -= carried ? 3 : 1;
    before = motion;
    reason = SlopesOn(c, s, stretch, stretch.from + (at - stretch.begin), c.ahead.last_joints, point, motion);
    failed_at = at;
    return reason == kinematics::Reason::kNone;
  };
  const trajectory::CoordinateLimits& limits = c.ahead.window.limits();
  const double left = stretch.end() - c.ahead.last.s;
  double most = stretch.to - stretch.from;
  if (stretch.segment.shape == path::Shape::kLine) {
    most = trajectory::StepBetweenSlowPoints(c.ahead.last, stretch.begin, stretch.end(), limits,
                                             c.ahead.window.build_up_s(), c.cycle.period_s);
  }
  most = std::max(most, kLeastStep);
  double end = left < 1.5 * most ? stretch.end() : c.ahead.last.s + most;
  // Boarding reserves limits up to an arc length: the next node is no further.
  trajectory::PathWindow& window = c.ahead.window;
  Boarding* boarding = BoardingOn(c.ahead, stretch);
  if (boarding && c.ahead.last.s >= boarding->reach) boarding = nullptr;
  if (boarding) {
    end = std::clamp(UpdateReach(window[window.end() - 1], *boarding), std::min(c.ahead.last.s + kLeastStep, end), end);
  }
  trajectory::PathPoint next;
  const auto bends = carried                       ? trajectory::BendSearch::kIgnored
                     : c.params.path.planned_ahead ? trajectory::BendSearch::kInJerk
                                                   : trajectory::BendSearch::kInAcceleration;
  for (bool even = false; !even;) {
    if (!trajectory::NextPoint(c.ahead.last, end, limits, c.ahead.window.build_up_s(), c.cycle.period_s, bends,
                               slopes_at, next)) {
      CutShort(c, stretch, reason, failed_at - stretch.begin, s);
      return false;
    }
    const double length = next.s - c.ahead.last.s;
    even = length <= kLeastTry || carried ||
           GoesEvenly(c.ahead.last_joints, c.ahead.last.slopes, before.position, next.slopes, length);
    end = c.ahead.last.s + 0.5 * length;
  }
  c.ahead.last_joints = before.position;
  c.ahead.last = next;
  next.renewed = boarding && next.s >= boarding->reach;
  window.Append(next, stretch.stops && next.s >= stretch.end());
  if (boarding) AdvanceReserve(c, window[window.end() - 2], window[window.end() - 1], *boarding);
  ++s.planning.nodes;
  return true;
}

// Returns true if the known end of the path does not yet slow the motion down.
bool GoesFreely(const Context& c, const State& s) {
  if (const trajectory::PathTiming& timing = c.ahead.timing; timing.active()) {
    const Stretch& blend = c.ahead[c.ahead.end() - 2];
    const double way = blend.begin - timing.EstimatedStop(c.ahead.window, s.pace);
    return timing.rest_s() > kTimeAhead || way > kFarAhead_s * blend.limits.velocity;
  }
  const trajectory::PathWindow& window = c.ahead.window;
  const std::uint64_t end = std::min(window.known(), s.pace.node + kNodesAhead);
  const double far = s.pace.raw.position + kTimeAhead * s.pace.raw.velocity;
  for (std::uint64_t i = s.pace.node + 1; i < end; ++i) {
    const trajectory::PathNode& node = window[i];
    if (node.at.s > far && node.ceiling >= node.cap) return true;
  }
  return false;
}

// Returns true if a next move may still come in time for the corner before the last stretch: the last move has just
// come, and what waits meanwhile is short and far ahead.
bool MayComeSoon(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  const Stretch& last = ahead[ahead.end() - 1];
  const double begin = ahead[ahead.end() - 2].begin;
  return static_cast<double>(c.cycle.count - s.planning.joined) * c.cycle.period_s < kTrifle_s &&
         last.end() - begin < kTrifle_s * last.limits.velocity &&
         begin - s.pace.now.position > kFarAhead_s * s.pace.now.velocity;
}

bool IsTransition(const Stretch& stretch) {
  return stretch.from_ride != stretch.to_ride;
}

}  // namespace

bool GoesEvenly(const kinematics::Joints& before, const trajectory::PathSlopes& slopes_before,
                const kinematics::Joints& after, const trajectory::PathSlopes& slopes_after, double length) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const double way = after[k] - before[k];
    const double expected = 0.5 * length * (slopes_before.first[k] + slopes_after.first[k]);
    if (std::abs(way - expected) > std::max(kUneven, kUnevenShare * std::abs(way))) return false;
  }
  return true;
}

std::uint64_t SampledTo(const Context& c, const State& s) noexcept {
  const LookAhead& ahead = c.ahead;
  const bool more = s.planning.move < s.done + s.queue.count;
  if (ahead.cut_short || ahead.count == 0) return ahead.end();
  // The transition between carrier bindings depends on its end.
  if (more && (s.planning.element > 0 || MoveAt(s, s.planning.move).blends())) {
    std::uint64_t open = ahead.end();
    while (open > ahead.first && IsTransition(ahead[open - 1]) && !ahead[open - 1].begun) --open;
    if (open < ahead.end()) return open;
  }
  if (!ahead.corner.open || ahead.count < 2) return ahead.end();
  const bool waits = more ? s.planning.element > 0 || MoveAt(s, s.planning.move).blends()
                          : s.begun && (GoesFreely(c, s) || MayComeSoon(c, s));
  return waits ? ahead.end() - 2 : ahead.end();
}

void Sample(const Context& c, int& budget, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  const std::uint64_t end = SampledTo(c, s);
  while (budget > 0 && ahead.sampling < end) {
    if (ahead.window.room() < kSpareNodes) {  // the rest when there is room again
      ahead.window.Close();
      s.planning.stage = Stage::kSweep;
      return;
    }
    Stretch& stretch = ahead[ahead.sampling];
    ahead.window.SetBuildUp(stretch.build_up_s);
    if (!stretch.begun) {
      stretch.begun = true;
      --budget;
      if (!SampleBegin(c, stretch, s)) CutShort(c, stretch, kinematics::Reason::kSingular, 0, s);
    } else if (ahead.last.s >= stretch.end()) {
      ++ahead.sampling;
    } else {
      SampleNext(c, stretch, budget, s);
    }
  }
  if (ahead.sampling < end) return;
  ahead.window.Close();
  s.planning.stage = Stage::kSweep;
}

}  // namespace takt::group
