#include "takt/environment/outputs.h"

#include "takt/core/describe.h"

namespace takt::environment {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("EnvironmentOutputs");
  d.about("An environment after a cycle.");
  d.internal<&O::stator_count>("Stators that it has.");
  d.internal<&O::border_count>("Straight pieces of its boundary; 0: it has none.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
}

}  // namespace takt::environment
