// Parameters of one cam module (Flex Cam) from the machine file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/axis/commands/coupling.h"
#include "takt/axis/homing_params.h"
#include "takt/core/describe_fwd.h"
#include "takt/flexcam/commands.h"
#include "takt/flexcam/settings.h"

namespace takt::flexcam {

struct FlexCamParams {
  std::string name;
  std::string slave;                    // name of the axis
  std::optional<std::string> master{};  // name of the axis, belt, mover or its coordinate; unset: a virtual master
  axis::MasterSource source = axis::MasterSource::kSetValue;  // which position of the master is used
  std::vector<std::string> cams;                              // for slots 1 to 4
  Settings settings;                                          // initial settings
  std::optional<axis::HomingParams> homing{};                 // for home_by_module
};

void describe(Description<FlexCamParams>&);

}  // namespace takt::flexcam
