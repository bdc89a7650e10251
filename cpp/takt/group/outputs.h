// What an axes group publishes every cycle.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/group/commands.h"
#include "takt/group/state_table.h"
#include "takt/group/track_state.h"
#include "takt/kinematics/frames.h"
#include "takt/kinematics/joints.h"
#include "takt/path/segment.h"
#include "takt/workspace/trouble.h"

namespace takt::group {

struct Outputs {
  GroupState state = GroupState::kDisabled;
  ErrorId error = ErrorId::kNone;
  // Commanded pose of the tool centre point in the machine coordinate system; NaN without kinematics.
  double x = 0;  // [mm]
  double y = 0;  // [mm]
  double z = 0;  // [mm]
  double a = 0;  // [deg]
  double b = 0;  // [deg]
  double c = 0;  // [deg]
  // Actual pose, likewise.
  double actual_x = 0;
  double actual_y = 0;
  double actual_z = 0;
  double actual_a = 0;
  double actual_b = 0;
  double actual_c = 0;
  double velocity = 0;         // [mm/s] commanded speed of the tool centre point
  double acceleration = 0;     // [mm/s²] magnitude of its commanded acceleration
  double actual_velocity = 0;  // [mm/s]
  // Along the path, since the group began to move from rest.
  double path_position = 0;      // [mm]
  double path_velocity = 0;      // [mm/s]
  double path_acceleration = 0;  // [mm/s²]
  double path_left = 0;          // [mm] remaining path as far as it is planned
  double time_left = 0;          // [s] until the motion rests at the end of all commanded moves; NaN: not known
  double path_error = 0;  // [mm] from the position commanded for this cycle to the actual one; 0: a member is off
  double override_factor = 1;
  std::uint64_t command = 0;   // ticket of the move in execution; 0: none
  std::uint32_t buffered = 0;  // moves that wait
  std::uint32_t axes = 0;      // number of members
  // Number of the axis at each index of the group, from 1; 0: none.
  std::uint32_t member1 = 0;
  std::uint32_t member2 = 0;
  std::uint32_t member3 = 0;
  std::uint32_t member4 = 0;
  std::uint32_t member5 = 0;
  std::uint32_t member6 = 0;
  std::uint32_t member7 = 0;
  std::uint32_t member8 = 0;
  // Present poses of the product coordinate systems in the machine coordinate system.
  kinematics::Pose pcs1{}, pcs2{}, pcs3{}, pcs4{}, pcs5{}, pcs6{}, pcs7{}, pcs8{};
  kinematics::Pose pcs9{}, pcs10{}, pcs11{}, pcs12{}, pcs13{}, pcs14{}, pcs15{}, pcs16{};
  // Synchronization with an object on a carrier; NaN without one.
  TrackState track_state = TrackState::kNone;
  bool in_sync = false;
  double track_lag = 0;  // [mm; tables: rad] travel of the carrier minus that of the tool
  double object_x = 0;   // [mm] of the tool as commanded, in the coordinate system of the object
  double object_y = 0;
  double object_z = 0;
  double object_a = 0;  // [deg]
  double object_b = 0;
  double object_c = 0;
  bool kinematics_on = false;  // there are kinematics with all their members, and they are switched on
  bool in_position = false;    // in Standby with no move waiting
  bool interrupted = false;    // at rest, or coming to rest, on the path until continued
  bool synchronized = false;   // a path that follows a master is in sync with it
  // Why the last move was refused or ended.
  kinematics::Reason reason = kinematics::Reason::kNone;  // why the axes cannot take a pose
  path::Problem problem = path::Problem::kNone;           // why there is no such path
  // [mm] from the start of that move; in a path from the start of `blocked_element` (with `trouble`: of the path).
  double blocked_at = 0;
  std::uint32_t blocked_element = 0;  // element of a path of the machine file, from 1; 0: no such path
  workspace::Trouble trouble = workspace::Trouble::kNone;  // why the path is not free
  // The two parts that collide: numbers from 1 in workspace::PartNames; 0: none.
  std::uint32_t first_part = 0;
  std::uint32_t second_part = 0;
  bool on_blend = false;         // on the blend into that move or element
  bool checking = false;         // a path check is pending
  std::uint32_t zones = 0;       // held by the group, a mask
  std::uint32_t waits_for = 0;   // number of the group that it waits for at a zone, from 1; 0: it does not wait
  std::uint32_t waits_zone = 0;  // number of the zone, from 1; 0: none
  kinematics::Pose tool{};       // of the tool centre point on the flange
};

// Product coordinate systems by number, from 0.
inline constexpr std::array<kinematics::Pose Outputs::*, kProductSystems> kPublishedSystems = {
    &Outputs::pcs1,  &Outputs::pcs2,  &Outputs::pcs3,  &Outputs::pcs4,  &Outputs::pcs5,  &Outputs::pcs6,
    &Outputs::pcs7,  &Outputs::pcs8,  &Outputs::pcs9,  &Outputs::pcs10, &Outputs::pcs11, &Outputs::pcs12,
    &Outputs::pcs13, &Outputs::pcs14, &Outputs::pcs15, &Outputs::pcs16};

void describe(Description<Outputs>&);

}  // namespace takt::group
