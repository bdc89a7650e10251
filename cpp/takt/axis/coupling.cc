#include "takt/axis/coupling.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

using trajectory::Limits;

namespace {

constexpr double kBlurredIncrements = 8;

KinematicState PhaseAt(const Context& c, const CouplingState& k) {
  return k.phase.At(static_cast<double>(c.cycle.count - k.phase_start) * c.cycle.period_s);
}

// Returns the outside master of this number; null if it is an axis.
const OutsideMaster* Outside(const Context& c, std::uint32_t master) {
  const std::size_t axes = c.machine.states.size();
  return master < axes ? nullptr : &c.machine.outside[master - axes];
}
double OriginOf(const Context& c, std::uint32_t master) {
  const OutsideMaster* outside = Outside(c, master);
  return outside ? outside->origin : c.machine.states[master].origin;
}
double TurnOf(const Context& c, std::uint32_t master) {
  return Outside(c, master) ? 0 : c.machine.params[master].turn();
}
double ReportedOf(const Context& c, std::uint32_t master, double position) {
  return Outside(c, master) ? position : Reported(c.machine.params[master], position);
}

// Returns the state of an axis over all turns, set or measured.
KinematicState AsItIs(const Context& c, const CouplingTerm& term) {
  const State& master = c.machine.states[term.master];
  const bool measured = term.source == MasterSource::kActualValue;
  KinematicState its = measured ? master.actual : master.setpoint;
  if (measured && master.loop_closed) its.acceleration = master.setpoint.acceleration;  // not measured
  its.position += master.origin;
  return its;
}

// Returns a master as this axis sees it: over all turns, with the phase.
KinematicState Seen(const Context& c, const CouplingState& k, const CouplingTerm& term, const KinematicState& phase) {
  if (const OutsideMaster* outside = Outside(c, term.master)) {
    const KinematicState& its = outside->at;
    return {its.position + phase.position, its.velocity + phase.velocity, its.acceleration + phase.acceleration};
  }
  const MasterFilter& filter = k.filters[&term == &k.law.terms[1] ? 1 : 0];
  const KinematicState its = k.filtered && filter.cycles > 0 ? filter.estimate : AsItIs(c, term);
  return {its.position + phase.position, its.velocity + phase.velocity, its.acceleration + phase.acceleration};
}

// Returns the time constant [s] of the filter of a measured master; 0 if it has none.
double FilterTime(const Context& c, const CouplingTerm& term) {
  if (term.master == kNoAxis || term.source == MasterSource::kSetValue || Outside(c, term.master)) return 0;
  return term.filter_s < 0 ? c.machine.params[term.master].encoder.velocity_filter_s : term.filter_s;
}

// Runs the filters of measured masters; once per cycle.
void FilterMasters(const Context& c, CouplingState& k) {
  for (std::size_t i = 0; i < k.law.terms.size(); ++i) {
    const CouplingTerm& term = k.law.terms[i];
    const double time_s = FilterTime(c, term);
    if (time_s <= 0) continue;
    KinematicState its = AsItIs(c, term);
    const State& master = c.machine.states[term.master];
    if (master.loop_closed) its.velocity = master.setpoint.velocity;  // to begin with: better than measured
    Filter(time_s, 1 / c.machine.params[term.master].encoder.increments_per_unit, c.cycle, its, k.filters[i]);
  }
}

// Returns the sum of all terms, as a demand over all own turns.
KinematicState Sum(const Context& c, const CouplingState& k, const KinematicState& phase) {
  KinematicState sum;
  for (const CouplingTerm& term : k.law.terms) {
    if (term.master == kNoAxis) continue;
    const KinematicState master = Seen(c, k, term, &term == &k.law.terms[0] ? phase : KinematicState{});
    sum.position += term.ratio * master.position;
    sum.velocity += term.ratio * master.velocity;
    sum.acceleration += term.ratio * master.acceleration;
  }
  return sum;
}

// Returns, of the positions equal to `position` modulo `turn`, the next one ahead of `from` in this sense; `position`
// if `turn` is 0.
double NextAhead(double turn, double position, double from, double sense) {
  if (turn == 0) return position;
  const double turns = (from - position) / turn;
  return position + turn * (sense < 0 ? std::floor(turns) : std::ceil(turns));
}

// Returns the slave position at the end of synchronisation, over all turns, for a slave that would reach about
// `expected` meanwhile. `sense`: of its travel then; catching up is further in that sense, slowing down less far.
double SlaveSync(const AxisParams& p, double position, double expected, SyncMode mode, double sense) {
  if (!p.rotary()) return position;
  const double turns = (expected - position) / p.modulus;
  if (mode == SyncMode::kShortest) return position + p.modulus * std::round(turns);
  const bool upwards = (mode == SyncMode::kCatchUp) == (sense >= 0);
  return position + p.modulus * (upwards ? std::ceil(turns) : std::floor(turns));
}

// Returns the velocity limit of a master, in its unit per second.
double Fastest(const Context& c, std::uint32_t master) {
  const OutsideMaster* outside = Outside(c, master);
  return outside ? outside->velocity : c.machine.params[master].limits.velocity;
}

// Returns the speed below which a master is at rest: there is no slope over its position then.
double Standing(const Context& c, std::uint32_t master) {
  return 1e-6 * Fastest(c, master);
}

// Returns true if the coupling follows the position from the start, not only once in step.
bool Joins(RequestKind kind) {
  return kind == RequestKind::kGearInPos || kind == RequestKind::kCamIn;
}

CamLaw CamOf(const Context& c, const Request& r) {
  const CouplingRequest& q = r.coupling;
  return {c.machine.cams[r.table.index], q.terms[0].ratio, q.periodic.value_or(false), r.table.scale};
}

CamLaw LawOf(const Context& c, const AddedCam& added) {
  return {c.machine.cams[added.table], added.ratio, added.periodic, added.scale};
}

// Returns what the added cams contribute at this position of the master; derivatives over the master's position.
cam::Value Added(const Context& c, double master, const CouplingState& k) {
  cam::Value sum;
  for (const AddedCam& added : k.added) {
    if (added.table == kNoTable) continue;
    const cam::Value value = ValueAt(LawOf(c, added), added.cam, master);
    sum.y += value.y;
    sum.dy += value.dy;
    sum.ddy += value.ddy;
    sum.dddy += value.dddy;
  }
  return sum;
}

// Returns the slave position in step at this position of the master; derivatives over the master's position.
cam::Value InStep(const Context& c, double master, const State& s) {
  const CouplingState& k = s.coupling;
  if (s.active.kind == RequestKind::kCamIn) {
    const cam::Value own = ValueAt(CamOf(c, s.active), k.cam, master), added = Added(c, master, k);
    return {own.y + added.y, own.dy + added.dy, own.ddy + added.ddy, own.dddy + added.dddy};
  }
  const double ratio = k.law.terms[0].ratio;
  return {k.slave_sync + ratio * (master - k.master_sync), ratio, 0, 0};
}

KinematicState DemandOf(const cam::Value& at, const KinematicState& master) {
  return trajectory::ComposeWithMaster({at.y, at.dy, at.ddy}, master);
}

// Chooses the slave position where synchronisation ends: of its repetitions the one that the SyncMode selects for a
// slave that would reach about `expected` meanwhile; for a relative cam `expected` plus the offset. `master_sense`: of
// the master's travel.
void ChooseSlaveSync(const Context& c, double expected, double master_sense, State& s) {
  CouplingState& k = s.coupling;
  const cam::Value place = InStep(c, k.master_sync, s);
  const double sense = place.dy != 0 ? place.dy * master_sense : s.setpoint.velocity;
  if (s.active.kind != RequestKind::kCamIn) {
    k.slave_sync = SlaveSync(c.params, k.slave_sync, expected, k.law.sync_mode, sense);
    return;
  }
  const double wanted = k.law.slave_absolute ? SlaveSync(c.params, place.y, expected, k.law.sync_mode, sense)
                                             : expected + s.active.table.offset;
  k.cam.slave += wanted - place.y;
}

// Begins the curve over the master's displacement, from the present motion of the slave to being in step. If the master
// is already there, or beyond, there is no curve: the slave gets into step within the limits of the command.
void BeginCurve(const Context& c, const KinematicState& master, State& s) {
  CouplingState& k = s.coupling;
  const double planned = k.master_sync - k.curve_begin;
  const double way = k.master_sync - master.position;
  const double own = s.setpoint.position + s.origin - k.chase.offset;
  if (way * planned <= 0) {
    ChooseSlaveSync(c, own, master.velocity, s);
    k.joining = Joining::kJoined;
    return;
  }
  k.joining = Joining::kOnCurve;
  k.curve_begin = master.position;
  double slope = 0;
  double bend = 0;
  if (std::abs(master.velocity) > Standing(c, k.law.terms[0].master)) {
    slope = s.setpoint.velocity / master.velocity;
    bend = (s.setpoint.acceleration - slope * master.acceleration) / (master.velocity * master.velocity);
  }
  ChooseSlaveSync(c, own + 0.5 * (slope + InStep(c, k.master_sync, s).dy) * way, way, s);
  const cam::Value end = InStep(c, k.master_sync, s);
  k.curve = trajectory::Connect(way, {own, slope, bend}, {end.y, end.dy, end.ddy});
}

KinematicState OnCurve(const CouplingState& k, const KinematicState& master) {
  return trajectory::ComposeWithMaster(k.curve.At(master.position - k.curve_begin), master);
}

// Begins the wait for the master position, `distance` before `master_sync`, at which synchronisation starts.
void Wait(double master, double distance, CouplingState& k) {
  const double side = k.master_sync < master ? -1 : 1;
  k.curve_begin = k.master_sync - side * distance;
  k.begin_side = master - k.curve_begin;
  k.joining = Joining::kWaiting;
}

// Returns true if the wait is over: the master has passed the start, or is between it and `master_sync`, moving towards
// the latter. If a master on a circle moves away from `master_sync`, the next repetition in its sense replaces it.
bool WaitIsOver(double standing, const KinematicState& master, CouplingState& k) {
  const double way = k.master_sync - k.curve_begin;
  const double side = master.position - k.curve_begin;
  const bool passes = side == 0 || (side > 0) != (k.begin_side > 0);
  if (way == 0 && passes) return true;
  if (std::abs(master.velocity) > standing) {
    const double sense = master.velocity < 0 ? -1 : 1;
    const double left = k.master_sync - master.position;
    if (left * way > 0 && std::abs(left) <= std::abs(way) && left * sense > 0) return true;
    if (k.turn != 0 && left * sense < 0) {
      const double place = NextAhead(k.turn, k.master_sync, master.position + sense * std::abs(way), sense);
      k.cam.master += place - k.master_sync;
      k.master_sync = place;
      Wait(master.position, std::abs(way), k);
      return false;
    }
  }
  return passes;
}

// Computes the demand of GearInPos and CamIn: waits for the start, follows the curve, then stays in step. Returns false
// while it waits.
bool JoinedDemand(const Context& c, const KinematicState& phase, State& s, KinematicState& demand) {
  CouplingState& k = s.coupling;
  const CouplingTerm& term = k.law.terms[0];
  const KinematicState master = Seen(c, k, term, phase);
  if (k.joining == Joining::kWaiting) {
    if (!WaitIsOver(Standing(c, term.master), master, k)) return false;
    BeginCurve(c, master, s);
  }
  if (k.joining == Joining::kOnCurve) {
    const double way = k.master_sync - k.curve_begin;
    const double share = way == 0 ? 1 : (master.position - k.curve_begin) / way;
    if (share < 1) {
      // If the master returns to before the curve, the slave stays where the curve began.
      demand = share >= 0 ? OnCurve(k, master) : KinematicState{k.curve.At(0).position, 0, 0};
      return true;
    }
    k.joining = Joining::kJoined;
  }
  demand = DemandOf(InStep(c, master.position, s), master);
  return true;
}

void BeginJoining(const Context& c, const Request& r, State& s) {
  CouplingState& k = s.coupling;
  const CouplingTerm& term = k.law.terms[0];
  const double origin = OriginOf(c, term.master);
  const KinematicState seen = Seen(c, k, term, PhaseAt(c, k));
  const double sense = seen.velocity < 0 ? -1 : 1;
  const double distance = std::max(0.0, r.coupling.master_start_distance);
  k.turn = TurnOf(c, term.master);
  k.master_sync = NextAhead(k.turn, r.coupling.master_sync_position + origin, seen.position + sense * distance, sense);
  k.slave_sync = r.coupling.slave_sync_position + s.origin;
  if (r.coupling.master_start_distance < 0) {
    const double own = s.setpoint.position + s.origin;
    const double way = k.master_sync - seen.position;
    k.slave_sync = SlaveSync(c.params, k.slave_sync, own + term.ratio * way, k.law.sync_mode, term.ratio * sense);
    k.joining = Joining::kJoined;
    return;
  }
  Wait(seen.position, distance, k);
}

// Lays a cam over the master's positions. A cam that takes over at the end of another begins exactly there.
void BeginCam(const Context& c, const Request& r, State& s) {
  CouplingState& k = s.coupling;
  const CouplingTerm& term = k.law.terms[0];
  const double origin = OriginOf(c, term.master);
  const double turn = TurnOf(c, term.master);
  const CamLaw law = CamOf(c, r);
  const KinematicState seen = Seen(c, k, term, PhaseAt(c, k));
  const bool takes_over = s.end_of_profile && k.cam.end_axis == term.master;
  const double sense = seen.velocity < 0 ? -1 : 1;
  const bool waits = k.law.master_start_distance >= 0;
  const double distance = std::max(0.0, k.law.master_start_distance);
  double at = takes_over ? k.cam.end_master : seen.position;   // reference position of the master, over all turns
  double zero = at - ReportedOf(c, term.master, at - origin);  // the master's zero in that turn
  const double begin = (law.table.begin() - k.law.master_offset) / law.ratio;  // from zero
  if (k.law.at_sync_position) {
    k.turn = turn;
    at = NextAhead(k.turn, k.law.master_sync_position + origin, seen.position + sense * distance, sense);
    zero = at - k.law.master_sync_position;
  } else if (waits && !k.law.master_absolute) {
    at = seen.position + sense * distance;
  } else if (waits) {
    k.turn = law.periodic ? std::abs(law.way()) : turn;
    at = NextAhead(k.turn, zero + begin, seen.position + sense * distance, sense);
    zero = at - begin;
  }
  k.cam.master = k.law.master_absolute ? zero + begin : at - k.law.master_offset / law.ratio;
  BeginCycles(law, at, k.cam);
  k.cam.slave = s.origin + r.table.offset;
  k.cam.share = ShareOf(law, k.cam, at);
  k.master_sync = at;
  if (waits) return Wait(seen.position, distance, k);
  ChooseSlaveSync(c, takes_over ? k.cam.end_slave : s.setpoint.position + s.origin, sense, s);
}

// Returns the tolerance [u] for being in step with measured masters, which are known only to their increments.
double Blur(const Context& c, const State& s) {
  double blur = 0;
  for (const CouplingTerm& term : s.coupling.law.terms) {
    if (term.master == kNoAxis || term.source == MasterSource::kSetValue || Outside(c, term.master)) continue;
    const double slope =
        Joins(s.active.kind) ? InStep(c, Seen(c, s.coupling, term, PhaseAt(c, s.coupling)).position, s).dy : term.ratio;
    blur += std::abs(slope) * kBlurredIncrements / c.machine.params[term.master].encoder.increments_per_unit;
  }
  return blur;
}

// Checks whether the master has passed an end of the cam.
void NoteEnd(const Context& c, const KinematicState& phase, State& s) {
  CouplingState& k = s.coupling;
  if (s.active.kind != RequestKind::kCamIn || k.joining != Joining::kJoined) return;
  const CamLaw law = CamOf(c, s.active);
  const double share = ShareOf(law, k.cam, Seen(c, k, k.law.terms[0], phase).position);
  const std::optional<double> end = EndPassed(k.cam.share, share);
  k.cam.share = share;
  s.end_of_profile = end.has_value();
  k.cam.over = end || (k.cam.over && !law.periodic && (share == 0 || share == 1));
  if (!end) return;
  ++s.profile_ends;
  k.cam.end_axis = k.law.terms[0].master;
  k.cam.end_master = k.cam.master + *end * law.way() - phase.position;
  k.cam.end_slave = k.cam.slave + k.chase.offset + Added(c, k.cam.end_master + phase.position, k).y +
                    law.scale * (law.table.At(law.table.begin()).y + *end * law.table.stroke());
}

bool MastersStand(const Context& c, const CouplingRequest& law) {
  return std::all_of(law.terms.begin(), law.terms.end(), [&](const CouplingTerm& term) {
    if (term.master == kNoAxis) return true;
    const OutsideMaster* outside = Outside(c, term.master);
    return outside ? outside->known : IsKnown(c.machine.states[term.master], term.source);
  });
}

void EndPhase(const Context& c, FeedbackState feedback, State& s) {
  if (!s.coupling.phase_moves) return;
  s.coupling.phase_moves = false;
  const double covered = s.coupling.phase_now - s.coupling.phase_begin;
  Report(c, s.coupling.phase_ticket, feedback, ErrorId::kNone, false, covered);
  s.coupling.phase_ticket = 0;
}

// Returns how far a master may move away from the only position at which synchronisation can start: for a cam by one
// cycle, for a gear as far as a master that reverses may overshoot.
double Excursion(const Context& c, const State& s) {
  const CouplingState& k = s.coupling;
  if (s.active.kind == RequestKind::kCamIn) return std::abs(CamOf(c, s.active).way());
  constexpr double kReversal = 1;  // [s] at the velocity limit
  return std::max(k.law.master_start_distance, kReversal * Fastest(c, k.law.terms[0].master));
}

// Returns true if the axis waits for the only position of its master at which synchronisation can start, and the master
// has moved away from it by more than Excursion since the wait began (CAM-82).
bool LeavesSyncPosition(const Context& c, const KinematicState& phase, const State& s) {
  const CouplingState& k = s.coupling;
  if (!Joins(s.active.kind) || k.joining != Joining::kWaiting || k.turn != 0) return false;
  const double side = Seen(c, k, k.law.terms[0], phase).position - k.curve_begin;
  return std::abs(side) - std::abs(k.begin_side) > Excursion(c, s);
}

void BreakOff(const Context& c, ErrorId error, State& s) {
  const Limits ramps = c.params.planner_limits();
  EndActive(c, FeedbackState::kError, error, s);
  s.coupling.law = CouplingRequest{};
  AbortBuffer(c, s);
  ComeToRest(c, ramps, FromCycleBefore(c), s);
}

// Puts a request that couples in control, without phase, filters and added cams.
void TakeCoupling(const Context& c, const Request& r, State& s) {
  Grant(c, r, s);
  CouplingState& k = s.coupling;
  const CamState cam = k.cam;  // the end of one cam is the beginning of the next
  k = CouplingState{};
  k.law = r.coupling;
  k.cam = cam;
  k.cam.over = false;
  s.limited_by = LimitedBy::kNothing;
  s.motion.profile = trajectory::Profile{s.setpoint};
  s.motion.target = s.setpoint.position;
  s.motion.arrived = false;
  k.locked = Joins(r.kind);
  k.filtered = std::ranges::any_of(k.law.terms, [&](const CouplingTerm& term) { return FilterTime(c, term) > 0; });
}

// Starts the synchronisation of couplings by position, with the phase of the master.
void BeginCoupling(const Context& c, const Request& r, State& s) {
  if (r.kind == RequestKind::kGearInPos) BeginJoining(c, r, s);
  if (r.kind == RequestKind::kCamIn) BeginCam(c, r, s);
  Enter(s, PlcState::kSynchronizedMotion);
}

Status ShiftPhase(const Context& c, Ticket ticket, bool relative, double shift, const std::optional<double>& velocity,
                  const std::optional<double>& acceleration, const std::optional<double>& deceleration,
                  const std::optional<double>& jerk, State& s) {
  CouplingState& k = s.coupling;
  const bool one_master = Couples(s.active.kind) && s.active.kind != RequestKind::kCombineAxes;
  if (!one_master) return Status::Failed(ErrorId::kState);
  const double ratio = std::max(std::abs(k.law.terms[0].ratio), 1e-6);
  const Limits own = c.params.planner_limits();
  const Limits limits = {velocity.value_or(own.velocity / ratio), acceleration.value_or(own.acceleration / ratio),
                         deceleration.value_or(own.deceleration / ratio), jerk.value_or(own.jerk / ratio)};
  const KinematicState from = k.phase.At(static_cast<double>(c.cycle.count - 1 - k.phase_start) * c.cycle.period_s);
  trajectory::Profile profile;
  const double target = relative ? from.position + shift : shift;
  if (const Status status = c.planner.ToPosition(from, target, 0, limits, profile); status.failed()) return status;
  EndPhase(c, FeedbackState::kAborted, s);
  k.phase_begin = relative ? from.position : 0;
  k.phase = profile;
  k.phase_start = c.cycle.count - 1;
  k.phase_ticket = ticket;
  k.phase_moves = true;
  Report(c, ticket, FeedbackState::kActive);
  return Status::Ok();
}

}  // namespace

bool IsKnown(const State& master, MasterSource source) noexcept {
  if (source == MasterSource::kSetValue) return master.loop_closed;
  const bool heard = !master.blind && !master.encoder_error;
  return heard && (master.loop_closed || master.error == ErrorId::kNone);
}

std::uint32_t FindMaster(const MachineView& machine, std::string_view name) noexcept {
  const std::uint32_t axis = FindAxis(machine.params, name);
  if (axis != kNoAxis) return axis;
  const auto found = std::ranges::find(machine.outside, name, &OutsideMaster::name);
  if (found == machine.outside.end()) return kNoAxis;
  return static_cast<std::uint32_t>(machine.states.size() + static_cast<std::size_t>(found - machine.outside.begin()));
}

bool UsesTable(const State& s, std::uint32_t index) noexcept {
  const auto uses = [&](const Request& r) { return !r.table.name.empty() && r.table.index == index; };
  if (s.active.kind != RequestKind::kNone && uses(s.active)) return true;
  if (std::ranges::find(s.coupling.added, index, &AddedCam::table) != s.coupling.added.end()) return true;
  return std::any_of(s.buffer.begin(), s.buffer.begin() + s.buffered, uses);
}

Status FindNamed(const Context& c, Request& r) noexcept {
  for (CouplingTerm& term : r.coupling.terms) {
    if (term.name.empty()) continue;
    if (term.master == kNoAxis) term.master = FindMaster(c.machine, term.name.view());
    if (term.master == kNoAxis) return Status::Failed(ErrorId::kUnknownTarget);
  }
  if (r.table.name.empty()) return Status::Ok();
  if (r.table.index == kNoTable) r.table.index = cam::Find(c.machine.cams, r.table.name.view()).value_or(kNoTable);
  if (r.table.index == kNoTable) return Status::Failed(ErrorId::kUnknownTarget);
  if (!r.coupling.periodic) r.coupling.periodic = c.machine.cams[r.table.index].cyclic();
  return Status::Ok();
}

Status MayCouple(const Context& c, const Request& r, const State& s) noexcept {
  if (!MastersStand(c, r.coupling)) return Status::Failed(ErrorId::kMasterOff);
  if (r.kind == RequestKind::kGearInPos && !c.params.rotary() &&
      !Inside(c.params.limits, r.coupling.slave_sync_position)) {
    return Status::Failed(ErrorId::kTargetBehindLimit);
  }
  const bool absolute = r.kind == RequestKind::kCamIn && r.coupling.slave_absolute;
  if (absolute && c.params.requires_reference && !s.homing.homed) return Status::Failed(ErrorId::kNoReference);
  return Status::Ok();
}

void Couple(const Context& c, const Request& r, State& s) noexcept {
  TakeCoupling(c, r, s);
  BeginCoupling(c, r, s);
}

void CoupleAgain(const Context& c, const Request& r, State& s) noexcept {
  const CouplingState was = s.coupling;
  TakeCoupling(c, r, s);
  CouplingState& k = s.coupling;
  k.added = was.added;
  k.phase = was.phase;
  k.phase_start = was.phase_start;
  k.phase_now = was.phase_now;
  k.phase_begin = was.phase_begin;
  k.phase_ticket = was.phase_ticket;
  k.phase_moves = was.phase_moves;
  for (std::size_t i = 0; i < k.law.terms.size(); ++i) {
    const CouplingTerm &now = k.law.terms[i], &before = was.law.terms[i];
    const bool same = now.master == before.master && now.source == before.source && now.filter_s == before.filter_s;
    if (same) k.filters[i] = was.filters[i];
  }
  BeginCoupling(c, r, s);
}

void UpdateCam(const Context& c, const Request& r, State& s) noexcept {
  CouplingState& k = s.coupling;
  if (k.joining == Joining::kWaiting) return CoupleAgain(c, r, s);  // it has not begun yet
  const CamLaw was = CamOf(c, s.active);
  const CamLaw law = CamOf(c, r);
  const bool absolute = k.law.master_absolute;
  const bool fixed = absolute || k.law.at_sync_position;  // x counts from a fixed position of the master
  const double offset = r.coupling.master_offset - k.law.master_offset;
  const double slave_offset = r.table.offset - s.active.table.offset;
  Grant(c, r, s);
  k.law = r.coupling;
  const KinematicState master = Seen(c, k, k.law.terms[0], PhaseAt(c, k));
  // On the curve: the position where both will be in step.
  const double place = k.joining == Joining::kOnCurve ? k.master_sync : master.position;
  const double cycle = WholeCycles(was, k.cam, place);
  const double begin = k.cam.master + cycle * was.way();  // of the present cycle
  if (fixed) {
    // Cycles of another length count from the master's zero, those of a relative cam from its sync position, as in
    // BeginCam; cycles of the same length from any beginning.
    const std::uint32_t its = k.law.terms[0].master;
    const bool other_length = law.periodic && law.ratio != was.ratio;
    const double zero = other_length && k.law.master_absolute
                            ? place - ReportedOf(c, its, place - OriginOf(c, its))
                            : begin - (was.table.begin() - (k.law.master_offset - offset)) / was.ratio;
    k.cam.master = zero + (law.table.begin() - k.law.master_offset) / law.ratio;
    if (other_length && !absolute && !k.law.master_absolute)
      k.cam.master = k.master_sync - k.law.master_offset / law.ratio;
    BeginCycles(law, place, k.cam);
    k.cam.master -= cycle * law.way();
  } else {
    const double x = was.ratio * (place - begin) + offset;  // from the beginning of the cam
    k.cam.master = place - x / law.ratio - cycle * law.way();
  }
  // In a later cycle the cam is offset by its strokes, which are not rescaled.
  k.cam.slave += slave_offset + (was.scale - law.scale) * cycle * law.table.stroke();
  k.cam.share = ShareOf(law, k.cam, place);
  k.cam.over = false;
  s.limited_by = LimitedBy::kNothing;
  if (k.joining == Joining::kOnCurve) BeginCurve(c, master, s);
}

bool LostMasters(const Context& c, const State& s) noexcept {
  return Couples(s.active.kind) && !MastersStand(c, s.coupling.law);
}

bool FollowMasters(const Context& c, State& s) noexcept {
  if (!Couples(s.active.kind)) return false;
  CouplingState& k = s.coupling;
  if (LostMasters(c, s)) {
    BreakOff(c, ErrorId::kAxisFault, s);
    return false;
  }
  if (k.filtered) FilterMasters(c, k);
  // Until the position is locked a phase shift would be lost in part: it pauses meanwhile.
  if (!k.locked && k.phase_moves) ++k.phase_start;
  KinematicState phase = PhaseAt(c, k);
  if (!k.locked) phase = {phase.position, 0, 0};
  if (LeavesSyncPosition(c, phase, s)) {
    BreakOff(c, ErrorId::kSyncPassed, s);
    return false;
  }
  NoteEnd(c, phase, s);
  if (s.end_of_profile && s.buffered > 0 && Couples(s.buffer[0].kind)) {  // takes over in this cycle
    Conclude(c, 0, s);
    if (!Couples(s.active.kind)) return false;
    phase = PhaseAt(c, k);
  }
  KinematicState demand;
  const bool begun = Joins(s.active.kind) ? JoinedDemand(c, phase, s, demand) : (demand = Sum(c, k, phase), true);
  if (!begun) {  // keeps its velocity until synchronisation starts
    demand = {s.setpoint.position + s.origin + s.setpoint.velocity * c.cycle.period_s, s.setpoint.velocity, 0};
  }
  demand.position -= s.origin;
  k.phase_now = phase.position;
  const trajectory::DemandFollower chaser = {c.params.planner_limits(), c.planner, s.active.limits(), c.cycle.period_s};
  if (k.locked) {
    if (begun) demand.position += k.chase.offset;
    s.setpoint = FollowDemand(chaser, trajectory::DemandMode::kPosition, s.setpoint, demand, k.chase);
  } else {
    s.setpoint = FollowDemand(chaser, trajectory::DemandMode::kVelocity, s.setpoint, demand, k.chase);
    k.locked = k.chase.in_step;
  }
  const auto near = [&] { return k.locked && std::abs(s.setpoint.position - demand.position) <= Blur(c, s); };
  k.in_step = begun && k.joining != Joining::kOnCurve && (k.chase.in_step || near());
  s.limited_by = Beyond(c.params.planner_limits(), demand, k.in_step);
  const bool phase_over = static_cast<double>(c.cycle.count - k.phase_start) * c.cycle.period_s >= k.phase.duration();
  if (k.phase_moves && phase_over && k.in_step) EndPhase(c, FeedbackState::kDone, s);
  if (!AtRest(s)) s.motion.arrived_cycle = c.cycle.count;
  return true;
}

Status CarryOut(const Context& c, Ticket ticket, const PhasingAbsolute& p, State& s) noexcept {
  return ShiftPhase(c, ticket, false, p.phase_shift, p.velocity, p.acceleration, p.deceleration, p.jerk, s);
}

Status CarryOut(const Context& c, Ticket ticket, const PhasingRelative& p, State& s) noexcept {
  return ShiftPhase(c, ticket, true, p.phase_shift, p.velocity, p.acceleration, p.deceleration, p.jerk, s);
}

namespace {

// The target of synchronisation has changed: begins the curve anew if the slave is on it.
void RestartCurve(const Context& c, State& s) {
  CouplingState& k = s.coupling;
  if (k.joining == Joining::kOnCurve) BeginCurve(c, Seen(c, k, k.law.terms[0], PhaseAt(c, k)), s);
}

}  // namespace

Status CarryOut(const Context& c, Ticket ticket, const CamAdd& command, State& s) noexcept {
  CouplingState& k = s.coupling;
  if (s.active.kind != RequestKind::kCamIn) return Status::Failed(ErrorId::kState);
  const std::optional<std::uint32_t> table = cam::Find(c.machine.cams, command.cam.view());
  if (!table) return Status::Failed(ErrorId::kUnknownTarget);
  const auto same = std::ranges::find_if(k.added, [&](const AddedCam& one) {
    return one.table != kNoTable && c.machine.cams[one.table].name() == command.cam.view();
  });
  const auto place = same != k.added.end() ? same : std::ranges::find(k.added, kNoTable, &AddedCam::table);
  if (place == k.added.end()) return Status::Failed(ErrorId::kBufferFull);
  const CouplingTerm& term = k.law.terms[0];
  const double master = Seen(c, k, term, PhaseAt(c, k)).position;
  const double origin = OriginOf(c, term.master);
  AddedCam added{*table,
                 command.master_scaling,
                 command.slave_scaling,
                 command.periodic.value_or(c.machine.cams[*table].cyclic()),
                 {}};
  const double zero = master - ReportedOf(c, term.master, master - origin);
  const double begin = (c.machine.cams[*table].begin() - command.master_offset) / added.ratio;
  added.cam.master = command.master_absolute ? zero + begin : master - command.master_offset / added.ratio;
  const CamLaw law = LawOf(c, added);
  BeginCycles(law, master, added.cam);
  added.cam.slave = command.slave_offset;
  if (!command.slave_absolute) added.cam.slave -= ValueAt(law, added.cam, master).y - command.slave_offset;
  *place = added;
  RestartCurve(c, s);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}

Status CarryOut(const Context& c, Ticket ticket, const CamRemove& command, State& s) noexcept {
  if (s.active.kind != RequestKind::kCamIn) return Status::Failed(ErrorId::kState);
  for (AddedCam& added : s.coupling.added) {
    if (added.table == kNoTable || c.machine.cams[added.table].name() != command.cam.view()) continue;
    added = {};
    RestartCurve(c, s);
    Report(c, ticket, FeedbackState::kActive);
    Report(c, ticket, FeedbackState::kDone);
    return Status::Ok();
  }
  return Status::Failed(ErrorId::kState);
}

Status LetGo(const Context& c, const Request& r, State& s) noexcept {
  if (s.plc != PlcState::kSynchronizedMotion || !Couples(s.active.kind)) return Status::Failed(ErrorId::kState);
  trajectory::Profile profile{s.setpoint};
  const Limits own = c.params.planner_limits();
  const double velocity = std::clamp(s.setpoint.velocity, -own.velocity, own.velocity);
  if (const Status status = c.planner.ToVelocity(s.setpoint, velocity, own, profile); status.failed()) return status;
  AbortAll(c, s);
  Grant(c, r, s);
  StartMotion(profile, 0, FromCycleBefore(c), s);
  Enter(s, PlcState::kContinuousMotion);
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
  return Status::Ok();
}

void Uncouple(const Context& c, bool after_fault, State& s) noexcept {
  EndPhase(c, FeedbackState::kAborted, s);
  s.coupling.in_step = false;
  s.coupling.added = {};
  if (!after_fault) s.coupling.law = CouplingRequest{};
}

bool CouplingOf(const Context& c, const Command& command, CouplingRequest& out) noexcept {
  Request request;
  if (MakeRequest(command, c.params, request).failed() || !Couples(request.kind)) return false;
  if (FindNamed(c, request).failed()) return false;
  out = request.coupling;
  return true;
}

void describe(Enumeration<Joining>& e) {
  e.about("Progress of synchronisation.");
  e.value(Joining::kWaiting, "waiting", "The master has not yet reached the start of synchronisation.");
  e.value(Joining::kOnCurve, "on_curve", "On a curve over the master's position that ends in step.");
  e.value(Joining::kJoined, "joined", "In step, as far as the limits allow.");
}

void describe(Description<AddedCam>& d) {
  using S = AddedCam;
  d.about("A cam added to that of a coupling.");
  d.internal<&S::table>("Its index among the machine's cams.");
  d.internal<&S::ratio>("Its x per master's unit.");
  d.internal<&S::scale>("Factor of its y.");
  d.internal<&S::periodic>("The cam repeats.");
  d.internal<&S::cam>("Position of the cam over the master.");
}

void describe(Description<CouplingState>& d) {
  using S = CouplingState;
  d.about("An axis that follows masters.");
  d.internal<&S::law>("Parameters of the coupling.");
  d.internal<&S::filtered>("A master is measured and has a filter.");
  d.internal<&S::filters>("Filters of the measured masters.");
  d.internal<&S::chase>("State of the follower that keeps the limits.");
  d.internal<&S::in_step>("In step with the masters, as far as their positions are known.");
  d.internal<&S::locked>("Locked to the position.");
  d.internal<&S::joining>("Progress of synchronisation.");
  d.internal<&S::master_sync>("Position of the master at which both are in step, over all turns.");
  d.internal<&S::slave_sync>(unit::u, "Position of this axis at which both are in step.");
  d.internal<&S::curve_begin>("Position of the master at which the curve begins.");
  d.internal<&S::begin_side>("Distance of the master from there when the wait began.");
  d.internal<&S::curve>("Synchronisation curve over the master's displacement from there.");
  d.internal<&S::cam>("Position of the cam that is followed.");
  d.internal<&S::added>("Cams added to it.");
  d.internal<&S::turn>("Distance to the next such position of the master; 0: there is only one.");
  d.internal<&S::phase>("Motion that is added to the master's position.");
  d.internal<&S::phase_start>("Cycle its time counts from.");
  d.internal<&S::phase_now>("Shift added by now.");
  d.internal<&S::phase_begin>("Shift before the last relative shift; absolute shift: 0.");
  d.internal<&S::phase_ticket>("Ticket of the command that shifts.");
  d.internal<&S::phase_moves>("A shift is in progress.");
}

}  // namespace takt::axis
