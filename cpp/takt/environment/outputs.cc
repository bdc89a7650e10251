#include "takt/environment/outputs.h"

#include "takt/core/describe.h"

namespace takt::environment {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("EnvironmentOutputs");
  d.about("State of an environment after a cycle.");
  d.internal<&O::stator_count>("Number of its stators.");
  d.internal<&O::border_count>("Number of straight sides of its boundary; 0: no boundary.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
}

}  // namespace takt::environment
