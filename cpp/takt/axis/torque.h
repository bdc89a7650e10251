// MC_TorqueControl (AX-42): the drive follows a torque up to a velocity limit.
//
// Velocity and acceleration are limited in the drive, where they meet the torque: each cycle it gets the torque and the
// velocity up to which the torque may drive it (DriveMode::kCyclicTorque); there its velocity loop takes over. That
// velocity runs on a ramp within the command's limits towards its velocity limit, never further ahead of the actual
// velocity than kMostLead allows. While the torque determines the motion, the set point follows the actual position,
// with acceleration 0; else it is the ramp. So the next command starts from the actual position and velocity.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"

namespace takt::axis {

struct Context;
struct State;

struct TorqueState {
  bool engaged = false;        // the drive gets a torque
  bool holds = false;          // the torque determines the motion: the set point follows the actual position
  double set_torque_nm = 0;    // on its ramp, from the measured torque on
  double velocity_before = 0;  // [u/s] actual velocity in the previous cycle
  double until = 0;            // [u/s] on its ramp: velocity up to which the torque acts in this cycle
  Ticket ticket = 0;           // of the command for which the ramp was planned
};

// Returns true if the drive is to follow a torque in this cycle.
bool FollowsTorque(const State& state) noexcept;

// sense: while the torque determines the motion, the set point becomes the actual position and velocity.
void SenseTorque(State& state) noexcept;

// move: computes the next torque. Before a stop inside the SW limits becomes impossible, predicted one cycle ahead with
// the measured acceleration (or the axis' own, if that is larger), the axis enters ErrorStop and brakes. Returns false
// if no torque command is in control.
bool MoveTorque(const Context& context, State& state) noexcept;

void describe(Description<TorqueState>&);

}  // namespace takt::axis
