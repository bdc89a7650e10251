// What a machine file says about one pick and place module.
#pragma once

#include <string>
#include <vector>

#include "takt/axis/homing_params.h"
#include "takt/core/describe_fwd.h"
#include "takt/pickplace/settings.h"

namespace takt::pickplace {

struct PickPlaceBelt {
  std::string belt;  // name of the machine's belt
  BeltSettings settings;
};

// How an axis looks for its reference with home_by_module.
struct AxisHoming {
  std::string axis;  // a member of the group
  axis::HomingParams homing;
};

struct PickPlaceParams {
  std::string name;
  std::string group;                 // that it moves
  std::vector<PickPlaceBelt> belts;  // 1 to 16
  Settings settings;                 // at the start
  std::vector<AxisHoming> homing;
};

void describe(Description<PickPlaceBelt>&);
void describe(Description<AxisHoming>&);
void describe(Description<PickPlaceParams>&);

}  // namespace takt::pickplace
