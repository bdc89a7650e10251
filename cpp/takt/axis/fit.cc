#include "takt/axis/fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/trajectory/planner.h"

namespace takt::axis {

using trajectory::Piece;
using trajectory::Profile;

namespace {

constexpr double kTolerance = 1e-9;  // of a limit
// Share of the velocity limit below which a velocity counts as standstill, where speed neither grows nor falls.
constexpr double kStanding = 1e-6;
// Number of instants at which a stop is tried in a motion that reverses. Between them its end changes little: it is
// stationary where it is furthest.
constexpr int kStopsLookedAt = 128;

bool BreaksVelocity(const AxisLimits& limits, const KinematicState& from, const Profile& profile) {
  const Profile::Range range = profile.VelocityRange();
  const double fastest = std::max(limits.velocity, std::abs(from.velocity)) * (1 + kTolerance);
  return range.max > fastest || range.min < -fastest;
}

// Within one piece and one sense of travel the acceleration is largest at one of both ends.
bool BreaksRamp(const trajectory::Limits& own, const Piece& piece, double begin, double end) {
  const KinematicState middle = piece.At(0.5 * (begin + end));
  if (std::abs(middle.velocity) < kStanding * own.velocity) return false;
  const double sense = middle.velocity < 0 ? -1 : 1;
  for (const double t : {begin, end}) {
    const double growing = sense * piece.At(t).acceleration;
    const double limit = growing > 0 ? own.acceleration : own.deceleration;
    if (std::abs(growing) > limit * (1 + kTolerance)) return true;
  }
  return false;
}

bool BreaksAcceleration(const AxisParams& params, const Profile& profile) {
  const trajectory::Limits own = params.planner_limits();
  double begin = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(profile.size()); ++i) {
    const double duration = profile.piece_ends_s[i] - begin;
    begin = profile.piece_ends_s[i];
    if (BreaksRamps(own, profile.pieces[i], duration)) return true;
  }
  return false;
}

// Returns the range that a motion passes, or would pass if the axis were stopped during it. A motion that reverses
// passes standstill with an acceleration, which a stop begun just before must end first, and so gets further.
Profile::Range Reach(const AxisParams& params, const Profile& profile) {
  const Profile::Range velocity = profile.VelocityRange();
  Profile::Range reach = profile.PositionRange();
  if (velocity.min >= 0 || velocity.max <= 0) return reach;
  const trajectory::Limits own = params.planner_limits();
  const double step = profile.duration() / kStopsLookedAt;
  for (int i = 0; i < kStopsLookedAt; ++i) {
    const double stop = trajectory::StopPosition(profile.At(i * step), own);
    reach.min = std::min(reach.min, stop);
    reach.max = std::max(reach.max, stop);
  }
  return reach;
}

bool BreaksPosition(const AxisParams& params, const KinematicState& from, const Profile& profile) {
  const AxisLimits& limits = params.limits;
  if (!limits.lower && !limits.upper) return false;
  const Profile::Range reach = Reach(params, profile);
  return (limits.lower && reach.min < std::min(*limits.lower, from.position) - Rounding(*limits.lower)) ||
         (limits.upper && reach.max > std::max(*limits.upper, from.position) + Rounding(*limits.upper));
}

bool TurnsRound(const AxisLimits& limits, const KinematicState& from, const Profile& profile) {
  const Profile::Range range = profile.VelocityRange();
  const double slack = kTolerance * limits.velocity;
  return (from.velocity > slack && range.min < -slack) || (from.velocity < -slack && range.max > slack);
}

// Returns true if the SW limits are further away than any stop gets: its highest speed, for the time to end the
// acceleration and to brake then. This costs half of planning the stop, and suffices for nearly all of the travel.
bool StopsFarInside(const AxisParams& p, const KinematicState& x) {
  const AxisLimits& l = p.limits;
  if (!l.lower && !l.upper) return true;
  const double deceleration = l.deceleration.value_or(l.acceleration);
  const double per_jerk = 1 / l.jerk;
  const double speed = std::abs(x.velocity) + 0.5 * x.acceleration * x.acceleration * per_jerk;
  const double reach = speed * ((std::abs(x.acceleration) + deceleration) * per_jerk + speed / deceleration);
  return (!l.lower || x.position - reach > *l.lower + Rounding(*l.lower)) &&
         (!l.upper || x.position + reach < *l.upper - Rounding(*l.upper));
}

}  // namespace

Profile::Range RangeOfStop(const AxisParams& p, const KinematicState& x) noexcept {
  const trajectory::Limits own = p.planner_limits();
  const double stop = trajectory::StopPosition(x, own);
  double turn = x.position;
  const double rest = x.acceleration * x.acceleration - 2 * own.jerk * std::abs(x.velocity);
  if (x.velocity * x.acceleration < 0 && own.jerk > 0 && rest > 0) {
    const double t = (std::abs(x.acceleration) - std::sqrt(rest)) / own.jerk;
    turn = Piece{x.position, x.velocity, x.acceleration, std::copysign(own.jerk, x.velocity)}.At(t).position;
  }
  return {std::min({stop, turn, x.position}), std::max({stop, turn, x.position})};
}

bool CanStopInside(const AxisParams& p, const KinematicState& before, const KinematicState& next,
                   double slack) noexcept {
  if (StopsFarInside(p, next)) return true;
  const Profile::Range range = RangeOfStop(p, next);
  const bool too_high = p.limits.upper && range.max > *p.limits.upper + slack && range.max > before.position;
  const bool too_low = p.limits.lower && range.min < *p.limits.lower - slack && range.min < before.position;
  return !too_high && !too_low;
}

bool BreaksRamps(const trajectory::Limits& own, const Piece& piece, double duration) noexcept {
  std::array<double, 4> cuts = {0, 0, 0, duration};
  const std::array<double, 2> zeros = piece.VelocityZeros();
  for (std::size_t k = 0; k < 2; ++k) cuts[k + 1] = zeros[k] > cuts[k] && zeros[k] < duration ? zeros[k] : cuts[k];
  for (std::size_t k = 0; k < 3; ++k) {
    if (cuts[k + 1] > cuts[k] && BreaksRamp(own, piece, cuts[k], cuts[k + 1])) return true;
  }
  return false;
}

bool Inside(const AxisLimits& limits, double position) noexcept {
  return !(limits.lower && position < *limits.lower - Rounding(*limits.lower)) &&
         !(limits.upper && position > *limits.upper + Rounding(*limits.upper));
}

LimitedBy Breaks(const AxisParams& params, const KinematicState& from, const Profile& profile,
                 const Demands& demands) noexcept {
  if (BreaksVelocity(params.limits, from, profile)) return LimitedBy::kVelocity;
  if (BreaksAcceleration(params, profile)) return LimitedBy::kAcceleration;
  if (demands.position && BreaksPosition(params, from, profile)) return LimitedBy::kPosition;
  if (demands.straight && TurnsRound(params.limits, from, profile)) return LimitedBy::kJerk;
  return LimitedBy::kNothing;
}

}  // namespace takt::axis
