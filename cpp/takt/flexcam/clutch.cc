#include "takt/flexcam/clutch.h"

#include <algorithm>
#include <cmath>

namespace takt::flexcam {

namespace {

using trajectory::Quintic;

constexpr int kBisections = 40;
constexpr int kTurnsAhead = 3;
constexpr double kTiny = 1e-9;
// A measured master has reversed once it is back by more than this share of the distance; noise is less.
constexpr double kPlay = 1e-3;

double SlaveTurn(const ClutchContext& c) {
  return c.slave.rotary() ? c.slave.modulus : 0;
}

bool KeepsSense(const ClutchContext& c) {
  return c.settings.position_control == PositionControl::kMasterDirection;
}

const ClutchCurve& Top(const ClutchState& s) {
  return s.curves[s.curve_count - 1];
}

bool OnCam(const ClutchState& s) {
  return s.phase == ClutchPhase::kWaitingOut || s.phase == ClutchPhase::kClosed;
}

// Returns true if the slave follows the last curve.
bool OnCurves(const ClutchState& s) {
  const bool opens = s.phase == ClutchPhase::kOpening || (s.phase == ClutchPhase::kWaitingIn && s.opens_still);
  return s.curve_count > 0 && s.mode == ClutchMode::kRampPos && (opens || s.phase == ClutchPhase::kClosing);
}

// Requires: OnCurves(s). Returns true if a master at `master` has passed the end of the curve.
bool EndsBefore(const ClutchState& s, double master) {
  return On(Top(s), master) >= Top(s).over.length;
}

bool BeyondEnd(const ClutchContext& c, const ClutchState& s) {
  return EndsBefore(s, c.master.position);
}

// --- The sense of the master ---

void ForgetSense(const ClutchContext& c, ClutchState& s) {
  s.sense = 0;
  s.furthest = c.master_before.position;
}

void UpdateSense(const ClutchContext& c, double distance, ClutchState& s) {
  const double play = c.measured ? kPlay * distance : 0;
  const double moved = c.master.position - s.furthest;
  if (s.sense * moved > 0) s.furthest = c.master.position;
  if (s.sense * moved >= 0 && s.sense != 0) return;
  if (std::abs(moved) <= play) return;
  s.sense = moved > 0 ? 1 : -1;
  s.furthest = c.master.position;
}

bool RightDirection(const ClutchContext& c, double sense) {
  switch (c.settings.sync_direction) {
    case ClutchDirection::kPositive:
      return sense > 0;
    case ClutchDirection::kNegative:
      return sense < 0;
    default:
      return true;
  }
}

// Returns the sense to plan for: that of the master or, while it is at rest, the only one allowed; 0: not known yet.
double SenseToPlan(const ClutchContext& c, const ClutchState& s) {
  if (s.sense != 0) return s.sense;
  if (c.settings.sync_direction == ClutchDirection::kCurrent) return 0;
  return c.settings.sync_direction == ClutchDirection::kPositive ? 1 : -1;
}

// --- Motion of the slave over the master's position ---

// Returns true if that motion is defined: at rest, on a curve, or on the cam with the master moving.
bool IsTied(const ClutchContext& c, const ClutchState& s) {
  if (OnCurves(s)) return c.in_step;
  if (OnCam(s)) return c.in_step && c.master_before.velocity != 0;
  return c.at_rest;
}

// Requires: IsTied, and `master` is a position from the previous cycle to this one.
KinematicState OwnOver(const ClutchContext& c, const ClutchState& s, double master) {
  if (OnCurves(s) && !EndsBefore(s, master)) return OverMaster(Top(s), master);
  const KinematicState& m = c.master_before;
  const KinematicState& own = c.own_before;
  if (!OnCam(s) || m.velocity == 0) return {own.position, 0, 0};
  const double slope = own.velocity / m.velocity;
  return {own.position, slope, (own.acceleration - slope * m.acceleration) / (m.velocity * m.velocity)};
}

// Begins a curve on the present motion of the slave. Returns false if there are too many curves.
bool Push(const ClutchCurve& curve, const Way& way, ClutchState& s) {
  if (!OnCurves(s) || EndsBefore(s, curve.begin)) {
    s.curve_count = 0;
    s.from_cam = OnCam(s);
  }
  if (s.curve_count == kClutchCurves) return false;
  s.curves[s.curve_count] = curve;
  s.curves[s.curve_count++].slave_zero = way.to_slave.out_zero;
  return true;
}

// Discards the curves whose begin the master has passed backwards. With an opening, the turn of a rotary slave is
// restored in which it began: a closing that was planned meanwhile may have chosen another one.
void TakeBack(const ClutchContext& c, Way& way, ClutchState& s) {
  const bool closes = s.phase == ClutchPhase::kWaitingIn || (s.phase == ClutchPhase::kClosing && !s.leaves);
  bool taken = false;
  double rest = s.out;
  while (s.curve_count > 0 && On(Top(s), c.master.position) < 0) {
    rest = Top(s).over.At(0).position;
    if (!Top(s).closes) way.to_slave.out_zero = Top(s).slave_zero;
    --s.curve_count;
    taken = true;
  }
  if (!taken) return;
  s.leaves = s.opens_still = false;
  s.waits_since = s.looked_from = c.master.position;
  s.planned_sense = 0;
  if (s.curve_count > 0) {
    s.mode = ClutchMode::kRampPos;
    if (Top(s).closes) {
      s.phase = ClutchPhase::kClosing;
      s.leaves = !closes;
    } else {
      s.phase = closes ? ClutchPhase::kWaitingIn : ClutchPhase::kOpening;
      s.opens_still = closes;
      s.out = Top(s).over.At(Top(s).over.length).position;
    }
  } else if (s.from_cam) {
    s.phase = closes ? ClutchPhase::kClosed : ClutchPhase::kWaitingOut;
  } else {
    s.phase = closes ? ClutchPhase::kWaitingIn : ClutchPhase::kOpening;
    s.mode = closes ? s.mode : ClutchMode::kAbsolute;
    s.out = rest;
  }
}

// --- Closing over the master's displacement ---

// While a ramp is in progress, the cam is no function of the master's position.
bool IsRamped(const Way& way) {
  return way.to_x.ramp.kind != RampKind::kNone || way.to_slave.ramp.kind != RampKind::kNone;
}

// [master's u] Returns the distance between sync positions; 0: there is only one.
double TurnOfPlace(const ClutchContext& c, const Way& way) {
  if (c.master_turn != 0) return c.master_turn;
  const bool repeats = c.settings.sync_in_passed == PassedSync::kNextCycle && !way.profiler.once;
  return repeats ? c.table.length() / way.to_x.factor : 0;
}

// Finds the next sync position that leaves room for the whole distance. Returns false if there is none ahead.
bool FindPlace(const ClutchContext& c, double sense, const Way& way, ClutchState& s) {
  const double full = c.settings.master_sync_in_distance;
  const double least = s.looked_from + sense * full * (1 - kTiny);
  s.place = c.settings.master_sync_in_position + c.master_zero;
  if (const double turn = TurnOfPlace(c, way); turn != 0) {
    const double turns = (least - s.place) / turn;
    s.place += turn * (sense < 0 ? std::floor(turns) : std::ceil(turns));
  } else if (sense * (s.place - least) < 0) {
    if (c.settings.sync_in_passed != PassedSync::kHere) return false;
    s.place = s.looked_from + sense * full;
  }
  return true;
}

// Moves the cam's position to the turn of a rotary slave that is nearest to `position`.
void NearestTurn(const ClutchContext& c, double wanted, double position, Way& way) {
  const double turn = SlaveTurn(c);
  if (turn != 0) way.to_slave.out_zero += turn * std::round((position - wanted) / turn);
}

ClutchCurve ClosingCurve(const ClutchContext& c, const KinematicState& own, double sense, double shift, const Way& way,
                         const ClutchState& s, double distance) {
  KinematicState end = PlaceAt(way, c.table, s.place);
  end.position += shift;
  return MakeCurve(s.place - sense * distance, distance, sense, true, own, end, c.slave.planner_limits());
}

// Finds the turn of the slave and the distance for which the curve does not reverse.
Status KeepSense(const ClutchContext& c, const KinematicState& own, double sense, Way& way, ClutchState& s) {
  const double full = c.settings.master_sync_in_distance;
  const double turn = SlaveTurn(c);
  const double speed = std::abs(c.master.velocity);
  const double ahead = sense * (own.position - PlaceAt(way, c.table, s.place).position);
  const double first = turn == 0 ? 0 : sense * turn * std::ceil(ahead / turn - kTiny);
  bool too_fast = false;
  for (int k = 0; k < (turn == 0 ? 1 : kTurnsAhead); ++k) {
    const double shift = first + k * sense * turn;
    const auto curve = [&](double distance) { return ClosingCurve(c, own, sense, shift, way, s, distance); };
    double low = 0, high = full;
    if (Monotone(curve(full))) low = full;
    for (int i = 0; i < kBisections && low < full; ++i) {
      const double middle = 0.5 * (low + high);
      (Monotone(curve(middle)) ? low : high) = middle;
    }
    if (low <= kTiny * full) continue;
    if (!Follows(curve(low), speed)) {
      too_fast = true;
      continue;
    }
    way.to_slave.out_zero += shift;
    s.distance = low;
    return Status::Ok();
  }
  return Status::Failed(too_fast ? ErrorId::kSlaveLimits : ErrorId::kWouldReverse);
}

// Plans begin and end of the curve for a master in this sense, and the turn of the slave.
Status PlanClosing(const ClutchContext& c, double sense, Way& way, ClutchState& s) {
  if (!FindPlace(c, sense, way, s)) return Status::Failed(ErrorId::kSyncPassed);
  const KinematicState own = IsTied(c, s) ? OwnOver(c, s, c.master_before.position) : KinematicState{s.out, 0, 0};
  s.distance = c.settings.master_sync_in_distance;
  if (KeepsSense(c)) {
    if (const Status status = KeepSense(c, own, sense, way, s); status.failed()) return status;
  } else {
    const KinematicState end = PlaceAt(way, c.table, s.place);
    const double expected = own.position + 0.5 * sense * (own.velocity + end.velocity) * s.distance;
    if (c.settings.slave_absolute) NearestTurn(c, end.position, expected, way);
    const ClutchCurve curve = ClosingCurve(c, own, sense, 0, way, s, s.distance);
    if (!Follows(curve, std::abs(c.master.velocity))) return Status::Failed(ErrorId::kSlaveLimits);
  }
  s.planned_sense = sense;
  if (s.accepted_sense == 0) s.accepted_sense = sense;
  return Status::Ok();
}

// Waits for the master to reach the begin of the curve.
Status WaitForBegin(const ClutchContext& c, Way& way, ClutchState& s) {
  UpdateSense(c, c.settings.master_sync_in_distance, s);
  const double sense = SenseToPlan(c, s);
  const auto wait = [&](ClutchWait why) {
    s.waits = why;
    return Status::Ok();
  };
  if (sense == 0) return wait(ClutchWait::kMasterStands);
  if (!RightDirection(c, sense)) {
    s.planned_sense = 0;
    s.looked_from = c.master.position;
    return wait(ClutchWait::kDirection);
  }
  const auto plan = [&] { return PlanClosing(c, sense, way, s); };
  if (s.planned_sense != sense) {
    s.planned_sense = 0;
    if (const Status status = plan(); status.failed()) {
      // A master that has turned away may return; a closing behind the master at the time of the request is refused.
      const bool away = status.error == ErrorId::kSyncPassed && s.accepted_sense != 0 && s.accepted_sense != sense;
      if (!away) return status;
      s.looked_from = c.master.position;
      return wait(ClutchWait::kAway);
    }
  }
  const bool there = sense * (c.master.position - (s.place - sense * s.distance)) > 0;
  const bool ramps = IsRamped(way);
  if (!there) {
    s.looked_from = c.master.position;
    return wait(ramps ? ClutchWait::kRamps : s.sense == 0 ? ClutchWait::kMasterStands : ClutchWait::kPosition);
  }
  if (ramps || !IsTied(c, s)) {  // the begin was passed meanwhile
    s.looked_from = c.master.position;
    s.planned_sense = 0;
    wait(ramps ? ClutchWait::kRamps : ClutchWait::kSlave);
    return plan();
  }
  const double begin = s.place - sense * s.distance;
  const ClutchCurve curve = ClosingCurve(c, OwnOver(c, s, begin), sense, 0, way, s, s.distance);
  if (!Follows(curve, std::abs(c.master.velocity))) return Status::Failed(ErrorId::kSlaveLimits);
  if (KeepsSense(c) && !Monotone(curve)) {  // something has changed since the planning
    s.looked_from = c.master.position;
    s.planned_sense = 0;
    wait(ClutchWait::kReverse);
    return plan();
  }
  if (!Push(curve, way, s)) {  // there is room once the opening is complete
    s.looked_from = c.master.position;
    s.planned_sense = 0;
    wait(ClutchWait::kSlave);
    return plan();
  }
  s.phase = ClutchPhase::kClosing;
  s.mode = ClutchMode::kRampPos;
  return Status::Ok();
}

// --- Closing over time ---

KinematicState Sum(const KinematicState& a, const KinematicState& b) {
  return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
}

KinematicState Shift(const KinematicState& own, const KinematicState& wanted) {
  return {own.position - wanted.position, own.velocity - wanted.velocity, own.acceleration - wanted.acceleration};
}

// Returns the limits of a ramp from a shift to zero. A shift that accelerates more than ramps may is decelerated as
// fast as the slave can: during the time that a low jerk takes for it, it would drift far away.
trajectory::Limits ClutchLimits(const ClutchContext& c, const KinematicState& shift) {
  const trajectory::Limits own = c.slave.planner_limits();
  const Settings& s = c.settings;
  const trajectory::Limits limits = {
      std::min(s.sync_velocity, own.velocity), std::min(s.sync_acceleration, own.acceleration),
      std::min(s.sync_deceleration, own.deceleration), own.jerk > 0 ? std::min(s.sync_jerk, own.jerk) : s.sync_jerk};
  if (std::abs(shift.acceleration) <= std::max(limits.acceleration, limits.deceleration)) return limits;
  return {limits.velocity, limits.acceleration, limits.deceleration, own.jerk > 0 ? own.jerk : limits.jerk};
}

constexpr double kStretch = 1.05;
constexpr int kStretches = 200;

// Begins to ramp the shift between the slave and Y to zero.
void BeginShift(const ClutchContext& c, const KinematicState& shift, double time_s, ClutchState& s) {
  if (s.mode == ClutchMode::kRampVelAcc) {
    if (!BeginProfile(shift, ClutchLimits(c, shift), c.cycle, c.planner, s.ramp)) s.mode = ClutchMode::kAbsolute;
    return;
  }
  const trajectory::Limits own = c.slave.planner_limits();
  const auto fits = [&](double time) { return Within(trajectory::Connect(time, shift, {}), own); };
  double stretched = time_s;
  for (int i = 0; i < kStretches && !fits(stretched); ++i) stretched *= kStretch;
  s.stretched = stretched > time_s;
  BeginTime(shift, fits(stretched) ? stretched : time_s, c.cycle, s.ramp);
}

bool OverTime(ClutchMode mode) {
  return mode == ClutchMode::kRampTime || mode == ClutchMode::kRampVelAcc;
}

void StartClosing(const ClutchContext& c, Way& way, ClutchState& s) {
  s.phase = ClutchPhase::kClosing;
  s.mode = s.next;
  s.curve_count = 0;
  KinematicState wanted = c.wanted_before;
  if (s.mode == ClutchMode::kRelative) {
    way.to_slave.out_zero += c.own_before.position - wanted.position;
  } else if (c.settings.slave_absolute) {
    const double zero = way.to_slave.out_zero;
    NearestTurn(c, wanted.position, c.own_before.position, way);
    wanted.position += way.to_slave.out_zero - zero;
  }
  if (OverTime(s.mode)) BeginShift(c, Shift(c.own_before, wanted), c.settings.sync_in_time_s, s);
}

// --- Following ---

// At the end of the closing curve: the cam's value there may now differ from the planned one.
void EndCurve(const ClutchContext& c, const Way& way, ClutchState& s) {
  const double place = EndOf(Top(s));
  const KinematicState now = PlaceAt(way, c.table, place);
  const KinematicState left = Shift(OverMaster(Top(s), place), now);
  const double size = 1 + std::abs(now.position);
  s.curve_count = 0;
  s.phase = ClutchPhase::kClosed;
  if (std::abs(left.position) < kTiny * size && std::abs(left.velocity) < kTiny * (1 + std::abs(now.velocity))) return;
  s.phase = ClutchPhase::kClosing;
  s.mode = ClutchMode::kRampVelAcc;
  BeginShift(c, trajectory::ComposeWithMaster(left, c.master), 0, s);
}

KinematicState OnCurve(const ClutchContext& c, const ClutchState& s) {
  return trajectory::ComposeWithMaster(OverMaster(Top(s), c.master.position), c.master);
}

KinematicState Closing(const ClutchContext& c, const KinematicState& wanted, const Way& way, ClutchState& s) {
  if (s.mode == ClutchMode::kRampPos) {
    if (!BeyondEnd(c, s)) return OnCurve(c, s);
    EndCurve(c, way, s);
    if (s.phase == ClutchPhase::kClosed) return wanted;
  }
  if (OverTime(s.mode)) {
    if (IsOver(s.ramp, c.cycle)) s.phase = ClutchPhase::kClosed;
    return Sum(wanted, At(s.ramp, c.cycle));
  }
  if (c.in_step) s.phase = ClutchPhase::kClosed;
  return wanted;
}

// Returns the turn of the sync-out position that is nearest to the expected position of the slave.
double OutPlace(const ClutchContext& c, double expected) {
  const double place = c.settings.slave_sync_out_position + c.slave_zero;
  const double turn = SlaveTurn(c);
  return turn == 0 ? place : place + turn * std::round((expected - place) / turn);
}

// Begins the opening over the master's displacement, if a curve serves.
void BeginOut(const ClutchContext& c, const Way& way, ClutchState& s) {
  const double length = c.settings.master_sync_out_distance;
  UpdateSense(c, length, s);
  s.waits = ClutchWait::kMasterStands;
  if (s.sense == 0 || c.master.velocity == 0) return;
  s.waits = ClutchWait::kRamps;
  // while the end of a cam is held, ramps of the slave do not proceed
  if (OnCam(s) && IsRamped(way) && !way.profiler.held) return;
  s.waits = ClutchWait::kSlave;
  if (!IsTied(c, s)) return;
  const double sense = s.sense;
  const double begin = c.master_before.position;
  const KinematicState own = OwnOver(c, s, begin);
  const double turn = SlaveTurn(c);
  double out = OutPlace(c, own.position + 0.5 * sense * own.velocity * length);
  s.waits = ClutchWait::kReverse;
  for (int k = 0; k < kTurnsAhead; ++k, out += sense * turn) {
    const ClutchCurve curve = MakeCurve(begin, length, sense, false, own, {out, 0, 0}, c.slave.planner_limits());
    const bool turns_round = KeepsSense(c) && !Monotone(curve);
    if (!turns_round && !Follows(curve, std::abs(c.master.velocity))) {
      s.waits = ClutchWait::kLimits;
    } else if (!turns_round) {
      s.waits = ClutchWait::kSlave;
      if (!Push(curve, way, s)) return;
      s.out = out;
      s.mode = ClutchMode::kRampPos;
      s.phase = ClutchPhase::kOpening;
      s.leaves = false;
      return;
    }
    if (turn == 0) break;
  }
}

// `there` returns true if the slave only has to come to rest.
KinematicState Opening(const ClutchContext& c, const ClutchState& s, bool& there) {
  const KinematicState rest = {s.out, 0, 0};
  there = true;
  if (OnCurves(s)) {
    there = BeyondEnd(c, s);
    return there ? rest : OnCurve(c, s);
  }
  if (!OverTime(s.mode)) return rest;
  there = IsOver(s.ramp, c.cycle);
  return Sum(rest, At(s.ramp, c.cycle));
}

// The clutch was never on the cam, or the closing is refused: the opening continues, or the slave stays at rest.
void GiveUpClosing(ClutchState& s) {
  s.phase = ClutchPhase::kOpening;
  if (!s.opens_still) s.mode = ClutchMode::kAbsolute;
  s.opens_still = false;
}

Status WaitToClose(const ClutchContext& c, Way& way, ClutchState& s) {
  Status status = Status::Ok();
  if (s.next == ClutchMode::kRampPos) {
    status = WaitForBegin(c, way, s);
  } else if (RightDirection(c, c.master.velocity)) {
    StartClosing(c, way, s);
  } else {
    s.waits = ClutchWait::kDirection;
  }
  if (status.failed()) GiveUpClosing(s);
  return status;
}

Status WaitToOpen(const ClutchContext& c, const Way& way, ClutchState& s) {
  if (OnCurves(s) && BeyondEnd(c, s)) {  // it closes in this cycle, and opens from the cam
    s.waits = ClutchWait::kSlave;
    return Status::Ok();
  }
  BeginOut(c, way, s);
  if (s.waits == ClutchWait::kRamps) s.waits_since = c.master.position;
  const double longest = c.table.length() / way.to_x.factor;
  if (s.phase != ClutchPhase::kWaitingOut || std::abs(c.master.position - s.waits_since) <= longest) {
    return Status::Ok();
  }
  s.phase = ClutchPhase::kClosed;
  return Status::Failed(s.waits == ClutchWait::kReverse ? ErrorId::kWouldReverse : ErrorId::kSlaveLimits);
}

}  // namespace

bool IsCoupled(const ClutchState& s) noexcept {
  return s.phase != ClutchPhase::kOpen && s.phase != ClutchPhase::kReleased;
}

bool IsOnCurve(const ClutchState& s) noexcept {
  return OnCurves(s);
}

bool IsOnRamp(const ClutchState& s) noexcept {
  const bool moves = s.phase == ClutchPhase::kClosing || s.phase == ClutchPhase::kOpening;
  return moves && s.mode != ClutchMode::kAbsolute && s.mode != ClutchMode::kRelative;
}

bool IsFrozen(const ClutchState& s) noexcept {
  return s.phase == ClutchPhase::kWaitingIn || s.phase == ClutchPhase::kClosing || IsOnCurve(s);
}

const ClutchCurve* FollowedCurve(const ClutchState& s) noexcept {
  return OnCurves(s) ? &Top(s) : nullptr;
}

void BeginClosing(const ClutchContext& c, ClutchState& s) noexcept {
  s.stretched = false;
  if (s.phase == ClutchPhase::kClosing || OnCam(s)) {  // still on the cam, or approaching it
    if (s.phase == ClutchPhase::kWaitingOut) s.phase = ClutchPhase::kClosed;
    s.leaves = false;
    return;
  }
  s.opens_still = s.phase == ClutchPhase::kOpening || (s.phase == ClutchPhase::kWaitingIn && s.opens_still);
  s.phase = ClutchPhase::kWaitingIn;
  s.next = c.settings.sync_mode;
  if (s.next == ClutchMode::kRampPos && c.settings.master_sync_in_distance == 0) s.next = ClutchMode::kAbsolute;
  s.planned_sense = s.accepted_sense = 0;
  s.looked_from = c.master_before.position;
  s.distance = c.settings.master_sync_in_distance;
  if (!s.opens_still) s.out = c.own_before.position;
  ForgetSense(c, s);
}

void BeginOpening(const ClutchContext& c, ClutchState& s) noexcept {
  const KinematicState& own = c.own_before;
  s.stretched = false;
  if (s.phase == ClutchPhase::kWaitingIn) return GiveUpClosing(s);
  if (c.settings.sync_mode == ClutchMode::kRampPos && c.settings.master_sync_out_distance > 0) {
    if (s.phase == ClutchPhase::kClosed) s.phase = ClutchPhase::kWaitingOut;
    s.leaves = s.phase == ClutchPhase::kClosing;
    s.waits_since = c.master.position;
    return ForgetSense(c, s);
  }
  s.mode = c.settings.sync_mode;
  s.phase = ClutchPhase::kOpening;
  s.curve_count = 0;
  const bool frozen = s.mode == ClutchMode::kAbsolute || s.mode == ClutchMode::kRelative;
  s.out = frozen ? own.position : OutPlace(c, own.position);
  if (OverTime(s.mode)) BeginShift(c, Shift(own, {s.out, 0, 0}), c.settings.sync_out_time_s, s);
}

Status StepClutch(const ClutchContext& c, const KinematicState& wanted, Way& way, ClutchState& s,
                  KinematicState& demand) noexcept {
  const double zero = way.to_slave.out_zero;
  const auto on_cam = [&] {  // in the present turn of the slave
    return KinematicState{wanted.position + way.to_slave.out_zero - zero, wanted.velocity, wanted.acceleration};
  };
  bool there = false;
  Status status = Status::Ok();
  s.waits = ClutchWait::kNothing;
  if (OnCurves(s)) TakeBack(c, way, s);
  if (s.phase == ClutchPhase::kWaitingIn) status = WaitToClose(c, way, s);
  if (s.phase == ClutchPhase::kWaitingOut || s.leaves) status = WaitToOpen(c, way, s);
  switch (s.phase) {
    case ClutchPhase::kWaitingIn:
      demand = s.opens_still ? Opening(c, s, there) : KinematicState{s.out, 0, 0};
      break;
    case ClutchPhase::kClosing:
      demand = Closing(c, on_cam(), way, s);
      if (s.phase == ClutchPhase::kClosed && s.leaves) {
        s.phase = ClutchPhase::kWaitingOut;
        s.waits_since = c.master.position;
        s.leaves = false;
      }
      break;
    case ClutchPhase::kClosed:
    case ClutchPhase::kWaitingOut:
      demand = on_cam();
      break;
    case ClutchPhase::kOpening:
      demand = Opening(c, s, there);
      if (there && c.at_rest && c.in_step) s.phase = ClutchPhase::kOpen;
      break;
    default:
      break;
  }
  if (s.phase != ClutchPhase::kWaitingIn && s.phase != ClutchPhase::kWaitingOut) s.waits = ClutchWait::kNothing;
  return status;
}

}  // namespace takt::flexcam
