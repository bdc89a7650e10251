#include "takt/track/outputs.h"

#include "takt/core/describe.h"

namespace takt::track {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("State of a track after a cycle.");
  d.internal<&O::state>("State of the track.");
  d.internal<&O::operation_mode>("Operation mode of the track.");
  d.internal<&O::error>("Error of the fault; 0: none.");
  d.internal<&O::length>(unit::mm, "Length of the track; 0: no geometry yet.");
  d.internal<&O::closed_loop>("True: its end is joined to its start.");
  d.internal<&O::element_count>("Number of its lines, circles and positions.");
  d.internal<&O::mover_count>("Number of movers on it.");
  d.internal<&O::previous_tracks>("Number of tracks that end where it starts.");
  d.internal<&O::subsequent_tracks>("Number of tracks that start where it ends.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
}

}  // namespace takt::track
