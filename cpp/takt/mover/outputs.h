// What a mover publishes every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/object.h"
#include "takt/core/status.h"
#include "takt/mover/command_mode.h"
#include "takt/mover/commands.h"
#include "takt/planar/object_state.h"

namespace takt::mover {

// Why a mover that has a command does not go on (PL-70).
enum class Delay : std::uint8_t {
  kNone,
  kMover,      // another one is in its way: waits_for
  kTrackEnd,   // its way ends here
  kTime,       // a wait for some time
  kRelease,    // one for a release; its route is being held
  kMaster,     // its master is where it may not go, or is held up itself
  kPart,       // a part of the surface is on its way, or not enabled
  kDeadlock,   // the movers ahead of it wait for one another
  kTrack,      // a track that is Moving is in its way
  kFormation,  // what is buffered waits until it has left its formation
  kPlace,      // another one visits the next place of its route before
};

struct Outputs {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  CommandMode command_mode = CommandMode::kFreeMovement;
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;  // what of the dynamics of the last command was reduced
  // Set points at the end of this cycle.
  double x = 0, y = 0, z = 0;                                         // mm
  double a = 0, b = 0, c = 0;                                         // deg
  double velocity_x = 0, velocity_y = 0, velocity_z = 0;              // mm/s
  double velocity_a = 0, velocity_b = 0, velocity_c = 0;              // deg/s
  double acceleration_x = 0, acceleration_y = 0, acceleration_z = 0;  // mm/s²
  double acceleration_a = 0, acceleration_b = 0, acceleration_c = 0;  // deg/s²
  // What is measured, at the beginning of this cycle.
  double actual_x = 0, actual_y = 0, actual_z = 0;  // mm
  double actual_a = 0, actual_b = 0, actual_c = 0;  // deg
  bool busy_xyc = false;                            // a move of X and Y, and of what turns with them
  bool busy_z = false, busy_a = false, busy_b = false, busy_c = false;
  SetpointMode external = SetpointMode::kNone;
  std::uint32_t track = 0;        // number of the track that it joins, is on, or leaves, from 1; 0: none
  double track_position = 0;      // mm along it, where it is on it
  double track_velocity = 0;      // mm/s
  double track_acceleration = 0;  // mm/s²
  double gap = 0;                 // mm, that it keeps to the mover before it on a track
  // Where its command leads it; on a track, or moved from outside, X and Y are where they are.
  double target_x = 0, target_y = 0;  // mm
  double target_c = 0;                // deg
  std::uint32_t target_track = 0;     // number of the track that its command leads it to, from 1; 0: none
  double target_position = 0;         // mm along that
  // The rectangle that what it has reserved in its group lies in, mm; all 0: its group does not watch.
  double reserved_lower_x = 0, reserved_lower_y = 0, reserved_upper_x = 0, reserved_upper_y = 0;
  bool in_sync = false;           // it is where its master or star wants it
  double sync_error = 0;          // mm, its place minus that
  std::uint32_t waits_for = 0;    // number of the mover that is in its way, from 1; 0: none
  bool deadlocked = false;        // that one waits for it, over others or not
  Delay delay = Delay::kNone;     // why it does not go on
  std::uint64_t delay_since = 0;  // cycle; 0: it goes on
  // What it waits for, be it a mover, an axis, a track or a part: of what kind, and its number from 1; 0: nothing.
  ObjectKind blocker_kind = ObjectKind::kNone;
  std::uint32_t blocker = 0;
  std::uint32_t buffered = 0;  // commands that wait for their turn
  std::uint32_t group = 0;     // number of the group of movers that it is in, from 1; 0: none
  // Numbers, from 1, of the coordinate system that positions are in, and of the part that its middle is on; 0: none.
  std::uint32_t coordinate_system = 0;
  std::uint32_t part = 0;
  std::uint32_t formation = 0;      // number of the star of the formation that it is in, itself or another; 0: none
  std::uint64_t commands = 0;       // so many have come
  bool on_route = false;            // over the free surface
  std::uint64_t route_granted = 0;  // number of the last visit that is its turn
  std::uint64_t route_visit = 0;    // number of the last visit of its routes whose place it has reached
};

void describe(Enumeration<Delay>&);
void describe(Description<Outputs>&);

}  // namespace takt::mover
