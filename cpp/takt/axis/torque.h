// MC_TorqueControl (AX-42): the drive follows a torque, no faster than a speed.
//
// The speed limit is kept where speed and torque meet, in the drive: it gets the torque and the largest speed in each
// cycle (DriveMode::kCyclicTorque), and its velocity loop takes over at that speed. Acceleration is what the torque
// makes it. The set point follows what is measured meanwhile, so that whatever comes next starts from where the axis
// is, as fast as it is, with acceleration 0.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct Context;
struct State;

struct TorqueState {
  bool engaged = false;        // the drive is told a torque
  double set_torque_nm = 0;    // on its ramp, from the measured torque on
  double velocity_before = 0;  // u/s, measured in the cycle before
};

// Whether the drive is to follow a torque in this cycle.
bool FollowsTorque(const State& state) noexcept;

// sense: the set point is where the axis is.
void SenseTorque(State& state) noexcept;

// move: the next torque. Before a stop inside the SW limits gets impossible, foreseen one cycle ahead by the measured
// acceleration (or the axis' own, if that is more), the axis goes to ErrorStop and brakes. False: no torque command is
// in control.
bool MoveTorque(const Context& context, State& state) noexcept;

void describe(Description<TorqueState>&);

}  // namespace takt::axis
