#include "takt/flexcam/clutch.h"

#include <algorithm>
#include <cmath>

#include "takt/cam/roots.h"
#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

using trajectory::Quintic;

constexpr int kBisections = 40;
constexpr int kTurnsAhead = 3;
constexpr double kTiny = 1e-9;

double SlaveTurn(const ClutchContext& c) {
  return c.slave.rotary() ? c.slave.modulus : 0;
}

bool KeepsSense(const ClutchContext& c) {
  return c.settings.position_control == PositionControl::kMasterDirection;
}

// The curve over its length, as one of a cam's.
cam::Curve CurveOf(const Quintic& q) {
  cam::Curve curve;
  double power = 1;
  for (std::size_t i = 0; i < q.c.size(); ++i, power *= q.length) curve.c[i] = q.c[i] / power;
  return curve;
}

double LeastSlope(const Quintic& q) {
  const cam::Curve slope = cam::Derivative(CurveOf(q));
  double least = HUGE_VAL;
  for (const double x : cam::ExtremePlaces(slope, q.length)) least = std::min(least, slope.At(x));
  return least;
}

// Whether it never turns round. What rounding makes of a slope of zero is none.
bool Monotone(const Quintic& q) {
  return LeastSlope(q) >= -kTiny * (std::abs(q.c[1]) + std::abs(q.At(q.length).position - q.c[0])) / q.length;
}

// Whether the slave can do it while the master keeps its speed.
bool WithinLimits(const ClutchContext& c, const Quintic& q) {
  const cam::Curve slope = cam::Derivative(CurveOf(q));
  const double v = std::abs(c.master.velocity);
  const trajectory::Limits own = c.slave.planner_limits();
  return cam::LargestMagnitude(slope, q.length) * v <= own.velocity &&
         cam::LargestMagnitude(cam::Derivative(slope), q.length) * v * v <=
             std::min(own.acceleration, own.deceleration);
}

// Place and slope over the master's way -> over the way in its sense.
KinematicState InSense(const KinematicState& over, double sense) {
  return {over.position, sense * over.velocity, over.acceleration};
}

// Whether the slave moves as the master lets it, or not at all: only then its motion has a slope over the master's way.
bool IsTied(const ClutchContext& c, const ClutchState& s) {
  if (c.at_rest) return true;
  const bool on_cam = s.phase == ClutchPhase::kWaitingOut || s.phase == ClutchPhase::kClosed;
  const bool opens = s.phase == ClutchPhase::kOpening || (s.phase == ClutchPhase::kWaitingIn && s.opens_still);
  const bool on_curve = s.mode == ClutchMode::kRampPos && (opens || s.phase == ClutchPhase::kClosing);
  return c.in_step && (on_cam || on_curve) && c.master_before.velocity != 0;
}

// How the slave moves over the master's way; it is tied to that.
KinematicState OwnOver(const ClutchContext& c) {
  const KinematicState& m = c.master_before;
  const KinematicState& own = c.own_before;
  if (c.at_rest || m.velocity == 0) return {own.position, 0, 0};
  const double slope = own.velocity / m.velocity;
  return {own.position, slope, (own.acceleration - slope * m.acceleration) / (m.velocity * m.velocity)};
}

// Of the places every `turn` from `position` on the next one ahead of `from` in this sense; no turn: as it is.
double NextAhead(double turn, double position, double from, double sense) {
  if (turn == 0) return position;
  const double turns = (from - position) / turn;
  return position + turn * (sense < 0 ? std::floor(turns) : std::ceil(turns));
}

// The next sync position ahead of a master at `from` that leaves room for this way.
double SyncPlace(const ClutchContext& c, double from, double distance, double sense) {
  const double place = c.settings.master_sync_in_position + c.master_zero;
  return NextAhead(c.master_turn, place, from + sense * distance * (1 - kTiny), sense);
}

// In which the master goes, or will have to go; 0: nobody knows yet.
double SenseOf(const ClutchContext& c, const ClutchState& s) {
  if (c.master.velocity != 0) return c.master.velocity > 0 ? 1 : -1;
  if (s.planned_sense != 0) return s.planned_sense;
  if (c.settings.sync_direction == ClutchDirection::kCurrent) return 0;
  return c.settings.sync_direction == ClutchDirection::kPositive ? 1 : -1;
}

bool RightDirection(const ClutchContext& c, double velocity) {
  switch (c.settings.sync_direction) {
    case ClutchDirection::kPositive:
      return velocity > 0;
    case ClutchDirection::kNegative:
      return velocity < 0;
    default:
      return true;
  }
}

// Brings the place that the cam means to the turn of a rotary slave that is nearest to `position`.
void NearestTurn(const ClutchContext& c, double wanted, double position, Way& way) {
  const double turn = SlaveTurn(c);
  if (turn != 0) way.to_slave.out_zero += turn * std::round((position - wanted) / turn);
}

// Finds turn and way such that the curve keeps its sense. False: there is none.
bool KeepSense(const ClutchContext& c, const KinematicState& own, double place, double sense, Way& way,
               ClutchState& s) {
  const double full = c.settings.master_sync_in_distance;
  const double turn = SlaveTurn(c);
  const auto curve = [&](double distance, double shift) {
    KinematicState end = PlaceAt(way, c.table, place);
    end.position += shift;
    return trajectory::Connect(distance, InSense(own, sense), InSense(end, sense));
  };
  const double ahead = sense * (own.position - PlaceAt(way, c.table, place).position);
  const double first = turn == 0 ? 0 : sense * turn * std::ceil(ahead / turn - kTiny);
  for (int k = 0; k < (turn == 0 ? 1 : kTurnsAhead); ++k) {
    const double shift = first + k * sense * turn;
    if (const Quintic whole = curve(full, shift); Monotone(whole)) {
      way.to_slave.out_zero += shift;
      s.distance = full;
      return true;
    }
    double low = 0, high = full;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (Monotone(curve(middle, shift)) ? low : high) = middle;
    }
    if (low <= kTiny * full || !WithinLimits(c, curve(low, shift))) continue;
    way.to_slave.out_zero += shift;
    s.distance = low;
    return true;
  }
  return false;
}

// Where a curve over the master's way begins, and in which turn of the slave it ends.
bool PlanWay(const ClutchContext& c, double sense, Way& way, ClutchState& s) {
  const double full = c.settings.master_sync_in_distance;
  const KinematicState own = OwnOver(c);
  const double place = SyncPlace(c, c.master_before.position, full, sense);
  s.planned_sense = sense;
  if (KeepsSense(c)) return KeepSense(c, own, place, sense, way, s);
  s.distance = full;
  if (!c.settings.slave_absolute) return true;
  const KinematicState end = PlaceAt(way, c.table, place);
  NearestTurn(c, end.position, own.position + 0.5 * sense * (own.velocity + end.velocity) * full, way);
  return true;
}

void BeginCurve(const ClutchContext& c, double length, double sense, const KinematicState& end, ClutchState& s) {
  const bool on_cam = s.phase == ClutchPhase::kWaitingOut || s.phase == ClutchPhase::kClosed;
  const bool on_curve = !on_cam && !c.at_rest;
  const CurveOrigin origin = s.origin;
  s.origin = on_cam ? CurveOrigin::kCam : on_curve ? CurveOrigin::kCurve : CurveOrigin::kRest;
  if (on_curve) {
    s.before_origin = origin;
    s.before = s.curve;
    s.before_begin = s.curve_begin;
    s.before_sense = s.sense;
  }
  s.end = end;
  s.sense = sense;
  s.curve_begin = c.master_before.position;
  s.curve = trajectory::Connect(length, InSense(OwnOver(c), sense), InSense(end, sense));
}

// `x` of the way done on a curve.
KinematicState At(const Quintic& curve, double x, double sense, const KinematicState& master) {
  if (x < 0) return {curve.At(0).position, 0, 0};
  return trajectory::AlongWay(InSense(curve.At(x), sense), master);
}

double OnCurveBy(const ClutchContext& c, const ClutchState& s) {
  return s.sense * (c.master.position - s.curve_begin);
}

KinematicState OnCurve(const ClutchContext& c, const KinematicState& wanted, const ClutchState& s) {
  const double x = OnCurveBy(c, s);
  if (x >= 0 || s.origin == CurveOrigin::kRest) return At(s.curve, x, s.sense, c.master);
  if (s.origin == CurveOrigin::kCam) return wanted;
  const double x_before = s.before_sense * (c.master.position - s.before_begin);
  if (x_before < 0 && s.before_origin == CurveOrigin::kCam) return wanted;
  return At(s.before, x_before, s.before_sense, c.master);
}

KinematicState Sum(const KinematicState& a, const KinematicState& b) {
  return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
}

KinematicState Shift(const KinematicState& own, const KinematicState& wanted) {
  return {own.position - wanted.position, own.velocity - wanted.velocity, own.acceleration - wanted.acceleration};
}

trajectory::Limits ClutchLimits(const ClutchContext& c) {
  const trajectory::Limits own = c.slave.planner_limits();
  const Settings& s = c.settings;
  return {std::min(s.sync_velocity, own.velocity), std::min(s.sync_acceleration, own.acceleration),
          std::min(s.sync_deceleration, own.deceleration),
          own.jerk > 0 ? std::min(s.sync_jerk, own.jerk) : s.sync_jerk};
}

// Begins to bring what lies between the slave and Y to zero.
void BeginShift(const ClutchContext& c, const KinematicState& shift, ClutchState& s) {
  if (s.mode == ClutchMode::kRampTime) {
    BeginTime(shift, c.settings.sync_in_time_s, c.cycle, s.ramp);
  } else if (!BeginProfile(shift, ClutchLimits(c), c.cycle, c.planner, s.ramp)) {
    s.mode = ClutchMode::kAbsolute;
  }
}

void StartClosing(const ClutchContext& c, Way& way, ClutchState& s) {
  s.phase = ClutchPhase::kClosing;
  s.mode = s.next;
  KinematicState wanted = c.wanted_before;
  if (s.mode == ClutchMode::kRelative) {
    way.to_slave.out_zero += c.own_before.position - wanted.position;
  } else if (c.settings.slave_absolute) {
    const double before = way.to_slave.out_zero;
    NearestTurn(c, wanted.position, c.own_before.position, way);
    wanted.position += way.to_slave.out_zero - before;
  }
  if (s.mode == ClutchMode::kRampTime || s.mode == ClutchMode::kRampVelAcc)
    BeginShift(c, Shift(c.own_before, wanted), s);
}

// The master came to where the curve begins in the cycle before, or is on its way from there to the sync position
// already. The curve is never longer than it was planned.
bool AtBegin(const ClutchContext& c, double sense, const Way& way, ClutchState& s, double& place) {
  place = SyncPlace(c, s.looked_from, s.distance, sense);
  s.looked_from = c.master_before.position;
  // Nobody knows where X and the slave will be at the end of ramps.
  const Ramp& own = way.to_slave.ramp;
  if (way.to_x.ramp.kind != RampKind::kNone || !IsOver(own, c.cycle, c.master) || !IsTied(c, s)) return false;
  const double left = sense * (place - c.master_before.position);
  return left <= s.distance && left > 0;
}

Status WaitForWay(const ClutchContext& c, Way& way, ClutchState& s) {
  const double sense = SenseOf(c, s);
  if (sense == 0 || !RightDirection(c, sense)) {
    s.looked_from = c.master_before.position;
    return Status::Ok();
  }
  if (s.planned_sense != sense && !PlanWay(c, sense, way, s)) return Status::Failed(ErrorId::kWouldReverse);
  double place = 0;
  if (!AtBegin(c, sense, way, s, place)) return Status::Ok();
  const double length = sense * (place - c.master_before.position);
  const KinematicState end = PlaceAt(way, c.table, place);
  BeginCurve(c, length, sense, end, s);
  if (KeepsSense(c) && !Monotone(s.curve)) {  // something has changed since it was planned
    if (!PlanWay(c, sense, way, s)) return Status::Failed(ErrorId::kWouldReverse);
    return Status::Ok();
  }
  s.phase = ClutchPhase::kClosing;
  s.mode = ClutchMode::kRampPos;
  return Status::Ok();
}

// The end of the curve over the master's way: what the cam says there now may differ from what it was to say.
void EndCurve(const ClutchContext& c, const Way& way, ClutchState& s) {
  const double place = s.curve_begin + s.sense * s.curve.length;
  const KinematicState now = PlaceAt(way, c.table, place);
  const KinematicState left = Shift(s.end, now);
  const double size = 1 + std::abs(now.position);
  s.phase = ClutchPhase::kClosed;
  if (std::abs(left.position) < kTiny * size && std::abs(left.velocity) < kTiny * (1 + std::abs(now.velocity))) return;
  s.phase = ClutchPhase::kClosing;
  s.mode = ClutchMode::kRampVelAcc;
  BeginShift(c, trajectory::AlongWay(left, c.master), s);
}

KinematicState Closing(const ClutchContext& c, const KinematicState& wanted, const Way& way, ClutchState& s) {
  if (s.mode == ClutchMode::kRampPos) {
    if (OnCurveBy(c, s) < s.curve.length) return OnCurve(c, wanted, s);
    EndCurve(c, way, s);
    if (s.phase == ClutchPhase::kClosed) return wanted;
  }
  if (s.mode == ClutchMode::kRampTime || s.mode == ClutchMode::kRampVelAcc) {
    if (IsOver(s.ramp, c.cycle, c.master)) s.phase = ClutchPhase::kClosed;
    return Sum(wanted, At(s.ramp, c.cycle, c.master));
  }
  if (c.in_step) s.phase = ClutchPhase::kClosed;
  return wanted;
}

// The turn of the sync-out position that lies nearest to where the slave comes.
double OutPlace(const ClutchContext& c, double expected) {
  const double place = c.settings.slave_sync_out_position + c.slave_zero;
  const double turn = SlaveTurn(c);
  return turn == 0 ? place : place + turn * std::round((expected - place) / turn);
}

bool BeginOut(const ClutchContext& c, ClutchState& s) {
  if (c.master.velocity == 0 || c.master_before.velocity == 0 || !IsTied(c, s)) return false;
  const double sense = c.master.velocity > 0 ? 1 : -1;
  const double length = c.settings.master_sync_out_distance;
  const KinematicState own = OwnOver(c);
  s.out = OutPlace(c, own.position + 0.5 * sense * own.velocity * length);
  const double turn = SlaveTurn(c);
  for (int k = 0; k < kTurnsAhead; ++k, s.out += sense * turn) {
    ClutchState tried = s;
    BeginCurve(c, length, sense, {s.out, 0, 0}, tried);
    if (!KeepsSense(c) || Monotone(tried.curve)) {
      s = tried;
      s.mode = ClutchMode::kRampPos;
      s.phase = ClutchPhase::kOpening;
      s.leaves = false;
      return true;
    }
    if (turn == 0) break;
  }
  return false;
}

// `there` comes back true where nothing is left to do but to come to rest.
KinematicState Opening(const ClutchContext& c, const KinematicState& wanted, const ClutchState& s, bool& there) {
  const KinematicState rest = {s.out, 0, 0};
  there = true;
  KinematicState demand = rest;
  if (s.mode == ClutchMode::kRampPos) {
    there = OnCurveBy(c, s) >= s.curve.length;
    if (!there) demand = OnCurve(c, wanted, s);
  } else if (s.mode == ClutchMode::kRampTime || s.mode == ClutchMode::kRampVelAcc) {
    there = IsOver(s.ramp, c.cycle, c.master);
    demand = Sum(rest, At(s.ramp, c.cycle, c.master));
  }
  return demand;
}

}  // namespace

bool IsCoupled(const ClutchState& s) noexcept {
  return s.phase != ClutchPhase::kOpen && s.phase != ClutchPhase::kReleased;
}

bool IsOnCurve(const ClutchState& s) noexcept {
  const bool moves = s.phase == ClutchPhase::kClosing || s.phase == ClutchPhase::kOpening;
  return moves && s.mode == ClutchMode::kRampPos;
}

bool IsFrozen(const ClutchState& s) noexcept {
  return s.phase == ClutchPhase::kWaitingIn || s.phase == ClutchPhase::kClosing || IsOnCurve(s);
}

void BeginClosing(const ClutchContext& c, Way&, ClutchState& s) noexcept {
  if (s.leaves || s.phase == ClutchPhase::kWaitingOut) {  // it is on the cam still, or on its way there
    if (s.phase == ClutchPhase::kWaitingOut) s.phase = ClutchPhase::kClosed;
    s.leaves = false;
    return;
  }
  s.opens_still = s.phase == ClutchPhase::kOpening;
  s.phase = ClutchPhase::kWaitingIn;
  s.next = c.settings.sync_mode;
  if (s.next == ClutchMode::kRampPos && c.settings.master_sync_in_distance == 0) s.next = ClutchMode::kAbsolute;
  s.planned_sense = 0;
  s.looked_from = c.master_before.position;
  s.distance = c.settings.master_sync_in_distance;
  if (!s.opens_still) s.out = c.own_before.position;
}

void BeginOpening(const ClutchContext& c, ClutchState& s) noexcept {
  const KinematicState& own = c.own_before;
  if (s.phase == ClutchPhase::kWaitingIn) {  // it was never on the cam
    s.phase = ClutchPhase::kOpening;
    if (!s.opens_still) s.mode = ClutchMode::kAbsolute;
    return;
  }
  if (c.settings.sync_mode == ClutchMode::kRampPos && c.settings.master_sync_out_distance > 0) {
    if (s.phase == ClutchPhase::kClosed) s.phase = ClutchPhase::kWaitingOut;
    s.leaves = s.phase == ClutchPhase::kClosing;
    s.waits_since = c.master.position;
    return;
  }
  s.mode = c.settings.sync_mode;
  s.phase = ClutchPhase::kOpening;
  if (s.mode == ClutchMode::kAbsolute || s.mode == ClutchMode::kRelative) {
    s.out = own.position;
    return;
  }
  s.out = OutPlace(c, own.position);
  const KinematicState shift = Shift(own, {s.out, 0, 0});
  if (s.mode == ClutchMode::kRampTime) {
    BeginTime(shift, c.settings.sync_out_time_s, c.cycle, s.ramp);
  } else if (s.mode == ClutchMode::kRampVelAcc && !BeginProfile(shift, ClutchLimits(c), c.cycle, c.planner, s.ramp)) {
    s.mode = ClutchMode::kAbsolute;
  }
}

Status StepClutch(const ClutchContext& c, const KinematicState& wanted, Way& way, ClutchState& s,
                  KinematicState& demand) noexcept {
  const double zero = way.to_slave.out_zero;
  const auto shifted = [&] {
    return KinematicState{wanted.position + way.to_slave.out_zero - zero, wanted.velocity, wanted.acceleration};
  };
  bool there = false;
  Status status = Status::Ok();
  if (s.phase == ClutchPhase::kWaitingIn) {
    if (s.next == ClutchMode::kRampPos) {
      if (status = WaitForWay(c, way, s); status.failed()) {
        s.phase = ClutchPhase::kOpening;
        if (!s.opens_still) s.mode = ClutchMode::kAbsolute;
      }
    } else if (RightDirection(c, c.master.velocity)) {
      StartClosing(c, way, s);
    }
  }
  if ((s.phase == ClutchPhase::kWaitingOut || s.leaves) && !BeginOut(c, s) && s.phase == ClutchPhase::kWaitingOut &&
      std::abs(c.master.position - s.waits_since) > c.table.length() / way.to_x.factor) {
    status = Status::Failed(ErrorId::kWouldReverse);
    s.phase = ClutchPhase::kClosed;
  }
  switch (s.phase) {
    case ClutchPhase::kWaitingIn:
      demand = s.opens_still ? Opening(c, wanted, s, there) : KinematicState{s.out, 0, 0};
      break;
    case ClutchPhase::kClosing:
      demand = Closing(c, shifted(), way, s);
      if (s.phase == ClutchPhase::kClosed && s.leaves) {
        s.phase = ClutchPhase::kWaitingOut;
        s.waits_since = c.master.position;
        s.leaves = false;
      }
      break;
    case ClutchPhase::kClosed:
    case ClutchPhase::kWaitingOut:
      demand = wanted;
      break;
    case ClutchPhase::kOpening:
      demand = Opening(c, wanted, s, there);
      if (there && c.at_rest && c.in_step) s.phase = ClutchPhase::kOpen;
      break;
    default:
      break;
  }
  return status;
}

void describe(Enumeration<ClutchPhase>& e) {
  e.about("How far the clutch is.");
  e.value(ClutchPhase::kOpen, "open", "The slave is on its own.");
  e.value(ClutchPhase::kWaitingIn, "waiting_in", "The master is not yet where it begins to close.");
  e.value(ClutchPhase::kClosing, "closing", "On the way onto the cam.");
  e.value(ClutchPhase::kClosed, "closed", "On the cam.");
  e.value(ClutchPhase::kWaitingOut, "waiting_out", "On the cam, and waits to leave it.");
  e.value(ClutchPhase::kOpening, "opening", "On the way to where the slave is to rest.");
  e.value(ClutchPhase::kReleased, "released", "Opened at once; the slave comes to rest.");
}

void describe(Enumeration<CurveOrigin>& e) {
  e.about("What a slave was on when a curve began.");
  e.value(CurveOrigin::kRest, "rest", "It stood.");
  e.value(CurveOrigin::kCam, "cam", "The cam.");
  e.value(CurveOrigin::kCurve, "curve", "Another curve.");
}

void describe(Description<ClutchState>& d) {
  using S = ClutchState;
  d.about("The clutch.");
  d.internal<&S::phase>("How far it is.");
  d.internal<&S::mode>("In which it closes or opens.");
  d.internal<&S::ramp>("Over time.");
  d.internal<&S::curve>("Over the master's way.");
  d.internal<&S::curve_begin>("Master's position where the curve begins.");
  d.internal<&S::sense>("In which the master goes on it.");
  d.internal<&S::end>("Where it ends, over the master's way.");
  d.internal<&S::distance>("Before the sync position: where it begins.");
  d.internal<&S::planned_sense>("For which that was planned.");
  d.internal<&S::out>(unit::u, "Where the slave is to rest.");
  d.internal<&S::next>("Mode in which it is to close.");
  d.internal<&S::opens_still>("It opens until it begins to close.");
  d.internal<&S::leaves>("It is to open as soon as it can.");
  d.internal<&S::looked_from>("Where the master was before it was looked at last.");
  d.internal<&S::waits_since>("Where the master was when the waiting to open began.");
  d.internal<&S::origin>("What the slave was on before the curve.");
  d.internal<&S::before>("The curve before.");
  d.internal<&S::before_begin>("Where that began.");
  d.internal<&S::before_origin>("What the slave was on before that.");
  d.internal<&S::before_sense>("In which the master went on it.");
}

void describe(Description<Way>& d) {
  d.about("The way from the master to the slave.");
  d.internal<&Way::to_x>("Scaling and offset of the master.");
  d.internal<&Way::profiler>("The cam.");
  d.internal<&Way::to_slave>("Scaling and offset of the slave.");
}

}  // namespace takt::flexcam
