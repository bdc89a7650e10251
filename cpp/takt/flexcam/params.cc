#include "takt/flexcam/params.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Description<FlexCamParams>& d) {
  using P = FlexCamParams;
  d.about("A cam module: one slave that follows a master through one of up to four cams.");
  d.required<&P::name>("Of the module; commands go to it.");
  d.required<&P::slave>("Name of the axis that is moved.");
  d.defaulted<&P::master>(
      "What is followed: the name of an axis, of a belt (its travel), of a mover (its position along its tracks), or "
      "of "
      "a mover's coordinate (shuttle.x, .y, .c); unset: a virtual master, see virtual_velocity.");
  d.defaulted<&P::source>("Whether its set position or its measured one counts.");
  d.required<&P::cams>("Names of cams of the machine, for slots 1 to 4.");
  d.defaulted<&P::settings>("Settings at the start.");
  d.defaulted<&P::homing>("How the slave finds its reference when settings say home_by_module.");
  d.rule<&P::cams>("must be 1 to 4 names", [](const P& p) { return !p.cams.empty() && p.cams.size() <= kSlots; });
  d.rule<&P::master>("must be another axis than the slave", [](const P& p) { return p.master != p.slave; });
}

}  // namespace takt::flexcam
