// Commands of a pick and place module. Its inputs are levels, like those of the Track Pick & Place block: they keep
// their values until they are changed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/patch.h"
#include "takt/pickplace/places.h"
#include "takt/pickplace/settings.h"

namespace takt::pickplace {

// The inputs of the Track Pick & Place manual, 3.6.2; "T&P:" in the doc strings gives their names there. Those of 3.6.3
// are commands of the belts.
template <template <typename> class Of>
struct InputsOf {
  Of<bool> enable = Preset<Of>(true);
  Of<bool> internal_control = Preset<Of>(false);
  Of<bool> reset_error = Preset<Of>(false);
  Of<bool> regulator_on = Preset<Of>(false);
  Of<bool> path_stop = Preset<Of>(false);
  Of<bool> path_halt = Preset<Of>(false);
  Of<bool> stop_all = Preset<Of>(false);
  Of<bool> home_execute = Preset<Of>(false);
  Of<std::array<bool, kRealAxes>> home_abs_switch = Preset<Of>(std::array<bool, kRealAxes>{});
  Of<bool> enable_hw_limit = Preset<Of>(false);
  Of<std::array<bool, kAllAxes>> hw_limit_positive = Preset<Of>(std::array<bool, kAllAxes>{});
  Of<std::array<bool, kAllAxes>> hw_limit_negative = Preset<Of>(std::array<bool, kAllAxes>{});
  Of<SelectAxis> select_axis = Preset<Of>(SelectAxis::kNone);
  Of<bool> execute = Preset<Of>(false);
  Of<std::uint32_t> set_target = Preset<Of>(std::uint32_t{0});
  Of<bool> path_interrupt = Preset<Of>(false);
  Of<bool> abort = Preset<Of>(false);
  Of<double> override_factor = Preset<Of>(1.0);
  Of<bool> ack_gripper = Preset<Of>(false);
  Of<bool> return_to_path = Preset<Of>(false);
};
using Inputs = InputsOf<Plain>;

// Changes inputs. Done at once; if a rising edge starts a profile, homing or the return to the path, done when that
// ends.
using Control = InputsOf<std::optional>;

// Returns true if the command requests power or motion.
bool AsksToMove(const Control& control) noexcept;

// Level-sensitive: repeat the command to change the levels; both false, or a release, ends the jog.
struct Jog {
  bool positive = false;
  bool negative = false;
};

struct ResetCounters {};  // of workpieces picked, placed and missed

using Command = std::variant<Control, Jog, Configure, ConfigureBelt, ResetCounters>;

void describe(Description<Inputs>&);
void describe(Description<Control>&);
void describe(Description<Jog>&);
void describe(Description<ResetCounters>&);

}  // namespace takt::pickplace
