// The end of a profile, predicted to the cycle, and the gripper's pulse before it (PP-30).
#include <cmath>
#include <optional>

#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using trajectory::PathPace;
using trajectory::PathWindow;

constexpr double kThere = 1e-6;  // [mm]
// Cycles that the scout runs in one cycle: fewer than the group's rehearsal, which may still slow the motion down where
// it runs.
constexpr int kScouted = 16;
// The same where the rehearsal is complete.
constexpr int kScoutedBehind = 64;
// Cycles before the pulse may be due in which each cycle is checked.
constexpr std::uint64_t kEarly = 3;

// Returns the arc length on the path at which a move ends; nothing if it is not planned to its end.
std::optional<double> EndOf(const group::LookAhead& ahead, std::uint64_t move) {
  const PathWindow& window = ahead.window;
  for (std::uint64_t i = ahead.end(); i > ahead.first; --i) {
    const group::Stretch& stretch = ahead[i - 1];
    if (stretch.move != move) continue;
    const bool known =
        window.swept() && window.known() > window.begin() && window[window.known() - 1].at.s >= stretch.end() - kThere;
    return known ? std::optional(stretch.end()) : std::nullopt;
  }
  return std::nullopt;
}

// Advances the pace in the same way as the group does.
void Advance(const PathWindow& window, double period_s, PathPace& pace) {
  const std::uint64_t next = pace.node + 1;
  if (pace.raw_stands && trajectory::Stands(pace) && window[pace.node].stop && next + 1 < window.known()) {
    trajectory::BeginAt(window, next, period_s, pace);
  }
  trajectory::Advance(window, trajectory::kFullSpeed, period_s, pace);
}

bool IsThere(const PathPace& pace, double end) {
  return trajectory::Stands(pace) && pace.now.position >= end - kThere;
}

bool ArrivesWithin(const PathWindow& window, double end, std::uint64_t cycles, double period_s, PathPace pace) {
  for (std::uint64_t i = 0; i < cycles; ++i) {
    Advance(window, period_s, pace);
    if (IsThere(pace, end)) return true;
  }
  return false;
}

bool IsOnItsWay(const group::State& g, const Order& order) {
  return order.phase == Phase::kGoing && g.begun && !g.ends && !g.interrupted && g.done >= order.first &&
         g.done <= order.last;
}

// Runs ahead of the group to the end of an order.
void GoOn(const Context& c, double end, int cycles, EndPredictor& scout) {
  for (int i = 0; i < cycles && !scout.known; ++i) {
    Advance(c.group.ahead.window, c.group.cycle.period_s, scout.pace);
    ++scout.cycle;
    scout.known = IsThere(scout.pace, end);
  }
  scout.end_cycle = scout.cycle;
}

double TimeOf(const Context& c, const Order& order, const EndPredictor& scout) {
  return static_cast<double>(scout.end_cycle - order.begin_cycle) * c.group.cycle.period_s;
}

void StepScout(const Context& c, const group::State& g, const Order& order, double end, State& s) {
  EndPredictor& scout = s.scout;
  if (scout.known) return;
  if (!scout.running) {
    scout = {.running = true, .order_last = order.last, .cycle = c.group.cycle.count - 1, .pace = g.pace};
  }
  // A law that leads to the end determines its time; a law that is to be replaced does not.
  if (const trajectory::PathTiming& timing = c.group.ahead.timing; timing.active()) {
    scout.known = timing.IsFinalTo(end);
    scout.end_cycle = scout.cycle = c.group.cycle.count - 1 + timing.rest_cycles();
  } else {
    GoOn(c, end, kScouted, scout);
  }
  if (!scout.known) return;
  s.profile_time = TimeOf(c, order, scout);
  Learn(s.profile_time, order, s);
}

// Runs from the end of the first order to that of the second one, so that its time is known when it begins. Repeated
// then: axes that have to keep up may make it longer.
void StepNextScout(const Context& c, State& s) {
  EndPredictor& scout = s.next_scout;
  if (!s.scout.known || scout.known || s.order_count < 2 || c.group.ahead.timing.active()) return;
  const Order& order = s.orders[1];
  if (order.phase != Phase::kGoing || c.group.ahead.rehearsal.end_cycle() == 0) return;
  const std::optional<double> end = EndOf(c.group.ahead, order.last);
  if (!end) return;
  if (scout.order_last != order.last) {
    scout = {.running = true, .order_last = order.last, .cycle = s.scout.end_cycle, .pace = s.scout.pace};
  }
  GoOn(c, *end, kScoutedBehind, scout);
}

}  // namespace

void StepGripper(const Context& c, const group::State& g, State& s) noexcept {
  if (s.order_count == 0) return;
  Order& order = s.orders[0];
  if (HasOverride(g, s)) {
    order.gripper_off = true;
    s.next_scout = {};
  }
  if (!IsOnItsWay(g, order)) {
    if (s.scout.order_last == order.last) s.next_scout = {};  // it does not continue at the expected time
    return;
  }
  if (s.scout.order_last != order.last) {
    order.begin_cycle = c.group.cycle.count - 1;
    const bool known = s.next_scout.known && s.next_scout.order_last == order.last;
    s.profile_time = known ? TimeOf(c, order, s.next_scout) : 0;
    s.scout = s.next_scout = {};
    s.scout.order_last = order.last;
  }
  const std::optional<double> end = EndOf(c.group.ahead, order.last);
  if (!end) return;
  StepScout(c, g, order, *end, s);
  StepNextScout(c, s);
  if (order.gripper_time <= 0 || order.gripper_off || order.pulse_at_end || order.pulsed || !s.scout.known) return;
  const double period = c.group.cycle.period_s;
  const auto before = static_cast<std::uint64_t>(std::llround(order.gripper_time / period));
  if (c.group.cycle.count + before + kEarly < s.scout.end_cycle) return;
  // The state after this cycle is its first step.
  const trajectory::PathTiming& timing = c.group.ahead.timing;
  if (timing.active() ? timing.rest_cycles() > before + 1
                      : !ArrivesWithin(c.group.ahead.window, *end, before + 1, period, g.pace)) {
    return;
  }
  s.pulse = order.pulsed = true;
}

}  // namespace takt::pickplace
