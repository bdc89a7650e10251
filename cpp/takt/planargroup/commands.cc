#include "takt/planargroup/commands.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<Enable>& d) {
  d.named("EnablePlanarGroup");
  d.about(
      "Lets the group refuse what would collide; done when it is Enabled. All that is in it has to rest, no mover may "
      "touch another, and all have to stand within the border.");
}

void describe(Description<Disable>& d) {
  d.named("DisablePlanarGroup");
  d.about(
      "Nothing is refused any more; done when it is Disabled. After a fault: a reset leads to Disabled instead of "
      "Enabled.");
}

void describe(Description<Reset>& d) {
  d.named("ResetPlanarGroup");
  d.about("Acknowledges a fault.");
}

}  // namespace takt::planargroup
