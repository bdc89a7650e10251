#include "takt/flexcam/run.h"

#include <algorithm>
#include <cmath>

namespace takt::flexcam {

namespace {

// A change with equal slopes searches this many pieces of the cam on either side: about 20 µs at most.
constexpr std::size_t kPiecesToLookAt = 64;

trajectory::Limits MasterRamps(const Settings& s) {
  return {s.offset_scaling_master_velocity, s.offset_scaling_master_acceleration, s.offset_scaling_master_deceleration,
          s.jerk};
}

trajectory::Limits SlaveRamps(const Settings& s) {
  return {s.offset_scaling_slave_velocity, s.offset_scaling_slave_acceleration, s.offset_scaling_slave_deceleration,
          s.jerk};
}

// Returns the Y at which the cam's own y is 0 in its present cycle.
double ZeroOfY(const Context& c, const State& s) {
  return s.way.profiler.base + static_cast<double>(s.way.profiler.cycle) * TableOf(c, s).stroke();
}

// Returns the master's position that absolute scaling refers to: its own zero as long as X is its position, else the
// position at which X is 0 in the present cycle of the cam.
double ZeroOfMaster(const Context& c, const State& s) {
  const double zero = ZeroOf(c.slave, c.master);
  const double turn = TurnOf(c.slave, c.master);
  if (s.assigned) return turn == 0 ? zero : zero + turn * std::floor((s.master.before.position - zero) / turn);
  const cam::Table& table = TableOf(c, s);
  const ProfilerState& p = s.way.profiler;
  return InverseOf(s.way.to_x, p.laid + static_cast<double>(p.cycle) * table.length() - table.begin());
}

ConversionTarget MasterTarget(const Context& c, const State& s) {
  ConversionTarget t;
  t.factor = s.inputs.scaling_master;
  t.offset = s.inputs.offset_master;
  t.scaling_mode = s.settings.scaling_mode_master;
  t.offset_mode = s.settings.offset_mode_master;
  t.ramps = MasterRamps(s.settings);
  t.with_master = s.settings.position_control == PositionControl::kMasterDirection;
  t.absolute_zero = ZeroOfMaster(c, s);
  return t;
}

ConversionTarget SlaveTarget(const Context& c, const State& s) {
  ConversionTarget t;
  t.factor = s.inputs.scaling_slave;
  t.offset = s.inputs.offset_slave;
  t.scaling_mode = s.settings.scaling_mode_slave;
  t.offset_mode = s.settings.offset_mode_slave;
  t.ramps = SlaveRamps(s.settings);
  t.with_master = s.settings.position_control == PositionControl::kMasterDirection;
  t.absolute_zero = ZeroOfY(c, s);
  return t;
}

// Ramps of the slave are relative to Y: they never move the slave against it. If Y falls while X rises they still
// proceed, so they use the speed of Y and the sense of X.
KinematicState RideOf(const KinematicState& y, const KinematicState& x) {
  const double sign = y.velocity * x.velocity < 0 ? -1 : 1;
  return {y.position, sign * y.velocity, sign * y.acceleration};
}

void TakeY(const Context& c, State& s) {
  s.at = ValueAt(TableOf(c, s), s.way.profiler, s.x.position);
  s.y = {s.at.y, s.at.dy * s.x.velocity, s.at.ddy * s.x.velocity * s.x.velocity + s.at.dy * s.x.acceleration};
}

bool IsEmpty(const State& s, std::uint32_t slot) {
  return slot == 0 || slot > kSlots || s.slots[slot - 1] == 0;
}

// Returns true if a cam's slope has a step between its end and its beginning: it was not made to be run cyclically.
// Cams of straight lines have such steps anyway.
bool IsOpen(const cam::Table& table) {
  if (table.cyclic() || table.source().interpolation == cam::Interpolation::kLinear) return false;
  const double begin = table.At(table.begin()).dy, end = table.At(table.end()).dy;
  return std::abs(end - begin) > 1e-6 * (1 + std::max(std::abs(begin), std::abs(end)));
}

// Returns true if the selected cam is run once: an open cam always is (CAM-86).
bool RunsOnce(const Context& c, bool cyclic, State& s) {
  const bool open = IsOpen(TableOf(c, s));
  if (open && (cyclic || s.settings.cam_cyclic)) s.warning = ErrorId::kOpenCam;
  return !cyclic || open;
}

void Take(const SequenceStep& next, State& s) {
  s.way.profiler.slot = next.slot;
  s.way.profiler.cam = s.slots[next.slot - 1] - 1;
}

// A change of cam that is no step of a sequence ends the sequence, and X cannot return to the previous cam.
void LeaveSequence(State& s) {
  s.sequencer = {};
  s.entry = {};
}

const PendingChange* Due(const State& s, ChangeWhen when) {
  return s.pending_count > 0 && s.pending[0].change.when == when ? &s.pending[0] : nullptr;
}

void EndChange(const Context& c, FeedbackState feedback, ErrorId error, State& s) {
  Report(c, s.pending[0].ticket, feedback, error);
  for (std::size_t i = 1; i < s.pending_count; ++i) s.pending[i - 1] = s.pending[i];
  s.pending[--s.pending_count] = {};
  s.gap_known = false;
}

// Changes to the other cam at the same x, or at an x with the same slope; at the instant of the previous cycle.
bool ChangeHere(const Context& c, std::uint32_t slot, ChangeAlign align, double x_before, State& s) {
  const cam::Table& to = c.slave.machine.cams[s.slots[slot - 1] - 1];
  const ProfilerValue was = ValueAt(TableOf(c, s), s.way.profiler, x_before);
  const double zero = ZeroOfY(c, s);
  double x = was.x;
  if (align == ChangeAlign::kVelocity) {
    const std::optional<double> same = cam::NearestSlope(to, was.dy, x, kPiecesToLookAt);
    if (!same) return false;
    x = *same;
  }
  ProfilerState& p = s.way.profiler;
  const bool cyclic = IsOpen(TableOf(c, s)) ? s.settings.cam_cyclic : !p.once;
  Take({slot, true}, s);
  Lay(to, x_before, x, RunsOnce(c, cyclic, s), p);
  // Outside the other cam its end is held. An end that X is at counts as passed.
  const double near = 1e-9 * to.length();
  if (p.once && (x < to.begin() - near || x > to.end() + near)) GoOn(to, x_before, p);
  const bool meets = align != ChangeAlign::kNothing || !s.settings.slave_absolute;
  p.base = meets ? was.y - ValueAt(to, p, x_before).y : zero;
  s.inputs.cam_table = slot;
  LeaveSequence(s);
  return true;
}

// Returns the master's position at which X was at `x`, between the previous cycle and this one.
double MasterAt(const State& s, double x, double x_before) {
  if (s.way.to_x.ramp.kind == RampKind::kNone) return InverseOf(s.way.to_x, x);
  const double way = s.x.position - x_before;
  const double share = way == 0 ? 1 : (x - x_before) / way;
  return s.master.before.position + share * (s.master.now.position - s.master.before.position);
}

bool Passes(double place, double turn, double before, double now) {
  if (before == now) return false;
  if (turn == 0) return (before - place) * (now - place) <= 0 && before != place;
  const double up = std::floor((std::max(before, now) - place) / turn);
  return up > std::floor((std::min(before, now) - place) / turn);
}

// Returns the gap between this cam and the next one: in position or, if Y is shifted anyway, in slope.
double GapTo(const Context& c, const PendingChange& change, bool in_place, const State& s) {
  const cam::Table& to = c.slave.machine.cams[s.slots[change.change.cam_table - 1] - 1];
  const cam::Value there = to.At(s.at.x);
  return in_place ? ZeroOfY(c, s) + there.y - s.at.y : there.dy - s.at.dy;
}

// Returns true if the slave can change from one slope to the other in a few cycles.
bool CanTakeSlope(const Context& c, double step, const State& s) {
  const trajectory::Limits own = c.slave.params.planner_limits();
  return std::abs(step * s.x.velocity * s.way.to_slave.factor) <=
         4 * std::min(own.acceleration, own.deceleration) * c.slave.cycle.period_s;
}

bool MeetsNow(const Context& c, const PendingChange& change, State& s) {
  if (change.change.align == ChangeAlign::kVelocity) return true;
  const bool in_place = change.change.align == ChangeAlign::kNothing && s.settings.slave_absolute;
  const double gap = GapTo(c, change, in_place, s);
  const bool meets = s.gap_known && s.gap * gap <= 0;
  s.gap = gap;
  s.gap_known = true;
  if (!meets || !in_place) return meets;
  return CanTakeSlope(c, GapTo(c, change, false, s), s);
}

// Returns true if the motion leads away from a position that occurs only once.
bool GoesAway(double place, double before, double now) {
  return (now - place) * (now - before) > 0;
}

bool IsDue(const Context& c, const PendingChange& change, double x_before, State& s) {
  const ProfilerState& p = s.way.profiler;
  switch (change.change.when) {
    case ChangeWhen::kAtOnce:
      return true;
    case ChangeWhen::kMasterPosition: {
      const double place = change.change.position + ZeroOf(c.slave, c.master), turn = TurnOf(c.slave, c.master);
      const double before = s.master.before.position, now = s.master.now.position;
      if (Passes(place, turn, before, now)) return true;
      if (turn == 0 && GoesAway(place, before, now)) s.warning = ErrorId::kSyncPassed;
      return false;
    }
    case ChangeWhen::kCamPosition: {
      const cam::Table& table = TableOf(c, s);
      return Passes(p.laid + change.change.position - table.begin(), p.once ? 0 : table.length(), x_before,
                    s.x.position);
    }
    case ChangeWhen::kWithoutJump:
      return MeetsNow(c, change, s);
    default:
      return false;
  }
}

// Returns true if the cam was changed.
bool TakeChanges(const Context& c, double x_before, State& s) {
  bool changed = false;
  if (s.instant) {
    s.instant = false;
    changed = ChangeHere(c, s.inputs.cam_table, ChangeAlign::kNothing, x_before, s);
  }
  while (s.pending_count > 0 && IsDue(c, s.pending[0], x_before, s)) {
    const ChangeCam change = s.pending[0].change;
    if (!ChangeHere(c, change.cam_table, change.align, x_before, s)) {
      if (change.when == ChangeWhen::kWithoutJump) return changed;
      EndChange(c, FeedbackState::kError, ErrorId::kPlanning, s);
      continue;
    }
    changed = true;
    EndChange(c, FeedbackState::kDone, ErrorId::kNone, s);
  }
  return changed;
}

// Keeps X in its present cycle from now on.
void Hold(const cam::Table& table, ProfilerState& p) {
  const auto cycle = static_cast<double>(p.cycle);
  p.laid += cycle * table.length();
  p.base += cycle * table.stroke();
  p.cycle = 0;
  p.once = p.held = true;
}

// Runs another cam from the end of this one.
void ChangeAtEnd(const Context& c, const Passed& passed, const SequenceStep& next, bool relative, State& s) {
  const cam::Table& from = TableOf(c, s);
  Take(next, s);
  Change(from, TableOf(c, s), passed, relative, RunsOnce(c, next.cyclic, s), s.way.profiler);
}

// Returns true if the other cam begins (X moving backwards: ends) as this one is left, in position and, as far as the
// slave can in a few cycles, in slope. MeetsNow does not find this between two cycles: the cams may touch there without
// crossing.
bool MeetsAtEnd(const Context& c, const PendingChange& change, const Passed& passed, const State& s) {
  const bool in_place = change.change.align == ChangeAlign::kNothing && s.settings.slave_absolute;
  const cam::Table& from = TableOf(c, s);
  const cam::Table& to = c.slave.machine.cams[s.slots[change.change.cam_table - 1] - 1];
  const double gap = to.At(to.begin()).y - from.At(from.begin()).y;
  if (!in_place || std::abs(gap) > 1e-9 * (1 + std::abs(from.lowest()) + std::abs(from.highest()))) return false;
  const double left = from.At(passed.sense > 0 ? from.end() : from.begin()).dy;
  const double entered = to.At(passed.sense > 0 ? to.begin() : to.end()).dy;
  return CanTakeSlope(c, entered - left, s);
}

// Changes to the cam that a command requests from this end on. Returns false if there is none.
bool TakePending(const Context& c, const Passed& passed, State& s) {
  const PendingChange* pending = Due(s, ChangeWhen::kNextCycle);
  if (pending == nullptr) pending = Due(s, ChangeWhen::kWithoutJump);
  if (pending == nullptr) return false;
  if (pending->change.when == ChangeWhen::kWithoutJump && !MeetsAtEnd(c, *pending, passed, s)) return false;
  const ChangeCam change = pending->change;
  // With equal slopes it continues somewhere within the other cam, else at its beginning.
  if (change.align == ChangeAlign::kVelocity) {
    if (!ChangeHere(c, change.cam_table, change.align, passed.x_total, s)) {
      EndChange(c, FeedbackState::kError, ErrorId::kPlanning, s);
      return false;
    }
  } else {
    const bool relative = change.align == ChangeAlign::kPosition || !s.settings.slave_absolute;
    ChangeAtEnd(c, passed, {change.cam_table, s.settings.cam_cyclic}, relative, s);
    LeaveSequence(s);
  }
  s.inputs.cam_table = change.cam_table;
  EndChange(c, FeedbackState::kDone, ErrorId::kNone, s);
  return true;
}

void TakeNext(const Context& c, const Passed& passed, State& s) {
  ProfilerState& p = s.way.profiler;
  SequenceStep next = Next(SequencerOf(c, s), s.sequencer);
  if (IsEmpty(s, next.slot)) {
    s.warning = ErrorId::kUnknownTarget;
    next = {p.slot, !p.once};
  }
  const bool same = next.slot == p.slot && s.slots[next.slot - 1] - 1 == p.cam;
  if (!same) return ChangeAtEnd(c, passed, next, !s.settings.slave_absolute, s);
  if (!RunsOnce(c, next.cyclic, s)) {
    p.once = false;
  } else if (!p.once) {
    Hold(TableOf(c, s), p);
  }
}

// The cam of a sequence is left over the end at which X entered: it was not run, and the previous one continues. A cam
// that was started right there continues itself, from its other end.
bool ComesBack(const Context& c, const Passed& passed, State& s) {
  if (s.entry.sense == 0 || passed.sense != -s.entry.sense) return false;
  if (s.sequencer.part == SequencePart::kNone) {  // the sequence was switched on before any cam was run
    if (!s.inputs.cam_sequencer) return false;
    const SequenceStep first = First(SequencerOf(c, s), s.sequencer);
    if (!IsEmpty(s, first.slot)) ChangeAtEnd(c, passed, first, !s.settings.slave_absolute, s);
    s.entry = {passed.sense, false, {}, {}};
    return true;
  }
  if (s.entry.has_before) {
    s.way.profiler = s.entry.profiler;
    s.sequencer = s.entry.sequencer;
    s.entry = {};
    return true;
  }
  const cam::Table& table = TableOf(c, s);
  s.way.profiler.laid += passed.sense * table.length();
  s.way.profiler.base += passed.sense * table.stroke();
  s.entry.sense = passed.sense;
  return true;
}

void GoOnInSequence(const Context& c, const Passed& passed, State& s) {
  const SequenceEntry before = {passed.sense, true, s.way.profiler, s.sequencer};
  TakeNext(c, passed, s);
  s.entry = s.way.profiler.slot == before.profiler.slot ? SequenceEntry{} : before;
}

void PassEnd(const Context& c, const Passed& passed, double x_before, State& s) {
  ProfilerState& p = s.way.profiler;
  const double master = MasterAt(s, passed.x_total, x_before);
  ++s.cam_ends;
  // A curve of the clutch that ends on this cam relies on its position.
  const bool stays = IsOnCurve(s.clutch);
  if (!stays && !ComesBack(c, passed, s) && !TakePending(c, passed, s)) GoOnInSequence(c, passed, s);
  const double turn = TurnOf(c.slave, c.master);
  if (turn == 0 || std::abs(TableOf(c, s).length() - turn) > 1e-9 * turn) s.assigned = false;
  const Cycle& cycle = c.slave.cycle;
  const ConversionInputs masters = {s.master.before, s.master.before};
  if (!stays) ApproachAtZero(MasterTarget(c, s), master, cycle, masters, c.slave.planner, s.way.to_x);
  s.x = Convert(s.way.to_x, c.slave.cycle, s.master.now);
  GoOn(TableOf(c, s), s.x.position, p);
  // Counted from the present Y: the end of a cam that is held there or entered backwards, else its beginning.
  const bool at_end = p.held ? passed.sense > 0 : passed.sense < 0;
  const double entered = ZeroOfY(c, s) + (at_end ? TableOf(c, s).stroke() : 0);
  const ConversionInputs ys = {s.y, RideOf(s.y, s.x)};
  if (!IsFrozen(s.clutch)) ApproachAtZero(SlaveTarget(c, s), entered, cycle, ys, c.slave.planner, s.way.to_slave);
}

// Returns true if new settings may come into force now. A clutch that waits for ramps in progress is not kept waiting
// by new ones.
bool TakesOver(const ClutchState& clutch) {
  return !IsOnCurve(clutch) && clutch.waits != ClutchWait::kRamps;
}

// Returns the cam to run instead of the held end of a cam, if any: by a command, by a sequence, or by the settings, be
// it another slot, another cam in this slot, or this one cyclically. `meets` returns true if it begins at the present
// Y.
std::optional<SequenceStep> AfterHeld(const Context& c, bool& meets, State& s) {
  const ProfilerState& p = s.way.profiler;
  if (const PendingChange* pending = Due(s, ChangeWhen::kNextCycle)) {
    s.inputs.cam_table = pending->change.cam_table;
    meets = meets || pending->change.align != ChangeAlign::kNothing;
    EndChange(c, FeedbackState::kDone, ErrorId::kNone, s);
    LeaveSequence(s);
    return SequenceStep{s.inputs.cam_table, s.settings.cam_cyclic};
  }
  if (const std::optional<SequenceStep> next = FromHeld(SequencerOf(c, s), s.sequencer)) return next;
  const bool other = s.slots[p.slot - 1] - 1 != p.cam;
  return other ? std::optional(SequenceStep{p.slot, s.settings.cam_cyclic}) : std::nullopt;
}

// Holds the end of a cam that is run once until another one is to be run. `changed`: the held cam was selected in this
// cycle, so the next one begins at its Y.
void HoldOn(const Context& c, bool changed, State& s) {
  ProfilerState& p = s.way.profiler;
  bool meets = changed || !s.settings.slave_absolute;
  const std::optional<SequenceStep> next = IsOnCurve(s.clutch) ? std::nullopt : AfterHeld(c, meets, s);
  if (!next || IsEmpty(s, next->slot)) return GoOn(TableOf(c, s), s.x.position, p);
  const double was = changed ? ValueAt(TableOf(c, s), p, s.x.position).y : s.y.position;
  Take(*next, s);
  const cam::Table& table = TableOf(c, s);
  const double back = s.x.velocity < 0 ? table.length() : 0;
  Lay(table, s.x.position, table.begin() + back, RunsOnce(c, next->cyclic, s), p);
  if (meets) p.base = was - ValueAt(table, p, s.x.position).y;
}

}  // namespace

void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error) noexcept {
  c.slave.feedback.Report({ticket, c.slave.cycle.count, feedback, false, error, 0});
}

const cam::Table& TableOf(const Context& c, const State& s) noexcept {
  return c.slave.machine.cams[s.way.profiler.cam];
}

bool IsSettled(const State& s, Adjustment what) noexcept {
  const auto ramps = [](const Conversion& c) { return c.ramp.kind != RampKind::kNone; };
  const auto offset = [&](const Conversion& c, double set) {
    return c.offset == set && !(ramps(c) && c.offset_left != 0);
  };
  const auto factor = [&](const Conversion& c, double set) {
    return c.factor == set && !(ramps(c) && c.factor_left != 0);
  };
  switch (what) {
    case Adjustment::kOffsetMaster:
      return offset(s.way.to_x, s.inputs.offset_master);
    case Adjustment::kOffsetSlave:
      return offset(s.way.to_slave, s.inputs.offset_slave);
    case Adjustment::kScalingMaster:
      return factor(s.way.to_x, s.inputs.scaling_master);
    case Adjustment::kScalingSlave:
      return factor(s.way.to_slave, s.inputs.scaling_slave);
  }
  return true;
}

bool IsStuck(const State& s, Adjustment what) noexcept {
  const bool on_cam = s.clutch.phase == ClutchPhase::kClosed || s.clutch.phase == ClutchPhase::kWaitingOut;
  if (s.state != ModuleState::kSync || !on_cam || !s.way.profiler.held || IsSettled(s, what)) return false;
  const Settings& set = s.settings;
  const bool rides = s.way.to_slave.ramp.kind == RampKind::kWithMaster;  // on Y, which is at rest
  switch (what) {
    case Adjustment::kOffsetMaster:
      return set.offset_mode_master == OffsetMode::kXZero && s.way.to_x.offset != s.inputs.offset_master;
    case Adjustment::kOffsetSlave:
      return rides || (set.offset_mode_slave == OffsetMode::kXZero && s.way.to_slave.offset != s.inputs.offset_slave);
    case Adjustment::kScalingMaster:
      return set.scaling_mode_master == ScalingMode::kXZero && s.way.to_x.factor != s.inputs.scaling_master;
    case Adjustment::kScalingSlave:
      return rides ||
             (set.scaling_mode_slave == ScalingMode::kXZero && s.way.to_slave.factor != s.inputs.scaling_slave);
  }
  return false;
}

SequencerInputs SequencerOf(const Context& c, const State& s) noexcept {
  const ProfilerState& p = s.way.profiler;
  const std::uint32_t slot = s.inputs.cam_table;
  const bool open = !IsEmpty(s, slot) && IsOpen(c.slave.machine.cams[s.slots[slot - 1] - 1]);
  return {s.inputs.cam_sequencer,
          s.settings.cam_sequence_mode,
          {s.inputs.cam_table, s.settings.cam_cyclic && !open},
          {p.slot, !p.once}};
}

void TakeUp(const Context& c, const axis::State& slave, State& s) noexcept {
  SequenceStep first = First(SequencerOf(c, s), s.sequencer);
  if (IsEmpty(s, first.slot)) first = {s.way.profiler.slot, s.settings.cam_cyclic};
  Take(first, s);
  const cam::Table& table = TableOf(c, s);
  const double master = s.master.before.position;
  Conversion& to_x = s.way.to_x;
  to_x = {s.inputs.scaling_master, s.inputs.offset_master, master, table.begin(), {}};
  s.assigned = s.settings.master_absolute;
  if (s.assigned) {
    to_x.in_zero = ZeroOfMaster(c, s);
    to_x.out_zero = 0;
  }
  s.x = Convert(to_x, c.slave.cycle, s.master.before);
  const double x = s.assigned ? s.x.position : table.begin() + to_x.offset;
  // A sequence begins in the cycle that X is in, at any position of the master; a cam that is run once may be over.
  const bool once = RunsOnce(c, first.cyclic, s);
  ProfilerState& p = s.way.profiler;
  Lay(table, s.x.position, x, once && s.sequencer.part == SequencePart::kNone, p);
  p.once = once;
  s.entry = {};
  if (std::abs(s.x.position - p.laid) <= 1e-9 * table.length()) s.entry.sense = 1;
  if (s.way.profiler.once) GoOn(table, s.x.position, s.way.profiler);
  TakeY(c, s);
  Conversion& to_slave = s.way.to_slave;
  to_slave = {s.inputs.scaling_slave, s.inputs.offset_slave, 0, 0, {}};
  s.wanted = Convert(to_slave, c.slave.cycle, s.y);
  const double own = slave.setpoint.position + slave.origin;
  to_slave.out_zero = s.settings.slave_absolute ? slave.origin : own - s.wanted.position;
  s.wanted.position += to_slave.out_zero;
}

void ShowWay(const Context& c, const axis::State& slave, State& s) noexcept {
  const ErrorId warning = s.warning;
  TakeUp(c, slave, s);
  s.warning = warning;
  s.x = Convert(s.way.to_x, c.slave.cycle, s.master.now);
  TakeY(c, s);
  s.wanted = Convert(s.way.to_slave, c.slave.cycle, s.y);
  s.end_of_profile = false;
}

void RunWay(const Context& c, State& s) noexcept {
  const Cycle& cycle = c.slave.cycle;
  const double x_before = s.x.position;
  const ConversionInputs masters = {s.master.before, s.master.before};
  const ConversionInputs ys = {s.y, RideOf(s.y, s.x)};
  EndRamp(cycle, s.way.to_x);
  EndRamp(cycle, s.way.to_slave);
  if (TakesOver(s.clutch)) Approach(MasterTarget(c, s), cycle, masters, c.slave.planner, s.way.to_x);
  Advance(s.master.before, s.master.now, s.master.now.position - s.master.before.position, cycle, c.slave.planner,
          s.way.to_x.ramp);
  s.x = Convert(s.way.to_x, cycle, s.master.now);
  const bool changed = !IsOnCurve(s.clutch) && TakeChanges(c, x_before, s);
  const std::optional<Passed> passed = PassedEnd(TableOf(c, s), s.way.profiler, s.x.position);
  if (passed) {
    PassEnd(c, *passed, x_before, s);
  } else if (s.way.profiler.held) {
    HoldOn(c, changed, s);
  }
  s.end_of_profile = AnnouncesEnd(TableOf(c, s), cycle, s.x, passed.has_value(), s.way.profiler);
  TakeY(c, s);
  if (TakesOver(s.clutch) && !IsFrozen(s.clutch))
    Approach(SlaveTarget(c, s), cycle, ys, c.slave.planner, s.way.to_slave);
  const double y_moved = std::copysign(s.y.position - ys.before.position, s.x.position - x_before);
  Advance(ys.ride_before, RideOf(s.y, s.x), y_moved, cycle, c.slave.planner, s.way.to_slave.ramp);
  s.wanted = Convert(s.way.to_slave, cycle, s.y);
}

bool Enqueue(Ticket ticket, const ChangeCam& change, State& s) noexcept {
  if (s.pending_count == kPendingChanges) return false;
  s.pending[s.pending_count++] = {ticket, change};
  return true;
}

void AbortChanges(const Context& c, State& s) noexcept {
  while (s.pending_count > 0) EndChange(c, FeedbackState::kAborted, ErrorId::kNone, s);
}

}  // namespace takt::flexcam
