#include "takt/axis/axis.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "takt/axis/coordinates.h"
#include "takt/axis/drive_link.h"
#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/guidance.h"
#include "takt/axis/sequence.h"
#include "takt/axis/settings.h"

namespace takt::axis {

namespace {

// A measured displacement beyond this multiple of what the velocity limit allows means a broken encoder.
constexpr double kJumpFactor = 4;
// Share of the velocity limit: the loop is not closed while an analogue drive still turns faster.
constexpr double kCoastingShare = 0.05;
// Rotary axes: positions are brought back into the first turn once they are this many turns away.
constexpr double kFarTurns = 1000;

double LargestStep(const Context& c) {
  return kJumpFactor * c.params.limits.velocity * c.cycle.period_s +
         c.params.supervision.encoder_noise_counts / c.params.encoder.increments_per_unit;
}

bool InMotion(const State& s) {
  return !s.motion.arrived || s.superimposed || !AtRest(s);
}

void WatchDeviation(const Context& c, State& s) {
  const Supervision& limits = c.params.supervision;
  const auto settled = [&] {
    return !InMotion(s) && static_cast<double>(c.cycle.count - s.motion.arrived_cycle) * c.cycle.period_s >
                               limits.in_position_timeout_s;
  };
  const auto& limit = limits.deviation_standstill && settled() ? limits.deviation_standstill : limits.deviation_moving;
  if (limit && std::abs(s.following_error) > *limit && !OwnsLag(s)) Fail(c, ErrorId::kDeviation, true, s);
}

// Faults at a new edge of a limit switch, or if the axis moves further out.
void WatchSwitches(const Context& c, State& s) {
  if (s.plc == PlcState::kErrorStop || OwnsLimitSwitches(s)) return;
  if (s.limit_positive && (!s.limit_positive_before || s.setpoint.velocity > 0)) {
    Fail(c, ErrorId::kLimitSwitchPositive, false, s);
  } else if (s.limit_negative && (!s.limit_negative_before || s.setpoint.velocity < 0)) {
    Fail(c, ErrorId::kLimitSwitchNegative, false, s);
  }
}

// Returns the speed [u/s] below which a velocity is rounding.
double Standing(const Context& c) {
  return 1e-9 * c.params.limits.velocity;
}

bool BrakesByCommand(const State& s) {
  const RequestKind kind = s.active.kind;
  const bool brakes = kind == RequestKind::kHalt || kind == RequestKind::kStop || kind == RequestKind::kPower ||
                      (kind == RequestKind::kJog && s.jog_sense == 0);
  return (brakes && !s.superimposed) || (IsGuided(s) && s.guidance.comes_to_rest);
}

// Returns true if the axis is already braking by a command: its own, of the component that guides it, or of the axis
// that it follows.
bool BrakesAnyway(const Context& c, const State& s) {
  if (BrakesByCommand(s)) return true;
  if (!c.params.follows || !s.coupled) return false;
  const State& master = *c.master;  // has stepped in this cycle already, perhaps to rest
  return BrakesByCommand(master) || (master.motion.arrived && master.motion.arrived_cycle == c.cycle.count);
}

// A motion in a direction that MC_Power does not enable ends as at a limit switch (AX-111). Under torque control the
// torque counts, as the measured velocity is noisy.
void WatchDirections(const Context& c, State& s) {
  if (s.plc == PlcState::kErrorStop || BrakesAnyway(c, s)) return;
  const bool torque = s.active.kind == RequestKind::kTorqueControl;
  const double way = torque ? s.active.value : s.setpoint.velocity;
  const double least = torque ? 0 : Standing(c);
  if ((s.bars_positive && way > least) || (s.bars_negative && way < -least)) Fail(c, ErrorId::kDirection, false, s);
}

// A voltage output with the loop open ends at a limit switch and at a SW limit.
void WatchDirectOutput(const Context& c, State& s) {
  const AxisLimits& limits = c.params.limits;
  const bool up = s.direct_voltage_v > 0;
  const double position = s.actual.position;
  if (up ? s.limit_positive : s.limit_negative) {
    Fail(c, up ? ErrorId::kLimitSwitchPositive : ErrorId::kLimitSwitchNegative, false, s);
  } else if (up ? limits.upper && position >= *limits.upper : limits.lower && position <= *limits.lower) {
    Fail(c, up ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
  }
}

void WatchLease(const Context& c, State& s) {
  const bool watched = s.active.lease_s > 0 && s.active.kind != RequestKind::kStop;  // stops have leases of their own
  if (!watched || c.cycle.count < s.lease_end_cycle) return;
  const Ticket ticket = s.active.ticket;
  const bool jog = s.active.kind == RequestKind::kJog;
  Release(c, ticket, s);
  s.active.lease_s = 0;
  if (jog) {
    Report(c, ticket, FeedbackState::kAborted, ErrorId::kLeaseExpired);
    s.active.ticket = 0;
  }
}

void Supervise(const Context& c, State& s) {
  if (s.encoder_error) Fail(c, ErrorId::kEncoder, true, s);
  const bool off = s.drive_fault || (s.loop_closed && !s.drive_ready);
  if (off && s.sampling.link == DriveLink::kHeard) Fail(c, ErrorId::kDrive, true, s);
  if (s.blind || s.sampling.link == DriveLink::kLost) WatchLink(c, s);
  if (!s.loop_closed) {
    if (s.direct_voltage_v != 0) WatchDirectOutput(c, s);
    return;
  }
  WatchDeviation(c, s);
  if (s.limit_positive || s.limit_negative) WatchSwitches(c, s);
  if (s.bars_positive || s.bars_negative) WatchDirections(c, s);
  WatchLease(c, s);
}

// Holds the axis while its brake opens; then the power command is done.
void AwaitBrake(const Context& c, State& s) {
  const double open_s = static_cast<double>(c.cycle.count - s.brake_cycle) * c.cycle.period_s;
  if (open_s < c.params.drive.brake_opens_s) return;
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
  StartNext(c, 0, s);
}

// Waits from power on until the drive is ready.
void AwaitDrive(const Context& c, State& s) {
  if (s.active.kind != RequestKind::kPower || !s.active.enable) return;
  if (s.enable_cycle == c.cycle.count) return;  // the loop stays open for at least one cycle
  // After a direct voltage output the drive coasts to rest at 0 V.
  const bool coasts = c.params.drive.mode == DriveMode::kAnalog &&
                      std::abs(s.actual.velocity) > kCoastingShare * c.params.limits.velocity;
  if (s.drive_ready && !coasts) {
    s.loop_closed = true;
    s.motion.profile = trajectory::Profile{s.setpoint};
    s.motion.target = s.setpoint.position;
    s.motion.arrived = true;
    s.motion.arrived_cycle = c.cycle.count;
    s.brake_cycle = c.cycle.count;
    s.brake_falls = false;
    AwaitBrake(c, s);
  } else if (static_cast<double>(c.cycle.count - s.enable_cycle) * c.cycle.period_s > c.params.drive.ready_timeout_s) {
    Fail(c, ErrorId::kDrive, true, s);
  }
}

void BringBackTurns(const AxisParams& p, State& s) {
  const double turns = std::floor(s.setpoint.position / p.modulus) * p.modulus;
  ShiftCoordinates(-turns, s);
}

// Returns true if a motion has no end of its own, or ends with a velocity.
bool GoesOn(const State& s) {
  return s.plc == PlcState::kContinuousMotion || s.plc == PlcState::kSynchronizedMotion ||
         FollowsTable(s.active.kind) || s.motion.profile.end().velocity != 0;
}

// Returns true if the ramp for faults, begun now, ends beyond the SW limit ahead.
bool StopsBeyond(const Context& c, const KinematicState& before, const State& s) {
  const double stop = trajectory::StopPosition(s.setpoint, WithFaultRamp(c, s));
  const AxisLimits& limits = c.params.limits;
  return (limits.upper && stop > *limits.upper && s.setpoint.position > before.position) ||
         (limits.lower && stop < *limits.lower && s.setpoint.position < before.position);
}

// Drops a set point from which the axis could not stop in time, and brakes instead.
void GuardLimits(const Context& c, const KinematicState& before, State& s) {
  if (s.superimposed) return;  // the limits apply to the sum
  const bool positions_count = s.plc != PlcState::kErrorStop && s.plc != PlcState::kHoming;
  if (!positions_count || !GoesOn(s)) return;
  const bool early = s.fault_ramp.leaves_limits && IsGuided(s) && StopsBeyond(c, before, s);
  // A run of blended moves may end at the limit exactly.
  const double slack = s.active.positions() ? Rounding(s.setpoint.position) : 0;
  if (!early && CanStopInside(c.params, before, s.setpoint, slack)) return;
  const bool upwards = s.setpoint.position > before.position;
  s.setpoint = before;
  Fail(c, upwards ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
  s.setpoint = s.motion.profile.At(Elapsed(c, s));
}

// Drops a set point that would begin a motion towards a limit switch that is on, or in a direction that is not enabled.
void GuardSwitches(const Context& c, const KinematicState& before, State& s) {
  if (s.superimposed || s.plc == PlcState::kErrorStop || OwnsLimitSwitches(s)) return;
  const bool up = s.setpoint.velocity > std::max(0.0, before.velocity);
  const bool down = s.setpoint.velocity < std::min(0.0, before.velocity);
  if (!up && !down) return;
  const bool own = up ? s.limit_positive : s.limit_negative;
  const bool barred = std::abs(s.setpoint.velocity) > Standing(c) && Bars(c, s, up ? 1 : -1);
  if (!own && !barred && !FollowerOnLimit(c, s, up ? 1 : -1)) return;
  const KinematicState next = s.setpoint;
  s.setpoint = before;
  const ErrorId at_switch = up ? ErrorId::kLimitSwitchPositive : ErrorId::kLimitSwitchNegative;
  if (!own && !barred) s.fault_of = BlockingFollower(c, s, up ? 1 : -1);
  Fail(c, own ? at_switch : barred ? ErrorId::kDirection : ErrorId::kAxisFault, false, s);
  if (IsGuided(s)) {  // its component brakes it, together with others: it has no motion of its own
    s.setpoint = next;
    return;
  }
  s.setpoint = s.motion.profile.At(Elapsed(c, s));
}

// Returns the sense in which a motion came to its end; `otherwise` if it did not move at all.
std::int8_t SenseAtEnd(const trajectory::Profile& profile, std::int8_t otherwise) {
  if (profile.size() == 0) return otherwise;
  const std::size_t last = static_cast<std::size_t>(profile.size()) - 1;
  const double begin = last > 0 ? profile.piece_ends_s[last - 1] : 0;
  const double velocity = profile.At(0.5 * (begin + profile.duration())).velocity;
  return velocity == 0 ? otherwise : static_cast<std::int8_t>(velocity > 0 ? 1 : -1);
}

// Handles the end of the motion in progress. Blended moves may be shorter than a cycle: as many begin and end in this
// cycle as their times require.
void ConcludeDue(const Context& c, const KinematicState& before, State& s) {
  for (int i = 0; i <= kBufferSize; ++i) {
    const double late_s = Elapsed(c, s) - s.motion.profile.duration();
    if (late_s < 0) return;
    if (!s.motion.arrived) {
      s.motion.arrived = true;
      s.motion.arrived_cycle = c.cycle.count;
      s.last_sense = SenseAtEnd(s.motion.profile, s.last_sense);
    }
    if (s.motion.held) return;
    const double origin = s.origin;
    Conclude(c, late_s, s);
    if (s.motion.arrived || FollowsDemand(s.active.kind)) return;  // no other motion with an end has begun
    const double renumbered = before.position + origin - s.origin;
    GuardLimits(c, {renumbered, before.velocity, before.acceleration}, s);
  }
}

// Computes the next set point of a motion that is over or has no end.
void AdvanceWatched(const Context& c, double t, State& s) {
  const KinematicState before = s.setpoint;
  s.setpoint = s.motion.profile.At(t);
  const bool over = t >= s.motion.profile.duration();
  // A move that ends in this cycle hands over first: the rest of the cycle belongs to another command.
  if (!over || s.plc == PlcState::kContinuousMotion) GuardLimits(c, before, s);
  // The end of a motion that is over concerns no command.
  const bool rests = s.motion.arrived && s.active.kind == RequestKind::kNone;
  if (over && !rests) ConcludeDue(c, before, s);
}

void NoteSense(State& s) {
  if (s.setpoint.velocity != 0) s.last_sense = s.setpoint.velocity > 0 ? 1 : -1;
}

// Inlined: every cycle of a moving axis needs it, and a call would add a tenth to its time.
[[gnu::always_inline]] inline void Advance(const Context& c, State& s) {
  const double t = Elapsed(c, s);
  if (t >= s.motion.profile.duration() || GoesOn(s)) {
    AdvanceWatched(c, t, s);
  } else {
    s.setpoint = s.motion.profile.At(t);
  }
  NoteSense(s);
}

// Computes the next set point of an axis that follows something. Returns false if the motion in progress gives it.
bool FollowNow(const Context& c, State& s) {
  if (Couples(s.active.kind)) return FollowMasters(c, s);
  if (FollowsTable(s.active.kind)) return FollowTime(c, s);
  if (Streams(s.active.kind)) return FollowStream(c, s);
  FollowGuidance(c, s);
  return true;
}

// Takes the set point from masters, a table over time, a stream or another component.
void FollowSource(const Context& c, State& s) {
  const KinematicState before = s.setpoint;
  const bool coupled = Couples(s.active.kind);
  const bool table = FollowsTable(s.active.kind);
  if (!FollowNow(c, s)) return Advance(c, s);
  GuardLimits(c, before, s);
  const bool closed = s.limit_positive || s.limit_negative || s.bars_positive || s.bars_negative;
  if (closed || s.leads) GuardSwitches(c, before, s);
  if (coupled && (s.coupling.in_step || s.coupling.cam.over)) Conclude(c, 0, s);
  if (table && s.time_table.over) ConcludeDue(c, before, s);
  NoteSense(s);
}

void StayOpen(const Context& c, State& s) {
  s.torque = TorqueState{};
  s.setpoint = {s.actual.position, 0, 0};
  AwaitDrive(c, s);
  if (s.loop_closed && c.params.follows) Follow(c, s);  // a member of a gantry follows from its first closed cycle on
}

// Computes the next set point. Unlikely cases are kept off the path of a move with an end.
void MoveOne(const Context& c, State& s) {
  if (!s.loop_closed) [[unlikely]]
    return StayOpen(c, s);
  if (s.active.kind == RequestKind::kPower && s.active.enable) [[unlikely]]
    return AwaitBrake(c, s);
  if (s.active.kind == RequestKind::kJog) FollowKeys(c, s);
  // The set point comes from the master.
  if (c.params.follows && Follow(c, s)) return;
  // The drive follows a torque, the set point follows the axis.
  if ((s.active.kind == RequestKind::kTorqueControl || s.torque.engaged) && MoveTorque(c, s)) return;
  if (FollowsDemand(s.active.kind)) [[unlikely]]
    return FollowSource(c, s);
  Advance(c, s);
  if (s.homing.stage != HomingStage::kNone) StepHoming(c, s);
}

void FinishReset(const Context& c, State& s) {
  if (!s.reset_pending) return;
  const bool stopped = !s.loop_closed || (AtRest(s) && !s.blind);
  if (s.plc == PlcState::kErrorStop && !stopped) return;
  s.reset_pending = false;
  if (s.drive_fault || s.encoder_line_error) {
    Report(c, s.reset_ticket, FeedbackState::kError, ErrorId::kAxisFault);
    return;
  }
  if (s.error != ErrorId::kNone) {  // an axis without an error keeps its measurement, which other axes may follow
    Trust(s.encoder);
    Trust(s.correction.load);
    s.correction.load_known = false;
  }
  s.error = ErrorId::kNone;
  s.fault_of = kNoAxis;
  if (s.plc == PlcState::kErrorStop) {
    Enter(s, s.loop_closed ? PlcState::kStandstill : PlcState::kDisabled);
  }
  Report(c, s.reset_ticket, FeedbackState::kDone);
}

// Returns the state of a switch: it changes once its wire has differed for long enough.
bool Settled(const Context& c, bool wire, bool before, std::uint32_t& changed) {
  if (wire == before) {
    changed = 0;
    return before;
  }
  ++changed;
  if (changed * c.cycle.period_s <= c.params.inputs.debounce_s) return before;
  changed = 0;
  return wire;
}

// Reads the switches behind inversion and debouncing; without debouncing the first time.
void ReadSwitches(const Context& c, const ServoInputs& in, State& s) {
  const InputSense& sense = c.params.inputs;
  const bool positive = in.limit_positive != sense.invert_limit_positive;
  const bool negative = in.limit_negative != sense.invert_limit_negative;
  const bool reference = in.reference != sense.invert_reference;
  s.limit_positive_before = s.limit_positive;
  s.limit_negative_before = s.limit_negative;
  const bool known = s.switches_known && sense.debounce_s > 0;
  s.limit_positive = known ? Settled(c, positive, s.limit_positive, s.unsettled[0]) : positive;
  s.limit_negative = known ? Settled(c, negative, s.limit_negative, s.unsettled[1]) : negative;
  s.reference = known ? Settled(c, reference, s.reference, s.unsettled[2]) : reference;
  s.switches_known = true;
}

// Returns the torque limit [Nm] of the command in control or of the axis; 0 if there is none.
double TorqueLimit(const AxisParams& p, const State& s) {
  const double own = p.limits.torque.value_or(0);
  const double asked = s.plc == PlcState::kHoming ? s.active.homing.torque_limit : 0;
  return asked > 0 ? asked : own;
}

}  // namespace

trajectory::Limits StopLimits(const AxisParams& p, ErrorId error) noexcept {
  trajectory::Limits limits = p.planner_limits();
  if (error == ErrorId::kSoftLimitPositive || error == ErrorId::kSoftLimitNegative) return limits;
  const bool at_switch = error == ErrorId::kLimitSwitchPositive || error == ErrorId::kLimitSwitchNegative;
  const StopRamp& ramp = at_switch ? p.limit_stop : p.fault_stop;
  limits.deceleration = std::max(limits.deceleration, ramp.deceleration.value_or(0));
  if (limits.jerk != 0 && ramp.jerk) limits.jerk = *ramp.jerk == 0 ? 0 : std::max(limits.jerk, *ramp.jerk);
  return limits;
}

// A fault ramp of its own is stronger than any ramp that planning with the axis' limits would take.
void BrakeInFault(const Context& c, ErrorId error, State& s) noexcept {
  const trajectory::Limits own = c.params.planner_limits();
  const trajectory::Limits limits = StopLimits(c.params, error);
  if (limits.deceleration == own.deceleration && limits.jerk == own.jerk) return Brake(c, own, FromCycleBefore(c), s);
  trajectory::Profile profile{s.setpoint};
  c.planner.Stop(s.setpoint, limits, profile);
  StartMotion(profile, profile.end().position, FromCycleBefore(c), s);
}

State MakeState(const AxisParams& params) noexcept {
  State s;
  s.system = params.planner_limits();
  if (params.limits.torque) s.most_torque = *params.limits.torque;
  s.homing.homed = params.position_encoder().type == EncoderType::kAbsoluteSsi;
  s.motion.arrived = true;
  return s;
}

void Sense(const Context& c, const ServoInputs& in, State& s, const Sampling& sampling) noexcept {
  const InputSense& sense = c.params.inputs;
  const bool resumes = sampling.link == DriveLink::kHeard && s.sampling.link != DriveLink::kHeard;
  const bool lost = sampling.link == DriveLink::kLost;
  s.sampling = sampling;
  EncoderOutputs measured;
  Step(c.params.encoder, {in.counts, in.encoder_error, LargestStep(c), sampling.step}, c.cycle, s.encoder, measured);
  if (c.params.load_encoder) SenseLoad(c, in, sampling.step, LargestStep(c), measured, s);
  s.encoder_error = measured.error;
  s.encoder_line_error = in.encoder_error || in.load_encoder_error;
  const KinematicState sampled{measured.position - s.correction.now - s.origin, measured.velocity - s.correction.rate,
                               0};
  if (s.blind || lost || sampling.age > 0) {
    Locate(c, sampled, s);
  } else {
    s.actual = sampled;
  }
  if (s.torque.engaged) SenseTorque(s);
  s.due = s.setpoint.position;
  s.following_error = s.loop_closed ? s.due - s.actual.position : 0;
  ReadSwitches(c, in, s);
  s.touch_probe = in.touch_probe != sense.invert_touch_probe;
  s.index_pulse = in.index_pulses != s.index_pulses;
  s.index_skipped = in.index_pulses - s.index_pulses > 1;
  s.index_pulses = in.index_pulses;
  s.index_counts = in.index_counts;
  if (measured.error && c.params.position_encoder().type == EncoderType::kIncremental) s.homing.homed = false;
  s.drive_ready = in.drive_ready && !lost;
  s.drive_fault = in.drive_fault || lost;
  if (in.drive_error != 0 || (s.error == ErrorId::kNone && !s.drive_fault)) s.drive_error = in.drive_error;
  s.torque_nm = in.torque_nm;
  if (resumes) ForgetSample(in, s.probe);
  if (sampling.step > 0) SenseProbe(c, in, s);
}

void Move(const Context& c, State& s) noexcept {
  s.end_of_profile = false;
  Supervise(c, s);
  if (c.params.follows) WatchSkew(c, s);
  // Rare conditions are tested here: a call that finds nothing to do would cost as much as the set point.
  if (s.homing.flying_ticket != 0) WatchFlying(c, s);
  if (s.probe.watch != ProbeWatch::kNothing) FollowProbe(c, s);
  if (s.pulsing) WatchPulse(c, s);
  if (s.stops.count > 0) FollowStops(c, s);
  if (s.superimposed && LostMasters(c, s)) AbortOverlay(c, FeedbackState::kError, ErrorId::kAxisFault, s);
  std::optional<ScopedBaseMotion> base;
  if (s.superimposed) base.emplace(s);
  MoveOne(c, s);
  if (base) {
    base.reset();
    Superimpose(c, s);
  }
  FinishReset(c, s);
  if (c.params.rotary() && std::abs(s.setpoint.position) > kFarTurns * c.params.modulus) BringBackTurns(c.params, s);
  s.cam_outputs = s.cam_switch.list < 0 ? 0 : SwitchCams(c, s);
}

// Returns the torque that the set point of this cycle requires by the load model.
double OffsetOf(const TorqueOffset& offset, const KinematicState& set) noexcept {
  const double along = std::clamp(set.velocity / offset.full_at, -1.0, 1.0);
  return offset.inertia * set.acceleration + offset.viscous_friction * set.velocity + offset.coulomb_friction * along +
         offset.load_torque;
}

bool Control(const Context& c, State& s, ServoOutputs& out) noexcept {
  const AxisParams& p = c.params;
  const bool torque = s.torque.engaged && FollowsTorque(s);
  const DriveMode mode = torque ? DriveMode::kCyclicTorque : p.drive.mode;
  const bool engine_closes = mode == DriveMode::kCyclicVelocity || mode == DriveMode::kAnalog;
  const double sign = p.drive.invert ? -1 : 1;
  ControlLoopOutputs loop;
  // The new set point is for the end of this cycle. The measured position is compared with the previous one, and the
  // velocity fed forward leads from there to the new one.
  if (p.compensation.any()) Correct(c, s);
  const double correction = s.correction.now;
  const double corrected = p.load_encoder ? 0 : s.correction.rate;  // [u/s] additional velocity of the motor
  const double mean_velocity = (s.setpoint.position - s.due) / c.cycle.period_s + corrected;
  const ControlLoopInputs inputs{p.drive.mode,     s.loop_closed && engine_closes, p.drive.invert, s.due, mean_velocity,
                                 s.actual.position};
  if (s.blind) {
    Step(WithoutFeedback(p.loop), inputs, c.cycle, s.loop, loop);
  } else {
    Step(p.loop, inputs, c.cycle, s.loop, loop);
  }
  out.mode = mode;
  out.position_counts = sign * CountsAt(p.encoder, s.setpoint.position + s.origin + correction);
  out.velocity_counts_s = torque
                              ? std::abs(CountRateAt(p.encoder, std::max(s.active.velocity, std::abs(s.torque.until))))
                          : engine_closes ? CountRateAt(p.encoder, loop.velocity)
                                          : sign * CountRateAt(p.encoder, s.setpoint.velocity + corrected);
  out.voltage_v = loop.voltage_v;
  out.torque_nm = torque                                   ? sign * s.torque.set_torque_nm
                  : p.drive.torque_offset && s.loop_closed ? sign * OffsetOf(*p.drive.torque_offset, s.setpoint)
                                                           : 0;
  out.torque_until_counts_s = torque ? sign * CountRateAt(p.encoder, s.torque.until) : 0;
  out.torque_limit_nm = TorqueLimit(p, s);
  out.digital_outputs = s.cam_outputs | s.written_outputs;
  const bool sound =
      std::isfinite(out.position_counts + out.velocity_counts_s + out.voltage_v) && std::isfinite(out.torque_nm);
  if (!sound) {
    s.setpoint = {0, 0, 0};
    Fail(c, ErrorId::kInternal, true, s);
    s.loop = ControlLoopState{};
    out.position_counts = CountsAt(p.encoder, s.actual.position + s.origin + correction);
    out.mode = p.drive.mode;
    out.velocity_counts_s = 0;
    out.voltage_v = 0;
    out.torque_nm = 0;
  }
  const bool direct = s.plc == PlcState::kDisabled && !s.enable && s.direct_voltage_v != 0;
  if (direct) out.voltage_v = sign * InConverterSteps(s.direct_voltage_v);
  s.voltage_v = out.voltage_v;
  out.enable = s.enable || direct;
  out.release_brake = (s.loop_closed && !s.brake_falls) || (direct && s.drive_ready);  // a ready drive holds the load
  return sound;
}

void Fail(const Context& c, ErrorId error, bool open_loop, State& s) noexcept {
  if (s.error == ErrorId::kNone) s.error = error;
  s.direct_voltage_v = 0;
  if (!s.loop_closed && !s.enable) return;
  const bool opens = open_loop || !s.loop_closed;
  const bool soft_limit = error == ErrorId::kSoftLimitPositive || error == ErrorId::kSoftLimitNegative;
  if (IsGuided(s) && s.guidance.brakes_with_others && !opens && !soft_limit) return Enter(s, PlcState::kErrorStop);
  if (s.plc != PlcState::kErrorStop) {
    const bool has_ramp = IsGuided(s) && s.fault_ramp.deceleration > 0;  // of the component in control
    const trajectory::Limits braking = FaultLimits(c, s);
    // A fault while braking for power off does not end that: the loop is opened all the same, at rest.
    const bool switching_off = s.active.kind == RequestKind::kPower && !s.active.enable && !opens;
    if (!switching_off) EndActive(c, FeedbackState::kError, error, s);
    AbortBuffer(c, s);
    AbortOverlay(c, FeedbackState::kError, error, s);
    Enter(s, PlcState::kErrorStop);
    if (!opens) has_ramp ? Brake(c, braking, FromCycleBefore(c), s) : BrakeInFault(c, error, s);
  }
  if (!opens) return;
  if (IsGuided(s)) s.active = Request{};
  const bool switching_off = s.active.kind == RequestKind::kPower;  // while braking in ErrorStop: it is off now
  switching_off ? SwitchedOff(c, s) : OpenLoop(s);
}

void EmergencyStop(const Context& c, State& s) noexcept {
  AbortAll(c, s);
  OpenLoop(s);
  s.direct_voltage_v = 0;
  s.error = ErrorId::kNone;
  s.fault_of = kNoAxis;
  s.emergency = Emergency::kHeld;
  Enter(s, PlcState::kDisabled);
}

void ReleaseEmergencyStop(State& s) noexcept {
  if (s.emergency == Emergency::kHeld) s.emergency = Emergency::kStopped;
}

void Publish(const AxisParams& p, const State& s, Outputs& out) noexcept {
  out.set_position = Reported(p, s.setpoint.position);
  out.set_velocity = s.setpoint.velocity;
  out.set_acceleration = s.setpoint.acceleration;
  out.actual_position = Reported(p, s.actual.position);
  out.actual_velocity = s.actual.velocity;
  out.following_error = s.following_error;
  out.voltage_v = s.voltage_v;
  out.torque_nm = s.torque_nm;
  out.override_factor = s.override_factors.velocity;
  out.active_command = s.active.ticket;
  out.error = s.error;
  out.state = s.plc;
  out.superimposed = s.superimposed;
  const double torque_limit = TorqueLimit(p, s);
  const bool at_torque_limit = torque_limit > 0 && s.loop_closed && std::abs(s.torque_nm) >= 0.999 * torque_limit;
  out.limited_by = at_torque_limit ? LimitedBy::kTorque : s.limited_by;
  out.covered_distance = 0;
  if (s.superimposed) {
    out.covered_distance = s.overlay.covered;
    if (s.overlay.limited_by != LimitedBy::kNothing) out.limited_by = s.overlay.limited_by;
  }
  out.homed = s.homing.homed;
  out.end_of_profile = s.end_of_profile;
  out.profile_ends = s.profile_ends;
  out.drive_heard = s.sampling.link == DriveLink::kHeard;
  out.drive_ready = s.drive_ready;
  out.drive_error = s.drive_error;
  out.skew = s.skew.measured;
  out.skewed = p.follows && s.skew.known && std::abs(s.skew.measured) > p.follows->skew_warning.value_or(HUGE_VAL);
  out.emergency_stopped = s.emergency != Emergency::kNone;
  out.fault_of = s.fault_of == kNoAxis ? 0 : s.fault_of + 1;
  const bool coupled = Couples(s.active.kind);
  const auto& terms = s.coupling.law.terms;
  out.phase_shift = coupled ? s.coupling.phase_now : 0;
  out.covered_phase_shift = coupled ? s.coupling.phase_now - s.coupling.phase_begin : 0;
  out.in_step = (s.coupled && InStep(p, s)) || (Streams(s.active.kind) && s.stream.chase.in_step) ||
                (coupled && s.coupling.in_step) || (s.active.kind == RequestKind::kGuided && s.guidance.chase.in_step);
  out.synchronizing = coupled && !out.in_step && s.coupling.joining != Joining::kWaiting;
  out.master1 = coupled ? terms[0].master + 1 : 0;  // kNoAxis + 1 is 0: none
  out.master2 = coupled ? terms[1].master + 1 : 0;
  out.buffered_commands = s.buffered;
  out.loop_closed = s.loop_closed;
  out.in_position = s.loop_closed && !InMotion(s) && !s.motion.held &&
                    std::abs(s.following_error) <= p.supervision.in_position.value_or(HUGE_VAL);
  out.limit_positive = s.limit_positive;
  out.limit_negative = s.limit_negative;
  out.reference = s.reference;
  out.touch_probe = s.touch_probe;
  out.probe_position = s.probe.position;
  out.probe_captures = s.probe.captures;
  out.cam_outputs = s.cam_outputs;
  out.digital_outputs = s.cam_outputs | s.written_outputs;
  out.enable_positive = !s.bars_positive;
  out.enable_negative = !s.bars_negative;
  out.encoder_correction = s.correction.now;
}

}  // namespace takt::axis
