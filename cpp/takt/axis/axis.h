// One axis, stage by stage of the cycle. Free functions over plain state: no function here allocates, locks, throws or
// reads a clock.
#pragma once

#include <span>
#include <string>

#include "takt/axis/commands.h"
#include "takt/axis/outputs.h"
#include "takt/axis/params.h"
#include "takt/axis/state.h"
#include "takt/cam/table.h"
#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/ports.h"
#include "takt/trajectory/planner.h"

namespace takt::axis {

// A master that is not an axis: a coordinate of a mover, or a belt.
struct OutsideMaster {
  std::string name;
  double velocity = 0;  // [u/s] its velocity limit
  KinematicState at{};  // over all turns, at the end of the cycle
  double origin = 0;    // value of `at.position` at the master's coordinate 0; changes where that coordinate jumps
  bool known = false;   // `at` is valid
};

// The rest of the machine, to be looked up by number or name.
struct MachineView {
  // States of all axes; those of axes that step before the present one are of this cycle.
  std::span<const State> states{};
  std::span<const AxisParams> params{};
  std::span<const CamSwitches> cam_switches{};
  std::span<const cam::Table> cams{};
  std::span<const OutsideMaster> outside{};  // numbered behind all axes when used as masters
};
inline constexpr MachineView kAlone{};

// Input of every stage besides the axis' state. Made anew for every axis and stage, so it is kept small.
struct Context {
  AxisParams& params;  // changed only by commands (GT_SetConstant, MC_WriteParameter, ...)
  Cycle cycle;
  trajectory::Planner& planner;
  FeedbackSink& feedback;
  // State, of this cycle, of the master that the axis follows from load on; null: none.
  const State* master = nullptr;
  const MachineView& machine = kAlone;
};

// Returns the state of an axis at start-up.
State MakeState(const AxisParams& params) noexcept;

// sense: turns raw inputs into positions and switches. `sampling`: age of inputs from a drive in another process.
void Sense(const Context& context, const ServoInputs& inputs, State& state, const Sampling& sampling = {}) noexcept;

// command: executes, buffers or rejects a command, and reports which. `lease_s` > 0: it ends unless renewed (Renew).
void Apply(const Context& context, Ticket ticket, double lease_s, const Command& command, State& state) noexcept;
// Releases the level-sensitive command (jog, held stop, touch probe) with this ticket, in control or buffered. Returns
// false if this axis has none.
bool Release(const Context& context, Ticket ticket, State& state) noexcept;
// Extends the lease of the command with this ticket. Returns false if this axis has none with a lease.
bool Renew(const Context& context, Ticket ticket, State& state) noexcept;

// move: supervises the axis, then computes the next set point.
void Move(const Context& context, State& state) noexcept;

// control and actuate: runs the position loop and computes the command to the drive. Returns false if a value was not
// finite: this axis has opened its loop and commands zero velocity, voltage and torque, and so must all others (AX-82).
bool Control(const Context& context, State& state, ServoOutputs& outputs) noexcept;

// Puts the axis into ErrorStop because of a fault. `open_loop`: the drive is switched off at once; else the axis
// brakes.
void Fail(const Context& context, ErrorId error, bool open_loop, State& state) noexcept;

// Returns the limits for braking after a fault. Limit switches and other faults may have ramps of their own, but none
// gentler than the axis' (AX-112). SW limits use the axis' own limits, as the axis brakes before them.
trajectory::Limits StopLimits(const AxisParams& params, ErrorId error) noexcept;
// Brakes within StopLimits from the set point of the previous cycle.
void BrakeInFault(const Context& context, ErrorId error, State& state) noexcept;

// GT_EStop: switches the drive off and closes the brake at once, clears faults and puts the axis into Disabled (AX-38).
// Power is rejected until the stop is released (AX-100).
void EmergencyStop(const Context& context, State& state) noexcept;
// Releases the emergency stop: commands may request power again.
void ReleaseEmergencyStop(State& state) noexcept;

// Returns true if a command requests power or motion: every command but those known to move nothing. Such commands are
// rejected during a held emergency stop, and by a gantry whose members are not in step.
bool AsksToMove(const Command& command) noexcept;

void Publish(const AxisParams& params, const State& state, Outputs& outputs) noexcept;

// Returns true if the set point is at rest.
inline bool AtRest(const State& state) noexcept {
  return state.setpoint.velocity == 0 && state.setpoint.acceleration == 0;
}

}  // namespace takt::axis
