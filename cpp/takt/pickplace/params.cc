#include "takt/pickplace/params.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

void describe(Description<PickPlaceBelt>& d) {
  d.about("A belt as a pick and place module uses it.");
  d.required<&PickPlaceBelt::belt>("Name of the belt.");
  d.defaulted<&PickPlaceBelt::settings>("What is set for it at the start.");
}

void describe(Description<AxisHoming>& d) {
  d.named("PickPlaceHoming");
  d.about("How an axis looks for its reference when settings say home_by_module.");
  d.required<&AxisHoming::axis>("Name of an axis of the group.");
  d.required<&AxisHoming::homing>("How it does.");
}

void describe(Description<PickPlaceParams>& d) {
  using P = PickPlaceParams;
  d.about("A pick and place module: it moves a group between static places and workpieces on belts.");
  d.required<&P::name>("Of the module; commands go to it.");
  d.required<&P::group>("Name of the group that it moves.");
  d.defaulted<&P::belts>("Belts that it picks from and places on, in the order of their numbers.");
  d.defaulted<&P::settings>("Settings at the start.");
  d.defaulted<&P::homing>("Homing of axes other than they do by themselves.");
  d.rule<&P::settings>("workpiece_pcs1 and workpiece_pcs2 must be different: places on two belts are seen from them",
                       [](const P& p) { return p.settings.workpiece_pcs1 != p.settings.workpiece_pcs2; });
  d.rule<&P::belts>("must be no more than 16", [](const P& p) { return p.belts.size() <= kBelts; });
}

}  // namespace takt::pickplace
