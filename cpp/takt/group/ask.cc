#include "takt/group/ask.h"

#include <algorithm>

#include "takt/group/carrier_bindings.h"
#include "takt/group/make_stretch.h"
#include "takt/group/queue.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

// A path that begins on a moving carrier, in its expected pose in the MCS: from the expected pose of the tool when it
// starts to that of the target when it arrives.
void FromCarrier(const Context& c, const State& s, PathCheckRequest& question) {
  const LookAhead& ahead = c.ahead;
  const Stretch& next = ahead.next;
  const CarrierBinding& from = ahead.rides[next.from_ride % kRides];
  const CarrierBinding& to = ahead.rides[next.to_ride % kRides];
  const double begin_s = std::max(0.0, ahead.end_eta - Now(c)), end_s = std::max(begin_s, next.eta_end - Now(c));
  const Frame begin = DisplacementOf(c, from, begin_s).GetFrame();
  const Frame target = DisplacementOf(c, to, end_s).GetFrame() * path::PointAt(next.segment, next.segment.length).frame;
  Request& move = question.move;
  move.kind = move.kind == MoveKind::kArch ? MoveKind::kArch : MoveKind::kLinear;
  move.relative = false;
  move.system = CoordinateSystem::kMcs;
  move.cargo = {};
  move.frame = kinematics::ToPose(target);
  std::fill_n(move.to.begin(), kToolNumbers, 0.0);
  std::fill_n(move.to.begin() + kToolNumbers, c.kinematics->count, kNotGiven);
  JointsAt(c, begin * ahead.end_tool, s.joints, question.from);
  if (question.follows) question.before.segment = Moved(begin, question.before.segment);
}

PathCheckRequest QuestionOf(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  PathCheckRequest question;
  question.group = c.number;
  question.number = s.planning.question;
  question.move = MoveAt(s, s.planning.move);
  question.from = ahead.end_joints;
  question.follows = ahead.known && ahead.count > 0;
  if (question.follows) question.before = ahead[ahead.end() - 1];
  if (BeginsOnCarrier(c)) {
    FromCarrier(c, s, question);
  } else if (question.move.cargo.carrier != 0) {  // expected pose of the target
    question.move.cargo = {};
    question.move.frame = kinematics::ToPose(ReferenceOf(ahead.rides[ahead.next.to_ride % kRides]));
  }
  question.limits = ahead.window.limits();
  question.tool = ToolOnFlange(c, s);
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::AxisLimits& limits = c.axes.params[s.members[k] - 1].limits;
    kinematics::JointRange& range = question.ranges[k];
    question.members[k] = true;
    range = {limits.lower.value_or(range.lower), limits.upper.value_or(range.upper)};
  }
  return question;
}

}  // namespace

bool HasWorkspace(const Context& c, const State& s) noexcept {
  return c.questions != nullptr && c.params.workspace && HasTool(c, s);
}

bool BeginsOnCarrier(const Context& c) noexcept {
  return c.ahead.rides[c.ahead.next.from_ride % kRides].displaces;
}

bool CanBeChecked(const Context& c, const State& s) noexcept {
  if (!HasWorkspace(c, s)) return false;
  const MoveKind kind = MoveAt(s, s.planning.move).kind;
  return !BeginsOnCarrier(c) || kind == MoveKind::kLinear || kind == MoveKind::kDirect || kind == MoveKind::kArch;
}

void Ask(const Context& c, State& s) noexcept {
  ++s.planning.question;
  s.planning.stage = Stage::kCheck;
  c.ahead.asked = false;
}

bool HasAnswer(const Context& c, State& s) noexcept {
  // Whether it was sent does not enter the state: in a replay nothing takes requests.
  if (!c.ahead.asked) c.ahead.asked = c.questions->TryPush(QuestionOf(c, s));
  return s.answer.number == s.planning.question;
}

bool Take(const PathChecked& answer, State& s) noexcept {
  const bool waits = s.planning.stage == Stage::kCheck && s.answer.number != s.planning.question;
  if (!waits || s.ends || answer.number != s.planning.question) return false;
  s.answer = answer;
  return true;
}

}  // namespace takt::group
