#include "takt/core/describe.h"
#include "takt/flexcam/clutch.h"

namespace takt::flexcam {

void describe(Description<ClutchState>& d) {
  using S = ClutchState;
  d.about("State of the clutch.");
  d.internal<&S::phase>("Phase of closing or opening.");
  d.internal<&S::mode>("Mode in which it closes or opens.");
  d.internal<&S::ramp>("Ramp of the modes over time.");
  d.internal<&S::stretched>("The ramp takes longer than was set.");
  d.internal<&S::out>(unit::u, "Position at which the slave comes to rest.");
  d.internal<&S::curves>("Curves over the master's displacement; the last one is followed.");
  d.internal<&S::curve_count>("Number of curves.");
  d.internal<&S::from_cam>("The first curve began on the cam.");
  d.internal<&S::waits>("Condition for which it waits.");
  d.internal<&S::next>("Mode in which it is to close.");
  d.internal<&S::opens_still>("An opening is completed until the closing begins.");
  d.internal<&S::leaves>("The clutch is to open as soon as possible.");
  d.internal<&S::sense>("Sense of the master since the wait began; 0: not known.");
  d.internal<&S::furthest>("Furthest position of the master in that sense.");
  d.internal<&S::looked_from>("Position of the master from which on a curve may begin.");
  d.internal<&S::planned_sense>("Sense of the master for which the curve was planned; 0: none.");
  d.internal<&S::accepted_sense>("Sense of the master in the first plan.");
  d.internal<&S::place>("Position of the master at which the clutch is to be closed.");
  d.internal<&S::distance>("Distance of the master before that position at which the curve begins.");
  d.internal<&S::waits_since>("Position of the master at which the wait to open began.");
}

void describe(Description<Way>& d) {
  d.about("Stages from the master to the slave.");
  d.internal<&Way::to_x>("Scaling and offset of the master.");
  d.internal<&Way::profiler>("The cam.");
  d.internal<&Way::to_slave>("Scaling and offset of the slave.");
}

}  // namespace takt::flexcam
