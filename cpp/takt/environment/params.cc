#include "takt/environment/params.h"

#include "takt/core/describe.h"

namespace takt::environment {

void describe(Description<EnvironmentParams>& d) {
  using P = EnvironmentParams;
  d.about("The surface that movers float on: stators of 240 mm by 240 mm, and the border around them.");
  d.required<&P::name>("Name of the environment, to which commands are addressed.");
  d.defaulted<&P::stators>("Lower left corners of the stators, around which the boundary is made. Empty: no boundary.");
}

}  // namespace takt::environment
