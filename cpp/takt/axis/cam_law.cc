#include "takt/axis/cam_law.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kNear = 1e-9;  // of a cycle

double Cycles(const CamLaw& law, const CamState& cam, double master) {
  return (master - cam.master) / law.way();
}

}  // namespace

double ShareOf(const CamLaw& law, const CamState& cam, double master) noexcept {
  const double share = Cycles(law, cam, master);
  return law.periodic ? share : std::clamp(share, 0.0, 1.0);
}

double WholeCycles(const CamLaw& law, const CamState& cam, double master) noexcept {
  return law.periodic ? std::floor(Cycles(law, cam, master) + kNear) : 0;
}

void BeginCycles(const CamLaw& law, double master, CamState& cam) noexcept {
  cam.master += WholeCycles(law, cam, master) * law.way();
}

cam::Value ValueAt(const CamLaw& law, const CamState& cam, double master) noexcept {
  const double share = Cycles(law, cam, master);
  const double cycle = law.periodic ? std::floor(share) : 0;
  const double x = law.table.begin() + law.ratio * (master - cam.master - cycle * law.way());
  const cam::Value at = law.table.At(x);
  const double y = cam.slave + law.scale * (cycle * law.table.stroke() + at.y);
  const bool held = !law.periodic && (share < -kNear || share > 1 + kNear);
  if (held) return {y, 0, 0, 0};
  const double slope = law.scale * law.ratio;
  return {y, slope * at.dy, slope * law.ratio * at.ddy, slope * law.ratio * law.ratio * at.dddy};
}

std::optional<double> EndPassed(double from, double to) noexcept {
  const double up = std::floor(to + kNear);
  if (to > from && up > std::floor(from + kNear)) return up;
  const double down = std::ceil(to - kNear);
  if (to < from && down < std::ceil(from - kNear)) return down;
  return std::nullopt;
}

void describe(Description<CamState>& d) {
  using C = CamState;
  d.about("Position of a cam over its master.");
  d.internal<&C::master>("Position of the master at which the cam begins.");
  d.internal<&C::slave>(unit::u, "Added to its y.");
  d.internal<&C::share>("Position of the master in the cam, in cycles.");
  d.internal<&C::end_axis>("Index of the master of the cam whose end was passed last.");
  d.internal<&C::end_master>("Position of the master at that end.");
  d.internal<&C::end_slave>(unit::u, "Position of this axis at that end.");
  d.internal<&C::over>("A buffered command may take over.");
}

}  // namespace takt::axis
