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

// What every stage gets besides the module itself.
struct Context {
  const FlexCamParams& params;
  axis::Context slave;  // of the axis that is moved
  std::optional<std::uint32_t> master{};
  axis::HomingParams homing{};  // of the slave, as the machine file has it
};

// Whether a slot, the cam that runs or one that a sequence may come back to has this index.
bool UsesCam(const State& state, std::uint32_t index) noexcept;

// As it stands when power comes on. `slots`: numbers of the machine's cams from 1; 0: none.
State MakeState(const FlexCamParams& params, const std::array<std::uint32_t, kSlots>& slots) noexcept;

// command: carries a command out or refuses it; reports either way. `lease_s` > 0: of a jog, see Renew.
void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, axis::State& slave,
           State& s) noexcept;
// Lets go of a jog with this ticket, and extends its lease. False: there is none.
bool Release(const Context& c, Ticket ticket, State& s) noexcept;
bool Renew(const Context& c, Ticket ticket, State& s) noexcept;

// Behind that of its slave: a module that moved it is in error, and does nothing that was asked for before.
void EmergencyStop(const Context& c, axis::State& slave, State& s) noexcept;

// move: behind the master, before the slave.
void Step(const Context& c, axis::State& slave, State& s) noexcept;

void Publish(const Context& c, const axis::State& slave, const State& s, Outputs& out) noexcept;

}  // namespace takt::flexcam
