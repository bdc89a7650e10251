#include "takt/part/outputs.h"

#include "takt/core/describe.h"

namespace takt::part {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PartOutputs");
  d.about("State of a part of the surface after a cycle.");
  d.internal<&O::state>("What it can do.");
  d.internal<&O::error>("Of the last fault; 0 without one.");
  d.internal<&O::disable_forced>("It must not be enabled.");
  d.internal<&O::position_index>("Index of the position where it is, from 1; 0: it is on its way.");
  d.internal<&O::commanded_index>("Index of the position where it is to be.");
  d.internal<&O::coordinate_system>("Number of the coordinate system it is in, from 1; 0: it is on its way.");
  d.internal<&O::x>(unit::mm, "X of its origin in that.");
  d.internal<&O::y>(unit::mm, "Y of it.");
  d.internal<&O::mover_count>("Movers whose middle is on it.");
}

}  // namespace takt::part
