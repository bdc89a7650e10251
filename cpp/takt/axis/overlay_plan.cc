#include "takt/axis/overlay_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/axis/fit.h"

namespace takt::axis {

using trajectory::Limits;
using trajectory::Piece;
using trajectory::Profile;

namespace {

constexpr double kRounding = 1e-9;  // of a limit
// A smaller share of the axis' own limits is not worth a plan: it would take too long.
constexpr double kLeastShare = 0.02;
constexpr std::size_t kMostTimes = 2 * Profile::kCapacity + 2;

// Ascending times at which the jerk of the base or of the added motion may change.
struct Times {
  std::array<double, kMostTimes> at{};
  std::size_t count = 0;

  void Add(double t) {
    if (t >= 0 && count < kMostTimes) at[count++] = t;
  }
};

Times TimesOf(const BaseAhead& base, const Profile* added) {
  Times times;
  times.Add(0);
  for (int i = 0; base.profile && i < base.profile->size(); ++i) {
    times.Add(base.profile->piece_ends_s[static_cast<std::size_t>(i)] - base.elapsed_s);
  }
  for (int i = 0; added && i < added->size(); ++i) times.Add(added->piece_ends_s[static_cast<std::size_t>(i)]);
  std::sort(times.at.begin(), times.at.begin() + static_cast<std::ptrdiff_t>(times.count));
  return times;
}

// Returns the piece of constant jerk that a profile follows from `t` to its next time; `middle`: a time between them.
Piece PieceAt(const Profile& profile, double t, double middle) {
  const double jerk = profile.JerkAt(middle);
  const KinematicState at = profile.At(middle);
  const double back = t - middle;
  const KinematicState begin = Piece{at.position, at.velocity, at.acceleration, jerk}.At(back);
  return {begin.position, begin.velocity, begin.acceleration, jerk};
}

Piece BaseAt(const BaseAhead& base, double t, double middle) {
  if (base.profile) return PieceAt(*base.profile, base.elapsed_s + t, base.elapsed_s + middle);
  return {base.now.position + base.now.velocity * t, base.now.velocity, 0, 0};
}

Profile::Range VelocityRange(const Piece& piece, double duration) {
  const double end = piece.At(duration).velocity;
  Profile::Range range = {std::min(piece.velocity, end), std::max(piece.velocity, end)};
  const double turn = piece.jerk != 0 ? -piece.acceleration / piece.jerk : 0;
  if (turn > 0 && turn < duration) {
    const double extreme = piece.At(turn).velocity;
    range = {std::min(range.min, extreme), std::max(range.max, extreme)};
  }
  return range;
}

bool KeepsPosition(const AxisLimits& limits, const Piece& piece, double duration) {
  if (!limits.lower && !limits.upper) return true;
  const auto inside = [&](double t) { return Inside(limits, piece.At(t).position); };
  if (!inside(duration)) return false;
  for (const double zero : piece.VelocityZeros()) {
    if (zero > 0 && zero < duration && !inside(zero)) return false;
  }
  return true;
}

// The largest part of the axis' limits that the base needs from now on.
struct Needs {
  Profile::Range velocity{0, 0};
  double acceleration = 0;
  double jerk = 0;
};

Needs NeedsOf(const BaseAhead& base) {
  Needs needs;
  const double last = base.profile ? base.profile->end().velocity : base.now.velocity;
  needs.velocity = {last, last};
  const Times times = TimesOf(base, nullptr);
  for (std::size_t i = 0; i + 1 < times.count; ++i) {
    const double duration = times.at[i + 1] - times.at[i];
    if (!(duration > 0)) continue;
    const Piece piece = BaseAt(base, times.at[i], 0.5 * (times.at[i] + times.at[i + 1]));
    const Profile::Range velocity = VelocityRange(piece, duration);
    needs.velocity = {std::min(needs.velocity.min, velocity.min), std::max(needs.velocity.max, velocity.max)};
    needs.acceleration =
        std::max({needs.acceleration, std::abs(piece.acceleration), std::abs(piece.At(duration).acceleration)});
    needs.jerk = std::max(needs.jerk, std::abs(piece.jerk));
  }
  return needs;
}

// Returns `wanted`, or the remainder if that is less; `wanted` if there is hardly a remainder, as the overlay must wait
// then.
double Leave(double wanted, double left, double own) {
  return left > kLeastShare * own ? std::min(wanted, left) : wanted;
}

// Limits the ramps to those that are always left. Returns false if they are too small.
bool LeaveRamps(const Limits& own, const Needs& needs, Limits& limits) {
  const double left = std::min(own.acceleration, own.deceleration) - needs.acceleration;
  const double jerk = own.jerk - needs.jerk;
  if (left < kLeastShare * std::min(own.acceleration, own.deceleration)) return false;
  if (own.jerk > 0 && jerk < kLeastShare * own.jerk) return false;
  limits.acceleration = std::min(limits.acceleration, left);
  limits.deceleration = std::min(limits.deceleration, left);
  if (own.jerk > 0) limits.jerk = std::min(limits.jerk, jerk);
  return true;
}

bool Late(const Profile& plan, double delay_s, Profile& late) {
  late = Profile{plan.start()};
  late.Append(delay_s, 0);
  if (!late.Append(plan)) return false;
  late.SnapEnd(plan.end());
  return true;
}

}  // namespace

bool SumKeeps(const AxisParams& params, const BaseAhead& base, const Profile& added) noexcept {
  const Limits own = params.planner_limits();
  const Times times = TimesOf(base, &added);
  const double fastest = own.velocity * (1 + kRounding);
  for (std::size_t i = 0; i + 1 < times.count; ++i) {
    const double begin = times.at[i];
    const double duration = times.at[i + 1] - begin;
    if (!(duration > 0)) continue;
    const double middle = begin + 0.5 * duration;
    const Piece under = BaseAt(base, begin, middle);
    const Piece over = PieceAt(added, begin, middle);
    const Piece sum = {under.position + over.position, under.velocity + over.velocity,
                       under.acceleration + over.acceleration, under.jerk + over.jerk};
    const Profile::Range velocity = VelocityRange(sum, duration);
    if (velocity.max > fastest || velocity.min < -fastest) return false;
    if (own.jerk > 0 && std::abs(sum.jerk) > own.jerk * (1 + kRounding)) return false;
    if (BreaksRamps(own, sum, duration)) return false;
    if (!KeepsPosition(params.limits, sum, duration)) return false;
  }
  return true;
}

Status PlanOverlay(const AxisParams& params, trajectory::Planner& planner, const BaseAhead& base,
                   const KinematicState& from, double target, const Limits& limits, Profile& added) noexcept {
  const Limits own = params.planner_limits();
  const Needs needs = NeedsOf(base);
  const bool up = target >= from.position;
  Limits at_once = limits;
  const double left = own.velocity - (up ? needs.velocity.max : -needs.velocity.min);
  at_once.velocity = Leave(limits.velocity, left, own.velocity);
  if (const Status status = planner.ToPosition(from, target, 0, at_once, added); status.failed()) return status;
  if (SumKeeps(params, base, added)) return Status::Ok();

  const Profile strongest = added;
  double ends_s = HUGE_VAL;
  Profile plan;
  Limits weaker = at_once;
  if (LeaveRamps(own, needs, weaker) && planner.ToPosition(from, target, 0, weaker, plan).ok() &&
      SumKeeps(params, base, plan)) {
    added = plan;
    ends_s = plan.duration();
  }
  if (from.velocity != 0 || from.acceleration != 0) return Status::Ok();
  const Times times = TimesOf(base, nullptr);
  for (std::size_t i = 0; i < times.count; ++i) {
    if (times.at[i] + strongest.duration() >= ends_s) break;
    if (!Late(strongest, times.at[i], plan) || !SumKeeps(params, base, plan)) continue;
    added = plan;
    break;
  }
  return Status::Ok();
}

}  // namespace takt::axis
