// A drive in another process that is not heard any more (AX-87): a drive error and a controlled stop.
//
// Where the axis is, is not known then, so nothing may go by it. The set point brakes with all the axis has and the
// drive is told so, for it may well still hear: one that closes the position loop gets positions as before, any other
// one the speed alone, as the engine's loop has nothing left to close it with. Once the set point rests, the drive is
// switched off and the brake falls. An axis at rest is switched off at once; one whose loop is open just has the fault.
// A drive that is heard again on the way changes nothing, unless it reports a fault.
//
// Meanwhile the axis counts as being where it was told to be. An incremental encoder may have lost counts or been
// switched off: its reference is lost. MC_Reset is refused until the drive is heard again.
#pragma once

#include "takt/axis/axis.h"

namespace takt::axis {

// sense: where the axis counts as being, when its last sample does not say so. An older one is carried on with the
// speed it had.
void Locate(const Context& context, const KinematicState& sampled, State& state) noexcept;

// move: supervision of an axis that is lost or stops blind.
void WatchLink(const Context& context, State& state) noexcept;

// The position loop of an axis that stops blind: the set speed alone.
ControlLoop SpeedAlone(const ControlLoop& params) noexcept;

}  // namespace takt::axis
