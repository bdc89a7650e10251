// Configuration of one pick and place module in a machine file.
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
  std::string belt;  // name of a belt of the machine
  BeltSettings settings;
};

// Homing of an axis if home_by_module is set.
struct AxisHoming {
  std::string axis;  // a member of the group
  axis::HomingParams homing;
};

struct PickPlaceParams {
  std::string name;
  std::string group;                 // name of the group that the module moves
  std::vector<PickPlaceBelt> belts;  // at most 16
  Settings settings;                 // initial settings
  std::vector<AxisHoming> homing;
};

inline constexpr std::string_view kStaticTarget = "the static target";  // meaning of belt 0

// Returns why the number of a belt is invalid for a module with this many belts; empty if it is valid. `none`: meaning
// of 0; empty: 0 is invalid.
std::string DiagnoseBelt(std::uint32_t belt, std::size_t belts, std::string_view none);
// Returns why a tracking mode is invalid for a module with this many belts; empty if it is valid.
std::string DiagnoseMode(TrackingMode mode, std::size_t belts);
// Returns why the module's work range on a belt is invalid; empty if it is valid.
std::string DiagnoseRange(const BeltSettings& settings, const conveyor::BeltParams& belt);
// Returns why leave and upper_limit do not fit the upper_limit of the belt; empty if they do.
std::string DiagnoseLeave(const BeltSettings& settings, const conveyor::BeltParams& belt);

void describe(Description<PickPlaceBelt>&);
void describe(Description<AxisHoming>&);
void describe(Description<PickPlaceParams>&);

}  // namespace takt::pickplace
