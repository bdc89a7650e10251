#include "takt/trajectory/path_pace.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::trajectory {

namespace {

constexpr double kOnNode = 1e-9;   // [mm]
constexpr double kLanding = 0.99;  // share of the deceleration; the rest is for stopping exactly

struct RawLimits {
  double low = 0;
  double high = 0;
};

// Returns the largest acceleration for one cycle after which the squared speed can still be brought down to `square`
// within the distance left, with `deceleration`, once the speed has been held for `hold_s`.
double BeforeSlower(double v, double left, double square, double deceleration, double hold_s, double period_s) {
  // With u = v + a h: (v + u) h / 2 + u hold + (u² - square) / (2 d) = left.
  const double linear = deceleration * (0.5 * period_s + hold_s);
  const double room = 2 * deceleration * (left - 0.5 * v * period_s) + square;
  const double later = room > 0 ? std::sqrt(linear * linear + room) - linear : 0;
  return (later - v) / period_s;
}

// Returns the bounds of the acceleration up to the next node. From below the ceiling of a node any acceleration within
// them leads below the ceiling of the next node.
RawLimits RawLimitsOf(const PathWindow& window, const PathPace& pace, double period_s, bool full = false) {
  const PathNode& node = window[pace.node];
  const PathNode& next = window[pace.node + 1];
  const double v = pace.raw.velocity;
  const double left = std::max(next.at.s - pace.raw.position, kOnNode);
  // The speed may have changed since the node was reached.
  RawLimits limits{std::max(node.bounds.Least(pace.entered, full), node.bounds.Least(v * v, full)),
                   std::min(node.bounds.Most(pace.entered), node.bounds.Most(v * v))};
  const auto to_reach = [&](double square) { return (square - v * v) / (2 * left); };
  double ahead = to_reach(next.ceiling);
  double coasting = to_reach(next.coast);
  const double landing = next.ceiling == 0 ? kLanding : 1;
  if (ahead > landing * limits.low && limits.low < 0) {  // not braking yet
    const double later = BeforeSlower(v, left, next.ceiling, -landing * limits.low, 0, period_s);
    if (v + 0.5 * later * period_s <= left / period_s) ahead = later;
    if (next.ceiling == 0) coasting = BeforeSlower(v, left, 0, -landing * limits.low, node.build_up_s, period_s);
  }
  limits.high = std::min({limits.high, ahead, std::max(0.0, coasting)});
  limits.low = std::min(limits.low, limits.high);
  return limits;
}

double NextAcceleration(const PathWindow& window, double wish, double period_s, bool full, PathPace& pace) {
  const RawLimits limits = RawLimitsOf(window, pace, period_s, full);
  // Relative to the acceleration that leaves the mean in this cycle.
  const PathNode& node = window[pace.node];
  const double square = std::max(pace.entered, pace.raw.velocity * pace.raw.velocity);
  double strength = node.bounds.strength.At(square);
  const double wanted = (wish - pace.raw.velocity) / period_s;
  if (pace.eased > 0 || wanted < limits.high) strength *= node.bounds.strength.gentle;
  const double build_up = node.at.limits.jerk * node.build_up_s;
  const double change = std::min(build_up, strength);
  const double before = pace.last[pace.oldest].acceleration;
  // Braking may be released at once: where it cannot be strong it would continue to a stop.
  const double released = std::min(0.0, before + build_up);
  const double most = std::min(std::max(before + change, released), strength);
  // Ceilings have priority over every other bound.
  const double high = std::min(limits.high, std::max(most, limits.low));
  const double least = std::max({limits.low, before - (full ? strength : change), -strength});
  const double a = std::clamp(std::min(high, wanted), std::min(least, high), high);
  if (wanted < high) {
    pace.eased = pace.cycles;
  } else if (pace.eased > 0 && a == limits.high) {
    --pace.eased;
  }
  return a;
}

// One cycle of the raw motion: an acceleration holds up to the next node at most.
PathCycle StepRaw(const PathWindow& window, double wish, double period_s, bool full, PathPace& pace) {
  const auto at_end = [&] { return pace.node + 1 >= window.known() || window[pace.node].stop; };
  PathCycle cycle{pace.raw.position, pace.raw.velocity, 0, 0};
  double left_s = period_s;
  double sum = 0;  // of the position relative to the start of the cycle, over time
  while (left_s > 0 && !at_end()) {
    const double s = pace.raw.position;
    const double v = pace.raw.velocity;
    const double a = NextAcceleration(window, wish, period_s, full, pace);
    const double way = window[pace.node + 1].at.s - s;
    // Time until the motion is at the next node, or at rest.
    double time = left_s;
    bool arrives = false;
    bool rests = false;
    const double square = v * v + 2 * a * way;
    if (square >= 0) {
      const double speed_sum = v + std::sqrt(square);
      // Two nodes may lie at the same arc length.
      const double arrival = way <= kOnNode ? 0 : speed_sum > 0 ? 2 * way / speed_sum : left_s * 2;
      arrives = arrival <= left_s;
      if (arrives) time = arrival;
    } else if (a < 0 && -v / a < left_s) {
      time = -v / a;
      rests = true;
    }
    sum += time * (s - cycle.position + time * (0.5 * v + time * a * (1.0 / 6)));
    left_s -= time;
    pace.raw = {s + time * (v + 0.5 * time * a), rests ? 0 : std::max(0.0, v + time * a), a};
    if (arrives) {
      pace.raw.position = window[pace.node + 1].at.s;
      pace.raw.velocity = std::sqrt(std::max(0.0, square));
      do {
        ++pace.node;
      } while (!at_end() && window[pace.node + 1].at.s <= pace.raw.position);
      pace.entered = pace.raw.velocity * pace.raw.velocity;
    } else if (pace.raw.velocity == 0) {
      // At rest between nodes, or on the stop except for rounding.
      if (window[pace.node + 1].ceiling == 0 && way - time * 0.5 * v < kOnNode) ++pace.node;
      break;
    }
  }
  if (at_end()) pace.raw = {window[pace.node].at.s, 0, 0};
  pace.raw_stands = at_end();
  sum += left_s * (pace.raw.position - cycle.position);
  cycle.acceleration = (pace.raw.velocity - cycle.velocity) / period_s;
  cycle.ahead = sum / period_s;
  return cycle;
}

// Returns the mean of the raw motion.
KinematicState Mean(const PathPace& pace, double period_s) {
  double sum = 0;
  for (std::uint32_t i = 0; i < pace.cycles; ++i) {
    sum += pace.last[i].position - pace.raw.position + pace.last[i].ahead;
  }
  const double time = pace.cycles * period_s;
  const PathCycle& oldest = pace.last[pace.oldest];
  return {pace.raw.position + sum / pace.cycles, (pace.raw.position - oldest.position) / time,
          (pace.raw.velocity - oldest.velocity) / time};
}

}  // namespace

void BeginAt(const PathWindow& window, std::uint64_t node, double period_s, PathPace& pace) noexcept {
  pace = {};
  pace.node = pace.passed = node;
  pace.now = pace.raw = {window[node].at.s, 0, 0};
  pace.raw_stands = false;
  const double cycles = std::round(window[node].build_up_s / period_s);
  pace.cycles = static_cast<std::uint32_t>(std::clamp(cycles, 1.0, static_cast<double>(kMostBuildUpCycles)));
  std::fill_n(pace.last.begin(), pace.cycles, PathCycle{pace.raw.position, 0, 0, 0});
}

void Advance(const PathWindow& window, double wish, double period_s, PathPace& pace, bool full) noexcept {
  pace.last[pace.oldest] = StepRaw(window, wish, period_s, full, pace);
  pace.oldest = (pace.oldest + 1) % pace.cycles;
  pace.now = Mean(pace, period_s);
  while (pace.passed < pace.node && window[pace.passed + 1].at.s <= pace.now.position) ++pace.passed;
}

bool GoesOn(const PathWindow& window, const PathPace& pace, double period_s) noexcept {
  if (pace.raw_stands || pace.node + 1 >= window.known() || window[pace.node].stop) return true;
  const PathNode& node = window[pace.node];
  const double square = std::max(pace.entered, pace.raw.velocity * pace.raw.velocity);
  const double change = std::min(node.at.limits.jerk * node.build_up_s, node.bounds.strength.At(square));
  const double least = std::max(-node.bounds.deceleration, pace.last[pace.oldest].acceleration - change);
  return RawLimitsOf(window, pace, period_s).high >= least - 1e-9 * node.bounds.deceleration;
}

bool Stands(const PathPace& pace) noexcept {
  return pace.raw.velocity == 0 && pace.now.velocity == 0 && pace.now.acceleration == 0;
}

void describe(Description<PathCycle>& d) {
  d.about("The raw motion in one cycle.");
  d.internal<&PathCycle::position>("Position at the beginning of the cycle.");
  d.internal<&PathCycle::velocity>("Velocity at the beginning of the cycle.");
  d.internal<&PathCycle::acceleration>("Mean acceleration over the cycle.");
  d.internal<&PathCycle::ahead>("Mean position minus that at the beginning of the cycle.");
}

void describe(Description<PathBrake>& d) {
  d.about("Limits with which a motion along a path is braked.");
  d.internal<&PathBrake::deceleration>("Largest deceleration; 0: that of the path.");
  d.internal<&PathBrake::jerk>("Largest jerk; 0: that of the path.");
  d.internal<&PathBrake::full>("Braked as hard as the coordinates allow, whatever the limits along the path.");
}

void describe(Description<PathPace>& d) {
  using P = PathPace;
  d.about("State of a motion along a path.");
  d.internal<&P::now>("Motion along the path: the mean of the raw motion.");
  d.internal<&P::raw>("Raw motion, ahead of the mean.");
  d.internal<&P::node>("Last node of the window that the raw motion has reached.");
  d.internal<&P::passed>("Last node of the window that the mean has reached.");
  d.internal<&P::entered>("Squared speed of the raw motion at node.");
  d.internal<&P::raw_stands>("The raw motion is at a stop or at the end of the known path.");
  d.internal<&P::eased>("Cycles left before the full acceleration cap applies again.");
  d.internal<&P::cycles>("Number of cycles in the mean.");
  d.internal<&P::oldest>("Index of the oldest cycle.");
  d.internal<&P::last>("Raw motion in the cycles of the mean.");
}

}  // namespace takt::trajectory
