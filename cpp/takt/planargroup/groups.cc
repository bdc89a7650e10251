#include "takt/planargroup/groups.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::planargroup {

namespace {

using planar::ObjectState;

void Enter(const Context& c, ObjectState state, State& s) {
  s.state = state;
  s.since = c.cycle.count;
}

void Finish(const Context& c, State& s, FeedbackState end) {
  if (s.ticket != 0) c.feedback.Report({s.ticket, c.cycle.count, end, false, ErrorId::kNone, 0});
  s.ticket = 0;
}

// Enables the group, or ends the command with the reason why that is not possible.
void Begin(const Context& c, std::uint32_t number, State& s) {
  const planar::Verdict verdict = planar::Watch(number, c.grounds);
  if (verdict.error == ErrorId::kNone) {
    Enter(c, ObjectState::kEnabled, s);
    return Finish(c, s, FeedbackState::kDone);
  }
  Enter(c, s.state == ObjectState::kEnabling ? ObjectState::kDisabling : ObjectState::kDisabled, s);
  if (s.ticket != 0) {
    c.feedback.Report({s.ticket, c.cycle.count, FeedbackState::kError, false, verdict.error, 0, verdict.object});
  }
  s.ticket = 0;
}

void StepOne(const Context& c, std::uint32_t number, State& s) {
  if (s.since >= c.cycle.count) return;  // each state lasts at least one cycle
  switch (s.state) {
    case ObjectState::kEnabling:
      Begin(c, number, s);
      break;
    case ObjectState::kDisabling:
      Enter(c, ObjectState::kDisabled, s);
      Finish(c, s, FeedbackState::kDone);
      break;
    case ObjectState::kErrorPending:
      Enter(c, ObjectState::kError, s);
      break;
    case ObjectState::kResetting:
      s.error = ErrorId::kNone;
      if (!s.aborts) {
        Begin(c, number, s);
        break;
      }
      Enter(c, ObjectState::kDisabled, s);
      Finish(c, s, FeedbackState::kDone);
      break;
    case ObjectState::kDisabled:
    case ObjectState::kEnabled:
    case ObjectState::kError:
      break;
  }
}

// One command to one group.
struct Applier {
  const Context& c;
  std::uint32_t number;  // from 1
  Ticket ticket;
  State& s;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone) const {
    c.feedback.Report({ticket, c.cycle.count, state, false, error, 0});
  }
  void DoneAtOnce() const {
    Report(FeedbackState::kActive);
    Report(FeedbackState::kDone);
  }
  // Enters a state. The pending command is aborted, also if it is of the same kind.
  void Become(ObjectState state) const {
    Finish(c, s, FeedbackState::kAborted);
    if (s.state != state) Enter(c, state, s);
    s.ticket = ticket;
    Report(FeedbackState::kActive);
  }

  void operator()(const Enable&) const {
    switch (s.state) {
      case ObjectState::kDisabled:
      case ObjectState::kDisabling:
      case ObjectState::kEnabling:
        return Become(ObjectState::kEnabling);
      case ObjectState::kEnabled:
        return DoneAtOnce();
      default:
        return Report(FeedbackState::kError, ErrorId::kState);
    }
  }
  void operator()(const Disable&) const {
    switch (s.state) {
      case ObjectState::kEnabled:
      case ObjectState::kEnabling:
      case ObjectState::kDisabling:
        planar::Unwatch(number, c.grounds);
        return Become(ObjectState::kDisabling);
      case ObjectState::kDisabled:
        return DoneAtOnce();
      default:  // after a fault
        s.aborts = true;
        return DoneAtOnce();
    }
  }
  void operator()(const Reset&) const {
    if (s.state == ObjectState::kErrorPending) return Report(FeedbackState::kError, ErrorId::kState);
    if (s.state != ObjectState::kError && s.state != ObjectState::kResetting) return DoneAtOnce();
    Become(ObjectState::kResetting);
  }
};

}  // namespace

void Apply(const Context& c, std::size_t group, Ticket ticket, const Command& command) noexcept {
  const Applier applier{c, static_cast<std::uint32_t>(group + 1), ticket, c.groups.states[group]};
  std::visit(applier, command);
}

void Fail(const Context& c, std::size_t group, ErrorId error, bool aborts) noexcept {
  State& s = c.groups.states[group];
  if (s.state == ObjectState::kResetting || s.state == ObjectState::kErrorPending) return;
  if (s.ticket != 0) c.feedback.Report({s.ticket, c.cycle.count, FeedbackState::kAborted, false, error, 0});
  s.ticket = 0;
  s.error = error;
  s.aborts = aborts;
  planar::Unwatch(static_cast<std::uint32_t>(group + 1), c.grounds);
  Enter(c, ObjectState::kErrorPending, s);
}

void Step(const Context& c) noexcept {
  for (std::uint32_t i = 0; i < c.groups.states.size(); ++i) StepOne(c, i + 1, c.groups.states[i]);
}

void Publish(const Context& c) noexcept {
  const auto count = [](const std::vector<std::uint32_t>& groups, std::uint32_t number) {
    return static_cast<std::uint32_t>(std::ranges::count(groups, number));
  };
  for (std::uint32_t i = 0; i < c.groups.states.size(); ++i) {
    const State& s = c.groups.states[i];
    c.groups.outputs[i] = {s.state, s.error, count(c.grounds.group_of_mover, i + 1),
                           count(c.grounds.group_of_track, i + 1), c.grounds.EnvironmentOf(i + 1)};
  }
}

void describe(Description<State>& d) {
  using S = State;
  d.named("PlanarGroupState");
  d.about("State of a group of movers.");
  d.internal<&S::state>("State of the group.");
  d.internal<&S::since>("Cycle in which the state was entered.");
  d.internal<&S::ticket>("Ticket of the command that changes the state.");
  d.internal<&S::error>("Error of the fault.");
  d.internal<&S::aborts>("True: a reset leads to Disabled.");
}

}  // namespace takt::planargroup
