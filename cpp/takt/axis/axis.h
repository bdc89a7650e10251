// One axis, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks, throws or
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

// Something besides axes that they can be coupled to: a coordinate of a mover.
struct OutsideMaster {
  std::string name;
  double velocity = 0;  // u/s, its largest
  KinematicState at{};  // over all turns, at the end of the cycle
  double origin = 0;    // the place that it calls 0, in those of `at`; it changes where the place makes a jump
  bool known = false;   // `at` means something
};

// What there is in a machine besides one axis, to be looked up by number or name.
struct MachineView {
  // Of all axes. Masters that step before an axis are of the same cycle.
  std::span<const State> states{};
  std::span<const AxisParams> params{};
  std::span<const CamSwitches> cam_switches{};
  std::span<const cam::Table> cams{};
  std::span<const OutsideMaster> outside{};  // as masters they are numbered behind all axes
};
inline constexpr MachineView kAlone{};

// What every stage gets besides the axis itself. It is made anew for every axis and stage, so it holds little.
struct Context {
  AxisParams& params;  // changed by settings (GT_SetConstant, MC_WriteParameter) alone
  Cycle cycle;
  trajectory::Planner& planner;
  FeedbackSink& feedback;
  const State* master = nullptr;  // of an axis that follows another from load on: its state of the same cycle
  const MachineView& machine = kAlone;
};

// As it stands when power comes on.
State MakeState(const AxisParams& params) noexcept;

// sense: raw inputs become positions and switches. Of a drive in another process they may be older ones.
void Sense(const Context& context, const ServoInputs& inputs, State& state, const Sampling& sampling = {}) noexcept;

// command: carries a command out, buffers it or refuses it; reports either way. `lease_s` > 0: see Renew.
void Apply(const Context& context, Ticket ticket, double lease_s, const Command& command, State& state) noexcept;
// Lets go of the level-sensitive command (jog, held stop) with this ticket. False: it is not in control here.
bool Release(const Context& context, Ticket ticket, State& state) noexcept;
// Extends its lease. False: it is not in control here.
bool Renew(const Context& context, Ticket ticket, State& state) noexcept;

// move: supervision, then the next set point.
void Move(const Context& context, State& state) noexcept;

// control and actuate: the position loop and what goes to the drive. False: a number was not finite; this axis has
// opened its loop and puts out zeros, and so must all others (AX-82).
bool Control(const Context& context, State& state, ServoOutputs& outputs) noexcept;

// A fault from outside (overrun, internal): to ErrorStop; with `open_loop` the drive is switched off at once, else it
// brakes.
void Fail(const Context& context, ErrorId error, bool open_loop, State& state) noexcept;

// Limit switches and faults may have ramps of their own, but none that are gentler than the axis' (AX-112). A SW limit
// is braked for in time: with the limits of the axis.
trajectory::Limits StopLimits(const AxisParams& params, ErrorId error) noexcept;
// Brakes so from the set point of the cycle before.
void BrakeInFault(const Context& context, ErrorId error, State& state) noexcept;

// GT_EStop: the drive is switched off and the brake falls at once; faults are cleared, the axis is Disabled (AX-38),
// and power is refused until the stop is released (AX-100) ...
void EmergencyStop(const Context& context, State& state) noexcept;
// ... Then commands may ask for it anew.
void ReleaseEmergencyStop(State& state) noexcept;

// Whether a command asks for power or motion: what a held emergency stop refuses, and a gantry whose members are not in
// step. Everything but what is known to move nothing.
bool AsksToMove(const Command& command) noexcept;

void Publish(const AxisParams& params, const State& state, Outputs& outputs) noexcept;

// At rest: the set point stands.
inline bool AtRest(const State& state) noexcept {
  return state.setpoint.velocity == 0 && state.setpoint.acceleration == 0;
}

}  // namespace takt::axis
