// Complete memory of an axes group: plain data that can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/stops.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/group/request.h"
#include "takt/group/state_table.h"
#include "takt/group/stream.h"
#include "takt/group/track_state.h"
#include "takt/kinematics/carrier.h"
#include "takt/kinematics/joints.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/path_pace.h"

namespace takt::group {

inline constexpr std::size_t kQueue = 128;  // capacity, in moves
inline constexpr std::size_t kSynced = 4;   // axes that follow the path

// Moves in the order of their arrival; a ring.
struct Queue {
  std::array<Request, kQueue> moves;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

// Stage of the planning of a move.
enum class Stage : std::uint8_t { kIdle, kVerify, kCheck, kJoin, kSample, kSweep, kEnter };

struct Planning {
  Stage stage = Stage::kIdle;
  std::uint64_t move = 1;      // number of the move being planned, from 1 since the start
  std::uint32_t element = 0;   // of a path, from 0
  bool tried = false;          // all elements of the path have been verified
  bool verifying = false;      // the start of the move has been verified
  double verified = 0;         // [mm] arc length verified so far ...
  double step = 0;             // ... and distance to the next point to verify
  std::uint64_t question = 0;  // number of the last path check request
  std::uint64_t joined = 0;    // cycle in which the last stretch was joined
  std::uint64_t nodes = 0;     // appended so far; the window itself is not part of the state
};

// Coupling between a carrier and the tool: `travel` is the carrier's travel as the tool takes it. The tool gets onto a
// moving carrier, and off it, along the travel of the carrier only, within limits.
struct Clutch {
  bool used = false;
  bool coupled = false;     // `travel` is the carrier's own
  std::uint64_t ride = 0;   // number of the carrier binding
  KinematicState travel;    // [mm or rad]
  bool catches_up = false;  // the tool is getting into sync
  bool boards = false;      // from rest, while the path already runs (boarding.h)
  bool reserved = false;    // its limits are not shared with the path (boarding.h)
  KinematicState apart;     // while catching up: `travel` minus the carrier's [mm or rad]
  // Limits of `travel`.
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;

  // The tool gets into sync, or out of it, by a quintic over this distance of the carrier's travel [mm or rad]; 0: as
  // fast as the limits allow.
  double law_length = 0;
  double law_begin = 0;  // the carrier's travel at its start
  double law_from = 0;   // the tool's travel at its start ...
  double law_way = 0;    // ... and displacement over it

  trajectory::Limits limits() const noexcept { return {velocity, acceleration, deceleration, jerk}; }
};
inline constexpr std::size_t kClutches = 2;

// Tracking of an object by command (track.h). Distances [mm or rad] along the travel of the carrier since the recorded
// position.
struct Track {
  Ticket ticket = 0;         // 0: none
  std::uint64_t behind = 0;  // number of the move after which it starts; 0: at once
  bool active = false;
  bool started = false;  // the tool is coupled to the object, or on its way to it
  bool boarded = false;  // a stretch on the object's carrier has begun
  bool ends = false;     // the object has left the range of tracking
  bool in_sync = false;
  std::uint64_t near_cycles = 0;
  CarriedTarget cargo;
  kinematics::CarrierKind kind = kinematics::CarrierKind::kStraight;
  double sense = 1;  // +1 or -1: direction of the travel
  double begin = 0;
  double end = 0;
  double in_distance = 0;
  double in_tool = 0;
  double out_distance = 0;
  double out_tool = 0;
};

// Directions of the axes (bits 0 to 7) and of the tool along and about X, Y, Z of the MCS (bits 8 to 13).
struct Directions {
  std::uint32_t positive = 0;
  std::uint32_t negative = 0;

  bool any() const noexcept { return (positive | negative) != 0; }
};

// Offset of the tool above its path (rise.h).
struct Rise {
  bool used = false;
  double height = 0;      // [mm] of the tool at the end, in the coordinate system of the object
  double target = 0;      // [mm] of the offset
  KinematicState offset;  // [mm]
  double velocity = 0;    // limits of the offset
  double acceleration = 0;
  double jerk = 0;
};

// A jog as planned.
struct Jogging {
  double speed = 0;                                       // along its path, at the speeds in Request::to
  ErrorId border = ErrorId::kNone;                        // what ends its path; kNone: its largest length
  kinematics::Reason reason = kinematics::Reason::kNone;  // likewise
  PathChecked met;                                        // likewise, in the workspace
};

// What a group does besides moves.
enum class Task : std::uint8_t { kNone, kStop, kHalt, kInterrupt, kHome, kPower };

using Brake = trajectory::PathBrake;

struct SyncedAxis {
  Ticket ticket = 0;
  std::uint32_t axis = 0;  // index + 1; 0: none
  double ratio = 1;        // [u/mm]
  double offset = 0;       // [u] over all turns, at arc length 0
  bool reached = false;    // it has been in sync once
};

// A path that follows a master axis.
struct MasterState {
  std::uint32_t axis = 0;  // index + 1; 0: none, the path runs by time
  std::uint64_t move = 0;  // number of the move that follows
  double begin = 0;        // [u] over all turns, position of the master at the start of the path
  double ratio = 1;        // [mm/u]
  double before = 0;       // [mm/s²] acceleration of the path demanded in the previous cycle
  bool in_step = false;
  bool reached = false;  // it has been in sync once
};

struct State {
  GroupState state = GroupState::kDisabled;
  ErrorId error = ErrorId::kNone;
  std::array<std::uint32_t, kMaxAxes> members{};  // axis index + 1; 0: none
  bool kinematics_on = true;
  std::array<kinematics::Pose, kProductSystems> product_systems{};  // in the MCS
  std::array<CarriedTarget, kProductSystems> cargoes{};             // targets of the systems that move instead
  bool tool_changed = false;  // since the machine was made; the frames are in Context::mounting
  kinematics::Pose tool;      // then: its pose on the flange
  double velocity_factor = 1;
  double acceleration_factor = 1;
  double jerk_factor = 1;

  Queue queue;               // moves[first] is being planned or in execution
  std::uint64_t done = 1;    // number of the move at queue.first
  std::uint64_t failed = 0;  // number of the last move before it that was aborted or failed; 0: none
  Ticket active = 0;         // of the move in execution; 0: none
  Ticket boards = 0;         // of the move for which the tool has boarded (boarding.h); 0: none
  Ticket goes_over = 0;      // of a move whose boarding was given up: planned with a transition between bindings
  Planning planning;
  trajectory::PathPace pace;
  bool guides = false;        // the members follow the group's set points
  bool begun = false;         // a motion along the path is in progress
  bool interrupted = false;   // at rest, or coming to rest, on the path until continued
  bool ends = false;          // comes to rest and discards the rest of the path
  Brake brake;                // how it brakes then
  std::uint32_t weighed = 0;  // members whose stopping distance along the path was compared with their own; a mask
  bool lets_go = false;       // releases its carriers: the tool comes to rest in the MCS
  std::array<Clutch, kClutches> clutches{};
  std::array<std::uint32_t, kClutches> ridden{};  // numbers of the carriers that take part in the motion now; 0: none
  Rise rise;
  Track track;
  axis::StopRequests holds;  // stops that hold the group, whatever has been commanded since
  Ticket ticket = 0;         // of the task
  Task task = Task::kNone;
  double lease_s = 0;  // [s] of a jog; 0: none
  std::uint64_t lease_end_cycle = 0;
  kinematics::Joints joints{};   // commanded positions of the members
  kinematics::Joints origins{};  // origins of the members (whole turns and zero offsets) when guidance began
  bool stop_reported = false;
  bool power_on = false;  // state that the last power command asked for
  bool resetting = false;
  bool reset_asked = false;  // the members have received the reset
  Ticket reset_ticket = 0;
  std::array<SyncedAxis, kSynced> synced;
  double way_before = 0;  // [mm] length of all paths before this one
  MasterState master;
  Jogging jog;
  StreamState stream;
  kinematics::Reason reason = kinematics::Reason::kNone;
  path::Problem problem = path::Problem::kNone;
  double blocked_at = 0;
  std::uint32_t blocked_element = 0;  // of a path, from 1; 0: no path
  Directions closed;                  // by switches that a module reads: no motion takes them (switches.h)
  Directions refused;                 // closed directions, the members' own included, that the last motion takes
  PathChecked answer;                 // to the last path check request
  // Zones (zones.h), as masks.
  std::uint32_t zones = 0;                // held by the group
  std::uint32_t zones_claimed = 0;        // of those: for the move being planned, ...
  std::uint64_t claimed_for = 0;          // ... which has this number
  std::uint32_t zones_wanted = 0;         // that the group waits for, ...
  std::uint32_t waits_for = 0;            // ... because this group (from 1) has one or is next; 0: it does not wait
  std::uint32_t waits_zone = 0;           // zone that it waits for, from 1; 0: none
  std::uint64_t waits_since = 0;          // cycle in which the wait began
  bool zone_circle = false;               // the last move was refused because groups would wait for one another
  bool zone_near = false;                 // a carrier will soon take the tool into a zone of another group
  bool gets_off = false;                  // it brakes for such a zone, to wait there: its moves are kept
  std::uint64_t illegal_transitions = 0;  // always 0: the state table holds
};

void describe(Description<Queue>&);
void describe(Enumeration<Stage>&);
void describe(Description<Planning>&);
void describe(Description<Clutch>&);
void describe(Description<Track>&);
void describe(Description<Directions>&);
void describe(Description<Rise>&);
void describe(Description<Jogging>&);
void describe(Enumeration<Task>&);
void describe(Description<SyncedAxis>&);
void describe(Description<MasterState>&);
void describe(Description<State>&);

}  // namespace takt::group
