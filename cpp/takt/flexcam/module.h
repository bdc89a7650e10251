// One cam module, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks, throws
// or reads a clock.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/axis.h"
#include "takt/core/feedback.h"
#include "takt/flexcam/commands.h"
#include "takt/flexcam/outputs.h"
#include "takt/flexcam/params.h"
#include "takt/flexcam/state.h"

namespace takt::flexcam {

// The context of every stage.
struct Context {
  const FlexCamParams& params;
  axis::Context slave;  // context of the axis that the module moves
  std::optional<std::uint32_t> master{};
  axis::HomingParams homing{};  // of the slave, from the machine file
};

// Returns true if the cam with this index is in a slot, runs, or may be returned to by a sequence, or is used for the
// extreme values.
bool UsesCam(const State& state, std::uint32_t index) noexcept;

// Returns the state at power-on. `slots`: numbers of the machine's cams from 1; 0: none.
State MakeState(const FlexCamParams& params, const std::array<std::uint32_t, kSlots>& slots) noexcept;

// Stage Apply: carries a command out or refuses it, and reports either. `lease_s` > 0: lease of a jog, see Renew.
void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, axis::State& slave,
           State& s) noexcept;
// Release ends the jog with this ticket, Renew extends its lease. Both return false if there is no such jog.
bool Release(const Context& c, Ticket ticket, State& s) noexcept;
bool Renew(const Context& c, Ticket ticket, State& s) noexcept;

// Call after the EmergencyStop of its slave: a module that moved the slave enters the error state and drops all
// requests.
void EmergencyStop(const Context& c, axis::State& slave, State& s) noexcept;

// Stage Move: after the master, before the slave.
void Step(const Context& c, axis::State& slave, State& s) noexcept;

void Publish(const Context& c, const axis::State& slave, const State& s, Outputs& out) noexcept;

}  // namespace takt::flexcam
