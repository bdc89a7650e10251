#include "takt/axis/promise.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/trajectory/planner.h"

namespace takt::axis {

using trajectory::Profile;

namespace {

constexpr int kBisections = 48;

// Between two limits so that what takes time (stopping) grows evenly. 0: unlimited.
double Between(double weak, double strong, double share) {
  const double inverse = (1 - share) * (weak > 0 ? 1 / weak : 0) + share * (strong > 0 ? 1 / strong : 0);
  return inverse > 0 ? 1 / inverse : 0;
}

// Planned anew on its braking curve a motion ends at its target but for rounding.
double Slack(double position, double way) {
  return Rounding(position) + 1e-8 * std::abs(way);
}

}  // namespace

double SenseOfTravel(const KinematicState& from) noexcept {
  const double running = from.velocity != 0 ? from.velocity : from.acceleration;
  return running < 0 ? -1 : 1;
}

bool Passes(const Profile& profile, double sense, double furthest) noexcept {
  const Profile::Range range = profile.PositionRange();
  const double slack = Slack(furthest, furthest - profile.start().position);
  return sense > 0 ? range.max > furthest + slack : range.min < furthest - slack;
}

bool Overshoots(const Profile& profile, double target) noexcept {
  return Passes(profile, target < profile.start().position ? -1 : 1, target);
}

Request Strengthened(const AxisParams& params, const KinematicState& from, const Request& request,
                     double furthest) noexcept {
  const trajectory::Limits own = params.planner_limits();
  const double sense = SenseOfTravel(from);
  const auto with = [&](double share) {
    Request r = request;
    r.deceleration = Between(request.deceleration, own.deceleration, share);
    r.jerk = Between(request.jerk, own.jerk, share);
    return r;
  };
  const auto stops = [&](double share) {
    return sense * (trajectory::StopPosition(from, with(share).limits()) - furthest) <= 0;
  };
  double low = 0;
  double high = 1;
  for (int i = 0; stops(1) && i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (stops(middle) ? high : low) = middle;
  }
  return with(high);
}

}  // namespace takt::axis
