// One pick and place module, stage by stage of the cycle: it moves a group by the group's own commands alone. Free
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

// What every stage gets besides the module itself.
struct Context {
  const PickPlaceParams& params;
  group::Context group;
  // Those of the params, in their order.
  std::array<Belt, kBelts> belts{};
  double path_error = 0;  // mm, of the group in the cycle before
};

// As it stands when power comes on.
State MakeState(const PickPlaceParams& params) noexcept;

// command: carries a command out or refuses it; reports either way. `lease_s` > 0: of a jog, see Renew.
void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, group::State& group,
           State& s) noexcept;
// Lets go of a jog with this ticket, and extends its lease. False: there is none.
bool Release(const Context& c, Ticket ticket, State& s) noexcept;
bool Renew(const Context& c, Ticket ticket, State& s) noexcept;

// Behind that of its group and axes: a module that was about something is in error, and does nothing that was asked for
// before.
void EmergencyStop(const Context& c, group::State& group, State& s) noexcept;

// move: just before the group.
void Step(const Context& c, group::State& group, State& s) noexcept;

void Publish(const Context& c, const group::State& group, const State& s, Outputs& out) noexcept;

}  // namespace takt::pickplace
