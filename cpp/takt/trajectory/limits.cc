#include "takt/trajectory/limits.h"

#include "takt/core/describe.h"

namespace takt::trajectory {

void describe(Description<Limits>& d) {
  d.about("How fast a motion may change.");
  d.internal<&Limits::velocity>("u/s.");
  d.internal<&Limits::acceleration>("u/s², while the speed grows.");
  d.internal<&Limits::deceleration>("u/s², while the speed falls.");
  d.internal<&Limits::jerk>("u/s³; 0: unlimited.");
}

}  // namespace takt::trajectory
