// Values that a mover publishes in every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/object.h"
#include "takt/core/status.h"
#include "takt/mover/command_mode.h"
#include "takt/mover/commands.h"
#include "takt/planar/object_state.h"

namespace takt::mover {

// Why a mover with a command does not move on (PL-70).
enum class Delay : std::uint8_t {
  kNone,
  kMover,      // another mover is in its way: waits_for
  kTrackEnd,   // its route ends here
  kTime,       // it waits for a time
  kRelease,    // it waits for a release, or its route is held
  kMaster,     // its master is where the mover may not go, or is delayed itself
  kPart,       // a part of the surface is moving, or not enabled
  kDeadlock,   // the movers ahead of it wait for one another
  kTrack,      // a track that is Moving is in its way
  kFormation,  // buffered commands wait until it has left its formation
  kPlace,      // another mover visits the next place of its route before
};

struct Outputs {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  CommandMode command_mode = CommandMode::kFreeMovement;
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;  // first value of the dynamics of the last command that was reduced
  // Set points at the end of this cycle.
  double x = 0, y = 0, z = 0;                                         // [mm]
  double a = 0, b = 0, c = 0;                                         // [deg]
  double velocity_x = 0, velocity_y = 0, velocity_z = 0;              // [mm/s]
  double velocity_a = 0, velocity_b = 0, velocity_c = 0;              // [deg/s]
  double acceleration_x = 0, acceleration_y = 0, acceleration_z = 0;  // [mm/s²]
  double acceleration_a = 0, acceleration_b = 0, acceleration_c = 0;  // [deg/s²]
  // Measured values at the beginning of this cycle.
  double actual_x = 0, actual_y = 0, actual_z = 0;  // [mm]
  double actual_a = 0, actual_b = 0, actual_c = 0;  // [deg]
  bool busy_xyc = false;                            // X and Y move, with the C that belongs to that move
  bool busy_z = false, busy_a = false, busy_b = false, busy_c = false;
  SetpointMode external = SetpointMode::kNone;
  std::uint32_t track = 0;        // number, from 1, of the track that it joins, is on, or leaves; 0: none
  double track_position = 0;      // [mm] along the track, while it is on it
  double track_velocity = 0;      // [mm/s]
  double track_acceleration = 0;  // [mm/s²]
  double gap = 0;                 // [mm] that it keeps to the mover ahead on a track
  // Target of its command; on a track and with external set points, X and Y are the set position.
  double target_x = 0, target_y = 0;  // [mm]
  double target_c = 0;                // [deg]
  std::uint32_t target_track = 0;     // number, from 1, of the track of the target; 0: none
  double target_position = 0;         // [mm] along that track
  // [mm] bounding rectangle of the area that it has reserved in its group; all 0: its group is not enabled.
  double reserved_lower_x = 0, reserved_lower_y = 0, reserved_upper_x = 0, reserved_upper_y = 0;
  bool in_sync = false;           // it is in sync with its master, or follows its star
  double sync_error = 0;          // [mm] its position minus the one that its master demands
  std::uint32_t waits_for = 0;    // number, from 1, of the mover that is in its way; 0: none
  bool deadlocked = false;        // that mover waits for this one, directly or over other movers
  Delay delay = Delay::kNone;     // why it does not move on
  std::uint64_t delay_since = 0;  // cycle since which it does not move on; 0: no delay
  // The mover, axis, track or part that it waits for: its kind, and its number from 1; 0: none.
  ObjectKind blocker_kind = ObjectKind::kNone;
  std::uint32_t blocker = 0;
  std::uint32_t buffered = 0;  // number of commands in the buffer
  std::uint32_t group = 0;     // number, from 1, of the group of movers that it is in; 0: none
  // Numbers, from 1, of the coordinate system of the positions, and of the part that its centre is on; 0: none.
  std::uint32_t coordinate_system = 0;
  std::uint32_t part = 0;
  // number, from 1, of the star of the formation that it is in, the mover itself or another one; 0: none
  std::uint32_t formation = 0;
  std::uint64_t commands = 0;       // number of commands received
  bool on_route = false;            // it is on a route over the free surface
  std::uint64_t route_granted = 0;  // number of the last visit that is granted to it
  std::uint64_t route_visit = 0;    // number of the last visit whose place it has reached
};

void describe(Enumeration<Delay>&);
void describe(Description<Outputs>&);

}  // namespace takt::mover
