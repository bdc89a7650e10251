#include "takt/group/ask.h"

#include "takt/group/queue.h"
#include "takt/group/rides.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

Question QuestionOf(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  Question question;
  question.group = c.number;
  question.number = s.planning.question;
  question.move = MoveAt(s, s.planning.move);
  if (question.move.cargo.carrier != 0) {  // where it will be
    question.move.cargo = {};
    question.move.frame = kinematics::ToPose(ReferenceOf(ahead.rides[ahead.next.to_ride % kRides]));
  }
  question.from = ahead.end_joints;
  question.follows = ahead.known && ahead.count > 0;
  if (question.follows) question.before = ahead[ahead.end() - 1];
  question.limits = ahead.window.limits();
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

void Ask(const Context& c, State& s) noexcept {
  ++s.planning.question;
  s.planning.stage = Stage::kCheck;
  c.ahead.asked = false;
}

bool IsAnswered(const Context& c, State& s) noexcept {
  // Whether it could be sent changes nothing in the state: a replay has nobody to ask.
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
