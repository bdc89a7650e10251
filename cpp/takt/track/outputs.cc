#include "takt/track/outputs.h"

#include "takt/core/describe.h"

namespace takt::track {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("State of a track after a cycle.");
  d.internal<&O::state>("State of the track.");
  d.internal<&O::operation_mode>("What it is doing as a way for movers.");
  d.internal<&O::error>("Why it is in error.");
  d.internal<&O::length>(unit::mm, "How long it is; 0: there is nothing to go along yet.");
  d.internal<&O::closed_loop>("It goes on from its end to its start.");
  d.internal<&O::element_count>("Lines, circles and positions that it is given by.");
  d.internal<&O::mover_count>("Movers on it.");
  d.internal<&O::previous_tracks>("Tracks that end where it starts.");
  d.internal<&O::subsequent_tracks>("Tracks that start where it ends.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
}

}  // namespace takt::track
