#include "takt/part/commands.h"

#include "takt/core/describe.h"

namespace takt::part {

void describe(Description<ActivatePosition>& d) {
  d.about(
      "Brings the part to one of its positions, with all movers that stand on it; done when it is there. Refused "
      "unless nothing moves on it or across its border, and the place is free; the object of the feedback is what is "
      "in the way.");
  d.required<&ActivatePosition::index>(between(1, 1000), "Index of the position, from 1.");
}

void describe(Description<AllowEnable>& d) {
  d.about("Takes force_disable back: the part is enabled again with the movers of its coordinate system.");
}

void describe(Description<ForceDisable>& d) {
  d.about(
      "Disables the part and keeps it disabled until allow_enable. Movers on it or on their way over it have a fault; "
      "done when none of them moves any more.");
}

void describe(Description<Reset>& d) {
  d.named("PartReset");
  d.about("Acknowledges the part's fault; those of its movers stay.");
}

}  // namespace takt::part
