// What a machine file says about one pick and place module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "takt/axis/homing_params.h"
#include "takt/conveyor/params.h"
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

inline constexpr std::string_view kStaticTarget = "the static target";  // what 0 means for a belt

// What is wrong with the number of a belt of a module with so many belts; empty: nothing. `none`: what 0 means.
std::string WhyNotBelt(std::uint32_t belt, std::size_t belts, std::string_view none);
// What is wrong with a tracking mode of a module with so many belts; empty: nothing.
std::string WhyNotMode(TrackingMode mode, std::size_t belts);
// What is wrong with the work range that a module is to have on a belt; empty: nothing.
std::string WhyNotRange(const BeltSettings& settings, const conveyor::BeltParams& belt);
// Why leave and upper_limit do not fit the upper_limit of the belt; empty: they do.
std::string WhyNotLeave(const BeltSettings& settings, const conveyor::BeltParams& belt);

void describe(Description<PickPlaceBelt>&);
void describe(Description<AxisHoming>&);
void describe(Description<PickPlaceParams>&);

}  // namespace takt::pickplace
