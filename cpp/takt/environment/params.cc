#include "takt/environment/params.h"

#include "takt/core/describe.h"

namespace takt::environment {

void describe(Description<EnvironmentParams>& d) {
  using P = EnvironmentParams;
  d.about("The surface that movers float on: stators of 240 mm by 240 mm, and the border around them.");
  d.required<&P::name>("Of the environment; commands go to it.");
  d.defaulted<&P::stators>("The lower left corners of the stators; the border is made of them. None: it has none.");
}

}  // namespace takt::environment
