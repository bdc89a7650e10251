// The complete state of a mover: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/mover/buffer.h"
#include "takt/mover/command_mode.h"
#include "takt/mover/commands.h"
#include "takt/mover/history.h"
#include "takt/mover/params.h"
#include "takt/mover/plane.h"
#include "takt/planar/network.h"
#include "takt/planar/object_state.h"
#include "takt/planar/parts.h"
#include "takt/planar/rider.h"
#include "takt/trajectory/profile.h"

namespace takt::mover {

enum Coordinate : std::size_t { kX, kY, kZ, kA, kB, kC, kCoordinates };
inline constexpr std::array kOthers = {kZ, kA, kB, kC};  // besides X and Y

using SetPoint = std::array<KinematicState, kCoordinates>;  // [mm, deg]

// Goal of X or Y by itself.
struct Goal {
  bool active = false;  // a command moves to `target`; else the coordinate stops, or is at rest
  double target = 0;    // [mm]
  trajectory::Limits limits;
};

// A motion of X and Y in progress.
struct PlaneMove {
  PlaneMotion motion;
  std::uint64_t begin = 0;  // cycle
  bool waits = false;       // the motion is a stop, after which the move to `next` begins
  MoveToPosition next;      // the move after the stop, with all its dynamics
  bool each = false;        // X and Y move each by itself, to `goals`
  std::array<Goal, 2> goals{};
  bool turns = false;  // C belongs to the move
  trajectory::Limits limits;
  bool tried = false;  // a blend of the corner at its end has been tried
  // the corner at its end is blended: the next buffered command takes over at the end of `motion`
  bool passes = false;
  double share = 0;                         // of the limits, across the second line of the blend
  double corner_x = 0, corner_y = 0;        // [mm]
  bool hard = false;                        // it stops with the maximum dynamics
  bool goes = false;                        // a command moves it to a target; else it stops
  std::uint32_t held_by = planar::kNobody;  // the mover in its way: it stops, and continues once the path is clear
  std::uint64_t held_since = 0;             // cycle
};

// The stop of X and Y if the mover may not move on: the course that the guard knows.
struct StopMotion {
  PlaneMotion motion;
  std::uint64_t begin = 0;  // cycle
  // The cycle at whose beginning it applies; maximum: none yet.
  std::uint64_t cycle = std::numeric_limits<std::uint64_t>::max();
};

// A motion of another coordinate in progress.
struct CoordinateMove {
  trajectory::Profile profile;
  std::uint64_t begin = 0;  // cycle
};

// A move of X, Y or C by velocity, until the room is used up.
struct VelocityMove {
  bool on = false;
  bool reached = false;          // the velocity has been reached and reported
  double velocity = 0;           // [mm/s, deg/s]
  ErrorId end = ErrorId::kNone;  // why it ends at the end of its room
  ObjectInfo object{};           // the obstacle there, if any
};
inline constexpr std::array kVelocityCoordinates = {kX, kY, kC};

// External set points.
struct External {
  SetpointMode mode = SetpointMode::kNone;
  SetPoint given{};           // the last one received, extrapolated over missing cycles
  bool fresh = false;         // one was received in this cycle
  SetPoint taken{};           // the last one that the mover followed
  std::uint32_t missing = 0;  // number of consecutive missing ones
};

inline constexpr std::uint32_t kNoStar = 0xffffffff;

// The master of a mover; the rest is with its state on tracks (planar/gear.h).
inline constexpr std::uint32_t kNoMaster = 0xffffffff;
struct GearState {
  std::uint32_t axis =
      kNoMaster;         // index in TrackNetworkState::masters; kNoMaster: the master is a mover, or there is none
  bool in_sync = false;  // as last reported
};

// State of a planet in a formation (mover/formation.h), and of a star.
struct FormationState {
  std::uint32_t star = kNoStar;  // index of the mover that it follows; kNoStar: none
  double x = 0, y = 0;           // [mm] position relative to the star, in its frame
  double c = 0;                  // [deg] angle relative to the star
  bool joined = false;           // as last reported
  bool whole = false;            // of a star: the motion in progress may use all of the dynamics ...
  double share = 0.5;            // ... else turning has this share of them
  bool brakes = false;           // of a star: it stops because of a planet that cannot continue
};

// Commands that may be in progress at the same time, each with its own ticket.
enum Slot : std::size_t {
  kPower,
  kPlane,
  kMoveX,
  kMoveY,
  kMoveZ,
  kMoveA,
  kMoveB,
  kMoveC,
  kHalt,
  kHaltOnTrack,
  kExternal,
  kStopExternal,
  kWait,
  kPassing,
  kFormation,
  kRoute,
  kSlots
};

struct State {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  std::uint64_t since = 0;  // cycle in which `state` was entered
  CommandMode mode = CommandMode::kFreeMovement;
  bool aborts = false;  // a reset of the fault leads to Disabled
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;  // first value of the dynamics of the last command that was reduced
  std::array<Ticket, kSlots> tickets{};
  std::array<std::uint64_t, kSlots> begun{};  // cycle in which each took its slot
  Buffer buffer;
  StopMotion escape;
  PlaneMove plane;                         // on a track: of the displacement from the position there
  std::uint32_t track = planar::kNoTrack;  // track that it joins, is on, or leaves
  std::uint32_t system = 0;                // index of its coordinate system
  std::uint32_t part = planar::kNoPart;    // part that its centre is on
  GearState gear;
  FormationState formation;
  std::array<CoordinateMove, kOthers.size()> others;              // in the order of kOthers
  std::array<VelocityMove, kVelocityCoordinates.size()> endless;  // in the order of kVelocityCoordinates
  External external;
  SetPoint set_point{};     // at the end of the last cycle
  planar::Place carried{};  // [mm] total displacement by moves of its part, without a motion of its own
  History history;
};

State MakeState(const MoverParams& params);

void describe(Description<Goal>&);
void describe(Description<PlaneMove>&);
void describe(Description<StopMotion>&);
void describe(Description<CoordinateMove>&);
void describe(Description<VelocityMove>&);
void describe(Description<External>&);
void describe(Description<GearState>&);
void describe(Description<FormationState>&);
void describe(Description<State>&);

}  // namespace takt::mover
