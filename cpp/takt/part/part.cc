#include "takt/part/part.h"

#include <utility>

#include "takt/core/describe.h"
#include "takt/core/in_range.h"

namespace takt::part {

namespace {

using planar::ObjectState;

void Enter(const Context& c, ObjectState state, State& s) {
  s.state = state;
  s.since = c.cycle.count;
}

void End(const Context& c, FeedbackState end, ErrorId error, Ticket& ticket) {
  if (ticket != 0) c.feedback.Report({ticket, c.cycle.count, end, false, error, 0});
  ticket = 0;
}
void Done(const Context& c, Ticket& ticket) {
  End(c, FeedbackState::kDone, ErrorId::kNone, ticket);
}

// One command.
struct Applier {
  const Context& c;
  Ticket ticket;
  const MoveBlocker& hindrance;
  State& s;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone, const ObjectInfo& object = {}) const {
    c.feedback.Report({ticket, c.cycle.count, state, false, error, 0, object});
  }
  void Refuse(ErrorId error, const ObjectInfo& object = {}) const { Report(FeedbackState::kError, error, object); }
  // Makes the command active; the one before it, in the same slot, is aborted.
  void GoOn(Ticket& place) const {
    End(c, FeedbackState::kAborted, ErrorId::kNone, place);
    place = ticket;
    Report(FeedbackState::kActive);
  }
  void DoneAtOnce() const {
    Report(FeedbackState::kActive);
    Report(FeedbackState::kDone);
  }

  void operator()(const ActivatePosition& a) const {
    if (a.index > c.params.positions.size()) return Refuse(ErrorId::kParameter);
    const planar::PartNow now = Show(s);
    if (now.faulty) return Refuse(ErrorId::kState);
    if (now.away) return Refuse(ErrorId::kPartDisabled);
    if (a.index == s.position + 1) return DoneAtOnce();
    if (hindrance.error != ErrorId::kNone) return Refuse(hindrance.error, hindrance.object);
    s.commanded = a.index - 1;
    s.went = c.cycle.count;
    GoOn(s.going);
  }
  void operator()(const AllowEnable&) const {
    s.forced = false;
    End(c, FeedbackState::kAborted, ErrorId::kNone, s.disabling);
    DoneAtOnce();
  }
  void operator()(const ForceDisable&) const {
    s.forced = true;
    if (s.state == ObjectState::kEnabled || s.state == ObjectState::kEnabling) Enter(c, ObjectState::kDisabling, s);
    if (s.state != ObjectState::kDisabling) return DoneAtOnce();
    GoOn(s.disabling);
  }
  void operator()(const Reset&) const {
    if (s.state == ObjectState::kErrorPending) return Refuse(ErrorId::kState);
    if (s.state != ObjectState::kError && s.state != ObjectState::kResetting) return DoneAtOnce();
    if (s.state == ObjectState::kError) Enter(c, ObjectState::kResetting, s);
    GoOn(s.resetting);
  }
};

void Change(const Context& c, const Around& around, State& s) {
  if (s.since >= c.cycle.count) return;  // each state lasts at least one cycle
  const bool wanted = around.wanted && !s.forced;
  switch (s.state) {
    case ObjectState::kDisabled:
      if (wanted) Enter(c, ObjectState::kEnabling, s);
      break;
    case ObjectState::kEnabling:
      Enter(c, wanted ? ObjectState::kEnabled : ObjectState::kDisabling, s);
      break;
    case ObjectState::kEnabled:
      if (!wanted) Enter(c, ObjectState::kDisabling, s);
      break;
    case ObjectState::kDisabling:
      if (wanted) {
        Enter(c, ObjectState::kEnabling, s);
      } else if (around.movers_rest) {
        Enter(c, ObjectState::kDisabled, s);
        Done(c, s.disabling);
      }
      break;
    case ObjectState::kErrorPending:
      if (around.movers_failed) Enter(c, ObjectState::kError, s);
      break;
    case ObjectState::kError:
      if (around.reset) Enter(c, ObjectState::kResetting, s);
      break;
    case ObjectState::kResetting:
      Enter(c, ObjectState::kDisabled, s);
      s.error = ErrorId::kNone;
      Done(c, s.resetting);
      break;
  }
}

}  // namespace

Inputs Simulate(const Context& c, const State& s) noexcept {
  const double gone_s = static_cast<double>(c.cycle.count - s.went) * c.cycle.period_s;
  const bool goes = s.commanded != s.position && gone_s < c.params.travel_time_s;
  return {goes ? 0 : s.commanded + 1, false};
}

void Apply(const Context& c, Ticket ticket, const Command& command, const MoveBlocker& hindrance, State& s) noexcept {
  const Applier applier{c, ticket, hindrance, s};
  std::visit([&](const auto& body) { takt::InRange(body) ? applier(body) : applier.Refuse(ErrorId::kParameter); },
             command);
}

void Fail(const Context& c, ErrorId error, State& s) noexcept {
  if (s.state == ObjectState::kErrorPending || s.state == ObjectState::kError || s.state == ObjectState::kResetting) {
    return;
  }
  for (Ticket* ticket : {&s.going, &s.disabling, &s.resetting}) End(c, FeedbackState::kError, error, *ticket);
  s.error = error;
  Enter(c, ObjectState::kErrorPending, s);
}

bool Arrive(const Context& c, const Inputs& inputs, State& s) noexcept {
  const std::uint32_t before = s.position;
  const std::uint32_t reported = inputs.position;
  const bool arrived = reported == s.commanded + 1;
  const bool goes = s.commanded != s.position;
  if (arrived) {
    s.position = s.commanded;
    Done(c, s.going);
  }
  s.away = !arrived && !(goes && reported == s.position + 1);
  // On the way it may be at no position; any other report is a fault.
  if (s.away && !(goes && reported == 0)) Fail(c, ErrorId::kPartPosition, s);
  if (inputs.fault) Fail(c, ErrorId::kPartFault, s);
  return s.position != before;
}

void Step(const Context& c, const Around& around, State& s) noexcept {
  Change(c, around, s);
}

void Publish(const planar::Spot& spot, std::uint32_t movers, const State& s, Outputs& out) noexcept {
  const bool away = Show(s).away;
  out.state = s.state;
  out.error = s.error;
  out.disable_forced = s.forced;
  out.position_index = away ? 0 : s.position + 1;
  out.commanded_index = s.commanded + 1;
  out.coordinate_system = away ? 0 : spot.system + 1;
  out.x = spot.origin.x;
  out.y = spot.origin.y;
  out.mover_count = movers;
}

void describe(Description<Inputs>& d) {
  d.named("PartInputs");
  d.about("Reported inputs of a part.");
  d.internal<&Inputs::position>("Index of its position at the beginning of the cycle, from 1; 0: none.");
  d.internal<&Inputs::fault>("True: it reports a fault.");
}

}  // namespace takt::part
