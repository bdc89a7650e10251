// Commands on arrival: inputs and settings change, targets are accepted or refused.
#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/group/run.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

void Refuse(const Context& c, Ticket ticket, ErrorId error, State& s) {
  s.warning = error;
  Report(c, ticket, FeedbackState::kError, error);
}

void Finish(const Context& c, Ticket ticket) {
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

// PP-20: continues from where the path was left.
void Resume(const Context& c, Ticket ticket, group::State& g, State& s) {
  if (s.hold.off) return Refuse(c, ticket, ErrorId::kOffPath, s);
  GoOn(c, g, s);
  Enter(PickPlaceState::kMovePp, s);
  Finish(c, ticket);
}

void Execute(const Context& c, Ticket ticket, group::State& g, State& s) {
  const bool moves = s.state == PickPlaceState::kPreparingPath || s.state == PickPlaceState::kMovePp;
  const bool returns = s.hold.returning;
  if (!IsOn(c, g)) return Refuse(c, ticket, WhyOff(c, g), s);
  if (StopIsAsked(s) || returns || !(moves || s.state == PickPlaceState::kReady)) {
    return Refuse(c, ticket, ErrorId::kState, s);
  }
  if (s.hold.held) return Resume(c, ticket, g, s);
  const bool program = s.settings.tracking_mode == TrackingMode::kProgram;
  const std::uint32_t before = s.order_count;
  program ? Accept(c, ticket, s.inputs.set_target, s) : BeginLoop(c, ticket, s);
  if (moves || (s.order_count == before && !s.loop.active)) return;
  s.prepare_cycle = c.group.cycle.count;
  Enter(PickPlaceState::kPreparingPath, s);
}

void Return(const Context& c, Ticket ticket, group::State& g, State& s) {
  if (!IsOn(c, g)) return Refuse(c, ticket, WhyOff(c, g), s);
  if (s.state != PickPlaceState::kReady || StopIsAsked(s) || !s.hold.held || !IsFree(c, g)) {
    return Refuse(c, ticket, ErrorId::kState, s);
  }
  if (!s.hold.off) return Finish(c, ticket);
  const kinematics::Pose& to = s.hold.pose;
  const Settings& p = s.settings;
  const Leg leg{.to = {.pose = to, .aux1 = s.hold.aux1}, .turns = true};
  const PathRamps ramps{p.path_velocity, p.path_acceleration, p.path_deceleration, p.path_jerk};
  const ErrorId error = Tell(c, LineOf(leg, ramps, false, Aux1Of(c, g)), g);
  if (error != ErrorId::kNone) return Refuse(c, ticket, error, s);
  s.hold.returning = true;
  s.hold.ticket = ticket;
  s.given = g.done + g.queue.count;
  s.hold.move = s.given - 1;
  Report(c, ticket, FeedbackState::kActive);
  Enter(PickPlaceState::kMovePp, s);
}

void CarryOut(const Context& c, Ticket ticket, double, const Control& command, group::State& g, State& s) {
  const Inputs was = s.inputs;
  ApplyPatch(command, s.inputs);
  s.reset |= s.inputs.reset_error && !was.reset_error;
  s.abort |= s.inputs.abort && !was.abort;
  s.ack |= s.inputs.ack_gripper && !was.ack_gripper;
  // Of several requests in one command the first one is carried out.
  if (s.inputs.execute && !was.execute) return Execute(c, ticket, g, s);
  if (s.inputs.home_execute && !was.home_execute) return BeginHoming(c, ticket, g, s);
  if (s.inputs.return_to_path && !was.return_to_path) return Return(c, ticket, g, s);
  Finish(c, ticket);
}

void CarryOut(const Context& c, Ticket ticket, double lease_s, const Jog& command, group::State& g, State& s) {
  const bool held = command.positive || command.negative;
  const bool rests = s.state == PickPlaceState::kStop || s.state == PickPlaceState::kPathInterrupt;
  const bool may = s.state == PickPlaceState::kReady || Jogs(s) || (rests && s.hold.held);
  ErrorId error = ErrorId::kNone;
  if (!may) error = ErrorId::kState;
  // Their order is not known.
  if (s.jog.ticket == 0 && command.positive && command.negative) error = ErrorId::kParameter;
  if (!IsOn(c, g)) error = WhyOff(c, g);
  if (held && error != ErrorId::kNone) return Refuse(c, ticket, error, s);
  Report(c, ticket, FeedbackState::kActive);
  if (s.jog.ticket != 0) Report(c, s.jog.ticket, FeedbackState::kAborted);
  s.jog = {ticket, command, lease_s, CycleIn(c.group.cycle, lease_s)};
  if (!held && !Jogs(s)) EndJog(c, FeedbackState::kDone, ErrorId::kNone, s);
}

// Returns true if no static target that was accepted lies in a product coordinate system of workpieces.
bool WaitingTargetsFit(const State& s) {
  Settings settings = s.settings;
  for (std::uint32_t i = 0; i < s.order_count; ++i) {
    settings.target_coordinate_system = s.orders[i].target.system;
    settings.target_pcs = s.orders[i].target.pcs;
    if (s.orders[i].belt == 0 && !TargetSystemFits(settings)) return false;
  }
  return true;
}

void CarryOut(const Context& c, Ticket ticket, double, const Configure& command, group::State&, State& s) {
  const Settings was = s.settings;
  ApplyPatch(command, s.settings);
  // With workpieces in one system the one from which the tool lifts would be overwritten.
  const bool fits = TargetFits(s.settings) && WorkpieceSystemsFit(s.settings) &&
                    (c.params.belts.empty() || (TargetSystemFits(s.settings) && WaitingTargetsFit(s)));
  if (!fits) {
    s.settings = was;
    return Refuse(c, ticket, ErrorId::kParameter, s);
  }
  Finish(c, ticket);
}

void CarryOut(const Context& c, Ticket ticket, double, const ConfigureBelt& command, group::State&, State& s) {
  const std::uint32_t belt = command.belt.value_or(1);
  if (belt > c.params.belts.size()) return Refuse(c, ticket, ErrorId::kUnknownTarget, s);
  BeltSettings changed = s.belts[belt - 1];
  ApplyPatch(command, changed);
  const conveyor::BeltParams& params = *c.belts[belt - 1].params;
  const bool fits = TurnsFit(changed) && RangeFits(changed) && LeaveFits(changed) && RangeMeets(changed, params) &&
                    LeaveMeets(changed, params);
  if (!fits) return Refuse(c, ticket, ErrorId::kParameter, s);
  s.belts[belt - 1] = changed;
  Finish(c, ticket);
}

void CarryOut(const Context& c, Ticket ticket, double, const ResetCounters&, group::State&, State& s) {
  s.counters = {};
  s.pick_count = 0;
  Finish(c, ticket);
}

}  // namespace

void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, group::State& g,
           State& s) noexcept {
  const auto carry_out = [&](const auto& body) {
    if (!InRange(body)) return Report(c, ticket, FeedbackState::kError, ErrorId::kParameter);
    CarryOut(c, ticket, lease_s, body, g, s);
  };
  std::visit(carry_out, command);
}

bool Release(const Context&, Ticket ticket, State& s) noexcept {
  if (ticket == 0 || s.jog.ticket != ticket) return false;
  s.jog.keys = {};
  return true;
}

bool Renew(const Context& c, Ticket ticket, State& s) noexcept {
  if (ticket == 0 || s.jog.ticket != ticket || s.jog.lease_s <= 0) return false;
  s.jog.lease_end_cycle = CycleIn(c.group.cycle, s.jog.lease_s);
  return true;
}

}  // namespace takt::pickplace
