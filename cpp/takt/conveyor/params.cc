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
  e.about("How a belt carries.");
  e.value(BeltKind::kStraight, "straight", "Along X of its origin.");
  e.value(BeltKind::kTurning, "turning", "About Z of its origin: a table.");
}

void describe(Description<BeltParams>& d) {
  using P = BeltParams;
  d.about("A belt, or a table that turns: it carries workpieces through the cell, and groups can go along with it.");
  d.required<&P::name>("Of the belt; commands go to it.");
  d.defaulted<&P::kind>("How it carries.");
  d.required<&P::axis>("Name of the axis that moves it, or that only measures it.");
  d.defaulted<&P::source>("Whether the axis' set position or its measured one counts.");
  d.defaulted<&P::ratio>(Unit{"mm/u", "deg of a table per axis' unit"}, kRatios,
                         "How far it goes while the axis goes one unit; below 0: against the axis.");
  d.defaulted<&P::origin>("In the world. X is the direction of travel; a table turns about Z.");
  d.defaulted<&P::lower_limit>(kAlong, kPlaces, "Where the work range begins, seen from the origin; unset: nowhere.");
  d.defaulted<&P::upper_limit>(kAlong, kPlaces,
                               "Where it ends; an object beyond it that nobody has taken is deleted. Unset: nowhere.");
  d.defaulted<&P::filter_s>(
      unit::s, between(0, 10),
      "Time constant of the filter; a constant speed and acceleration pass without lag. Unset: where the axis is "
      "measured 5 ms, or as many as its encoder's steps need not to shake the tool, and a fifth where the speed "
      "changes; else 0. A set position is not filtered with 0, a measured one as little as can be.");
  d.defaulted<&P::dead_time_s>(unit::s, between(0, 1),
                               "The belt is taken to be so much further on than its axis says, at its speed and "
                               "acceleration. The cycle that passes anyway is made good without it.");
  d.defaulted<&P::forget_after>(
      kAlong, between(0, 1e9),
      "An object that was detected but not located is deleted once it has travelled so far; unset: never.");
  d.rule<&P::ratio>("must not be 0", [](const P& p) { return p.ratio != 0; });
  d.rule<&P::upper_limit>("must lie above lower_limit", [](const P& p) {
    return !p.lower_limit || !p.upper_limit || *p.lower_limit < *p.upper_limit;
  });
}

}  // namespace takt::conveyor
