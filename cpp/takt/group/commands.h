// Commands of an axes group (PLCopen Part 4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/core/status.h"
#include "takt/kinematics/joints.h"
#include "takt/path/make.h"
#include "takt/workspace/trouble.h"

namespace takt::group {

inline constexpr std::size_t kMaxAxes = 8;
inline constexpr std::size_t kProductSystems = 16;

using axis::BufferMode;

enum class CoordinateSystem : std::uint8_t { kAcs, kMcs, kWcs, kPcs };

// Transition from one move to the next (with a blending buffer mode).
enum class TransitionMode : std::uint8_t {
  kNone,
  kStartVelocity,
  kConstantVelocity,
  kCornerDistance,
  kMaxCornerDeviation,
};

enum class Reference : std::uint8_t { kAbsolute, kRelative };

// Target, or displacement of relative moves: x to c of the tool in Cartesian coordinate systems, a1 to a8 of the axes
// in ACS; of auxiliary axes in every system. Unset coordinates keep their values. Unset velocities, accelerations and
// jerks: those of the group.

template <Reference kReference>
struct MoveLinear {  // MC_MoveLinearAbsolute, MC_MoveLinearRelative
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;  // [mm], or [mm/s] for transitions by velocity
};
using MoveLinearAbsolute = MoveLinear<Reference::kAbsolute>;
using MoveLinearRelative = MoveLinear<Reference::kRelative>;

template <Reference kReference>
struct MoveCircular {  // MC_MoveCircularAbsolute, MC_MoveCircularRelative
  path::CircMode circ_mode = path::CircMode::kBorder;
  double aux_x = 0, aux_y = 0, aux_z = 0;  // [mm]; meaning by circ_mode (path/make.h)
  path::PathChoice path_choice = path::PathChoice::kCounterclockwise;
  double normal_x = 0, normal_y = 0, normal_z = 0;
  std::uint32_t turns = 0;
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};
using MoveCircularAbsolute = MoveCircular<Reference::kAbsolute>;
using MoveCircularRelative = MoveCircular<Reference::kRelative>;

template <Reference kReference>
struct MoveDirect {  // MC_MoveDirectAbsolute, MC_MoveDirectRelative
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kAcs;
  std::uint32_t pcs = 1;
  // Configuration, for moves to a pose; kKeep: the one that the axes reach first (GR-44).
  kinematics::Shoulder shoulder = kinematics::Shoulder::kKeep;
  kinematics::Elbow elbow = kinematics::Elbow::kKeep;
  kinematics::Wrist wrist = kinematics::Wrist::kKeep;
  double velocity_factor = 1;      // 1e-3 to 1, of the axes' own limits
  double acceleration_factor = 1;  // likewise
  double jerk_factor = 1;          // likewise
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};
using MoveDirectAbsolute = MoveDirect<Reference::kAbsolute>;
using MoveDirectRelative = MoveDirect<Reference::kRelative>;

// Half an ellipse, upright in the world over start and end; with a vertical line where their heights differ.
struct MoveArch {
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  double height = 0;  // [mm] of the crest above the higher of start and end
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};

struct MovePath {  // MC_MovePath, with the path that MC_PathSelect names
  Name path;
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;  // at the corners of the path, and into it
  double transition_parameter = 0;
};

struct MovePathSynchronized {  // MC_MovePathSynchronized
  Name path;
  Name master;       // name of an axis that is not a member
  double ratio = 1;  // [mm/u] path per master
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};

struct SyncAxis {                // MC_SyncAxisToGroup
  Name axis;                     // name of an axis that is not a member
  double ratio_numerator = 1;    // [u] of the axis ...
  double ratio_denominator = 1;  // ... per [mm] of the path
};

// Coordinate system of a jog: the axes, the machine, the world, a product, or the tool itself.
enum class JogSystem : std::uint8_t { kAcs, kMcs, kWcs, kPcs, kTool };

// Level-sensitive: moves at these velocities until it is released. A further jog changes them, all 0 releases. x to c
// of the tool along and about the axes of the coordinate system, a1 to a8 of the axes in ACS; of auxiliary axes in
// every system.
struct Jog {
  double x = 0, y = 0, z = 0;                                             // [mm/s]
  double a = 0, b = 0, c = 0;                                             // [deg/s]
  double a1 = 0, a2 = 0, a3 = 0, a4 = 0, a5 = 0, a6 = 0, a7 = 0, a8 = 0;  // [u/s]
  JogSystem coordinate_system = JogSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
};

// Follows set points from outside, given as StreamPoints (AX-114).
struct Stream {
  std::int32_t key = 0;
  double delay = 0.02;             // [s] from the arrival of the first set point until it is due
  double timeout = 0.1;            // [s] longest time without a set point
  double velocity_factor = 1;      // 1e-3 to 1, of the axes' own limits, to catch up with the set points
  double acceleration_factor = 1;  // likewise
  double jerk_factor = 1;          // likewise
};
struct StreamPoint {
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  std::optional<double> vx{}, vy{}, vz{}, wx{}, wy{}, wz{};              // [mm/s, deg/s]
  std::optional<double> v1{}, v2{}, v3{}, v4{}, v5{}, v6{}, v7{}, v8{};  // [u/s]
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> time{};  // [s] by the sender's clock; unset: time of arrival
  std::int32_t key = 0;
};

struct Stop {  // MC_GroupStop
  std::optional<double> deceleration{}, jerk{};
  bool hold = false;  // stay in Stopping until released (Execute kept true)
};
struct Halt {  // MC_GroupHalt
  std::optional<double> deceleration{}, jerk{};
};
struct Interrupt {  // MC_GroupInterrupt: comes to rest on the path, which Continue resumes
  std::optional<double> deceleration{}, jerk{};
};
struct Continue {};  // MC_GroupContinue

struct AddAxis {  // MC_AddAxisToGroup
  Name axis;
  std::uint32_t ident = 1;  // its index in the group, from 1
};
struct RemoveAxis {  // MC_RemoveAxisFromGroup
  std::uint32_t ident = 1;
};
struct UngroupAllAxes {};  // MC_UngroupAllAxes
struct Enable {};          // MC_GroupEnable
struct Disable {};         // MC_GroupDisable
struct Reset {};           // MC_GroupReset
struct Power {             // MC_Power of every member
  bool enable = true;
};
struct Home {};       // MC_GroupHome: every member by its own `homing`
struct SetPosition {  // MC_GroupSetPosition: assigns new coordinates to the present position
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kAcs;
  std::uint32_t pcs = 1;
};
struct SetOverride {  // MC_GroupSetOverride
  double velocity_factor = 1;
  double acceleration_factor = 1;  // for commands given from now on
  double jerk_factor = 1;          // likewise

  bool operator==(const SetOverride&) const = default;
};
struct SetKinTransform {  // MC_SetKinTransform
  bool enable = true;     // false: axes only, no tool
};
struct SetCartesianTransform {  // MC_SetCartesianTransform: a PCS in the MCS
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0;  // [mm]
  double a = 0, b = 0, c = 0;  // [deg]
};
struct SetCoordinateTransform {  // MC_SetCoordinateTransform: a PCS in any other coordinate system
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0;
  double a = 0, b = 0, c = 0;
  CoordinateSystem reference = CoordinateSystem::kMcs;  // not ACS
  std::uint32_t reference_pcs = 1;
};

// Changes the tool (GR-46): the pose of the tool centre point on the flange.
struct SetTool {
  double x = 0, y = 0, z = 0;  // [mm]
  double a = 0, b = 0, c = 0;  // [deg]
};

// Computes a PCS from three or four measured positions of the tool (GR-46).
struct Calibrate {
  std::uint32_t pcs = 1;
  // [mm] in the MCS.
  double x1 = 0, y1 = 0, z1 = 0;
  double x2 = 0, y2 = 0, z2 = 0;
  double x3 = 0, y3 = 0, z3 = 0;
  std::optional<double> x4{}, y4{}, z4{};
  // [mm] the same points in the PCS. Unset: X points from point 1 to point 2, point 3 lies towards +Y; the origin is
  // point 1, or point 4 if given.
  std::optional<double> seen_x1{}, seen_y1{}, seen_z1{}, seen_x2{}, seen_y2{}, seen_z2{};
  std::optional<double> seen_x3{}, seen_y3{}, seen_z3{}, seen_x4{}, seen_y4{}, seen_z4{};
  std::optional<double> largest_residual{};  // [mm] above which the command fails; unset: no limit
};

// When a command that is not itself a motion takes effect.
enum class ExecutionMode : std::uint8_t {
  kImmediately,  // at once, whatever is in execution
  kDelayed,      // at the end of the move in execution
  kQueued,       // at the end of all moves given before
};

// Binds a PCS to a carrier (MC_SetDynCoordTransform): a belt, a table, the tool of another group, or a pose from
// elsewhere. pose = origin * travel since `recorded_position` * (x, y, z, a, b, c).
struct SetDynCoordTransform {
  std::uint32_t pcs = 1;
  Name carrier;  // name of the belt, table, group or pose
  double x = 0, y = 0, z = 0;
  double a = 0, b = 0, c = 0;
  std::optional<double> recorded_position{};  // [u] position of the belt's axis; unset: the present one
};

// Synchronizes the tool with an object on a belt; moves in its PCS are superimposed (MC_TrackConveyorBelt).
struct TrackConveyorBelt {
  Name belt;
  std::uint32_t pcs = 1;  // becomes the coordinate system of the object
  // Origin of the belt in the MCS; if all are unset its own, else unset values are 0.
  std::optional<double> origin_x{}, origin_y{}, origin_z{}, origin_a{}, origin_b{}, origin_c{};
  double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0;  // InitialObjectPosition, on the belt
  std::optional<double> recorded_position{};        // [u] position of the belt's axis; unset: the present one
  // Range of tracking: travel of the belt since the recorded position, at the start also x.
  double start_distance = 0;             // [mm]
  std::optional<double> end_distance{};  // [mm]; unset: unlimited
  // TrackOptions; unset or 0: as fast as the limits allow.
  std::optional<double> sync_in_conveyor_distance{}, sync_in_tcp_distance{};    // [mm]
  std::optional<double> sync_out_conveyor_distance{}, sync_out_tcp_distance{};  // [mm]
  ExecutionMode execution_mode = ExecutionMode::kImmediately;
};

// The same on a rotary table (MC_TrackRotaryTable).
struct TrackRotaryTable {
  Name table;
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0;
  std::optional<double> recorded_position{};                // [u] position of the table's axis; unset: the present one
  double start_angle = 0;                                   // [deg] in the direction in which the table turns
  std::optional<double> end_angle{};                        // [deg]; unset: unlimited
  std::optional<double> sync_in_angle{}, sync_out_angle{};  // [deg] of the table; unset or 0: by the limits
  ExecutionMode execution_mode = ExecutionMode::kImmediately;
};

// Answer to a PathCheckRequest (path_check_request.h). Given by the engine only.
struct PathChecked {
  std::uint64_t number = 0;  // of the request
  workspace::Trouble trouble = workspace::Trouble::kNone;
  kinematics::Reason reason = kinematics::Reason::kNone;  // why the axes cannot take a pose, if `trouble` is kNoPose
  // The two parts that collide: numbers from 1 in workspace::PartNames; 0: none.
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::uint32_t element = 0;  // of a path of the machine file, from 1; 0: not such a path
  double place = 0;           // distance from the start of the move, in the unit of its length
  bool on_blend = false;      // on the blend into the move, or into that element

  bool operator==(const PathChecked&) const = default;
};

// The plan ordered by a group is computed (trajectory/path_timing.h). Given by the engine only.
struct PathPlanned {
  std::uint64_t number = 0;  // of the order
};

using Command = std::variant<MoveLinearAbsolute, MoveLinearRelative, MoveCircularAbsolute, MoveCircularRelative,
                             MoveDirectAbsolute, MoveDirectRelative, MovePath, MovePathSynchronized, SyncAxis, Stop,
                             Halt, Interrupt, Continue, AddAxis, RemoveAxis, UngroupAllAxes, Enable, Disable, Reset,
                             Power, Home, SetPosition, SetOverride, SetKinTransform, SetCartesianTransform,
                             SetCoordinateTransform, SetTool, Calibrate, SetDynCoordTransform, TrackConveyorBelt,
                             TrackRotaryTable, MoveArch, Jog, Stream, StreamPoint, PathChecked, PathPlanned>;

// Returns what is wrong with a command, as a sentence for users; empty: nothing. Not for the cycle.
std::string Diagnose(const Command& command);
// Returns the error of a command that Diagnose rejects; the same that the cycle reports for it.
ErrorId ErrorOf(const Command& command) noexcept;

void describe(Enumeration<CoordinateSystem>&);
void describe(Enumeration<TransitionMode>&);
void describe(Description<MoveLinearAbsolute>&);
void describe(Description<MoveLinearRelative>&);
void describe(Description<MoveCircularAbsolute>&);
void describe(Description<MoveCircularRelative>&);
void describe(Description<MoveDirectAbsolute>&);
void describe(Description<MoveDirectRelative>&);
void describe(Description<MoveArch>&);
void describe(Description<MovePath>&);
void describe(Description<MovePathSynchronized>&);
void describe(Description<SyncAxis>&);
void describe(Enumeration<JogSystem>&);
void describe(Description<Jog>&);
void describe(Description<Stream>&);
void describe(Description<StreamPoint>&);
void describe(Description<Stop>&);
void describe(Description<Halt>&);
void describe(Description<Interrupt>&);
void describe(Description<Continue>&);
void describe(Description<AddAxis>&);
void describe(Description<RemoveAxis>&);
void describe(Description<UngroupAllAxes>&);
void describe(Description<Enable>&);
void describe(Description<Disable>&);
void describe(Description<Reset>&);
void describe(Description<Power>&);
void describe(Description<Home>&);
void describe(Description<SetPosition>&);
void describe(Description<SetOverride>&);
void describe(Description<SetKinTransform>&);
void describe(Description<SetCartesianTransform>&);
void describe(Description<SetTool>&);
void describe(Description<Calibrate>&);
void describe(Enumeration<ExecutionMode>&);
void describe(Description<SetDynCoordTransform>&);
void describe(Description<TrackConveyorBelt>&);
void describe(Description<TrackRotaryTable>&);
void describe(Description<SetCoordinateTransform>&);
void describe(Description<PathChecked>&);
void describe(Description<PathPlanned>&);

}  // namespace takt::group
