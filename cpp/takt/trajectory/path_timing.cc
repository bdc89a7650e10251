#include "takt/trajectory/path_timing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace takt::trajectory {

namespace {

constexpr double kLead_s = 0.012;         // from the order of a plan to its start, at least, with a plan in force ...
constexpr double kFirstLead_s = 0.004;    // ... without one ...
constexpr std::uint64_t kOfLastPlan = 2;  // ... and as a multiple of the time that the last plan took
constexpr std::uint64_t kMostLead = 400;  // cycles
constexpr std::uint64_t kOrderAgain = 8;  // cycles after a failed order
constexpr double kRenew_s = 0.4;          // before a law ends: time from which it is renewed if the path continues ...
constexpr double kRenewShare = 0.75;      // ... at most this share of its duration
constexpr double kBrakesSoon_s = 0.1;     // ... or it brakes to its end within this time
constexpr double kShort_s = 0.15;         // laws as short as this start from rest: the motion still accelerates
constexpr double kSlow_s = 0.04;          // lead from which plans take too long to be refined
constexpr double kOfTime = 12;            // as a multiple of the time that plans take, instead
constexpr double kBehind_s = 0.1;         // before the end of a law: the motion behind a stop there is planned
constexpr double kAgainShare = 0.1;       // of the time left of a law: least wait after a failed plan
constexpr int kRefinements = 3;           // refinements of a plan, as long as ...
constexpr double kRefined = 0.99;     // ... each shortens it to this share; required at once where a plan holds speeds
constexpr double kUrgent_s = 0.15;    // before the law in force ends: slower plans are accepted
constexpr double kWithin = 1 + 1e-7;  // factor on a limit
constexpr int kSamples = 12;          // samples of a piece of a profile that is verified, besides the nodes it passes
constexpr double kShares[] = {1, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1};  // shares of limits, tried for bridges
constexpr double kMuchFaster = 4;  // times the slowest speed of a bridge: it ends where more is allowed
constexpr double kCrawls = 4;      // times the duration of the reference: bridges, with stops between them, are faster
constexpr double kBrakeShares[] = {1,   0.8,  0.6,   0.45,   0.3,  0.2,
                                   0.1, 0.05, 0.025, 0.0125, 0.006};  // of limits, tried for braking
constexpr double kBrakesWithin[] = {kWithin, 1.008, 1.018};  // of the limits of the window, 0.98 of the members'
constexpr double kOfBrakes = 2;                              // ratio of the deceleration share to the jerk share
constexpr double kLastResort = 0.1;       // largest share of the limits that may be tried within more than kWithin
constexpr std::uint64_t kMoreAfter = 10;  // cycles in which nothing was found within less
constexpr std::uint64_t kBrakeAgain = 4;  // cycles after which a harder braking is tried
// References for a plan, tried in turn.
struct Reference {
  double share;    // share of limits
  bool follow;     // begins with the law in force
  double slowest;  // accepted time of the plan, as a multiple of what the law in force takes until it brakes to its end
  bool urgent;     // tried only if the end of that law is near
};
constexpr double kAnyTime = std::numeric_limits<double>::infinity();
constexpr Reference kReferences[] = {
    {1, false, 1.03, false}, {1, true, 1.15, false}, {0.8, false, kAnyTime, true}, {0.5, false, kAnyTime, true}};
constexpr double kRoomForPlans = 0.97;           // share of limits: a plan can start from such a motion
constexpr double kSamePosition = 1e-9;           // [mm]
constexpr double kCoordinatesShare = 0.979;      // share of the coordinates' limits; plans use 0.98
constexpr int kTails = 8;                        // starts tried for a tail
constexpr double kTailShares[] = {1, 0.8, 0.5};  // shares of limits, tried for tails
constexpr double kStraight = 1e-12;              // second slopes that are rounding
constexpr double kUnlimitedAlong = std::numeric_limits<double>::max();
constexpr double kGentle = 0.3;  // of the limits: a stop found later with kBrakeShares may be this gentle

// Returns the use of limits accepted for a motion to rest after this many cycles in which none was found.
double WithinAfter(std::uint64_t cycles) {
  return kBrakesWithin[std::min<std::size_t>(cycles / kMoreAfter, std::size(kBrakesWithin) - 1)];
}

// At a joint, `step` is the step of accelerations as a share of what jerk changes in a cycle, `use` the use of jerk
// there.
bool LeavesTooLittle(double step, double use, double within) {
  constexpr double kForStep = (1 - kJerkAtJoint) / kStepAtJoint;
  return step > within * kStepAtJoint || use + kForStep * step > within;
}

bool IsAtRest(const KinematicState& state) {
  return state.velocity == 0 && state.acceleration == 0;
}

bool IsStraight(const PathWindow& window, std::uint64_t from, std::uint64_t to) {
  for (std::uint64_t i = from; i <= to; ++i) {
    const auto straight = [](double q) { return std::abs(q) < kStraight; };
    if (!std::ranges::all_of(window[i].at.slopes.second, straight)) return false;
  }
  return true;
}

}  // namespace

double PathTiming::Law::Duration() const noexcept {
  if (tail_s < std::numeric_limits<double>::infinity()) return tail_s + tail.duration();
  return planned ? plan.duration() : profile.duration();
}

double PathTiming::Law::EndArcLength() const noexcept {
  if (tail_s < std::numeric_limits<double>::infinity()) return tail.end().position;
  return planned ? course.end_place() : profile.end().position;
}

KinematicState PathTiming::Law::At(double t) const noexcept {
  if (t >= Duration()) return {EndArcLength(), 0, 0};
  if (t >= tail_s) return tail.At(t - tail_s);
  return planned ? course.At(plan.At(t)) : profile.At(t);
}

PathTiming::PathTiming(double period_s)
    : period_s_(period_s), maker_(std::make_unique<PlanWorker>(period_s)), current_(period_s), next_(period_s) {}

void PathTiming::Clear() noexcept {
  active_ = braking_ = final_ = reserved_ = slows_ = false;
  DropPlan();
}

void PathTiming::DropPlan() noexcept {
  dropped_ = planning_;
  ready_ = false;
}

// The path behind an arc length changes: a plan that ends there or before is kept.
void PathTiming::KeepPlanTo(double place) noexcept {
  known_to_ = std::min(known_to_, place);
  if (ready_ && next_.EndArcLength() > known_to_ + kSamePosition) ready_ = false;
}

void PathTiming::Begin(const PathPace& pace) noexcept {
  const bool planned = ready_ && behind_ && std::abs(next_.begin_place - pace.now.position) < kSamePosition;
  Clear();
  active_ = true;
  late_ = refused_ = took_ = tick_ = wait_until_ = ordered_ = 0;
  Take(Profile(pace.now), 1);
  behind_ = false;
  ready_ = planned;
  if (planned) next_.begin = tick_;
}

void PathTiming::Take(const Profile& profile, double factor) noexcept {
  current_.begin = tick_;
  current_.planned = false;
  current_.profile = profile;
  current_.tail_s = std::numeric_limits<double>::infinity();
  current_.factor = factor;
}

KinematicState PathTiming::StateAt(std::uint64_t tick) const noexcept {
  return current_.At(static_cast<double>(tick - current_.begin) * period_s_);
}

double PathTiming::rest_s() const noexcept {
  return std::max(0.0, current_.Duration() - static_cast<double>(tick_ - current_.begin) * period_s_);
}

std::uint64_t PathTiming::rest_cycles() const noexcept {
  return static_cast<std::uint64_t>(std::ceil(rest_s() / period_s_ - 1e-9));
}

bool PathTiming::IsFinalTo(double place) const noexcept {
  return !braking_ && (current_.planned || final_) && rest_place() >= place - 1e-6;
}

// Returns true if a motion keeps the limits of all coordinates and never reverses.
bool PathTiming::Holds(const PathWindow& window, std::uint64_t node, const Profile& profile,
                       double within) const noexcept {
  if (profile.VelocityRange().min < -kSamePosition) return false;
  KinematicState before = profile.At(0);
  double begin_s = 0;
  for (int i = 0; i < profile.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double jerk = profile.pieces[k].jerk;
    const double length_s = profile.piece_ends_s[k] - begin_s;
    for (int sample = 0; sample <= kSamples; ++sample) {
      const KinematicState at = profile.pieces[k].At(length_s * sample / kSamples);
      // Nodes between two samples, with the slopes on both of their sides.
      while (node + 1 < window.known() && !window[node].stop && window[node + 1].at.s <= at.position + kSamePosition) {
        const double s = window[node + 1].at.s;
        const double length = at.position - before.position;
        const double share = length > kSamePosition ? std::clamp((s - before.position) / length, 0.0, 1.0) : 1;
        const double square = std::lerp(before.velocity * before.velocity, at.velocity * at.velocity, share);
        const double acceleration = std::lerp(before.acceleration, at.acceleration, share);
        const KinematicState there{s, std::sqrt(square), acceleration};
        if (UseOf(window, node, there, jerk) > within) return false;
        const PathSlopes &slopes = window[node].at.slopes, &behind = window[node + 1].at.slopes;
        const bool joint = window[node].at.s == s;
        const double step = joint ? square / JointSquare(slopes, behind, window.limits(), period_s_) : 0;
        if (step > 0 && LeavesTooLittle(step, JerkUse(window, node, there, jerk), within)) return false;
        ++node;
        if (step > 0 && LeavesTooLittle(step, JerkUse(window, node, there, jerk), within)) return false;
        if (UseOf(window, node, there, jerk) > within) return false;
      }
      if (UseOf(window, node, at, jerk) > within) return false;
      before = at;
    }
    begin_s = profile.piece_ends_s[k];
  }
  return true;
}

// Takes one motion from the present state to rest: where the path begins to bend or, with `slowly`, up to where the
// allowed speed changes much, no faster than the slowest node.
bool PathTiming::Bridge(const PathWindow& window, double factor, bool slowly, const PathPace& pace) noexcept {
  const std::uint64_t end = StopBehind(window, pace.node);
  if (!(window[end].at.s > pace.now.position + kSamePosition)) return false;
  // To the end, or to the first bend.
  std::uint64_t bend = end, furthest = end;
  const auto steady = [&](std::uint64_t i) {
    const PathSlopes& slopes = window[i].at.slopes;
    const double most = factor * window[i].at.limits.velocity;
    return window[i].own >= 0.9 * most * most || std::ranges::all_of(slopes.second, [](double q) { return q == 0; });
  };
  for (std::uint64_t i = pace.node + 1; i <= end; ++i) {
    if (steady(i)) continue;
    bend = i - 1;
    break;
  }
  // On a path that bends at once the motion waits for its plan. If there is no plan it moves at the speed of the
  // slowest node, up to the first node that allows much more or much less.
  if (slowly) {
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    std::uint64_t alike = pace.node;
    while (alike < end) {
      const double own = window[alike + 1].own;
      slowest = std::min(slowest, own);
      fastest = std::max(fastest, own);
      if (fastest > kMuchFaster * kMuchFaster * slowest && window[alike].at.s > pace.now.position + kSamePosition)
        break;
      ++alike;
    }
    furthest = alike;
  }
  if (bend <= pace.node || !(window[bend].at.s > pace.now.position + kSamePosition)) {
    if (!slowly) return false;
    bend = furthest;
  }
  for (const std::uint64_t to : {slowly ? furthest : bend, bend}) {
    AlongPath least = window[pace.node].at.limits;
    double velocity = std::numeric_limits<double>::infinity();
    for (std::uint64_t i = pace.node; i <= to; ++i) {
      const PathPoint& point = window[i].at;
      least = Least(least, LimitsAt(point, window.limits(), kCoordinatesShare));
      const double most = factor * point.limits.velocity;
      velocity = std::min({velocity, most, std::max(factor, 1e-3) * std::sqrt(window[i].own)});
    }
    if (!(velocity > 0)) continue;
    const bool straight = IsStraight(window, pace.node, to);
    const bool last = to == end && straight && window[to].stop;
    for (double share : kShares) {
      if (share == 1 && !last) share = kRoomForPlans;
      const Limits limits{velocity, share * least.acceleration, share * least.deceleration, share * least.jerk};
      Profile profile{};
      if (planner_.ToPosition(pace.now, window[to].at.s, 0, limits, profile).failed()) continue;
      if (profile.PositionRange().max > window[to].at.s + kSamePosition) continue;
      if (!Holds(window, pace.node, profile, kWithin)) continue;
      DropPlan();
      Take(profile, factor);
      slows_ = false;
      final_ = to == end && straight && share >= kRoomForPlans;
      reserved_ = final_ && !last;
      braking_ = false;
      return true;
    }
    if (to == bend) break;
  }
  return false;
}

void PathTiming::Go(const PathWindow& window, PathPace& pace) noexcept {
  ++tick_;
  if (ready_ && !behind_ && next_.begin <= tick_) {
    std::swap(current_, next_);
    ready_ = false;
    braking_ = final_ = slows_ = false;
    refused_ = 0;
  }
  pace.now = pace.raw = StateAt(tick_);
  pace.node = pace.passed = NodeAt(window, pace.node, pace.now.position);
  pace.entered = pace.now.velocity * pace.now.velocity;
  pace.raw_stands = IsAtRest(pace.now) && (pace.node + 1 >= window.known() || window[pace.node].stop);
}

void PathTiming::Advance(const PathWindow& window, double factor, PathPace& pace) noexcept {
  if (factor > 0 && IsAtRest(pace.now) && rest_s() == 0 && !ready_) {
    Bridge(window, factor, no_plan_, pace);
  } else if (slows_ && !ready_ && !IsAtRest(pace.now)) {
    if (!braking_) Brake(window, {}, 0, pace);
    if (braking_ && braked_ < 1 && tick_ >= tried_ + kBrakeAgain) Brake(window, {}, braked_, pace);
  }
  if (!slows_) refused_ = 0;
  Go(window, pace);
}

// Takes the hardest jerk-limited motion to rest that is found with a share of the limits above `least`.
bool PathTiming::Brake(const PathWindow& window, const PathBrake& brake, double least, const PathPace& pace) noexcept {
  AlongPath asked = window[pace.node].at.limits;
  if (brake.deceleration > 0) asked.deceleration = brake.deceleration;
  if (brake.jerk > 0) asked.jerk = std::min(brake.jerk, asked.jerk);
  PathPoint here = window[pace.node].at;
  here.limits = asked;
  AlongPath along = LimitsAt(here, window.limits(), kCoordinatesShare);
  if (brake.full) {
    const AlongPath own = along;
    here.limits.deceleration = here.limits.jerk = kUnlimitedAlong;
    along = LimitsAt(here, window.limits(), kCoordinatesShare);
    if (along.deceleration == kUnlimitedAlong) along.deceleration = own.deceleration;
    if (along.jerk == kUnlimitedAlong) along.jerk = own.jerk;
  }
  const double furthest = window[StopBehind(window, pace.node)].at.s;
  tried_ = tick_;
  for (const double within : kBrakesWithin) {
    if (within > (braking_ ? braked_within_ : WithinAfter(refused_))) break;
    for (const double share : kBrakeShares) {
      if (share <= least) break;
      if (within > kWithin && share > kLastResort) continue;  // only motions that hardly change the present one
      Profile profile{};
      // Bends leave less jerk than acceleration where both are nearly used up.
      const Limits limits{along.velocity, along.deceleration, std::min(1.0, kOfBrakes * share) * along.deceleration,
                          share * along.jerk};
      if (planner_.Stop(pace.now, limits, profile).failed()) continue;
      if (profile.end().position > furthest || !Holds(window, pace.node, profile, within)) continue;
      if (braking_ && !(profile.duration() < rest_s())) return false;
      Take(profile, current_.factor);
      DropPlan();
      braking_ = true;
      full_ = brake.full;
      final_ = false;
      braked_ = share;
      braked_within_ = within;
      refused_ = 0;
      return true;
    }
  }
  if (!braking_) ++refused_;
  return false;
}

void PathTiming::Stop(const PathWindow& window, const PathBrake& brake, PathPace& pace) noexcept {
  slows_ = false;
  if (!IsAtRest(pace.now)) {
    if (!braking_ || (brake.full && !full_)) {
      Brake(window, brake, 0, pace);
    } else if (braked_ < 1 && tick_ >= tried_ + kBrakeAgain) {
      Brake(window, brake, braked_, pace);  // the slower the motion, the more the bends leave
    }
  } else {
    DropPlan();
    braking_ = true;
    braked_ = 1;
    Take(Profile(pace.now), current_.factor);
  }
  Go(window, pace);
}

double PathTiming::EstimatedStop(const PathWindow& window, const PathPace& pace) const noexcept {
  if (braking_) return rest_place();
  const AlongPath& along = window[pace.node].at.limits;
  const Limits gentle{along.velocity, along.acceleration, kGentle * along.deceleration, kGentle * along.jerk};
  return std::min(window[StopBehind(window, pace.node)].at.s, StopPosition(pace.now, gentle));
}

// Returns the lead from the order of a plan to its start [ticks].
std::uint64_t PathTiming::Lead() const noexcept {
  const auto least = static_cast<std::uint64_t>(std::ceil((current_.planned ? kLead_s : kFirstLead_s) / period_s_));
  const std::uint64_t lead = std::clamp(kOfLastPlan * took_, std::max(late_, least), std::max(kMostLead, least));
  // Preferably at half of the time to a stop rather than there.
  const std::uint64_t half = rest_cycles() / 2;
  return lead > half && took_ < rest_cycles() && current_.planned ? std::max({half, took_, least}) : lead;
}

bool PathTiming::Order(const PathWindow& window, double factor, const PathPace& pace) noexcept {
  const std::uint64_t lead = Lead();
  next_.begin = tick_ + lead;
  const KinematicState begin = StateAt(next_.begin);
  const std::uint64_t node = NodeAt(window, pace.node, begin.position);
  if (!OrderFrom(window, node, begin, factor)) return false;
  const double from_s = period_s_ * static_cast<double>(next_.begin - current_.begin);
  const bool follows = current_.planned && std::isinf(current_.tail_s) && current_.factor == factor;
  if (follows && from_s < current_.plan.duration()) next_.course.Follow(current_.course, current_.plan, from_s);
  from_rest_ = IsAtRest(begin);
  const double lead_s = period_s_ * static_cast<double>(lead);
  maker_->urgent = rest_s() < std::max(kUrgent_s, kOfTime * period_s_ * static_cast<double>(took_));
  maker_->refinements = lead_s < kSlow_s ? kRefinements : 0;
  reserved_ = no_plan_ = behind_ = false;
  maker_->order.store(OrderState::kOrdered, std::memory_order_release);
  return true;
}

bool PathTiming::OrderFrom(const PathWindow& window, std::uint64_t node, const KinematicState& begin,
                           double factor) noexcept {
  if (!next_.course.Take(window, node, begin, StopBehind(window, node), factor)) return false;
  next_.begin_place = begin.position;
  next_.planned = true;
  next_.factor = factor;
  next_.tail_s = std::numeric_limits<double>::infinity();
  ++maker_->number;
  planning_ = true;
  dropped_ = false;
  known_to_ = std::numeric_limits<double>::infinity();
  ordered_ = tick_;
  return true;
}

// Orders the motion behind the stop at a node, so that it starts at once and its duration is known by then.
void PathTiming::OrderBehind(const PathWindow& window, std::uint64_t stop, double factor) noexcept {
  const std::uint64_t node = stop + 1;
  if (rest_s() > kBehind_s || !window.swept() || node + 1 >= window.known()) return;
  if (IsStraight(window, node, StopBehind(window, node))) return;  // a bridge is as fast
  if (!OrderFrom(window, node, {window[node].at.s, 0, 0}, factor)) {
    wait_until_ = tick_ + kOrderAgain;
    return;
  }
  from_rest_ = false;  // not from the rest of the law in force
  maker_->urgent = false;
  maker_->refinements = kRefinements;
  behind_ = true;
  maker_->order.store(OrderState::kOrdered, std::memory_order_release);
}

void PathTiming::Ask(const PathWindow& window, double factor, const PathPace& pace) noexcept {
  if (!active_ || !(factor > 0) || tick_ == 0) return;
  if (ready_ && behind_ && next_.factor != factor) DropPlan();
  if (ready_) return;
  if (planning_) {
    if (tick_ > ordered_ + kMostLead) no_plan_ = true;  // no thread computes plans
    return;
  }
  const std::uint64_t end = StopBehind(window, pace.node);
  const bool further = window[end].at.s > rest_place() + kSamePosition;
  // Earlier if plans take long: they are to begin before the law in force brakes to its end.
  const double renew_s =
      std::max(std::min(kRenew_s, kRenewShare * current_.Duration()), kOfTime * period_s_ * static_cast<double>(took_));
  const auto brakes_soon = [&] {
    if (rest_s() >= kRenew_s || current_.Duration() <= kShort_s) return false;
    const AlongPath& along = window[pace.node].at.limits;
    const Limits usual{along.velocity, along.acceleration, along.deceleration, along.jerk};
    return rest_place() - StopPosition(pace.now, usual) < kBrakesSoon_s * pace.now.velocity;
  };
  const bool wanted = (further && (rest_s() < renew_s || brakes_soon())) || braking_ ||
                      (!current_.planned && !final_) || current_.factor != factor || (reserved_ && window[end].stop);
  if (tick_ < wait_until_) return;
  if (!wanted && !further && window[end].stop) OrderBehind(window, end, factor);
  if (!wanted || !(window[end].at.s > pace.now.position + kSamePosition)) return;
  if (Order(window, factor, pace)) return;
  wait_until_ = tick_ + kOrderAgain;
  no_plan_ = IsAtRest(pace.now);
}

std::optional<std::uint64_t> PathTiming::MakePlan() noexcept {
  if (maker_->order.load(std::memory_order_acquire) != OrderState::kOrdered) return {};
  maker_->status = PathPlanStatus::kNoPlan;
  for (const Reference& reference : kReferences) {
    if (maker_->status != PathPlanStatus::kNoPlan || (reference.urgent && !maker_->urgent)) break;
    if (reference.follow && !next_.course.follows()) continue;
    if (!next_.course.Make(maker_->profiles, reference.share, reference.follow)) continue;
    maker_->status = maker_->planner.Plan(next_.course.Request(), next_.plan);
    const bool found = maker_->status == PathPlanStatus::kPlanned;
    const bool crawls = next_.plan.duration() > kCrawls * next_.course.duration();
    if (maker_->status == PathPlanStatus::kScaled && crawls) maker_->status = PathPlanStatus::kNoPlan;
    if (found && next_.course.IsSlower(next_.plan, reference.slowest)) maker_->status = PathPlanStatus::kNoPlan;
  }
  // Refine with the plan as the reference: where its speed changes by orders of magnitude it is far from the optimum.
  for (int i = 0; i < maker_->refinements && maker_->status == PathPlanStatus::kPlanned; ++i) {
    const double before_s = next_.plan.duration();
    const double most_s = maker_->planner.holds() ? kRefined * before_s : before_s;
    if (!maker_->course.Make(next_.course, next_.plan)) break;
    const PathPlanStatus status = maker_->planner.Plan(maker_->course.Request(), maker_->plan);
    if (status != PathPlanStatus::kPlanned || !(maker_->plan.duration() < most_s)) break;
    std::swap(maker_->course, next_.course);
    std::swap(maker_->plan, next_.plan);
    if (next_.plan.duration() > kRefined * before_s) break;
  }
  const std::uint64_t number = maker_->number;
  maker_->order.store(OrderState::kMade, std::memory_order_release);
  return number;
}

void PathTiming::RepeatPlan() noexcept {
  maker_->order.store(OrderState::kOrdered, std::memory_order_release);
}

// Returns true if the plan leads further than the law in force, or ends sooner.
bool PathTiming::EndsSooner() const noexcept {
  const auto end_s = [&](const Law& law) { return static_cast<double>(law.begin) * period_s_ + law.Duration(); };
  return next_.EndArcLength() > current_.EndArcLength() + kSamePosition || end_s(next_) < end_s(current_);
}

void PathTiming::TakePlan(std::uint64_t number) noexcept {
  if (!planning_ || number != maker_->number) return;
  MakePlan();
  maker_->order.store(OrderState::kNone, std::memory_order_relaxed);
  planning_ = false;
  took_ = std::max(tick_ - ordered_, took_ - took_ / 4);  // a plan that fails may be ready at once
  if (dropped_) return;
  const PathPlanStatus status = maker_->status;
  const bool found = status == PathPlanStatus::kPlanned || status == PathPlanStatus::kScaled;
  if (found && next_.EndArcLength() > known_to_ + kSamePosition) return;  // the path has changed there
  if (found && !behind_ && final_ && !braking_ && next_.factor == current_.factor && !EndsSooner()) return;
  if (found && from_rest_) {
    const auto rests = current_.begin + static_cast<std::uint64_t>(std::ceil(current_.Duration() / period_s_ - 1e-9));
    next_.begin = std::max(tick_, rests);
    ready_ = true;
  } else if (found && (behind_ || next_.begin >= tick_)) {
    ready_ = true;
  } else if (found) {  // too late
    late_ = std::min(2 * (next_.begin - ordered_), kMostLead);
    return;
  } else {
    // The law in force may be one of a low speed factor, which lasts for a long time.
    const double wait_s = kAgainShare * std::min(rest_s(), kRenew_s);
    wait_until_ = tick_ + std::max(kOrderAgain, static_cast<std::uint64_t>(wait_s / period_s_));
    no_plan_ = from_rest_;
    slows_ = !behind_ && next_.factor < current_.factor;
  }
  late_ = 0;
}

bool PathTiming::StopBefore(const PathWindow& window, double place, const PathPace& pace) noexcept {
  if (rest_place() <= place + kSamePosition) {
    KeepPlanTo(place);
    return true;
  }
  // The last cycle before the position.
  std::uint64_t last = tick_;
  const auto ends = static_cast<std::uint64_t>(std::ceil(rest_s() / period_s_)) + tick_;
  std::uint64_t behind = ends;
  while (behind - last > 1) {
    const std::uint64_t middle = last + (behind - last) / 2;
    (StateAt(middle).position < place ? last : behind) = middle;
  }
  const std::uint64_t step = std::max<std::uint64_t>(1, (last - tick_ + kTails - 1) / kTails);
  for (std::uint64_t tick = last;; tick -= std::min(step, tick - tick_)) {
    const KinematicState from = StateAt(tick);
    const std::uint64_t node = NodeAt(window, pace.node, from.position);
    AlongPath least = window[node].at.limits;
    for (std::uint64_t i = node; i < window.known() && window[i].at.s < place; ++i) {
      least = Least(least, LimitsAt(window[i].at, window.limits(), 1));
    }
    for (const double share : kTailShares) {
      const Limits limits{std::max(least.velocity, from.velocity), share * least.acceleration,
                          share * least.deceleration, share * least.jerk};
      Profile profile{};
      const bool found = !planner_.ToPosition(from, place, 0, limits, profile).failed() &&
                         profile.PositionRange().max <= place + kSamePosition && Holds(window, node, profile, kWithin);
      if (!found) continue;
      current_.tail_s = static_cast<double>(tick - current_.begin) * period_s_;
      current_.tail = profile;
      DropPlan();
      final_ = false;
      return true;
    }
    if (tick == tick_) return false;
  }
}

}  // namespace takt::trajectory
