#include "takt/planargroup/commands.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<Enable>& d) {
  d.named("EnablePlanarGroup");
  d.about(
      "Lets the group refuse moves that would collide; done when it is Enabled. All its members must be at rest, no "
      "movers may touch, and all must be within the border.");
}

void describe(Description<Disable>& d) {
  d.named("DisablePlanarGroup");
  d.about(
      "Ends the refusal of moves; done when the group is Disabled. After a fault: a reset leads to Disabled instead of "
      "Enabled.");
}

void describe(Description<Reset>& d) {
  d.named("ResetPlanarGroup");
  d.about("Acknowledges a fault.");
}

}  // namespace takt::planargroup
