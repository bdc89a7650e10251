// A drive in another process that is not heard any more (AX-87): a drive error and a controlled stop.
//
// The position of the axis is then unknown, so nothing may rely on it. The set point brakes on the ramp for faults and
// is still sent, as the drive may well receive it: a drive that closes the position loop gets positions as before, any
// other only the velocity, as the engine's loop has no feedback. Once the set point is at rest, the drive is switched
// off and the brake closes. An axis at rest is switched off at once; one whose loop is open only gets the fault. If the
// drive is heard again during the stop, nothing changes unless it reports a fault.
//
// Meanwhile the set point counts as the actual position. An incremental encoder may have lost counts or been switched
// off: its reference is lost. MC_Reset is rejected until the drive is heard again.
#pragma once

#include "takt/axis/axis.h"

namespace takt::axis {

// sense: sets the actual position when the last sample does not give it. An older sample is extrapolated at its
// velocity.
void Locate(const Context& context, const KinematicState& sampled, State& state) noexcept;

// move: supervises an axis whose drive is lost, or that stops without feedback (`blind`).
void WatchLink(const Context& context, State& state) noexcept;

// Returns the parameters of a position loop without feedback, which passes the set velocity on.
ControlLoop WithoutFeedback(const ControlLoop& params) noexcept;

}  // namespace takt::axis
