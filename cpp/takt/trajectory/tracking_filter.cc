#include "takt/trajectory/tracking_filter.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::trajectory {

namespace {

// Least time constant in cycles; with 2.2 the filter would no longer settle, since its jerk changes only once a cycle.
constexpr double kFastest = 3;
constexpr double kFollows = 3.5;  // speed relative to that of the slow estimate, if there are two

KinematicState After(const KinematicState& x, double jerk, double t) {
  return {x.position + t * (x.velocity + t * (0.5 * x.acceleration + t * jerk / 6)),
          x.velocity + t * (x.acceleration + 0.5 * t * jerk), x.acceleration + t * jerk};
}

TrackingEstimate Ahead(const TrackingEstimate& x, double t) {
  return {After(x.state, x.jerk, t), x.jerk};
}

TrackingEstimate Between(const TrackingEstimate& from, const TrackingEstimate& to, double share) {
  const KinematicState &a = from.state, &b = to.state;
  return {{std::lerp(a.position, b.position, share), std::lerp(a.velocity, b.velocity, share),
           std::lerp(a.acceleration, b.acceleration, share)},
          std::lerp(from.jerk, to.jerk, share)};
}

// Advances the estimate by one cycle of t [s], with all poles of the error equal.
void Correct(double filter_s, double t, double position, TrackingEstimate& estimate) {
  const double fresh = -maths::Expm1(-t / filter_s);
  const double pole = 1 - fresh;
  const double square = fresh * fresh;
  estimate = Ahead(estimate, t);
  KinematicState& x = estimate.state;
  const double missed = position - x.position;
  x.position += (1 - pole * pole * pole * pole) * missed;
  x.velocity += square * (11 + pole * (14 + 11 * pole)) / (6 * t) * missed;
  x.acceleration += 2 * square * fresh * (1 + pole) / (t * t) * missed;
  estimate.jerk += square * square / (t * t * t) * missed;
}

}  // namespace

KinematicState Track(const TrackingFilter& filter, double period_s, double position, double velocity,
                     TrackingFilterState& f) noexcept {
  const double t = period_s;
  const bool two = filter.fast_filter_s > 0;
  if (!f.running) {
    f.running = true;
    f.slow = f.fast = {{position, velocity, 0}, 0};
    f.state = After(f.slow.state, 0, filter.dead_time_s);
    return f.state;
  }
  const double fastest = kFastest * t;
  Correct(std::max(filter.filter_s, fastest), t, position, f.slow);
  TrackingEstimate measured = f.slow;
  if (two) {
    Correct(std::max(filter.fast_filter_s, fastest), t, position, f.fast);
    const double gap = std::abs(f.fast.state.position - f.slow.state.position);
    if (gap > filter.band) measured = Between(f.slow, f.fast, 1 - filter.band / gap);
  }
  const double w = 1 / std::max(filter.filter_s / (two ? kFollows : 1), fastest);
  const KinematicState aim = After(measured.state, measured.jerk, filter.dead_time_s);
  const KinematicState expected = After(f.state, measured.jerk, t);
  const double jerk =
      measured.jerk + w * (3 * (aim.acceleration - expected.acceleration) +
                           w * (3 * (aim.velocity - expected.velocity) + w * (aim.position - expected.position)));
  f.state = After(f.state, jerk, t);
  return f.state;
}

void describe(Description<TrackingEstimate>& d) {
  d.about("Estimated motion at the time of the measurement.");
  d.internal<&TrackingEstimate::state>("Position, velocity and acceleration.");
  d.internal<&TrackingEstimate::jerk>("Jerk.");
}

void describe(Description<TrackingFilterState>& d) {
  d.about("State of the filter of a measured position.");
  d.internal<&TrackingFilterState::slow>("The slow estimate, or the only one.");
  d.internal<&TrackingFilterState::fast>("The fast estimate.");
  d.internal<&TrackingFilterState::state>("Estimate of the present motion.");
  d.internal<&TrackingFilterState::running>("A first value has been received.");
}

}  // namespace takt::trajectory
