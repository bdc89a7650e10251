// MC_TorqueControl (AX-42): the drive follows a torque, no faster than a speed.
//
// Velocity and acceleration are limited where they meet the torque, in the drive: each cycle it gets the torque and the
// velocity up to which the torque may drive (DriveMode::kCyclicTorque); there its velocity loop takes over. That
// velocity runs on a ramp within the command's limits towards its largest one, never further ahead of what is measured
// than kMostLead. While the torque is what holds the axis, the set point follows what is measured, with acceleration 0;
// else it is the ramp. So the next command starts from where the axis is, and as fast as it is.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"

namespace takt::axis {

struct Context;
struct State;

struct TorqueState {
  bool engaged = false;        // the drive is told a torque
  bool holds = false;          // the torque is what holds the axis: the set point follows what is measured
  double set_torque_nm = 0;    // on its ramp, from the measured torque on
  double velocity_before = 0;  // [u/s] measured in the cycle before
  double until = 0;            // [u/s] on its ramp: where the torque ends in this cycle
  Ticket ticket = 0;           // of the command that the ramp was planned for
};

// Whether the drive is to follow a torque in this cycle.
bool FollowsTorque(const State& state) noexcept;

// sense: where the torque holds the axis, the set point is where that is.
void SenseTorque(State& state) noexcept;

// move: the next torque. Before a stop inside the SW limits gets impossible, foreseen one cycle ahead by the measured
// acceleration (or the axis' own, if that is more), the axis goes to ErrorStop and brakes. False: no torque command is
// in control.
bool MoveTorque(const Context& context, State& state) noexcept;

void describe(Description<TorqueState>&);

}  // namespace takt::axis
