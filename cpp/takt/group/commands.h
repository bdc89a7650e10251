// What an axes group understands (PLCopen Part 4).
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

// How one move goes over into the next (with a blending buffer mode).
enum class TransitionMode : std::uint8_t {
  kNone,
  kStartVelocity,
  kConstantVelocity,
  kCornerDistance,
  kMaxCornerDeviation,
};

enum class Reference : std::uint8_t { kAbsolute, kRelative };

// Where to, or how far: x to c of the tool in Cartesian coordinate systems, a1 to a8 of axes in ACS; of auxiliary axes
// in all. What is not given stays. Unset velocities, accelerations and jerks are the group's.

template <Reference kReference>
struct MoveLinear {  // MC_MoveLinearAbsolute, MC_MoveLinearRelative
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;  // mm, or mm/s for transitions by velocity
};
using MoveLinearAbsolute = MoveLinear<Reference::kAbsolute>;
using MoveLinearRelative = MoveLinear<Reference::kRelative>;

template <Reference kReference>
struct MoveCircular {  // MC_MoveCircularAbsolute, MC_MoveCircularRelative
  path::CircMode circ_mode = path::CircMode::kBorder;
  double aux_x = 0, aux_y = 0, aux_z = 0;  // mm, what they are says the mode
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
  // Of a pose; keep: whatever is nearest.
  kinematics::Shoulder shoulder = kinematics::Shoulder::kKeep;
  kinematics::Elbow elbow = kinematics::Elbow::kKeep;
  kinematics::Wrist wrist = kinematics::Wrist::kKeep;
  double velocity_factor = 1;      // of the axes' own limits
  double acceleration_factor = 1;  // the same
  double jerk_factor = 1;          // the same
  BufferMode buffer_mode = BufferMode::kAborting;
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};
using MoveDirectAbsolute = MoveDirect<Reference::kAbsolute>;
using MoveDirectRelative = MoveDirect<Reference::kRelative>;

// Half an ellipse, upright over where the move begins and ends; a straight piece where their heights differ.
struct MoveArch {
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  double height = 0;  // mm, of its crest above the higher of both
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
  Name master;       // an axis
  double ratio = 1;  // mm of the path per u of the master
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  TransitionMode transition_mode = TransitionMode::kNone;
  double transition_parameter = 0;
};

struct SyncAxis {                // MC_SyncAxisToGroup
  Name axis;                     // no member
  double ratio_numerator = 1;    // u of the axis ...
  double ratio_denominator = 1;  // ... per mm of the path
};

// What a jog is seen from: the axes, the machine, the world, a product, or the tool itself.
enum class JogSystem : std::uint8_t { kAcs, kMcs, kWcs, kPcs, kTool };

// Level-sensitive: moves at these speeds until it is released; give it again to change them, all 0 to let
// go. x to c of the tool along and about the axes of the coordinate system, a1 to a8 of axes in ACS; of auxiliary axes
// in all.
struct Jog {
  double x = 0, y = 0, z = 0;                                             // mm/s
  double a = 0, b = 0, c = 0;                                             // deg/s
  double a1 = 0, a2 = 0, a3 = 0, a4 = 0, a5 = 0, a6 = 0, a7 = 0, a8 = 0;  // u/s
  JogSystem coordinate_system = JogSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
};

// Set points that come from outside, one StreamPoint after another (AX-114).
struct Stream {
  std::int32_t key = 0;
  double delay = 0.02;             // s
  double timeout = 0.1;            // s
  double velocity_factor = 1;      // of the axes' own limits, to get onto the set points
  double acceleration_factor = 1;  // the same
  double jerk_factor = 1;          // the same
};
struct StreamPoint {
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  std::optional<double> vx{}, vy{}, vz{}, wx{}, wy{}, wz{};              // mm/s, deg/s
  std::optional<double> v1{}, v2{}, v3{}, v4{}, v5{}, v6{}, v7{}, v8{};  // u/s
  CoordinateSystem coordinate_system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 1;
  std::optional<double> time{};  // s, by the sender's clock; unset: when it comes
  std::int32_t key = 0;
};

struct Stop {  // MC_GroupStop
  std::optional<double> deceleration{}, jerk{};
  bool hold = false;  // stay in Stopping until released (Execute kept true)
};
struct Halt {  // MC_GroupHalt
  std::optional<double> deceleration{}, jerk{};
};
struct Interrupt {  // MC_GroupInterrupt: comes to rest on the path, which Continue goes on with
  std::optional<double> deceleration{}, jerk{};
};
struct Continue {};  // MC_GroupContinue

struct AddAxis {  // MC_AddAxisToGroup
  Name axis;
  std::uint32_t ident = 1;  // its place, from 1
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
struct Home {};       // MC_GroupHome: every member as its `homing` says
struct SetPosition {  // MC_GroupSetPosition: other numbers for where the group is
  std::optional<double> x{}, y{}, z{}, a{}, b{}, c{};
  std::optional<double> a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{};
  CoordinateSystem coordinate_system = CoordinateSystem::kAcs;
  std::uint32_t pcs = 1;
};
struct SetOverride {  // MC_GroupSetOverride
  double velocity_factor = 1;
  double acceleration_factor = 1;  // of what is commanded from now on
  double jerk_factor = 1;          // the same

  bool operator==(const SetOverride&) const = default;
};
struct SetKinTransform {  // MC_SetKinTransform
  bool enable = true;     // false: axes only, without a tool
};
struct SetCartesianTransform {  // MC_SetCartesianTransform: a PCS in the MCS
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0;  // mm
  double a = 0, b = 0, c = 0;  // deg
};
struct SetCoordinateTransform {  // MC_SetCoordinateTransform: a PCS in any other coordinate system
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0;
  double a = 0, b = 0, c = 0;
  CoordinateSystem reference = CoordinateSystem::kMcs;  // not ACS
  std::uint32_t reference_pcs = 1;
};

// The tool is another one (GR-46): where its centre point is on the flange.
struct SetTool {
  double x = 0, y = 0, z = 0;  // mm
  double a = 0, b = 0, c = 0;  // deg
};

// A PCS from three or four measured places of the tool (GR-46).
struct Calibrate {
  std::uint32_t pcs = 1;
  // mm, in the MCS.
  double x1 = 0, y1 = 0, z1 = 0;
  double x2 = 0, y2 = 0, z2 = 0;
  double x3 = 0, y3 = 0, z3 = 0;
  std::optional<double> x4{}, y4{}, z4{};
  // mm, the same places as they are in the PCS; unset: the first is its origin, the second on X, the third towards Y.
  std::optional<double> seen_x1{}, seen_y1{}, seen_z1{}, seen_x2{}, seen_y2{}, seen_z2{};
  std::optional<double> seen_x3{}, seen_y3{}, seen_z3{}, seen_x4{}, seen_y4{}, seen_z4{};
  std::optional<double> largest_residual{};  // mm
};

// When a command that is no motion itself takes effect.
enum class ExecutionMode : std::uint8_t {
  kImmediately,  // at once, whatever runs
  kDelayed,      // when the motion in progress is over
  kQueued,       // when all motions given before are over
};

// A PCS that goes along with something (MC_SetDynCoordTransform): a belt, a table, the tool of another group, or a pose
// from elsewhere. pose = origin * travel since `recorded_position` * (x, y, z, a, b, c).
struct SetDynCoordTransform {
  std::uint32_t pcs = 1;
  Name carrier;  // name of the belt, the table, the group or the pose
  double x = 0, y = 0, z = 0;
  double a = 0, b = 0, c = 0;
  std::optional<double> recorded_position{};  // of the belt's axis, u; unset: where it is now
};

// The tool goes along with a belt, by itself and beneath moves in that PCS (MC_TrackConveyorBelt).
struct TrackConveyorBelt {
  Name belt;
  std::uint32_t pcs = 1;  // becomes that of the object
  // Another origin than that of the belt, in the MCS; unset: the belt's own.
  std::optional<double> origin_x{}, origin_y{}, origin_z{}, origin_a{}, origin_b{}, origin_c{};
  double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0;  // InitialObjectPosition, on the belt
  std::optional<double> recorded_position{};        // of the belt's axis, u; unset: where it is now
  // Of the belt, from the recorded position (and x further on).
  double start_distance = 0;             // mm
  std::optional<double> end_distance{};  // mm; unset: none
  // TrackOptions; unset or 0: as fast as the limits allow.
  std::optional<double> sync_in_conveyor_distance{}, sync_in_tcp_distance{};    // mm
  std::optional<double> sync_out_conveyor_distance{}, sync_out_tcp_distance{};  // mm
  ExecutionMode execution_mode = ExecutionMode::kImmediately;
};

// The same on a table that turns (MC_TrackRotaryTable).
struct TrackRotaryTable {
  Name table;
  std::uint32_t pcs = 1;
  double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0;
  std::optional<double> recorded_position{};                // of the table's axis, u
  double start_angle = 0;                                   // deg, in the sense in which the table turns
  std::optional<double> end_angle{};                        // deg
  std::optional<double> sync_in_angle{}, sync_out_angle{};  // deg of the table
  ExecutionMode execution_mode = ExecutionMode::kImmediately;
};

// What became of a question whether a path is free (path_check_request.h). The engine alone gives it to itself.
struct PathChecked {
  std::uint64_t number = 0;  // of the question
  workspace::Trouble trouble = workspace::Trouble::kNone;
  kinematics::Reason reason = kinematics::Reason::kNone;  // no position of the links: why
  // What meets what: numbers from 1 in workspace::PartNames; 0: none.
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::uint32_t element = 0;  // of a path of the machine file, from 1; 0: of no such path
  double place = 0;           // from the beginning of the move, mm or what it counts
  bool on_blend = false;      // on the blend into the move, or into that element

  bool operator==(const PathChecked&) const = default;
};

// The plan that a group has asked for is there (trajectory/path_timing.h). The engine alone gives it to itself.
struct PathPlanned {
  std::uint64_t number = 0;  // of the order
};

using Command = std::variant<MoveLinearAbsolute, MoveLinearRelative, MoveCircularAbsolute, MoveCircularRelative,
                             MoveDirectAbsolute, MoveDirectRelative, MovePath, MovePathSynchronized, SyncAxis, Stop,
                             Halt, Interrupt, Continue, AddAxis, RemoveAxis, UngroupAllAxes, Enable, Disable, Reset,
                             Power, Home, SetPosition, SetOverride, SetKinTransform, SetCartesianTransform,
                             SetCoordinateTransform, SetTool, Calibrate, SetDynCoordTransform, TrackConveyorBelt,
                             TrackRotaryTable, MoveArch, Jog, Stream, StreamPoint, PathChecked, PathPlanned>;

// What is wrong with a command, as a sentence for people; empty: nothing. Not for the cycle.
std::string Diagnose(const Command& command);
// The error of a command with which something is wrong: the same that the cycle finds in its numbers.
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
