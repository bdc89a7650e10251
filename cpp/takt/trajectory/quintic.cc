#include "takt/trajectory/quintic.h"

#include "takt/core/describe.h"

namespace takt::trajectory {

Quintic Connect(double length, const KinematicState& begin, const KinematicState& end) noexcept {
  const double h = end.position - begin.position;
  const double d0 = begin.velocity * length;
  const double d1 = end.velocity * length;
  const double b0 = begin.acceleration * length * length;
  const double b1 = end.acceleration * length * length;
  return {{begin.position, d0, 0.5 * b0, 10 * h - 6 * d0 - 4 * d1 - 1.5 * b0 + 0.5 * b1,
           -15 * h + 8 * d0 + 7 * d1 + 1.5 * b0 - b1, 6 * h - 3 * d0 - 3 * d1 - 0.5 * b0 + 0.5 * b1},
          length};
}

void describe(Description<Quintic>& d) {
  d.about("A polynomial of the fifth degree.");
  d.internal<&Quintic::c>("Coefficients over the fraction of the length.");
  d.internal<&Quintic::length>("Length of the curve; negative: the variable falls along it.");
}

}  // namespace takt::trajectory
