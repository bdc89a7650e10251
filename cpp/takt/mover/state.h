// All memory of a mover: plain, so that it can be copied, compared, hashed and replayed.
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

using SetPoint = std::array<KinematicState, kCoordinates>;  // mm, deg

// Where a command leads X or Y by itself.
struct Goal {
  bool active = false;  // a command leads to it; else the coordinate comes to rest, or stands
  double target = 0;    // mm
  trajectory::Limits limits;
};

// A motion of X and Y in progress.
struct PlaneMove {
  PlaneMotion motion;
  std::uint64_t begin = 0;  // cycle
  bool waits = false;       // it only comes to rest, and then goes to `next`
  MoveToPosition next;      // with all its dynamics
  bool each = false;        // X and Y move each by itself, to their goals
  std::array<Goal, 2> goals{};
  bool turns = false;  // C belongs to it
  trajectory::Limits limits;
  bool tried = false;   // whether it can go round a corner has been looked at
  bool passes = false;  // it goes round a corner at its end: what is buffered next takes over where it ends
  double share = 0;     // of the limits then, across the second line
  double corner_x = 0, corner_y = 0;        // mm
  bool hard = false;                        // it comes to rest with the greatest dynamics
  bool goes = false;                        // a command leads it to a target; else it comes to rest
  std::uint32_t held_by = planar::kNobody;  // the mover in its way: it comes to rest, and goes on once that is clear
  std::uint64_t held_since = 0;             // cycle
};

// How X and Y come to rest if the mover may not go on: the course that the guard knows of it.
struct Escape {
  PlaneMotion motion;
  std::uint64_t begin = 0;  // cycle
  // It is good from the beginning of this cycle on; none yet.
  std::uint64_t cycle = std::numeric_limits<std::uint64_t>::max();
};

// One of another coordinate.
struct CoordinateMove {
  trajectory::Profile profile;
  std::uint64_t begin = 0;  // cycle
};

// A move of X, Y or C by velocity: as far as there is room.
struct Endless {
  bool on = false;
  bool reached = false;          // its velocity, as said
  double velocity = 0;           // mm/s, deg/s
  ErrorId end = ErrorId::kNone;  // why it ends where it does
  ObjectInfo object{};           // that is in its way there
};
inline constexpr std::array kEndless = {kX, kY, kC};

// Set points from outside.
struct External {
  SetpointMode mode = SetpointMode::kNone;
  SetPoint given{};           // the last one, or what it went on to
  bool fresh = false;         // one has come in this cycle
  SetPoint taken{};           // the last one that the mover followed
  std::uint32_t missing = 0;  // so many in a row
};

inline constexpr std::uint32_t kNoStar = 0xffffffff;

// What a mover goes along with; the rest of it lies with its place on tracks (planar/gear.h).
inline constexpr std::uint32_t kNoMaster = 0xffffffff;
struct GearState {
  std::uint32_t axis =
      kNoMaster;         // number of the master among TrackNetworkState::masters; kNoMaster: a mover, or nothing
  bool in_sync = false;  // as last said
};

// A planet's place in a formation (mover/formation.h), and what a star remembers of its own.
struct FormationState {
  std::uint32_t star = kNoStar;  // number of the mover that it goes along with, from 0
  double x = 0, y = 0;           // mm, where it is seen from the star
  double c = 0;                  // deg, to the star
  bool joined = false;           // as last said
  bool whole = false;            // of a star: what it does now may have all of its dynamics ...
  double share = 0.5;            // ... else, what turning has of them
  bool brakes = false;           // of a star: for a planet that cannot go on
};

// What commands there may be at a time, each with a ticket of its own.
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
  std::uint64_t since = 0;  // cycle in which it came to be so
  CommandMode mode = CommandMode::kFreeMovement;
  bool aborts = false;  // the fault is to lead to Disabled
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;  // what of the dynamics of the last command was reduced
  std::array<Ticket, kSlots> tickets{};
  std::array<std::uint64_t, kSlots> begun{};  // cycle in which each took its slot
  Buffer buffer;
  Escape escape;
  PlaneMove plane;                         // on a track: of where it is off its place there
  std::uint32_t track = planar::kNoTrack;  // that it joins, is on, or leaves
  std::uint32_t system = 0;                // coordinate system where it is, from 0
  std::uint32_t part = planar::kNoPart;    // that its middle is on
  GearState gear;
  FormationState formation;
  std::array<CoordinateMove, kOthers.size()> others;  // in the order of kOthers
  std::array<Endless, kEndless.size()> endless;       // in the order of kEndless
  External external;
  SetPoint set_point{};     // at the end of the last cycle
  planar::Place carried{};  // mm, by parts: its place was put so much further on, without any motion
  History history;
};

State MakeState(const MoverParams& params);

void describe(Description<Goal>&);
void describe(Description<PlaneMove>&);
void describe(Description<Escape>&);
void describe(Description<CoordinateMove>&);
void describe(Description<Endless>&);
void describe(Description<External>&);
void describe(Description<GearState>&);
void describe(Description<FormationState>&);
void describe(Description<State>&);

}  // namespace takt::mover
