// Commands of a mover.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/inline_vector.h"
#include "takt/core/name.h"

namespace takt::mover {

// Which target is meant where positions repeat: after a full turn of C (c_modulus), or after the length of a closed
// track. MoveOnTrack on an open track: kPositive and kNegative allow one direction only, kShortestWay is as kNonModulo.
enum class TurnDirection : std::uint8_t {
  kNonModulo,    // to the absolute position, over as many turns as needed
  kPositive,     // upwards to the next equivalent position
  kShortestWay,  // to the nearest equivalent position
  kNegative,     // downwards to the next equivalent position
};

enum class SetpointMode : std::uint8_t {
  kNone,
  kAbsolute,  // the mover follows the set points alone
  kRelative,  // added to whatever else the mover does
};

enum class Buffering : std::uint8_t {
  kAborting,  // at once; if it takes over X or Y, the buffer is aborted
  kBuffered,  // when all commands before it are done
};

struct Enable {};
struct Disable {};
struct Reset {};

// The dynamics are those of X and Y; all other coordinates stop with their standard dynamics. A planet brings its
// formation to rest, with the maximum dynamics.
struct Halt {
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};

struct SetPosition {
  double x = 0, y = 0;  // [mm]
  double c = 0;         // [deg]
  Name reference{};     // part or coordinate system that X and Y belong to
};

struct MoveToPosition {
  double x = 0, y = 0;                   // [mm]
  std::optional<double> c{};             // [deg]; unset: C stays
  bool use_orientation = true;           // false: C stays in any case
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Name reference{};                      // part or coordinate system that X and Y belong to
  Buffering buffer_mode = Buffering::kAborting;
  // [mm] largest distance from the end of the preceding move at which this one takes over; needs kBuffered
  double blending = 0;
};
inline bool HasOrientationTarget(const MoveToPosition& move) noexcept {
  return move.use_orientation && move.c.has_value();
}

struct MoveZ {
  double position = 0;                   // [mm]
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveA {
  double position = 0;                   // [deg]
  std::optional<double> velocity{};      // [deg/s]
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveB {
  double position = 0;                   // [deg]
  std::optional<double> velocity{};      // [deg/s]
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveC {
  double position = 0;  // [deg]
  TurnDirection direction = TurnDirection::kNonModulo;
  std::uint32_t additional_turns = 0;    // with kPositive and kNegative only
  std::optional<double> velocity{};      // [deg/s]
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};

// X or Y by itself, whatever the other one does.
struct MoveX {
  double position = 0;                   // [mm]
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Name reference{};                      // part or coordinate system that the position belongs to
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveY {
  double position = 0;                   // [mm]
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Name reference{};                      // part or coordinate system that the position belongs to
  Buffering buffer_mode = Buffering::kAborting;
};
// By a distance from the position at the beginning of the command.
struct MoveRelativeX {
  double distance = 0;                   // [mm]
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveRelativeY {
  double distance = 0;                   // [mm]
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveRelativeC {
  double distance = 0;                   // [deg]
  std::optional<double> velocity{};      // [deg/s]
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
// At a velocity, until the room is used up. 0: the coordinate stops.
struct MoveVelocityX {
  double velocity = 0;                   // [mm/s] negative: towards smaller values
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveVelocityY {
  double velocity = 0;                   // [mm/s] negative: towards smaller values
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveVelocityC {
  double velocity = 0;                   // [deg/s] negative: towards smaller values
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
// One coordinate comes to rest; the others continue. During a move of both X and Y, HaltX and HaltY stop both on their
// line.
struct HaltX {
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};
struct HaltY {
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};
struct HaltZ {
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};
struct HaltA {
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
};
struct HaltB {
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
};
struct HaltC {
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
};
struct HaltOnTrack {                     // along its track; Z, A, B and C continue
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};

struct JoinTrack {
  Name track{};
  bool use_orientation = true;           // true: C turns to the orientation of the track, which is 0
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
struct LeaveTrack {
  double x = 0, y = 0;                   // [mm]
  double c = 0;                          // [deg] with use_orientation only
  bool use_orientation = true;           // false: C stays
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Name reference{};                      // part or coordinate system that X and Y belong to
  Buffering buffer_mode = Buffering::kAborting;
};
// How curves limit a move along tracks.
enum class DynamicsReduction : std::uint8_t {
  kAccelerationLimitedVelocity,  // slower, so that the lateral acceleration of the machine file is kept
  kNone,                         // as fast as the maxima of X and Y, as vectors, allow
};
struct MoveOnTrack {
  double position = 0;          // [mm] along the track, within [0, length]; any on a closed loop with kNonModulo
  Name track{};                 // empty: the track of the mover
  std::optional<double> gap{};  // [mm] to the mover ahead, from centre to centre
  TurnDirection direction = TurnDirection::kNonModulo;
  std::uint32_t additional_turns = 0;  // on a closed loop, with kPositive and kNegative only
  // [mm] on a closed loop, not with kNonModulo: a target within this distance is reached directly
  double modulo_tolerance = 0;
  DynamicsReduction dynamics_reduction = DynamicsReduction::kAccelerationLimitedVelocity;
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  Buffering buffer_mode = Buffering::kAborting;
};
// Directions in which a slave may move until it has been in sync.
enum class SyncDirections : std::uint8_t { kPositive, kNegative, kBoth };

// Consecutive tracks, each at most once.
using Trail = InlineVector<Name, 128>;

struct GearInPosOnTrack {  // along tracks, with an axis
  Name master{};
  double master_sync_position = 0;  // [u] of the master
  double slave_sync_position = 0;   // [mm] along the track
  Name slave_sync_track{};          // on the trail or just passed; empty: the present track of the mover
  Trail trail{};                    // empty: the present track of the mover alone
  std::optional<double> gap{};      // [mm] to the mover ahead, from centre to centre
  double in_sync_tolerance = 0;     // [mm]
  TurnDirection direction_slave_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_slave_sync_position = 0;  // [mm] of a closed loop
  SyncDirections allowed_slave_sync_directions = SyncDirections::kPositive;
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};
struct GearInPosOnTrackWithMasterMover {
  Name master{};
  double master_sync_position = 0;  // [mm] along the track
  Name master_sync_track{};         // empty: the track of the master
  double slave_sync_position = 0;   // [mm] along the track
  Name slave_sync_track{};          // on the trail or just passed; empty: the present track of the mover
  Trail trail{};                    // empty: the present track of the mover alone
  std::optional<double> gap{};      // [mm] to the mover ahead, from centre to centre
  double in_sync_tolerance = 0;     // [mm]
  TurnDirection direction_slave_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_slave_sync_position = 0;  // [mm] of a closed loop
  TurnDirection direction_master_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_master_sync_position = 0;  // [mm] of a closed loop
  SyncDirections allowed_slave_sync_directions = SyncDirections::kPositive;
  // from the track of the master's sync position on, the slave takes the route of the master
  bool follow_mover = false;
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};
struct AdoptTrackOrientation {  // C turns to the orientation of the track, which is 0
  TurnDirection direction = TurnDirection::kShortestWay;
  std::uint32_t additional_turns = 0;    // with kPositive and kNegative only
  std::optional<double> velocity{};      // [deg/s]
  std::optional<double> acceleration{};  // [deg/s²]
  std::optional<double> deceleration{};  // [deg/s²]
  std::optional<double> jerk{};          // [deg/s³]
  Buffering buffer_mode = Buffering::kAborting;
};

// Control of the buffer: Wait is buffered, Release acts at once.
struct Wait {
  double duration = 0;       // [s] at least
  bool for_release = false;  // wait for a release, and consume it
};
struct Release {};  // adds one release; the current or a later Wait for a release consumes it

struct StartExternalSetpointGeneration {  // the first set point is required in the same cycle
  SetpointMode mode = SetpointMode::kAbsolute;
};
struct SetExternalSetpoint {   // for the end of the cycle that applies the command; required in every cycle
  double x = 0, y = 0, z = 0;  // [mm]
  double a = 0, b = 0, c = 0;  // [deg]
  double velocity_x = 0, velocity_y = 0, velocity_z = 0;              // [mm/s]
  double velocity_a = 0, velocity_b = 0, velocity_c = 0;              // [deg/s]
  double acceleration_x = 0, acceleration_y = 0, acceleration_z = 0;  // [mm/s²]
  double acceleration_a = 0, acceleration_b = 0, acceleration_c = 0;  // [deg/s²]
  Name reference{};                                                   // part or coordinate system, of absolute ones
};
struct StopExternalSetpointGeneration {};

struct AddToGroup {  // of movers that do not collide
  Name group{};
};
struct RemoveFromGroup {};

// Follows a star from now on, as one rigid body with it.
struct JoinFormation {
  Name star{};
};
struct LeaveFormation {};

// A place on a route over the free surface, with its planned times [s], which count from StartRoutes.
struct Visit {
  double x = 0, y = 0;                     // [mm] centre of the place
  std::uint32_t after = 0;                 // number, from 1, of the mover that visits the place before; 0: none
  std::uint64_t after_visit = 0;           // number of the visit of that mover which has to be over
  std::optional<double> entry_time{};      // from this time on the mover cannot come to rest before the place
  std::optional<double> exit_time{};       // the mover has left the place
  std::optional<double> departure_time{};  // start of a straight motion from rest here
  std::optional<double> arrival_time{};    // end of a straight motion here
};
inline constexpr std::size_t kVisitsPerCommand = 48;

// Sequence of places that the mover visits once its route is started (StartRoutes).
struct SetRoute {
  // number of the first visit: where the mover is at rest, or a visit of its present route where it can still come to
  // rest; with `continues`, the number after the last visit
  std::uint64_t first = 0;
  bool continues = false;  // the visits continue those of the preceding SetRoute, which is not started yet
  InlineVector<Visit, kVisitsPerCommand> visits;
};
// Resumes the route that a halt, a fault or another command has interrupted; at rest, at most 0.05 mm off it.
struct ContinueRoute {};

using MoverNumbers = InlineVector<std::uint32_t, 1000>;  // from 1, in the order of the machine file

// Starts together the routes that movers have received with SetRoute. The target of the command is the machine.
struct StartRoutes {
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
  MoverNumbers movers{};                 // empty: all movers that have received a route
};

// Holds or continues routes. The target of the command is the machine.
struct HoldRoutes {
  bool hold = true;       // false: the routes continue
  MoverNumbers movers{};  // empty: all movers
};

using Command =
    std::variant<Enable, Disable, Reset, Halt, SetPosition, MoveToPosition, MoveZ, MoveA, MoveB, MoveC, JoinTrack,
                 LeaveTrack, MoveOnTrack, AdoptTrackOrientation, StartExternalSetpointGeneration, SetExternalSetpoint,
                 StopExternalSetpointGeneration, Wait, Release, AddToGroup, RemoveFromGroup, GearInPosOnTrack,
                 GearInPosOnTrackWithMasterMover, JoinFormation, LeaveFormation, MoveX, MoveY, MoveRelativeX,
                 MoveRelativeY, MoveRelativeC, MoveVelocityX, MoveVelocityY, MoveVelocityC, HaltX, HaltY, HaltZ, HaltA,
                 HaltB, HaltC, HaltOnTrack, SetRoute, ContinueRoute>;

template <typename T, typename... Kinds>
inline constexpr bool kIsOneOf = (std::is_same_v<T, Kinds> || ...);

// Returns the table of arguments of the command with this index in the variant.
const Type& TypeOfCommand(std::size_t index);

void describe(Enumeration<TurnDirection>&);
void describe(Enumeration<SetpointMode>&);
void describe(Enumeration<Buffering>&);
void describe(Description<Enable>&);
void describe(Description<Disable>&);
void describe(Description<Reset>&);
void describe(Description<Halt>&);
void describe(Description<SetPosition>&);
void describe(Description<MoveToPosition>&);
void describe(Description<MoveZ>&);
void describe(Description<MoveA>&);
void describe(Description<MoveB>&);
void describe(Description<MoveC>&);
void describe(Description<MoveX>&);
void describe(Description<MoveY>&);
void describe(Description<MoveRelativeX>&);
void describe(Description<MoveRelativeY>&);
void describe(Description<MoveRelativeC>&);
void describe(Description<MoveVelocityX>&);
void describe(Description<MoveVelocityY>&);
void describe(Description<MoveVelocityC>&);
void describe(Description<HaltX>&);
void describe(Description<HaltY>&);
void describe(Description<HaltZ>&);
void describe(Description<HaltA>&);
void describe(Description<HaltB>&);
void describe(Description<HaltC>&);
void describe(Description<HaltOnTrack>&);
void describe(Enumeration<DynamicsReduction>&);
void describe(Description<JoinTrack>&);
void describe(Description<LeaveTrack>&);
void describe(Description<MoveOnTrack>&);
void describe(Enumeration<SyncDirections>&);
void describe(Description<GearInPosOnTrack>&);
void describe(Description<GearInPosOnTrackWithMasterMover>&);
void describe(Description<AdoptTrackOrientation>&);
void describe(Description<StartExternalSetpointGeneration>&);
void describe(Description<SetExternalSetpoint>&);
void describe(Description<StopExternalSetpointGeneration>&);
void describe(Description<Wait>&);
void describe(Description<Release>&);
void describe(Description<AddToGroup>&);
void describe(Description<RemoveFromGroup>&);
void describe(Description<JoinFormation>&);
void describe(Description<LeaveFormation>&);
void describe(Description<Visit>&);
void describe(Description<SetRoute>&);
void describe(Description<ContinueRoute>&);
void describe(Description<StartRoutes>&);
void describe(Description<HoldRoutes>&);

}  // namespace takt::mover
