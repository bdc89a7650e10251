// What people tell a mover.
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

enum class TurnDirection : std::uint8_t {
  kNonModulo,    // to the very position
  kPositive,     // to the next place upwards that looks the same
  kShortestWay,  // to the nearest
  kNegative,     // to the next downwards
};

enum class SetpointMode : std::uint8_t {
  kNone,
  kAbsolute,  // the mover follows the set points alone
  kRelative,  // they come on top of whatever else it does
};

enum class Buffering : std::uint8_t {
  kAborting,  // at once; what waits is aborted
  kBuffered,  // when all before it is done
};

struct Enable {};
struct Disable {};
struct Reset {};

struct Halt {  // dynamics of X and Y; all other coordinates stop, too, with their standard ones
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};

struct SetPosition {
  double x = 0, y = 0;  // mm
  double c = 0;         // deg
  Name reference{};     // part or coordinate system that X and Y belong to
};

struct MoveToPosition {
  double x = 0, y = 0;                   // mm
  std::optional<double> c{};             // deg; unset: C stays
  bool use_orientation = true;           // else C stays in any case
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Name reference{};                      // part or coordinate system that X and Y belong to
  Buffering buffer_mode = Buffering::kAborting;
  double blending = 0;  // mm before the end of the move before, buffered
};
inline bool TurnsAlong(const MoveToPosition& move) noexcept {
  return move.use_orientation && move.c.has_value();
}

struct MoveZ {
  double position = 0;                   // mm
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveA {
  double position = 0;                   // deg
  std::optional<double> velocity{};      // deg/s
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveB {
  double position = 0;                   // deg
  std::optional<double> velocity{};      // deg/s
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveC {
  double position = 0;  // deg
  TurnDirection direction = TurnDirection::kNonModulo;
  std::uint32_t additional_turns = 0;    // positive, negative
  std::optional<double> velocity{};      // deg/s
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};

// X or Y by itself, whatever the other one does.
struct MoveX {
  double position = 0;                   // mm
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Name reference{};                      // part or coordinate system that the position belongs to
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveY {
  double position = 0;                   // mm
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Name reference{};                      // part or coordinate system that the position belongs to
  Buffering buffer_mode = Buffering::kAborting;
};
// By a distance from where the coordinate is when the command begins.
struct MoveRelativeX {
  double distance = 0;                   // mm
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveRelativeY {
  double distance = 0;                   // mm
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveRelativeC {
  double distance = 0;                   // deg
  std::optional<double> velocity{};      // deg/s
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};
// At a velocity, as far as there is room.
struct MoveVelocityX {
  double velocity = 0;                   // mm/s, negative: towards smaller values
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveVelocityY {
  double velocity = 0;                   // mm/s, negative: towards smaller values
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct MoveVelocityC {
  double velocity = 0;                   // deg/s, negative: towards smaller values
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};
// One coordinate comes to rest; the others go on.
struct HaltX {
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};
struct HaltY {
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};
struct HaltZ {
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};
struct HaltA {
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
};
struct HaltB {
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
};
struct HaltC {
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
};
struct HaltOnTrack {                     // along its track; Z, A, B and C go on
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};

struct JoinTrack {
  Name track{};
  bool use_orientation = true;           // C goes to that of the track, which is 0
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
struct LeaveTrack {
  double x = 0, y = 0;                   // mm
  double c = 0;                          // deg; counts with use_orientation
  bool use_orientation = true;           // else C stays
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Name reference{};                      // part or coordinate system that X and Y belong to
  Buffering buffer_mode = Buffering::kAborting;
};
// How the limits of a move along tracks count in curves.
enum class DynamicsReduction : std::uint8_t {
  kAccelerationLimitedVelocity,  // slower, so that the lateral acceleration of the machine file is kept
  kNone,                         // as fast as the maxima of X and Y, as vectors, allow
};
struct MoveOnTrack {
  double position = 0;          // mm along the track
  Name track{};                 // empty: that where the mover is
  std::optional<double> gap{};  // mm to the mover ahead, from centre to centre
  TurnDirection direction = TurnDirection::kNonModulo;
  std::uint32_t additional_turns = 0;  // of a closed loop; positive, negative
  double modulo_tolerance = 0;         // mm, of a closed loop
  DynamicsReduction dynamics_reduction = DynamicsReduction::kAccelerationLimitedVelocity;
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  Buffering buffer_mode = Buffering::kAborting;
};
// Which way a slave may go until it has been in step.
enum class SyncDirections : std::uint8_t { kPositive, kNegative, kBoth };

// Tracks one behind the other, each once.
using Trail = InlineVector<Name, 128>;

struct GearInPosOnTrack {  // along tracks, with an axis
  Name master{};
  double master_sync_position = 0;  // u of the master
  double slave_sync_position = 0;   // mm along the track
  Name slave_sync_track{};          // empty: that where the mover is
  Trail trail{};                    // empty: that track alone
  std::optional<double> gap{};      // mm to the mover ahead, from centre to centre
  double in_sync_tolerance = 0;     // mm
  TurnDirection direction_slave_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_slave_sync_position = 0;  // mm, of a closed loop
  SyncDirections allowed_slave_sync_directions = SyncDirections::kPositive;
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};
struct GearInPosOnTrackWithMasterMover {
  Name master{};
  double master_sync_position = 0;  // mm along the track
  Name master_sync_track{};         // empty: that where the master is
  double slave_sync_position = 0;   // mm along the track
  Name slave_sync_track{};          // empty: that where the mover is
  Trail trail{};                    // empty: that track alone
  std::optional<double> gap{};      // mm to the mover ahead, from centre to centre
  double in_sync_tolerance = 0;     // mm
  TurnDirection direction_slave_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_slave_sync_position = 0;  // mm, of a closed loop
  TurnDirection direction_master_sync_position = TurnDirection::kNonModulo;
  double modulo_tolerance_master_sync_position = 0;  // mm, of a closed loop
  SyncDirections allowed_slave_sync_directions = SyncDirections::kPositive;
  bool follow_mover = false;             // goes on where the master goes
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};
struct AdoptTrackOrientation {  // C turns to that of the track, which is 0
  TurnDirection direction = TurnDirection::kShortestWay;
  std::uint32_t additional_turns = 0;    // positive, negative
  std::optional<double> velocity{};      // deg/s
  std::optional<double> acceleration{};  // deg/s²
  std::optional<double> deceleration{};  // deg/s²
  std::optional<double> jerk{};          // deg/s³
  Buffering buffer_mode = Buffering::kAborting;
};

// The buffer: both wait their turn there.
struct Wait {
  double duration = 0;       // s, at least
  bool for_release = false;  // until there is a release; takes it
};
struct Release {};  // lets one Wait go on, be it the next to come

struct StartExternalSetpointGeneration {
  SetpointMode mode = SetpointMode::kAbsolute;
};
struct SetExternalSetpoint {                                          // for the end of the cycle that applies it
  double x = 0, y = 0, z = 0;                                         // mm
  double a = 0, b = 0, c = 0;                                         // deg
  double velocity_x = 0, velocity_y = 0, velocity_z = 0;              // mm/s
  double velocity_a = 0, velocity_b = 0, velocity_c = 0;              // deg/s
  double acceleration_x = 0, acceleration_y = 0, acceleration_z = 0;  // mm/s²
  double acceleration_a = 0, acceleration_b = 0, acceleration_c = 0;  // deg/s²
  Name reference{};                                                   // part or coordinate system, of absolute ones
};
struct StopExternalSetpointGeneration {};

struct AddToGroup {  // of movers that do not collide
  Name group{};
};
struct RemoveFromGroup {};

// Goes along with a star from now on, as one body with it.
struct JoinFormation {
  Name star{};
};
struct LeaveFormation {};

// A place on a route over the free surface, and when the mover is to be there as planned: s since the start of routes.
struct Visit {
  double x = 0, y = 0;                     // mm, of its middle
  std::uint32_t after = 0;                 // number of the mover that visits the place before, from 1; 0: none
  std::uint64_t after_visit = 0;           // the visit of that one which has to be over
  std::optional<double> entry_time{};      // from when on it cannot come to rest before the place any more
  std::optional<double> exit_time{};       // when it has left it
  std::optional<double> departure_time{};  // a straight motion from rest begins here
  std::optional<double> arrival_time{};    // one ends here
};
inline constexpr std::size_t kVisitsPerCommand = 48;

// Places that the mover is to visit one after the other, once routes are started (StartRoutes).
struct SetRoute {
  std::uint64_t first = 0;  // number of the first of them, that where it is or that where its new route begins
  bool continues = false;   // these follow on those of the command before
  InlineVector<Visit, kVisitsPerCommand> visits;
};
struct ContinueRoute {};  // that it was taken off

using MoverNumbers = InlineVector<std::uint32_t, 1000>;  // from 1, in the order of the machine file

// To movers at once: what each was told by SetRoute. Its target is the machine.
struct StartRoutes {
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
  MoverNumbers movers{};                 // none: all that were told one
};

// Its target is the machine, too.
struct HoldRoutes {
  bool hold = true;       // false: they go on
  MoverNumbers movers{};  // none: all
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

// Table of the arguments of the command at this place of the variant.
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
