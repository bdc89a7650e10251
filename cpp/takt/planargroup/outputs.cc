#include "takt/planargroup/outputs.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PlanarGroupOutputs");
  d.about("State of a group of movers after a cycle.");
  d.internal<&O::state>("State of the group.");
  d.internal<&O::error>("Error of the fault; 0: none.");
  d.internal<&O::mover_count>("Number of movers in the group.");
  d.internal<&O::track_count>("Number of tracks in the group.");
  d.internal<&O::environment>("Number of the environment in the group, from 1; 0: none.");
}

}  // namespace takt::planargroup
