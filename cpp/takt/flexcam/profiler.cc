#include "takt/flexcam/profiler.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

constexpr double kSliver = 1e-9;  // of a cycle

double CyclesAt(const cam::Table& table, const ProfilerState& s, double x_total) {
  return (x_total - s.laid) / table.length();
}

std::int64_t CycleAt(const cam::Table& table, const ProfilerState& s, double x_total) {
  return static_cast<std::int64_t>(std::floor(CyclesAt(table, s, x_total) + kSliver));
}

double BeginOf(const cam::Table& table, const ProfilerState& s, std::int64_t cycle) {
  return s.laid + static_cast<double>(cycle) * table.length();
}

}  // namespace

ProfilerValue ValueAt(const cam::Table& table, const ProfilerState& s, double x_total) noexcept {
  ProfilerValue at;
  const std::int64_t cycle = s.once ? 0 : CycleAt(table, s, x_total);
  const double in_cycle = x_total - BeginOf(table, s, cycle);
  at.x = table.begin() + std::clamp(in_cycle, 0.0, table.length());
  const cam::Value value = table.At(at.x);
  at.y_in_cam = value.y;
  at.y = s.base + static_cast<double>(cycle) * table.stroke() + value.y;
  const double near = kSliver * table.length();
  const bool held = s.once && (in_cycle < -near || in_cycle > table.length() + near);
  at.dy = held ? 0 : value.dy;
  at.ddy = held ? 0 : value.ddy;
  return at;
}

void Lay(const cam::Table& table, double x_total, double x, bool once, ProfilerState& s) noexcept {
  s.laid = x_total - (x - table.begin());
  s.once = once;
  s.held = false;
  s.announced = false;
  s.cycle = 0;
  s.base = 0;
  if (once) return;
  s.laid = BeginOf(table, s, CycleAt(table, s, x_total));
}

std::optional<Passed> PassedEnd(const cam::Table& table, const ProfilerState& s, double x_total) noexcept {
  const std::int64_t cycle = CycleAt(table, s, x_total);
  if (s.once && s.held) return std::nullopt;
  if (cycle > s.cycle) return Passed{BeginOf(table, s, s.cycle + 1), 1};
  if (cycle < s.cycle) return Passed{BeginOf(table, s, s.cycle), -1};
  return std::nullopt;
}

void GoOn(const cam::Table& table, double x_total, ProfilerState& s) noexcept {
  const std::int64_t cycle = CycleAt(table, s, x_total);
  if (s.once) {
    s.held = cycle != 0;
  } else {
    s.cycle = cycle;
  }
}

void Change(const cam::Table& from, const cam::Table& to, const Passed& at, bool relative, bool once,
            ProfilerState& s) noexcept {
  const auto cycle = static_cast<double>(s.cycle);
  const double left = from.At(at.sense > 0 ? from.end() : from.begin()).y;
  const double was = s.base + cycle * from.stroke();  // the zero of the old cam's y in its cycle
  double base = was + (at.sense > 0 ? from.stroke() : -to.stroke());
  if (relative) base = was + left - to.At(at.sense > 0 ? to.begin() : to.end()).y;
  s.laid = at.sense > 0 ? at.x_total : at.x_total - to.length();
  s.base = base;
  s.cycle = 0;
  s.once = once;
  s.held = false;
}

bool AnnouncesEnd(const cam::Table& table, const Cycle& cycle, const KinematicState& x, bool passed,
                  ProfilerState& s) noexcept {
  const double t = cycle.period_s;
  const KinematicState next = {x.position + t * (x.velocity + 0.5 * t * x.acceleration), 0, 0};
  bool announce = passed && !s.announced;  // it was not expected
  if (passed) s.announced = false;
  const std::optional<Passed> ahead = PassedEnd(table, s, next.position);
  if (ahead && !s.announced && !announce) {
    announce = s.announced = true;
    s.announced_sense = ahead->sense;
  } else if (!ahead && s.announced && x.velocity * s.announced_sense <= 0) {
    s.announced = false;  // X did not reach it
  }
  return announce;
}

void describe(Description<ProfilerState>& d) {
  using S = ProfilerState;
  d.about("The cam on the X axis.");
  d.internal<&S::cam>("Number of the cam, from 0.");
  d.internal<&S::slot>("Slot from which the cam was taken.");
  d.internal<&S::laid>("Beginning of its cycle 0, over all cycles.");
  d.internal<&S::base>("Added to its y.");
  d.internal<&S::cycle>("Cycle in which X is.");
  d.internal<&S::once>("The cam runs once.");
  d.internal<&S::held>("An end position is held.");
  d.internal<&S::announced>("The end ahead was announced.");
  d.internal<&S::announced_sense>("Sense in which it was announced.");
}

void describe(Description<ProfilerValue>& d) {
  using V = ProfilerValue;
  d.about("Value of the cam.");
  d.internal<&V::x>("X in the cycle of the cam.");
  d.internal<&V::y_in_cam>("Y of the cam at that position.");
  d.internal<&V::y>("Y with strokes and base added.");
  d.internal<&V::dy>("Derivative over X.");
  d.internal<&V::ddy>("Second derivative over X.");
}

}  // namespace takt::flexcam
