// All memory of an axes group: plain, so that it can be copied, compared, hashed and replayed.
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

inline constexpr std::size_t kQueue = 128;  // moves that may wait
inline constexpr std::size_t kSynced = 4;   // axes that follow the path

// Moves in the order in which they came; a ring.
struct Queue {
  std::array<Request, kQueue> moves;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

// Where the planning of a move has got to.
enum class Stage : std::uint8_t { kIdle, kVerify, kCheck, kJoin, kSample, kSweep, kEnter };

struct Planning {
  Stage stage = Stage::kIdle;
  std::uint64_t move = 1;      // number of the move that is planned, from 1 since the start
  std::uint32_t element = 0;   // of a path
  bool tried = false;          // all elements of it are good
  bool verifying = false;      // the beginning is good
  double verified = 0;         // mm: the path is good so far ...
  double step = 0;             // ... and is tried so much further on next
  std::uint64_t question = 0;  // number of the last one about a path
  std::uint64_t joined = 0;    // cycle in which the last stretch was joined
  std::uint64_t nodes = 0;     // so many were made: the window itself is no part of the state
};

// Between a carrier and the tool: where the carrier's travel is as far as the tool is concerned. The tool gets onto
// what moves, and off it, along the travel of the carrier alone, within limits.
struct Clutch {
  bool used = false;
  bool coupled = false;     // it is the carrier's own
  std::uint64_t ride = 0;   // number of the ride
  KinematicState travel;    // mm or rad
  bool catches_up = false;  // the tool is on its way into step
  bool boards = false;      // from rest, and the path goes on meanwhile (boarding.h)
  bool reserved = false;    // the path leaves it its limits and waits (boarding.h)
  KinematicState apart;     // how far its travel is from the carrier's then, and how that changes
  // Of the travel.
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;

  // Over a distance of the carrier's travel the tool gets into step, or out of it: a quintic over that. 0: as fast as
  // the limits allow.
  double law_length = 0;
  double law_begin = 0;  // of the carrier's travel
  double law_from = 0;   // of the tool's ...
  double law_way = 0;    // ... and so far

  trajectory::Limits limits() const noexcept { return {velocity, acceleration, deceleration, jerk}; }
};
inline constexpr std::size_t kClutches = 2;

// Tracking an object by command (track.h). Distances along the travel of the carrier, mm or rad, since it was recorded.
struct Track {
  Ticket ticket = 0;         // 0: none
  std::uint64_t behind = 0;  // number of the move that it waits for
  bool active = false;
  bool started = false;  // the tool is taken along
  bool boarded = false;  // and on the object's carrier
  bool ends = false;     // the object has left
  bool in_sync = false;
  std::uint64_t near_cycles = 0;
  CarriedTarget cargo;
  kinematics::CarrierKind kind = kinematics::CarrierKind::kStraight;
  double sense = 1;  // of the travel
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

// The tool above its path (rise.h).
struct Rise {
  bool used = false;
  double height = 0;      // mm, that it is to have in the end
  double target = 0;      // mm, of the offset
  KinematicState offset;  // mm
  double velocity = 0;    // limits of that
  double acceleration = 0;
  double jerk = 0;
};

// A jog as it was planned.
struct Jogging {
  double speed = 0;                                       // along its way, of the speeds in Request::to
  ErrorId border = ErrorId::kNone;                        // what its way ends at; kNone: it could be longer
  kinematics::Reason reason = kinematics::Reason::kNone;  // the same
  PathChecked met;                                        // the same, of the workspace
};

// What a group is doing besides moves.
enum class Task : std::uint8_t { kNone, kStop, kHalt, kInterrupt, kHome, kPower };

using Brake = trajectory::PathBrake;

struct SyncedAxis {
  Ticket ticket = 0;
  std::uint32_t axis = 0;  // + 1; 0: none
  double ratio = 1;        // u per mm
  double offset = 0;       // u, over all turns, where the way is 0
  bool reached = false;    // it was in step once
};

// A path that is gone as a master says.
struct MasterState {
  std::uint32_t axis = 0;  // + 1; 0: time says how fast
  std::uint64_t move = 0;  // number of the move that is gone so
  double begin = 0;        // u, over all turns, where the path begins
  double ratio = 1;        // mm per u
  double before = 0;       // mm/s², of the path as the master moved in the cycle before
  bool in_step = false;
  bool reached = false;  // it was once
};

struct State {
  GroupState state = GroupState::kDisabled;
  ErrorId error = ErrorId::kNone;
  std::array<std::uint32_t, kMaxAxes> members{};  // axis + 1 in each place; 0: none
  bool kinematics_on = true;
  std::array<kinematics::Pose, kProductSystems> product_systems{};  // in the MCS
  std::array<CarriedTarget, kProductSystems> cargoes{};             // of those that move instead
  bool tool_changed = false;  // since the machine was made; the frames are in Context::mounting
  kinematics::Pose tool;      // then: on the flange
  double velocity_factor = 1;
  double acceleration_factor = 1;
  double jerk_factor = 1;

  Queue queue;               // [first] is the one planned or moved along now
  std::uint64_t done = 1;    // number of the move at queue.first
  std::uint64_t failed = 0;  // number of the last one before it that was aborted or failed; 0: none
  Ticket active = 0;         // of the move in execution
  Ticket boards = 0;         // of the move for which the tool has boarded (boarding.h); 0: none
  Ticket goes_over = 0;      // of a move that could not be carried out so
  Planning planning;
  trajectory::PathPace pace;
  bool guides = false;        // the members go by the group's set points
  bool begun = false;         // a motion along the path is in progress
  bool interrupted = false;   // rests, or comes to rest, on the path until it is continued
  bool ends = false;          // comes to rest and forgets what is left of the path
  Brake brake;                // how it brakes then
  std::uint32_t weighed = 0;  // members whose way to rest along the path was held against their own, a mask
  bool lets_go = false;       // of what carries it: the tool comes to rest in the MCS
  std::array<Clutch, kClutches> clutches{};
  std::array<std::uint32_t, kClutches> ridden{};  // numbers of the carriers that take part in the motion now
  Rise rise;
  Track track;
  axis::StopOrders holds;  // stops that hold it, whatever has come since
  Ticket ticket = 0;       // of the task
  Task task = Task::kNone;
  double lease_s = 0;  // of a jog
  std::uint64_t lease_end_cycle = 0;
  kinematics::Joints joints{};   // where the members are told to be
  kinematics::Joints origins{};  // whole turns and zeros taken out of their positions when they began to be guided
  bool stop_reported = false;
  bool power_on = false;  // what power asked for
  bool resetting = false;
  bool reset_asked = false;  // of the members
  Ticket reset_ticket = 0;
  std::array<SyncedAxis, kSynced> synced;
  double way_before = 0;  // mm, gone along all paths before this one
  MasterState master;
  Jogging jog;
  StreamState stream;
  kinematics::Reason reason = kinematics::Reason::kNone;
  path::Problem problem = path::Problem::kNone;
  double blocked_at = 0;
  std::uint32_t blocked_element = 0;  // of a path, from 1; 0: no path
  Directions closed;                  // by switches that a module looks at: nothing moves so (switches.h)
  Directions refused;                 // of those, and of the members' own: what the last move wanted
  PathChecked answer;                 // to the last question
  // Zones (zones.h), as masks.
  std::uint32_t zones = 0;                // that the group has
  std::uint32_t zones_claimed = 0;        // of those: for the move that is planned, ...
  std::uint64_t claimed_for = 0;          // ... with this number
  std::uint32_t zones_wanted = 0;         // that it waits for, ...
  std::uint32_t waits_for = 0;            // ... because this group has one or is before it, from 1; 0: it does not wait
  std::uint32_t waits_zone = 0;           // this one, from 1
  std::uint64_t waits_since = 0;          // cycle
  bool zone_circle = false;               // the last move was refused for that
  bool zone_near = false;                 // what carries the tool takes it soon into a zone of another group
  bool gets_off = false;                  // it is braked for such a zone, to wait there: its moves are kept
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
