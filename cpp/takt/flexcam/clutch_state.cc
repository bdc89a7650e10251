#include "takt/core/describe.h"
#include "takt/flexcam/clutch.h"

namespace takt::flexcam {

void describe(Description<ClutchState>& d) {
  using S = ClutchState;
  d.about("The clutch.");
  d.internal<&S::phase>("How far it is.");
  d.internal<&S::mode>("In which it closes or opens.");
  d.internal<&S::ramp>("Over time.");
  d.internal<&S::stretched>("It takes more time than was asked for.");
  d.internal<&S::out>(unit::u, "Where the slave is to rest.");
  d.internal<&S::curves>("Over the master's displacement; the last one is followed.");
  d.internal<&S::curve_count>("How many there are.");
  d.internal<&S::from_cam>("The first one began on the cam.");
  d.internal<&S::waits>("For what it waits.");
  d.internal<&S::next>("Mode in which it is to close.");
  d.internal<&S::opens_still>("It opens until it begins to close.");
  d.internal<&S::leaves>("It is to open as soon as it can.");
  d.internal<&S::sense>("Of the master since the waiting began.");
  d.internal<&S::furthest>("Where the master was furthest in that sense.");
  d.internal<&S::looked_from>("A curve begins here or further on.");
  d.internal<&S::planned_sense>("For which the curve was planned.");
  d.internal<&S::accepted_sense>("Of the first plan.");
  d.internal<&S::place>("Where it is to be closed.");
  d.internal<&S::distance>("Before that: where the curve begins.");
  d.internal<&S::waits_since>("Where the master was when the waiting to open began.");
}

void describe(Description<Way>& d) {
  d.about("The way from the master to the slave.");
  d.internal<&Way::to_x>("Scaling and offset of the master.");
  d.internal<&Way::profiler>("The cam.");
  d.internal<&Way::to_slave>("Scaling and offset of the slave.");
}

}  // namespace takt::flexcam
