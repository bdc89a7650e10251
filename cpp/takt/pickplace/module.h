// One pick and place module, stage by stage of the cycle: it moves a group with the group's own commands only. Free
// functions over plain state; nothing here allocates, locks, throws or reads a clock.
#pragma once

#include <cstdint>
#include <span>

#include "takt/conveyor/objects.h"
#include "takt/core/feedback.h"
#include "takt/group/group.h"
#include "takt/pickplace/commands.h"
#include "takt/pickplace/outputs.h"
#include "takt/pickplace/params.h"
#include "takt/pickplace/state.h"

namespace takt::pickplace {

// A belt of the machine.
struct Belt {
  const conveyor::BeltParams* params = nullptr;
  conveyor::State* state = nullptr;
};

// Input of every stage besides the module itself.
struct Context {
  const PickPlaceParams& params;
  group::Context group;
  // The belts of the params, in the same order.
  std::array<Belt, kBelts> belts{};
  double path_error = 0;  // [mm] path error of the group in the previous cycle
};

// Returns the state at power-on.
State MakeState(const PickPlaceParams& params) noexcept;

// Command stage: carries a command out or refuses it, and reports either. `lease_s` [s]: lease of a jog, see Renew; 0:
// none.
void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, group::State& group,
           State& s) noexcept;
// Release ends the jog with this ticket, Renew extends its lease. Returns false if there is no such jog (Renew: with a
// lease).
bool Release(const Context& c, Ticket ticket, State& s) noexcept;
bool Renew(const Context& c, Ticket ticket, State& s) noexcept;

// Runs after the emergency stop of the group and its axes: an active module goes into error and drops everything
// requested before.
void EmergencyStop(const Context& c, group::State& group, State& s) noexcept;

// Motion stage: runs just before the group's.
void Step(const Context& c, group::State& group, State& s) noexcept;

void Publish(const Context& c, const group::State& group, const State& s, Outputs& out) noexcept;

}  // namespace takt::pickplace
