#include "takt/axis/overshoot_guard.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/trajectory/planner.h"

namespace takt::axis {

using trajectory::Profile;

namespace {

constexpr int kBisections = 48;
constexpr double kSwing = 1e-6;  // share of a speed that counts as 0

// Interpolates two limits so that the time they imply (of a stop) grows evenly. 0: unlimited.
double Between(double weak, double strong, double share) {
  const double inverse = (1 - share) * (weak > 0 ? 1 / weak : 0) + share * (strong > 0 ? 1 / strong : 0);
  return inverse > 0 ? 1 / inverse : 0;
}

// A motion planned anew on its braking curve ends at its target but for this rounding.
double Slack(double position, double way) {
  return Rounding(position) + 2e-8 * std::abs(way);
}

// Returns true if a motion that starts in this sense gets beyond `furthest`.
bool Passes(const Profile& profile, double sense, double furthest) {
  const Profile::Range range = profile.PositionRange();
  const double slack = Slack(furthest, furthest - profile.start().position);
  return sense > 0 ? range.max > furthest + slack : range.min < furthest - slack;
}

bool TurnsRound(const AxisParams& params, const Profile& profile) {
  const Profile::Range velocity = profile.VelocityRange();
  const double slack = 1e-9 * params.limits.velocity;
  const double start = profile.start().velocity;
  return (start > 0 && velocity.min < -slack) || (start < 0 && velocity.max > slack);
}

// Returns true if the present deceleration outlasts the speed, so that a stop must swing back. `margin`: relative
// tolerance.
bool SwingsBack(const KinematicState& from, double jerk, double margin) {
  const bool brakes = from.velocity * from.acceleration < 0;
  return brakes && jerk > 0 &&
         from.acceleration * from.acceleration > 2 * jerk * std::abs(from.velocity) * (1 + margin);
}

}  // namespace

double SenseOfTravel(const KinematicState& from) noexcept {
  const double running = from.velocity != 0 ? from.velocity : from.acceleration;
  return running < 0 ? -1 : 1;
}

bool Overshoots(const Profile& profile, double target) noexcept {
  return Passes(profile, target < profile.start().position ? -1 : 1, target);
}

bool BreaksGuard(const AxisParams& params, const OvershootGuard& guard, const Profile& profile) noexcept {
  const double sense = SenseOfTravel(profile.start());
  return (guard.furthest && Passes(profile, sense, *guard.furthest)) || (guard.straight && TurnsRound(params, profile));
}

bool StopsBy(const KinematicState& state, const trajectory::Limits& limits, double furthest) noexcept {
  if (SwingsBack(state, limits.jerk, kSwing)) return false;
  const double over = trajectory::StopPosition(state, limits) - furthest;
  return SenseOfTravel(state) * over <= Slack(furthest, furthest - state.position);
}

Request WithStrongerRamps(const AxisParams& params, const KinematicState& from, const Request& request,
                          const OvershootGuard& guard) noexcept {
  const trajectory::Limits own = params.planner_limits();
  const double sense = SenseOfTravel(from);
  const auto with = [&](double share) {
    Request r = request;
    r.deceleration = Between(request.deceleration, own.deceleration, share);
    r.jerk = Between(request.jerk, own.jerk, share);
    return r;
  };
  const auto keeps = [&](double share) {
    const trajectory::Limits limits = with(share).limits();
    if (guard.straight && SwingsBack(from, limits.jerk, -kSwing)) return false;
    return !guard.furthest || sense * (trajectory::StopPosition(from, limits) - *guard.furthest) <= 0;
  };
  double low = 0;
  double high = 1;
  for (int i = 0; keeps(1) && i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (keeps(middle) ? high : low) = middle;
  }
  return with(high);
}

}  // namespace takt::axis
