#include "takt/group/run.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/guidance.h"
#include "takt/group/make_stretch.h"
#include "takt/group/members.h"
#include "takt/group/queue.h"
#include "takt/group/sync.h"

namespace takt::group {

namespace {

// The stretch that a place of the path lies on.
const Stretch* StretchAt(LookAhead& ahead, double s) {
  while (ahead.count > 1 && ahead[ahead.first].end() <= s) {
    ++ahead.first;
    --ahead.count;
  }
  return ahead.count > 0 ? &ahead[ahead.first] : nullptr;
}

void Demand(const Context& c, const kinematics::JointMotion& motion, State& s) {
  s.joints = motion.position;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    MemberOf(c, s, k).guidance.demand = {motion.position[k] + s.origins[k], motion.velocity[k], motion.acceleration[k]};
  }
}

bool Follow(const Context& c, State& s) {
  const KinematicState& now = s.pace.now;
  const Stretch* stretch = StretchAt(c.ahead, now.position);
  if (!stretch) return true;
  kinematics::JointMotion by_way;
  const double way = std::clamp(stretch->from + now.position - stretch->begin, stretch->from, stretch->to);
  if (const auto reason = AxesOn(c, s, *stretch, way, s.joints, by_way); reason != kinematics::Reason::kNone) {
    s.reason = reason;
    return false;
  }
  kinematics::JointMotion motion = by_way;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const KinematicState at =
        trajectory::AlongWay({by_way.position[k], by_way.velocity[k], by_way.acceleration[k]}, now);
    motion.velocity[k] = at.velocity;
    motion.acceleration[k] = at.acceleration;
  }
  Demand(c, motion, s);
  return true;
}

// Moves whose last stretch is behind are done; the one that is being gone is active.
void TellMoves(const Context& c, State& s) {
  if (c.ahead.count == 0) return;
  const std::uint64_t at = c.ahead[c.ahead.first].move;
  while (s.queue.count > 0 && s.done < at) Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (s.queue.count > 0 && s.done == at && s.active != MoveAt(s, at).ticket) {
    s.active = MoveAt(s, at).ticket;
    Report(c, s.active, FeedbackState::kActive);
  }
}

double WishOf(const Context& c, State& s) {
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  if (!s.ends && !s.interrupted) {
    if (Follows(c, s)) return WishOfMaster(c, s);
    return s.velocity_factor < 1 ? s.velocity_factor * node.at.limits.velocity : trajectory::kFullSpeed;
  }
  double deceleration = s.brake.deceleration > 0 ? s.brake.deceleration : node.bounds.deceleration;
  // What takes no longer to build up, and to be taken back, than all accelerations of this path.
  if (s.brake.jerk > 0) deceleration = std::min(deceleration, s.brake.jerk * node.build_up_s);
  return std::max(0.0, s.pace.raw.velocity - deceleration * c.cycle.period_s);
}

// What lies behind is forgotten.
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
      LetGoOfMembers(c, s);
      return status.error;
    }
    member.guidance.brakes_with_others = true;
    s.origins[k] = member.origin;
    s.joints[k] = member.setpoint.position;
  }
  s.guides = true;
  return ErrorId::kNone;
}

void LetGoOfMembers(const Context& c, State& s) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    axis::LetGoOfGuidance(ContextOf(c, s, k), MemberOf(c, s, k));
  }
  s.guides = false;
}

bool Advance(const Context& c, State& s) noexcept {
  if (s.pace.raw_stands && trajectory::Stands(s.pace) && !s.ends) {
    // Behind a stop the next motion begins.
    const std::uint64_t next = s.pace.node + 1;
    const trajectory::PathWindow& window = c.ahead.window;
    if (window[s.pace.node].stop && next + 1 < window.known() && window.swept()) {
      trajectory::BeginAt(window, next, c.cycle.period_s, s.pace);
      const std::uint64_t move = c.ahead[c.ahead.first].move;
      BeginFollowing(c, MoveAt(s, move), move, s);
    }
  }
  trajectory::Advance(c.ahead.window, WishOf(c, s), c.cycle.period_s, s.pace);
  if (!Follow(c, s)) return false;
  TellMoves(c, s);
  WatchMaster(c, s);
  Forget(c, s);
  return true;
}

bool Rests(const State& s) noexcept {
  return trajectory::Stands(s.pace);
}

void EndMotion(const Brake& brake, State& s) noexcept {
  s.ends = true;
  s.interrupted = false;
  s.brake = brake;
}

}  // namespace takt::group
