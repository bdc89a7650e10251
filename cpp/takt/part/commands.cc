#include "takt/part/commands.h"

#include "takt/core/describe.h"

namespace takt::part {

void describe(Description<ActivatePosition>& d) {
  d.about(
      "Moves the part to one of its positions, with all movers at rest on it; done when it has arrived. Refused if "
      "anything moves on the part or across its border, or the position is occupied; the object of the feedback is the "
      "obstacle.");
  d.required<&ActivatePosition::index>(between(1, 1000), "Index of the position, from 1.");
}

void describe(Description<AllowEnable>& d) {
  d.about("Ends force_disable: the part is enabled again with the movers of its coordinate system.");
}

void describe(Description<ForceDisable>& d) {
  d.about(
      "Disables the part and keeps it disabled until allow_enable. Movers on it or moving over it have a fault; done "
      "when they are at rest.");
}

void describe(Description<Reset>& d) {
  d.named("PartReset");
  d.about("Acknowledges the fault of the part; faults of its movers persist.");
}

}  // namespace takt::part
