#include "takt/axis/probe.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

bool InWindow(const AxisParams& p, const Capture& capture, double position) {
  if (!capture.window_only) return true;
  const bool across_zero = p.rotary() && capture.last_position < capture.first_position;
  const bool above = position >= capture.first_position;
  const bool below = position <= capture.last_position;
  return across_zero ? above || below : above && below;
}

// Returns the position `age_s` before this sample.
double PositionBefore(const Context& c, const State& s, double age_s) {
  const double period = c.cycle.period_s;
  if (s.sampling.age > 0 || s.sampling.step > 1) {  // samples not one cycle apart: by the velocity
    return s.actual.position - s.actual.velocity * (age_s + s.sampling.age * period);
  }
  const double age = std::clamp(age_s, 0.0, period);
  const double acceleration = s.loop_closed ? (s.setpoint.velocity - s.probe.set_velocity) / period : 0;
  return s.actual.position - s.probe.step * age / period - 0.5 * acceleration * age * (period - age);
}

void Note(double reported, ProbeState& probe) {
  probe.position = reported;
  ++probe.captures;
}

// Ends the commands that wait for this edge at this position.
void CaptureAt(const Context& c, ProbeEdge edge, double position, State& s) {
  ProbeState& probe = s.probe;
  const double reported = Reported(c.params, position);
  std::uint8_t left = 0;
  for (std::uint8_t i = 0; i < probe.waits; ++i) {
    const Capture one = probe.waiting[i];
    if (one.edge == edge && InWindow(c.params, one, reported)) {
      Report(c, one.ticket, FeedbackState::kDone, ErrorId::kNone, false, reported);
    } else {
      probe.waiting[left++] = one;
    }
  }
  const bool touches = probe.watch == ProbeWatch::kTouch && !probe.touched && probe.edge == edge;
  if (left < probe.waits || touches) Note(reported, probe);
  for (std::uint8_t i = left; i < probe.waits; ++i) probe.waiting[i] = {};
  probe.waits = left;
  if (!touches) return;
  probe.touched = true;
  probe.touch_position = position;
}

// Captures at an edge of the wire since the previous sample, by its age; if the drive does not report the age, at the
// position of this sample.
void LookForEdge(const Context& c, const ServoInputs& in, ProbeEdge edge, State& s) {
  const ProbeState& probe = s.probe;
  const bool rise = (edge == ProbeEdge::kRising) != c.params.inputs.invert_touch_probe;
  const bool counted = rise ? in.probe_rises != probe.rises : in.probe_falls != probe.falls;
  const bool counts = in.probe_rises != 0 || in.probe_falls != 0;
  if (counted) {
    CaptureAt(c, edge, PositionBefore(c, s, rise ? in.probe_rise_age_s : in.probe_fall_age_s), s);
  } else if (!counts && in.touch_probe == rise && probe.wire != rise) {
    CaptureAt(c, edge, s.actual.position, s);
  }
}

bool CanBeSlowed(const Request& r) {
  return r.positions() || r.kind == RequestKind::kMoveVelocity || r.kind == RequestKind::kJog;
}

void Restore(const Context& c, State& s) {
  ProbeState& probe = s.probe;
  if (!probe.slowing) return;
  probe.slowing = false;
  if (s.active.kind == RequestKind::kNone || s.active.ticket != probe.slowed) return;
  s.active.velocity = probe.own_velocity;
  PlanAgain(c, s);
}

void Slow(const Context& c, State& s) {
  ProbeState& probe = s.probe;
  if (s.touch_probe != (probe.edge == ProbeEdge::kRising)) return Restore(c, s);
  if (!s.loop_closed || !CanBeSlowed(s.active) || s.active.velocity <= probe.velocity) return;
  probe.slowing = true;
  probe.slowed = s.active.ticket;
  probe.own_velocity = s.active.velocity;
  s.active.velocity = probe.velocity;
  PlanAgain(c, s);
  if (!probe.reported) Report(c, probe.ticket, FeedbackState::kActive);
  probe.reported = true;
}

Status MayTouch(const Context& c, const State& s) {
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  return c.params.follows ? Status::Failed(ErrorId::kState) : Status::Ok();
}

Status TakeTouch(const Context& c, State& s) {
  const ProbeState& probe = s.probe;
  if (s.plc == PlcState::kStopping) return Status::Failed(ErrorId::kAxisStopping);
  if (s.plc == PlcState::kHoming) return Status::Failed(ErrorId::kState);
  if (!Inside(c.params.limits, probe.touch_position)) return Status::Failed(ErrorId::kTargetBehindLimit);
  Request request;
  request.kind = RequestKind::kTouch;
  request.ticket = probe.ticket;
  request.velocity = probe.velocity;
  request.acceleration = probe.acceleration;
  request.deceleration = probe.deceleration;
  request.jerk = probe.jerk;
  Plan plan;
  plan.target = probe.touch_position;
  const PlanningContext around = SumPlanningContext(c, s);
  Status status = Replan(c.params, around, c.planner, s.setpoint, request, {}, plan);
  if (status.ok()) status = CheckSwitches(around, s.setpoint, plan.profile);
  if (status.failed()) return status;
  AbortAll(c, s);
  TakeControl(c, request, plan, FromCycleBefore(c), s);
  return Status::Ok();
}

// Replaces the waiting GT_Touch.
void Supersede(const Context& c, ProbeWatch watch, ProbeEdge edge, Ticket ticket, State& s) {
  Restore(c, s);
  ProbeState& probe = s.probe;
  if (probe.watch != ProbeWatch::kNothing) Report(c, probe.ticket, FeedbackState::kAborted);
  probe.watch = watch;
  probe.edge = edge;
  probe.ticket = ticket;
  probe.touched = false;
  probe.reported = false;
}

}  // namespace

bool Fill(const RequestBuilder& m, const TouchProbe& c) {
  const double low = m.params.rotary() ? 0 : -kMaxPosition;
  const double high = m.params.rotary() ? m.params.modulus : kMaxPosition;
  const bool ordered = c.window_only && !m.params.rotary();  // on a rotary axis the window may contain 0
  return m.In("first_position", c.first_position, low, high) &&
         m.In("last_position", c.last_position, ordered ? c.first_position : low, high);
}

bool Fill(const RequestBuilder& m, const Touch& c) {
  return m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

void SenseProbe(const Context& c, const ServoInputs& in, State& s) noexcept {
  ProbeState& probe = s.probe;
  const bool good = !s.encoder_error;
  if (probe.watch != ProbeWatch::kNothing || probe.waits > 0) {
    const bool known = probe.sampled && good;
    const double before =
        known ? LatchedPosition(c.params.encoder, s.encoder, probe.counts) - s.correction.now - s.origin : 0;
    probe.step = known ? s.actual.position - before : s.actual.velocity * c.cycle.period_s;
    if (good) {
      LookForEdge(c, in, ProbeEdge::kRising, s);
      LookForEdge(c, in, ProbeEdge::kFalling, s);
    }
  }
  probe.sampled = good;
  probe.counts = in.counts;
  probe.wire = in.touch_probe;
  probe.rises = in.probe_rises;
  probe.falls = in.probe_falls;
  probe.set_velocity = s.setpoint.velocity;
}

void ForgetSample(const ServoInputs& in, ProbeState& probe) noexcept {
  probe.sampled = false;
  probe.wire = in.touch_probe;
  probe.rises = in.probe_rises;
  probe.falls = in.probe_falls;
}

void FollowProbe(const Context& c, State& s) noexcept {
  ProbeState& probe = s.probe;
  if (probe.watch == ProbeWatch::kSlow) return Slow(c, s);
  if (probe.watch != ProbeWatch::kTouch) return;
  Status status = MayTouch(c, s);
  if (status.ok() && probe.touched) status = TakeTouch(c, s);
  if (status.ok() && !probe.touched) return;
  probe.watch = ProbeWatch::kNothing;
  if (status.failed()) Report(c, probe.ticket, FeedbackState::kError, status.error);
}

Status CarryOut(const Context& c, Ticket ticket, const TouchProbe& command, State& s) noexcept {
  ProbeState& probe = s.probe;
  if (probe.waits == kCaptures) return Status::Failed(ErrorId::kBufferFull);
  probe.waiting[probe.waits++] = {ticket, command.edge, command.window_only, command.first_position,
                                  command.last_position};
  Report(c, ticket, FeedbackState::kActive);
  return Status::Ok();
}

namespace {

// Ends the commands for which `ends` is true, as aborted.
template <typename Ends>
bool EndCaptures(const Context& c, const Ends& ends, ProbeState& probe) {
  std::uint8_t left = 0;
  for (std::uint8_t i = 0; i < probe.waits; ++i) {
    const Capture one = probe.waiting[i];
    if (ends(one)) {
      Report(c, one.ticket, FeedbackState::kAborted);
    } else {
      probe.waiting[left++] = one;
    }
  }
  const bool any = left < probe.waits;
  for (std::uint8_t i = left; i < probe.waits; ++i) probe.waiting[i] = {};
  probe.waits = left;
  return any;
}

}  // namespace

bool EndProbing(const Context& c, Ticket ticket, State& s) noexcept {
  if (ticket == 0) return false;
  if (s.probe.watch != ProbeWatch::kNothing && s.probe.ticket == ticket) {
    Supersede(c, ProbeWatch::kNothing, s.probe.edge, 0, s);
    return true;
  }
  return EndCaptures(
      c, [&](const Capture& one) { return one.ticket == ticket; }, s.probe);
}

Status CarryOut(const Context& c, Ticket ticket, const AbortTrigger& command, State& s) noexcept {
  EndCaptures(
      c, [&](const Capture& one) { return !command.edge || one.edge == *command.edge; }, s.probe);
  if (!command.edge || s.probe.edge == *command.edge) Supersede(c, ProbeWatch::kNothing, s.probe.edge, 0, s);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}

Status CarryOut(const Context& c, Ticket ticket, const Touch& command, State& s) noexcept {
  const bool captures = command.mode == TouchMode::kCapture;
  if (const Status status = MayTouch(c, s); captures && status.failed()) return status;
  Request limits;
  Refusal why;
  Fill(RequestBuilder{c.params, limits, why}, command);
  Supersede(c, captures ? ProbeWatch::kTouch : ProbeWatch::kSlow, command.edge, ticket, s);
  s.probe.velocity = limits.velocity;
  s.probe.acceleration = limits.acceleration;
  s.probe.deceleration = limits.deceleration;
  s.probe.jerk = limits.jerk;
  Report(c, ticket, FeedbackState::kBusy);
  return Status::Ok();
}

void describe(Enumeration<ProbeWatch>& e) {
  e.about("Mode of a waiting GT_Touch.");
  e.value(ProbeWatch::kNothing, "nothing", "No GT_Touch waits.");
  e.value(ProbeWatch::kTouch, "touch", "Waits for the edge, to capture, stop and return.");
  e.value(ProbeWatch::kSlow, "slow", "Waits for the probe, to slow down while it is on.");
}

void describe(Description<Capture>& d) {
  using C = Capture;
  d.about("A waiting MC_TouchProbe.");
  d.internal<&C::ticket>("Ticket of the command.");
  d.internal<&C::edge>("Edge that captures.");
  d.internal<&C::window_only>("Only edges within the window count.");
  d.internal<&C::first_position>(unit::u, "Begin of the window.");
  d.internal<&C::last_position>(unit::u, "End of the window.");
}

void describe(Description<ProbeState>& d) {
  using P = ProbeState;
  d.about("The touch probe.");
  d.internal<&P::waiting>("Waiting MC_TouchProbe commands.");
  d.internal<&P::waits>("Number of waiting commands.");
  d.internal<&P::watch>("GT_Touch: mode.");
  d.internal<&P::edge>("GT_Touch: edge.");
  d.internal<&P::touched>("GT_Touch: the edge has come.");
  d.internal<&P::touch_position>(unit::u, "GT_Touch: position at the edge, unwrapped.");
  d.internal<&P::ticket>("GT_Touch: ticket of the command.");
  d.internal<&P::velocity>(unit::u_s, "GT_Touch: largest velocity.");
  d.internal<&P::acceleration>(unit::u_s2, "GT_Touch: largest acceleration.");
  d.internal<&P::deceleration>(unit::u_s2, "GT_Touch: largest deceleration.");
  d.internal<&P::jerk>(unit::u_s3, "GT_Touch: largest jerk; 0: unlimited.");
  d.internal<&P::slowing>("GT_Touch: a motion is being slowed down.");
  d.internal<&P::reported>("GT_Touch: Active has been reported.");
  d.internal<&P::slowed>("GT_Touch: ticket of the motion that is slowed down.");
  d.internal<&P::own_velocity>(unit::u_s, "GT_Touch: velocity of that motion before.");
  d.internal<&P::position>(unit::u, "Position of the last capture.");
  d.internal<&P::captures>("Number of captures.");
  d.internal<&P::sampled>("The previous sample was good.");
  d.internal<&P::wire>("Input in the previous sample.");
  d.internal<&P::counts>(unit::count, "Encoder counts in the previous sample.");
  d.internal<&P::rises>("Rising edges up to the previous sample.");
  d.internal<&P::falls>("Falling edges up to the previous sample.");
  d.internal<&P::set_velocity>(unit::u_s, "Velocity of the set point at the previous sample.");
  d.internal<&P::step>(unit::u, "Displacement from the previous sample to this one.");
}

}  // namespace takt::axis
