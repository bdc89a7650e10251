#include "takt/conveyor/params.h"

#include <algorithm>
#include <cmath>

#include "takt/conveyor/texts.h"

namespace takt::conveyor {

namespace {

constexpr double kMeasuredFilter = 0.005;  // [s]
constexpr double kShaking = 300;           // [mm/s²] or [deg/s²], largest acceleration that encoder steps may cause
constexpr double kBand = 0.6;              // in steps: largest difference of the estimates at constant velocity
constexpr double kFaster = 5;              // ratio of the time constants
// lower bound of the fast time constant, as the dead time is extrapolated with it
constexpr double kOfDeadTime = 0.4;

}  // namespace

trajectory::TrackingFilter FilterOf(const BeltParams& params, double step, double period_s) noexcept {
  // A measured position is that at the begin of the cycle.
  const double dead_time_s = params.dead_time_s + (IsMeasured(params) ? period_s : 0);
  if (params.filter_s || !IsMeasured(params) || !(step > 0)) {
    const double filter_s = params.filter_s.value_or(IsMeasured(params) ? kMeasuredFilter : 0);
    return {.filter_s = filter_s, .dead_time_s = dead_time_s};
  }
  // Steps cause accelerations of up to 7 step / f² (trajectory::Track).
  const double filter_s = std::max(kMeasuredFilter, std::sqrt(7 * step / kShaking));
  return {.filter_s = filter_s,
          .fast_filter_s = std::max(filter_s / kFaster, kOfDeadTime * dead_time_s),
          .band = kBand * step,
          .dead_time_s = dead_time_s};
}

void describe(Enumeration<BeltKind>& e) {
  e.about("Direction in which a belt carries objects.");
  e.value(BeltKind::kStraight, "straight", "Along X of its origin.");
  e.value(BeltKind::kTurning, "turning", "About Z of its origin: a table.");
}

void describe(Description<BeltParams>& d) {
  using P = BeltParams;
  d.about(
      "A belt or a rotary table: it carries workpieces through the cell, and the tools of groups can synchronise with "
      "it.");
  d.required<&P::name>("Name of the belt, to which commands are addressed.");
  d.defaulted<&P::kind>("Direction in which it carries objects.");
  d.required<&P::axis>("Name of the axis that moves the belt, or only measures it.");
  d.defaulted<&P::source>("Position of the axis that counts: the set value or the actual value.");
  d.defaulted<&P::ratio>(Unit{"mm/u", "deg of a table per axis' unit"}, kRatios,
                         "Travel of the belt per unit of the axis; negative: opposite to the axis.");
  d.defaulted<&P::origin>("Pose in the world. X is the direction of travel; a table turns about Z.");
  d.defaulted<&P::lower_limit>(kAlong, kPlaces, "Start of the work range, from the origin; unset: unlimited.");
  d.defaulted<&P::upper_limit>(
      kAlong, kPlaces,
      "End of the work range, from the origin. A visible, untaken object beyond it is deleted. Unset: unlimited.");
  d.defaulted<&P::filter_s>(unit::s, between(0, 10),
                            "Time constant of the filter; constant speeds and accelerations pass without lag. Unset: "
                            "for an actual position 5 ms, or more where the resolution of its encoder requires it for "
                            "smooth motion, and down to a fifth while the speed changes; for a set position 0. With 0 "
                            "a set position is not filtered, an actual one as little as possible.");
  d.defaulted<&P::dead_time_s>(unit::s, between(0, 1),
                               "Age of the axis' position, by which the belt is extrapolated at its speed and "
                               "acceleration. The cycle that every actual position takes is compensated without it.");
  d.defaulted<&P::forget_after>(
      kAlong, between(0, 1e9),
      "Travel after which an object that was detected but not located is deleted; unset: never.");
  d.rule<&P::ratio>("must not be 0", [](const P& p) { return p.ratio != 0; });
  d.rule<&P::upper_limit>("must lie above lower_limit", [](const P& p) {
    return !p.lower_limit || !p.upper_limit || *p.lower_limit < *p.upper_limit;
  });
}

}  // namespace takt::conveyor
