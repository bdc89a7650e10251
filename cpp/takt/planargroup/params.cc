#include "takt/planargroup/params.h"

#include "takt/core/describe.h"

namespace takt::planargroup {

void describe(Description<PlanarGroupParams>& d) {
  using P = PlanarGroupParams;
  d.about("A group of movers: while it is enabled no move is accepted that would make what is in it collide.");
  d.required<&P::name>("Of the group; commands go to it.");
  d.defaulted<&P::movers>("Names of the movers that are in it from the start.");
  d.defaulted<&P::tracks>("Names of the tracks.");
  d.defaulted<&P::environment>("Name of the environment whose border its movers do not cross; unset: none.");
  d.defaulted<&P::moves_wait>(
      "Moves of X and Y and along tracks that another mover or a track is in the way of wait for their turn, as "
      "buffered "
      "ones do; else they are refused.");
}

}  // namespace takt::planargroup
