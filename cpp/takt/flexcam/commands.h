// The commands of a cam module. Its inputs are levels, as those of the Flex Cam block: they keep their value until they
// are changed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/core/patch.h"
#include "takt/flexcam/settings.h"

namespace takt::flexcam {

inline constexpr std::size_t kSlots = 4;

// The inputs of the manual's 3.3.2; in doc strings "Flex Cam:" gives the name used there.
template <template <typename> class Of>
struct InputsOf {
  Of<bool> enable = Preset<Of>(true);
  Of<bool> internal_control = Preset<Of>(false);
  Of<bool> reset_error = Preset<Of>(false);
  Of<bool> regulator_on = Preset<Of>(false);
  Of<bool> stop = Preset<Of>(false);
  Of<bool> halt = Preset<Of>(false);
  Of<bool> home_execute = Preset<Of>(false);
  Of<bool> home_abs_switch = Preset<Of>(false);
  Of<bool> enable_hw_limit = Preset<Of>(false);
  Of<bool> hw_limit_positive = Preset<Of>(false);
  Of<bool> hw_limit_negative = Preset<Of>(false);
  Of<bool> sync_cam = Preset<Of>(false);
  Of<bool> sync_out_instant = Preset<Of>(false);
  Of<bool> cam_change_instant = Preset<Of>(false);
  Of<bool> cam_sequencer = Preset<Of>(false);
  Of<double> offset_master = Preset<Of>(0.0);   // [x]
  Of<double> offset_slave = Preset<Of>(0.0);    // [u]
  Of<double> scaling_master = Preset<Of>(1.0);  // [x per master's u]
  Of<double> scaling_slave = Preset<Of>(1.0);   // [u per y]
  Of<std::uint32_t> cam_table = Preset<Of>(std::uint32_t{1});
  Of<double> virtual_velocity = Preset<Of>(0.0);  // [master's u/s]
};
using Inputs = InputsOf<Plain>;

// Changes inputs. If that closes or opens the clutch or starts homing, the command is done when that is done.
using Control = InputsOf<std::optional>;

// Returns true if the command requests power or motion.
bool AsksToMove(const Control& control) noexcept;

// Level-sensitive: give it again to change the levels; both false (or a release) ends the jog.
struct Jog {
  bool positive = false;
  bool negative = false;
};

struct SetCam {  // puts another cam into a slot
  std::uint32_t slot = 1;
  Name cam;
};

// When a change of cam takes effect.
enum class ChangeWhen : std::uint8_t { kAtOnce, kMasterPosition, kCamPosition, kNextCycle, kWithoutJump };
// How Y or X is shifted so that both cams meet.
enum class ChangeAlign : std::uint8_t { kNothing, kPosition, kVelocity };

struct ChangeCam {
  std::uint32_t cam_table = 1;
  ChangeWhen when = ChangeWhen::kNextCycle;
  double position = 0;  // [master's u or x] for the kinds of `when` that need one
  ChangeAlign align = ChangeAlign::kNothing;
};
struct WithdrawChanges {};  // aborts all changes that have not taken effect

using Command = std::variant<Control, Jog, Configure, SetCam, ChangeCam, WithdrawChanges>;

// Returns what is wrong with a command, as a sentence for users; empty if nothing is. Not for use within the cycle.
std::string Diagnose(const Command& command);

void describe(Enumeration<ChangeWhen>&);
void describe(Enumeration<ChangeAlign>&);
void describe(Description<Inputs>&);
void describe(Description<Control>&);
void describe(Description<Jog>&);
void describe(Description<SetCam>&);
void describe(Description<ChangeCam>&);
void describe(Description<WithdrawChanges>&);

}  // namespace takt::flexcam
