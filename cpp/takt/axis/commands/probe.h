// Commands that watch positions (touch probe and cam switches), and torque control.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/coupling.h"
#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

// Edge of the probe that captures.
enum class ProbeEdge : std::uint8_t { kRising, kFalling };
// What GT_Touch does at the edge.
enum class TouchMode : std::uint8_t { kCapture, kSlow };

struct TouchProbe {  // MC_TouchProbe
  ProbeEdge edge = ProbeEdge::kRising;
  bool window_only = false;
  double first_position = 0;
  double last_position = 0;
};
struct AbortTrigger {               // MC_AbortTrigger
  std::optional<ProbeEdge> edge{};  // unset: both
};
struct Touch {  // GT_Touch
  TouchMode mode = TouchMode::kCapture;
  ProbeEdge edge = ProbeEdge::kRising;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};
struct DigitalCamSwitch {  // MC_DigitalCamSwitch
  Name switches;
  std::uint32_t enable_mask = 0xffffffff;
  bool enable = true;
  MasterSource source = MasterSource::kSetValue;
};
struct TorqueControl {  // MC_TorqueControl
  double torque = 0;
  std::optional<double> torque_ramp{};
  std::optional<double> velocity{};
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const TorqueControl&) const = default;
};

void describe(Enumeration<ProbeEdge>&);
void describe(Enumeration<TouchMode>&);
void describe(Description<TouchProbe>&);
void describe(Description<AbortTrigger>&);
void describe(Description<Touch>&);
void describe(Description<DigitalCamSwitch>&);
void describe(Description<TorqueControl>&);

}  // namespace takt::axis
