#include "takt/part/outputs.h"

#include "takt/core/describe.h"

namespace takt::part {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PartOutputs");
  d.about("State of a part of the surface after a cycle.");
  d.internal<&O::state>("State of the part.");
  d.internal<&O::error>("Error of the last fault; 0: none.");
  d.internal<&O::disable_forced>("True: it must not be enabled.");
  d.internal<&O::position_index>("Index of its position, from 1; 0: at no position.");
  d.internal<&O::commanded_index>("Index of its commanded position, from 1.");
  d.internal<&O::coordinate_system>("Number of its coordinate system, from 1; 0: at no position.");
  d.internal<&O::x>(unit::mm, "X of its origin in the coordinate system, at its present or last position.");
  d.internal<&O::y>(unit::mm, "Y of its origin in the coordinate system, at its present or last position.");
  d.internal<&O::mover_count>("Number of movers with their centre on it.");
}

}  // namespace takt::part
