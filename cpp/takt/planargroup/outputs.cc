#include "takt/planargroup/outputs.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PlanarGroupOutputs");
  d.about("State of a group of movers after a cycle.");
  d.internal<&O::state>("State of the group.");
  d.internal<&O::error>("Why it is in error.");
  d.internal<&O::mover_count>("Movers in it.");
  d.internal<&O::track_count>("Tracks in it.");
  d.internal<&O::environment>("Number of the environment in it, from 1; 0: none.");
}

}  // namespace takt::planargroup
