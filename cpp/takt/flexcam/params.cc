#include "takt/flexcam/params.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Description<FlexCamParams>& d) {
  using P = FlexCamParams;
  d.about("A cam module: one slave that follows a master through one of up to four cams.");
  d.required<&P::name>("Name of the module in commands.");
  d.required<&P::slave>("Name of the axis that the module moves.");
  d.defaulted<&P::master>(
      "Name of the master: an axis, a belt (its travel), a mover (its position along its tracks), or a coordinate of a "
      "mover (shuttle.x, .y, .c); unset: a virtual master, see virtual_velocity.");
  d.defaulted<&P::source>("Set or measured position of the master.");
  d.required<&P::cams>("Names of cams of the machine, for slots 1 to 4.");
  d.defaulted<&P::settings>("Settings at the start.");
  d.defaulted<&P::homing>("Homing of the slave if home_by_module is set.");
  d.rule<&P::cams>("must be 1 to 4 names", [](const P& p) { return !p.cams.empty() && p.cams.size() <= kSlots; });
  d.rule<&P::master>("must be another axis than the slave", [](const P& p) { return p.master != p.slave; });
}

}  // namespace takt::flexcam
