#include "takt/planargroup/params.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<PlanarGroupParams>& d) {
  using P = PlanarGroupParams;
  d.about("A group of movers: while it is enabled, moves with which its members would collide are refused.");
  d.required<&P::name>("Name of the group, to which commands are addressed.");
  d.defaulted<&P::movers>("Names of the movers that are members from the start.");
  d.defaulted<&P::tracks>("Names of the tracks that are members from the start.");
  d.defaulted<&P::environment>("Name of the environment whose border its movers must not cross; unset: none.");
  d.defaulted<&P::moves_wait>(
      "True: moves of X and Y and along tracks that another mover or a track blocks wait in the buffer for their area. "
      "False: they are refused.");
}

}  // namespace takt::planargroup
