// One axes group, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks, throws
// or reads a clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/core/feedback.h"
#include "takt/group/carriers.h"
#include "takt/group/commands.h"
#include "takt/group/look_ahead.h"
#include "takt/group/outputs.h"
#include "takt/group/params.h"
#include "takt/group/path_check_request.h"
#include "takt/group/path_table.h"
#include "takt/group/state.h"
#include "takt/group/zones.h"
#include "takt/kinematics/kinematics.h"

namespace takt::group {

// The axes of the machine, to be commanded.
struct Axes {
  std::span<axis::State> states{};
  std::span<const axis::AxisParams> params{};
  axis::Context (*context)(void* owner, std::size_t axis) noexcept = nullptr;
  void* owner = nullptr;

  axis::Context Of(std::size_t axis) const noexcept { return context(owner, axis); }
};

// The mounting of the mechanism and of its tool, as frames: computed when a machine is made, and when its tool is
// changed (SetTool).
struct Mounting {
  kinematics::Frame base;          // X_WM: of the machine (M) in the world (W)
  kinematics::Frame base_inverse;  // X_MW
  kinematics::Frame tool;          // X_FT: of the tool centre point (T) on the flange (F)
  kinematics::Frame tool_inverse;  // X_TF
};
Mounting MakeMounting(const GroupParams& params);
void MountTool(const kinematics::Frame& tool, Mounting& mounting) noexcept;

// What every stage gets besides the state of the group.
struct Context {
  const GroupParams& params;
  Mounting& mounting;
  const kinematics::Kinematics* kinematics = nullptr;  // null: none
  std::span<const PathTable> paths{};
  // For each axis of the machine the number of its group, from 1; 0: none.
  std::span<std::uint32_t> group_of{};
  std::uint32_t number = 0;  // of this group, from 1
  Axes axes;
  Cycle cycle;
  FeedbackSink& feedback;
  LookAhead& ahead;
  Carriers carriers{};
  PathCheckRequests* questions = nullptr;  // receives path check requests; null: paths are not checked
  Zones zones{};
  bool plans_elsewhere = false;  // plans are computed outside the cycle and announced by PathPlanned
};

// Returns the state at power-on. `axes`: index of each member.
State MakeState(std::span<const std::uint32_t> axes) noexcept;

// Stage command: executes, queues or refuses a command, and reports it under `ticket`. `lease_s` [s]: a held stop or a
// jog ends by itself so long after its last Renew; 0: never.
void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, State& s) noexcept;
// Release ends the held stop or the jog with this ticket; Renew extends its lease from this cycle on. Both return false
// if there is none, Renew also if it was given without a lease.
bool Release(const Context& c, Ticket ticket, State& s) noexcept;
bool Renew(const Context& c, Ticket ticket, State& s) noexcept;

// Emergency stop (AX-100); called before that of the members. A group that moves, homes, stops, has queued moves or
// controls its members goes to GroupErrorStop, otherwise its state stays; all of its commands end with kEmergencyStop.
void EmergencyStop(const Context& c, State& s) noexcept;

// Stage move: before the members, after the axis that a path follows.
void Step(const Context& c, State& s) noexcept;

void Publish(const Context& c, const State& s, Outputs& out) noexcept;

// Returns true in all states but GroupDisabled: motion commands to single members are refused (kGroupMember, 1000).
bool Owns(const State& s) noexcept;

}  // namespace takt::group
