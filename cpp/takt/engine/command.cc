#include "takt/engine/command.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "takt/axis/request.h"
#include "takt/core/arguments.h"
#include "takt/core/describe.h"
#include "takt/core/problem.h"
#include "takt/core/writer.h"
#include "takt/engine/components.h"

namespace takt::engine {

namespace {

constexpr std::string_view kMachine = "machine";
constexpr std::string_view kAxis = "axis";
constexpr std::string_view kFlexCam = "flex_cam";
constexpr std::string_view kGroup = "group";
constexpr std::string_view kBelt = "belt";
constexpr std::string_view kPose = "pose";
constexpr std::string_view kPickPlace = "pick_place";
constexpr std::string_view kMover = "mover";
constexpr std::string_view kTrack = "track";
constexpr std::string_view kPlanarGroup = "planar_group";
constexpr std::string_view kEnvironment = "environment";
constexpr std::string_view kPart = "part";

// Returns true if the command, with these arguments, stops something, releases it or switches it off (EN-32): the one
// list. All other commands return false, including those that also request power or motion: they expire, and an
// emergency stop refuses them.
template <typename T>
bool Releases(const T&) noexcept {
  return false;
}
bool Releases(const StopAll&) noexcept {
  return true;
}
bool Releases(const EmergencyStop&) noexcept {
  return true;
}
bool Releases(const FailAllAxes&) noexcept {
  return true;
}
bool Releases(const Release&) noexcept {
  return true;
}
bool Releases(const axis::Halt&) noexcept {
  return true;
}
bool Releases(const axis::Stop&) noexcept {
  return true;
}
bool Releases(const axis::HaltSuperimposed&) noexcept {
  return true;
}
bool Releases(const axis::Power& c) noexcept {
  return !c.enable;
}
bool Releases(const axis::Jog& c) noexcept {
  return !c.forward && !c.backward;
}
bool Releases(const axis::SetOverride& c) noexcept {
  return c.velocity_factor == 0;
}
bool Releases(const axis::DirectOutput& c) noexcept {
  return c.voltage == 0;
}
bool Releases(const flexcam::Control& c) noexcept {
  const bool releases = !c.enable.value_or(true) || !c.regulator_on.value_or(true) || c.stop.value_or(false) ||
                        c.halt.value_or(false) || c.sync_out_instant.value_or(false) || !c.sync_cam.value_or(true) ||
                        c.virtual_velocity.value_or(1) == 0;
  return releases && !flexcam::AsksToMove(c);
}
bool Releases(const flexcam::Jog& c) noexcept {
  return !c.positive && !c.negative;
}
bool Releases(const group::Stop&) noexcept {
  return true;
}
bool Releases(const group::Jog& c) noexcept {
  const std::array speeds = {c.x, c.y, c.z, c.a, c.b, c.c, c.a1, c.a2, c.a3, c.a4, c.a5, c.a6, c.a7, c.a8};
  return std::ranges::all_of(speeds, [](double speed) { return speed == 0; });
}
bool Releases(const group::Halt&) noexcept {
  return true;
}
bool Releases(const group::Interrupt&) noexcept {
  return true;
}
bool Releases(const group::Disable&) noexcept {
  return true;
}
bool Releases(const group::Power& c) noexcept {
  return !c.enable;
}
bool Releases(const group::SetOverride& c) noexcept {
  return c.velocity_factor == 0;
}
bool Releases(const pickplace::Control& c) noexcept {
  const bool releases = !c.enable.value_or(true) || !c.regulator_on.value_or(true) || c.path_stop.value_or(false) ||
                        c.path_halt.value_or(false) || c.stop_all.value_or(false) || c.path_interrupt.value_or(false) ||
                        c.abort.value_or(false) || c.override_factor.value_or(1) == 0;
  return releases && !pickplace::AsksToMove(c);
}
bool Releases(const pickplace::Jog& c) noexcept {
  return !c.positive && !c.negative;
}
bool Releases(const mover::Halt&) noexcept {
  return true;
}
bool Releases(const mover::HaltX&) noexcept {
  return true;
}
bool Releases(const mover::HaltY&) noexcept {
  return true;
}
bool Releases(const mover::HaltZ&) noexcept {
  return true;
}
bool Releases(const mover::HaltA&) noexcept {
  return true;
}
bool Releases(const mover::HaltB&) noexcept {
  return true;
}
bool Releases(const mover::HaltC&) noexcept {
  return true;
}
bool Releases(const mover::HaltOnTrack&) noexcept {
  return true;
}
bool Releases(const mover::Disable&) noexcept {
  return true;
}
bool Releases(const mover::StopExternalSetpointGeneration&) noexcept {
  return true;
}
bool Releases(const mover::HoldRoutes& c) noexcept {
  return c.hold;
}
bool Releases(const track::Disable&) noexcept {
  return true;
}
bool Releases(const part::ForceDisable&) noexcept {
  return true;
}

// A verb and the conversions of its struct.
struct Entry {
  Verb verb;
  bool (*read)(std::string_view text, CommandBody& body, Problem& problem);
  const void* (*find)(const CommandBody& body);  // null: the body is another verb's
  bool (*lets_go)(const void* arguments) noexcept;
};

template <typename Kind, typename T>
Entry Make(std::string_view target_kind, std::string_view name, bool level_sensitive = false) {
  return {{target_kind, name, &TypeOf<T>(), level_sensitive},
          [](std::string_view text, CommandBody& body, Problem& problem) {
            T arguments;
            if (!ReadArguments(arguments, text, &problem)) return false;
            body = Kind(arguments);
            return true;
          },
          [](const CommandBody& body) -> const void* {
            const Kind* kind = std::get_if<Kind>(&body);
            return kind ? std::get_if<T>(kind) : nullptr;
          },
          [](const void* arguments) noexcept { return Releases(*static_cast<const T*>(arguments)); }};
}

// Returns true for verbs that only the engine gives.
bool IsInternal(const Verb& verb) {
  return verb.arguments == &TypeOf<group::PathChecked>() || verb.arguments == &TypeOf<group::PathPlanned>() ||
         verb.arguments == &TypeOf<track::TrackMade>() || verb.arguments == &TypeOf<environment::BoundaryMade>() ||
         verb.arguments == &TypeOf<cam::CamBuilt>();
}

// All commands: the one list.
const std::vector<Entry>& Entries() {
  static const std::vector<Entry> entries = {
      Make<MachineCommand, StopAll>(kMachine, "stop_all"),
      Make<MachineCommand, EmergencyStop>(kMachine, "emergency_stop"),
      Make<MachineCommand, ReleaseEmergencyStop>(kMachine, "release_emergency_stop"),
      Make<MachineCommand, FailAllAxes>(kMachine, "fail_all_axes"),
      Make<MachineCommand, Release>(kMachine, "release"),
      Make<MachineCommand, Renew>(kMachine, "renew"),
      Make<MachineCommand, cam::BeginCam>(kMachine, "begin_cam"),
      Make<MachineCommand, cam::AddCamPoints>(kMachine, "add_cam_points"),
      Make<MachineCommand, cam::AddCamSegments>(kMachine, "add_cam_segments"),
      Make<MachineCommand, cam::BuildCam>(kMachine, "build_cam"),
      Make<MachineCommand, cam::DropCam>(kMachine, "drop_cam"),
      Make<MachineCommand, cam::ReadCam>(kMachine, "read_cam"),
      Make<MachineCommand, cam::CamBuilt>(kMachine, "cam_built"),
      Make<MachineCommand, mover::StartRoutes>(kMachine, "start_routes"),
      Make<MachineCommand, mover::HoldRoutes>(kMachine, "hold_routes"),
      Make<axis::Command, axis::Power>(kAxis, "power"),
      Make<axis::Command, axis::Reset>(kAxis, "reset"),
      Make<axis::Command, axis::Straighten>(kAxis, "straighten"),
      Make<axis::Command, axis::MoveAbsolute>(kAxis, "move_absolute"),
      Make<axis::Command, axis::MoveRelative>(kAxis, "move_relative"),
      Make<axis::Command, axis::MoveAdditive>(kAxis, "move_additive"),
      Make<axis::Command, axis::MoveVelocity>(kAxis, "move_velocity"),
      Make<axis::Command, axis::Halt>(kAxis, "halt"),
      Make<axis::Command, axis::Stop>(kAxis, "stop", true),
      Make<axis::Command, axis::Jog>(kAxis, "jog", true),
      Make<axis::Command, axis::MoveContinuousAbsolute>(kAxis, "move_continuous_absolute"),
      Make<axis::Command, axis::MoveContinuousRelative>(kAxis, "move_continuous_relative"),
      Make<axis::Command, axis::Inch>(kAxis, "inch"),
      Make<axis::Command, axis::MoveSuperimposed>(kAxis, "move_superimposed"),
      Make<axis::Command, axis::HaltSuperimposed>(kAxis, "halt_superimposed"),
      Make<axis::Command, axis::TorqueControl>(kAxis, "torque_control"),
      Make<axis::Command, axis::GearIn>(kAxis, "gear_in"),
      Make<axis::Command, axis::GearOut>(kAxis, "gear_out"),
      Make<axis::Command, axis::GearInPos>(kAxis, "gear_in_pos"),
      Make<axis::Command, axis::PhasingAbsolute>(kAxis, "phasing_absolute"),
      Make<axis::Command, axis::PhasingRelative>(kAxis, "phasing_relative"),
      Make<axis::Command, axis::CombineAxes>(kAxis, "combine_axes"),
      Make<axis::Command, axis::CamTableSelect>(kAxis, "cam_table_select"),
      Make<axis::Command, axis::CamIn>(kAxis, "cam_in"),
      Make<axis::Command, axis::CamAdd>(kAxis, "cam_add"),
      Make<axis::Command, axis::CamRemove>(kAxis, "cam_remove"),
      Make<axis::Command, axis::CamOut>(kAxis, "cam_out"),
      Make<axis::Command, axis::PositionProfile>(kAxis, "position_profile"),
      Make<axis::Command, axis::VelocityProfile>(kAxis, "velocity_profile"),
      Make<axis::Command, axis::AccelerationProfile>(kAxis, "acceleration_profile"),
      Make<axis::Command, axis::Home>(kAxis, "home"),
      Make<axis::Command, axis::StepAbsSwitch>(kAxis, "step_abs_switch"),
      Make<axis::Command, axis::StepLimitSwitch>(kAxis, "step_limit_switch"),
      Make<axis::Command, axis::StepBlock>(kAxis, "step_block"),
      Make<axis::Command, axis::StepRefPulse>(kAxis, "step_ref_pulse"),
      Make<axis::Command, axis::StepDistanceCoded>(kAxis, "step_distance_coded"),
      Make<axis::Command, axis::StepDirect>(kAxis, "step_direct"),
      Make<axis::Command, axis::StepAbsolute>(kAxis, "step_absolute"),
      Make<axis::Command, axis::FinishHoming>(kAxis, "finish_homing"),
      Make<axis::Command, axis::StepRefFlyingSwitch>(kAxis, "step_ref_flying_switch"),
      Make<axis::Command, axis::StepRefFlyingRefPulse>(kAxis, "step_ref_flying_ref_pulse"),
      Make<axis::Command, axis::AbortPassiveHoming>(kAxis, "abort_passive_homing"),
      Make<axis::Command, axis::SetConstants>(kAxis, "set_constants"),
      Make<axis::Command, axis::SetLoad>(kAxis, "set_load"),
      Make<axis::Command, axis::WriteParameter>(kAxis, "write_parameter"),
      Make<axis::Command, axis::ReadParameter>(kAxis, "read_parameter"),
      Make<axis::Command, axis::SetSoftLimits>(kAxis, "set_soft_limits"),
      Make<axis::Command, axis::DirectOutput>(kAxis, "direct_output"),
      Make<axis::Command, axis::PulseOutput>(kAxis, "pulse_output"),
      Make<axis::Command, axis::WriteOutput>(kAxis, "write_output"),
      Make<axis::Command, axis::SetPosition>(kAxis, "define_position"),
      Make<axis::Command, axis::SetOverride>(kAxis, "set_override"),
      Make<axis::Command, axis::TouchProbe>(kAxis, "arm_probe"),
      Make<axis::Command, axis::AbortTrigger>(kAxis, "abort_trigger"),
      Make<axis::Command, axis::Touch>(kAxis, "touch"),
      Make<axis::Command, axis::DigitalCamSwitch>(kAxis, "digital_cam_switch"),
      Make<axis::Command, axis::Stream>(kAxis, "stream"),
      Make<axis::Command, axis::StreamPoint>(kAxis, "stream_point"),
      Make<flexcam::Command, flexcam::Control>(kFlexCam, "control"),
      Make<flexcam::Command, flexcam::Jog>(kFlexCam, "jog", true),
      Make<flexcam::Command, flexcam::Configure>(kFlexCam, "configure"),
      Make<flexcam::Command, flexcam::SetCam>(kFlexCam, "set_cam"),
      Make<flexcam::Command, flexcam::ChangeCam>(kFlexCam, "change_cam"),
      Make<flexcam::Command, flexcam::WithdrawChanges>(kFlexCam, "withdraw_changes"),
      Make<group::Command, group::Power>(kGroup, "power"),
      Make<group::Command, group::Reset>(kGroup, "reset"),
      Make<group::Command, group::Enable>(kGroup, "enable"),
      Make<group::Command, group::Disable>(kGroup, "disable"),
      Make<group::Command, group::AddAxis>(kGroup, "add_axis"),
      Make<group::Command, group::RemoveAxis>(kGroup, "remove_axis"),
      Make<group::Command, group::UngroupAllAxes>(kGroup, "ungroup_all_axes"),
      Make<group::Command, group::Home>(kGroup, "home"),
      Make<group::Command, group::SetPosition>(kGroup, "define_position"),
      Make<group::Command, group::SetOverride>(kGroup, "set_override"),
      Make<group::Command, group::SetKinTransform>(kGroup, "set_kin_transform"),
      Make<group::Command, group::SetCartesianTransform>(kGroup, "set_cartesian_transform"),
      Make<group::Command, group::SetCoordinateTransform>(kGroup, "set_coordinate_transform"),
      Make<group::Command, group::SetTool>(kGroup, "set_tool"),
      Make<group::Command, group::Calibrate>(kGroup, "calibrate"),
      Make<group::Command, group::SetDynCoordTransform>(kGroup, "set_dyn_coord_transform"),
      Make<group::Command, group::TrackConveyorBelt>(kGroup, "track_conveyor_belt"),
      Make<group::Command, group::TrackRotaryTable>(kGroup, "track_rotary_table"),
      Make<group::Command, group::MoveLinearAbsolute>(kGroup, "move_linear_absolute"),
      Make<group::Command, group::MoveLinearRelative>(kGroup, "move_linear_relative"),
      Make<group::Command, group::MoveCircularAbsolute>(kGroup, "move_circular_absolute"),
      Make<group::Command, group::MoveCircularRelative>(kGroup, "move_circular_relative"),
      Make<group::Command, group::MoveDirectAbsolute>(kGroup, "move_direct_absolute"),
      Make<group::Command, group::MoveDirectRelative>(kGroup, "move_direct_relative"),
      Make<group::Command, group::MoveArch>(kGroup, "move_arch"),
      Make<group::Command, group::MovePath>(kGroup, "move_path"),
      Make<group::Command, group::MovePathSynchronized>(kGroup, "move_path_synchronized"),
      Make<group::Command, group::SyncAxis>(kGroup, "sync_axis"),
      Make<group::Command, group::Jog>(kGroup, "jog", true),
      Make<group::Command, group::Stream>(kGroup, "stream"),
      Make<group::Command, group::StreamPoint>(kGroup, "stream_point"),
      Make<group::Command, group::Stop>(kGroup, "stop", true),
      Make<group::Command, group::Halt>(kGroup, "halt"),
      Make<group::Command, group::Interrupt>(kGroup, "interrupt"),
      Make<group::Command, group::Continue>(kGroup, "continue_path"),
      Make<group::Command, group::PathChecked>(kGroup, "path_checked"),
      Make<group::Command, group::PathPlanned>(kGroup, "path_planned"),
      Make<conveyor::Command, conveyor::Detect>(kBelt, "detect"),
      Make<conveyor::Command, conveyor::Locate>(kBelt, "locate"),
      Make<conveyor::Command, conveyor::TakeObject>(kBelt, "take"),
      Make<conveyor::Command, conveyor::GiveBackObject>(kBelt, "give_back"),
      Make<conveyor::Command, conveyor::RemoveObject>(kBelt, "remove"),
      Make<conveyor::Command, conveyor::ClearObjects>(kBelt, "clear"),
      Make<conveyor::PoseCommand, conveyor::SetPose>(kPose, "set"),
      Make<pickplace::Command, pickplace::Control>(kPickPlace, "control"),
      Make<pickplace::Command, pickplace::Jog>(kPickPlace, "jog", true),
      Make<pickplace::Command, pickplace::Configure>(kPickPlace, "configure"),
      Make<pickplace::Command, pickplace::ConfigureBelt>(kPickPlace, "configure_belt"),
      Make<pickplace::Command, pickplace::ResetCounters>(kPickPlace, "reset_counters"),
      Make<mover::Command, mover::Enable>(kMover, "enable"),
      Make<mover::Command, mover::Disable>(kMover, "disable"),
      Make<mover::Command, mover::Reset>(kMover, "reset"),
      Make<mover::Command, mover::Halt>(kMover, "halt"),
      Make<mover::Command, mover::SetPosition>(kMover, "set_position"),
      Make<mover::Command, mover::MoveToPosition>(kMover, "move_to_position"),
      Make<mover::Command, mover::MoveZ>(kMover, "move_z"),
      Make<mover::Command, mover::MoveA>(kMover, "move_a"),
      Make<mover::Command, mover::MoveB>(kMover, "move_b"),
      Make<mover::Command, mover::MoveC>(kMover, "move_c"),
      Make<mover::Command, mover::MoveX>(kMover, "move_x"),
      Make<mover::Command, mover::MoveY>(kMover, "move_y"),
      Make<mover::Command, mover::MoveRelativeX>(kMover, "move_relative_x"),
      Make<mover::Command, mover::MoveRelativeY>(kMover, "move_relative_y"),
      Make<mover::Command, mover::MoveRelativeC>(kMover, "move_relative_c"),
      Make<mover::Command, mover::MoveVelocityX>(kMover, "move_velocity_x"),
      Make<mover::Command, mover::MoveVelocityY>(kMover, "move_velocity_y"),
      Make<mover::Command, mover::MoveVelocityC>(kMover, "move_velocity_c"),
      Make<mover::Command, mover::HaltX>(kMover, "halt_x"),
      Make<mover::Command, mover::HaltY>(kMover, "halt_y"),
      Make<mover::Command, mover::HaltZ>(kMover, "halt_z"),
      Make<mover::Command, mover::HaltA>(kMover, "halt_a"),
      Make<mover::Command, mover::HaltB>(kMover, "halt_b"),
      Make<mover::Command, mover::HaltC>(kMover, "halt_c"),
      Make<mover::Command, mover::HaltOnTrack>(kMover, "halt_on_track"),
      Make<mover::Command, mover::JoinTrack>(kMover, "join_track"),
      Make<mover::Command, mover::LeaveTrack>(kMover, "leave_track"),
      Make<mover::Command, mover::MoveOnTrack>(kMover, "move_on_track"),
      Make<mover::Command, mover::GearInPosOnTrack>(kMover, "gear_in_pos_on_track"),
      Make<mover::Command, mover::GearInPosOnTrackWithMasterMover>(kMover, "gear_in_pos_on_track_with_master_mover"),
      Make<mover::Command, mover::AdoptTrackOrientation>(kMover, "adopt_track_orientation"),
      Make<mover::Command, mover::StartExternalSetpointGeneration>(kMover, "start_external_setpoint_generation"),
      Make<mover::Command, mover::SetExternalSetpoint>(kMover, "set_external_setpoint"),
      Make<mover::Command, mover::StopExternalSetpointGeneration>(kMover, "stop_external_setpoint_generation"),
      Make<mover::Command, mover::Wait>(kMover, "wait"),
      Make<mover::Command, mover::Release>(kMover, "release"),
      Make<mover::Command, mover::AddToGroup>(kMover, "add_to_group"),
      Make<mover::Command, mover::RemoveFromGroup>(kMover, "remove_from_group"),
      Make<mover::Command, mover::JoinFormation>(kMover, "join_formation"),
      Make<mover::Command, mover::LeaveFormation>(kMover, "leave_formation"),
      Make<mover::Command, mover::SetRoute>(kMover, "set_route"),
      Make<mover::Command, mover::ContinueRoute>(kMover, "continue_route"),
      Make<track::Command, track::AppendLine>(kTrack, "append_line"),
      Make<track::Command, track::AppendCircle>(kTrack, "append_circle"),
      Make<track::Command, track::AppendPosition>(kTrack, "append_position"),
      Make<track::Command, track::CloseLoop>(kTrack, "close_loop"),
      Make<track::Command, track::Clear>(kTrack, "clear"),
      Make<track::Command, track::StartFromTrack>(kTrack, "start_from_track"),
      Make<track::Command, track::EndAtTrack>(kTrack, "end_at_track"),
      Make<track::Command, track::Enable>(kTrack, "enable"),
      Make<track::Command, track::Disable>(kTrack, "disable"),
      Make<track::Command, track::Reset>(kTrack, "reset"),
      Make<track::Command, track::AddToGroup>(kTrack, "add_to_group"),
      Make<track::Command, track::RemoveFromGroup>(kTrack, "remove_from_group"),
      Make<track::Command, track::TrackMade>(kTrack, "track_made"),
      Make<planargroup::Command, planargroup::Enable>(kPlanarGroup, "enable"),
      Make<planargroup::Command, planargroup::Disable>(kPlanarGroup, "disable"),
      Make<planargroup::Command, planargroup::Reset>(kPlanarGroup, "reset"),
      Make<environment::Command, environment::AddStator>(kEnvironment, "add_stator"),
      Make<environment::Command, environment::CreateBoundary>(kEnvironment, "create_boundary"),
      Make<environment::Command, environment::Clear>(kEnvironment, "clear"),
      Make<environment::Command, environment::AddToGroup>(kEnvironment, "add_to_group"),
      Make<environment::Command, environment::RemoveFromGroup>(kEnvironment, "remove_from_group"),
      Make<environment::Command, environment::BoundaryMade>(kEnvironment, "boundary_made"),
      Make<part::Command, part::ActivatePosition>(kPart, "activate_position"),
      Make<part::Command, part::AllowEnable>(kPart, "allow_enable"),
      Make<part::Command, part::ForceDisable>(kPart, "force_disable"),
      Make<part::Command, part::Reset>(kPart, "reset"),
  };
  return entries;
}

std::optional<std::uint32_t> FindTarget(const Machine& machine, std::string_view name) {
  if (name == kMachine) return kMachineTarget;
  const std::optional<std::uint32_t> component = FindComponent(machine, name);
  return component ? std::optional(*component + 1) : std::nullopt;
}

std::string_view KindOf(const Machine& machine, std::uint32_t target) {
  return target == kMachineTarget ? kMachine : PlaceOf(machine, target - 1).kind->name;
}

std::string_view NameOf(const Machine& machine, std::uint32_t target) {
  if (target == kMachineTarget) return kMachine;
  const auto [kind, index] = PlaceOf(machine, target - 1);
  return kind->name_of(machine, index);
}

// Returns "an axis", "the machine".
std::string_view PhraseOf(std::string_view target_kind) {
  for (const ComponentKind& kind : ComponentKinds()) {
    if (kind.name == target_kind) return kind.one;
  }
  return "the machine";
}

// Returns what is wrong with a list of cam switches for this axis. An unknown list is found in the cycle.
std::string DiagnoseCamSwitches(const Machine& machine, const axis::DigitalCamSwitch& command,
                                const axis::AxisParams& axis) {
  for (const axis::CamSwitches& list : machine.cam_switches) {
    if (list.name != command.switches.view()) continue;
    std::string why = axis::DiagnoseCamSwitches(list, axis);
    return why.empty() ? why : "switches: " + Quoted(list.name) + ": " + why;
  }
  return {};
}

std::string Diagnose(const Machine& machine, const axis::Command& command, const axis::AxisParams& axis) {
  std::string why = axis::Diagnose(command, axis);
  const auto* switches = std::get_if<axis::DigitalCamSwitch>(&command);
  return why.empty() && switches ? DiagnoseCamSwitches(machine, *switches, axis) : why;
}

template <typename T>
std::vector<std::string_view> NamesOf(const std::vector<T>& list) {
  std::vector<std::string_view> names;
  for (const T& element : list) names.push_back(element.name);
  return names;
}

std::vector<std::string_view> BeltsOf(const Machine& machine, conveyor::BeltKind kind) {
  std::vector<std::string_view> names;
  for (const conveyor::BeltParams& belt : machine.belts) {
    if (belt.kind == kind) names.push_back(belt.name);
  }
  return names;
}

// Returns the names of all carriers for the tool of a group: all but the group itself.
std::vector<std::string_view> CarriersOf(const Machine& machine, std::string_view group) {
  std::vector<std::string_view> names = NamesOf(machine.belts);
  std::ranges::copy(NamesOf(machine.groups), std::back_inserter(names));
  std::ranges::copy(NamesOf(machine.poses), std::back_inserter(names));
  std::erase(names, group);
  return names;
}

// Returns what is wrong with a name in a command; empty if nothing is.
std::string WhyNotNamed(const char* field, const Name& name, const std::vector<std::string_view>& names,
                        const char* what) {
  if (std::ranges::find(names, name.view()) != names.end()) return {};
  return std::string(field) + ": expected the name of " + what + ", found " + Quoted(name.view()) +
         DidYouMean(name.view(), names);
}

std::string Diagnose(const Machine& machine, const group::Command& command, std::string_view target) {
  std::string why = group::Diagnose(command);
  const auto check = [&](const char* field, const Name& name, const std::vector<std::string_view>& names,
                         const char* what) {
    if (why.empty()) why = WhyNotNamed(field, name, names, what);
  };
  if (const auto* path = std::get_if<group::MovePath>(&command)) {
    check("path", path->path, NamesOf(machine.paths), "a path of the machine");
  } else if (const auto* path = std::get_if<group::MovePathSynchronized>(&command)) {
    check("path", path->path, NamesOf(machine.paths), "a path of the machine");
    check("master", path->master, NamesOf(machine.axes), "an axis");
  } else if (const auto* sync = std::get_if<group::SyncAxis>(&command)) {
    check("axis", sync->axis, NamesOf(machine.axes), "an axis");
  } else if (const auto* add = std::get_if<group::AddAxis>(&command)) {
    check("axis", add->axis, NamesOf(machine.axes), "an axis");
    const std::string no_member = WhyNoMember(machine, add->axis.view());
    if (why.empty() && !no_member.empty()) why = "axis: " + no_member;
  } else if (const auto* dynamic = std::get_if<group::SetDynCoordTransform>(&command)) {
    check("carrier", dynamic->carrier, CarriersOf(machine, target), "a belt, another group or a pose");
  } else if (const auto* belt = std::get_if<group::TrackConveyorBelt>(&command)) {
    check("belt", belt->belt, BeltsOf(machine, conveyor::BeltKind::kStraight), "a belt that goes straight");
  } else if (const auto* table = std::get_if<group::TrackRotaryTable>(&command)) {
    check("table", table->table, BeltsOf(machine, conveyor::BeltKind::kTurning), "a belt that turns");
  }
  return why;
}

// The same for the name of a group of movers.
std::string WhyNotGroup(const Machine& machine, const Name& group) {
  return WhyNotNamed("group", group, NamesOf(machine.planar_groups), "a group of movers");
}

// Returns true if positions need a reference: there are several coordinate systems, or parts that move.
bool NeedsReference(const Machine& machine) {
  const auto moves = [](const part::PartParams& part) { return part.positions.size() > 1; };
  return machine.coordinate_systems.size() > 1 || std::ranges::any_of(machine.parts, moves);
}

// Returns true if the command lacks a required reference. Relative external set points need none: those are checked in
// the cycle.
template <typename Command>
bool LacksReference(const Machine& machine, const Command& command) {
  return std::visit(
      [&]<typename T>(const T& body) {
        if constexpr (std::is_same_v<T, mover::SetExternalSetpoint>) return false;
        if constexpr (requires { body.reference; }) return body.reference.empty() && NeedsReference(machine);
        return false;
      },
      command);
}

std::string WhyNotReference(const Machine& machine, const Name& reference, bool lacks) {
  if (reference.empty() && !lacks) return {};
  std::vector<std::string_view> names = NamesOf(machine.parts);
  std::ranges::copy(NamesOf(machine.coordinate_systems), std::back_inserter(names));
  if (!lacks) return WhyNotNamed("reference", reference, names, "a part or a coordinate system");
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return "reference: expected the name of a part or a coordinate system, needed where there are several coordinate "
         "systems or parts that move (there are " +
         all + ")";
}

// Returns what is wrong with the reference of a command; empty if nothing is, or the command has none.
template <typename Command>
std::string WhyNotReferenceOf(const Machine& machine, const Command& command) {
  return std::visit(
      [&]<typename T>(const T& body) {
        if constexpr (requires { body.reference; }) {
          return WhyNotReference(machine, body.reference, LacksReference(machine, command));
        }
        return std::string();
      },
      command);
}

// Returns what is wrong with the index of a part's position; empty if nothing is.
std::string WhyNotPosition(const Machine& machine, std::string_view part, std::uint32_t index) {
  const auto found = std::ranges::find(machine.parts, part, &part::PartParams::name);
  if (found == machine.parts.end() || index <= found->positions.size()) return {};
  const std::size_t count = found->positions.size();
  return "index: expected " + (count == 1 ? std::string("1") : "1 to " + std::to_string(count)) +
         ", of the positions of part " + found->name + ", found " + std::to_string(index);
}

std::string Diagnose(const Machine& machine, const track::Command& command, std::string_view target) {
  if (const auto* add = std::get_if<track::AddToGroup>(&command)) return WhyNotGroup(machine, add->group);
  std::vector<std::string_view> others = NamesOf(machine.tracks);
  std::erase(others, target);
  if (const auto* from = std::get_if<track::StartFromTrack>(&command)) {
    return WhyNotNamed("track", from->track, others, "another track");
  }
  if (const auto* to = std::get_if<track::EndAtTrack>(&command)) {
    return WhyNotNamed("track", to->track, others, "another track");
  }
  return WhyNotReferenceOf(machine, command);
}

// Checks the names only; the geometry of the tracks is checked in the cycle.
template <typename Gear>
std::string WhyNotGear(const Machine& machine, const Gear& gear, std::string_view target) {
  std::string why;
  const auto check_track = [&](const char* field, const Name& track) {
    if (why.empty() && !track.empty())
      why = WhyNotNamed(field, track, NamesOf(machine.tracks), "a track of the machine");
  };
  if constexpr (std::is_same_v<Gear, mover::GearInPosOnTrack>) {
    why = WhyNotNamed("master", gear.master, NamesOf(machine.axes), "an axis");
  } else {
    std::vector<std::string_view> others = NamesOf(machine.movers);
    std::erase(others, target);
    why = WhyNotNamed("master", gear.master, others, "another mover");
    check_track("master_sync_track", gear.master_sync_track);
  }
  check_track("slave_sync_track", gear.slave_sync_track);
  for (const Name& track : gear.trail.all()) {
    check_track("trail", track);
    if (why.empty() && std::ranges::count(gear.trail.all(), track) > 1) {
      why = "trail: expected each track once, found " + Quoted(track.view()) + " more often";
    }
  }
  return why;
}

std::string Diagnose(const Machine& machine, const mover::Command& command, std::string_view target) {
  const auto check = [&](const Name& track) {
    return WhyNotNamed("track", track, NamesOf(machine.tracks), "a track of the machine");
  };
  if (const auto* add = std::get_if<mover::AddToGroup>(&command)) return WhyNotGroup(machine, add->group);
  if (const auto* join = std::get_if<mover::JoinTrack>(&command)) return check(join->track);
  if (const auto* gear = std::get_if<mover::GearInPosOnTrack>(&command)) return WhyNotGear(machine, *gear, target);
  if (const auto* gear = std::get_if<mover::GearInPosOnTrackWithMasterMover>(&command)) {
    return WhyNotGear(machine, *gear, target);
  }
  if (const auto* join = std::get_if<mover::JoinFormation>(&command)) {
    std::vector<std::string_view> others = NamesOf(machine.movers);
    std::erase(others, target);
    return WhyNotNamed("star", join->star, others, "another mover");
  }
  const auto* move = std::get_if<mover::MoveOnTrack>(&command);
  return move && !move->track.empty() ? check(move->track) : WhyNotReferenceOf(machine, command);
}

// Checks belts and ranges; rules that depend on settings at run time are checked in the cycle.
std::string Diagnose(const Machine& machine, const pickplace::Command& command, std::string_view target) {
  const auto module = std::ranges::find(machine.pick_and_place, target, &pickplace::PickPlaceParams::name);
  if (module == machine.pick_and_place.end()) return {};
  const std::size_t count = module->belts.size();
  const auto named = [](const char* field, const std::string& why) { return why.empty() ? why : field + (": " + why); };
  const auto belt = [&](const char* field, const std::optional<std::uint32_t>& number, std::string_view none) {
    return number ? named(field, pickplace::DiagnoseBelt(*number, count, none)) : std::string();
  };
  if (const auto* control = std::get_if<pickplace::Control>(&command)) {
    return belt("set_target", control->set_target, pickplace::kStaticTarget);
  }
  if (const auto* configure = std::get_if<pickplace::Configure>(&command)) {
    std::string why = belt("pick_belt", configure->pick_belt, pickplace::kStaticTarget);
    if (why.empty()) why = belt("place_belt", configure->place_belt, pickplace::kStaticTarget);
    if (why.empty() && configure->tracking_mode) {
      why = named("tracking_mode", pickplace::DiagnoseMode(*configure->tracking_mode, count));
    }
    return why;
  }
  const auto* configure = std::get_if<pickplace::ConfigureBelt>(&command);
  if (!configure) return {};
  std::string why = belt("belt", configure->belt.value_or(1), {});
  if (!why.empty() || !configure->lower_limit || !configure->upper_limit) return why;
  const std::string& name = module->belts[configure->belt.value_or(1) - 1].belt;
  const auto found = std::ranges::find(machine.belts, name, &conveyor::BeltParams::name);
  pickplace::BeltSettings range;
  range.lower_limit = *configure->lower_limit;
  range.upper_limit = *configure->upper_limit;
  range.leave = configure->leave.value_or(0);
  if (found == machine.belts.end() || !pickplace::RangeFits(range)) return {};
  why = named("lower_limit", pickplace::DiagnoseRange(range, *found));
  return why.empty() ? named("leave", pickplace::DiagnoseLeave(range, *found)) : why;
}

// Returns why this component cannot carry out the command, as far as the machine file tells; empty if it can.
std::string Diagnose(const Machine& machine, const Command& command) {
  if (const auto* body = std::get_if<axis::Command>(&command.body)) {
    return Diagnose(machine, *body, machine.axes[command.target - 1]);
  }
  if (const auto* body = std::get_if<flexcam::Command>(&command.body)) return flexcam::Diagnose(*body);
  if (const auto* body = std::get_if<group::Command>(&command.body)) {
    return Diagnose(machine, *body, NameOf(machine, command.target));
  }
  if (const auto* body = std::get_if<pickplace::Command>(&command.body)) {
    return Diagnose(machine, *body, NameOf(machine, command.target));
  }
  if (const auto* body = std::get_if<mover::Command>(&command.body)) {
    return Diagnose(machine, *body, NameOf(machine, command.target));
  }
  if (const auto* body = std::get_if<track::Command>(&command.body)) {
    return Diagnose(machine, *body, NameOf(machine, command.target));
  }
  if (const auto* body = std::get_if<part::Command>(&command.body)) {
    const auto* activate = std::get_if<part::ActivatePosition>(body);
    return activate ? WhyNotPosition(machine, NameOf(machine, command.target), activate->index) : std::string();
  }
  if (const auto* body = std::get_if<environment::Command>(&command.body)) {
    const auto* add = std::get_if<environment::AddToGroup>(body);
    return add ? WhyNotGroup(machine, add->group) : std::string();
  }
  return {};
}

// Returns the error number for a command that this component cannot carry out.
ErrorId ErrorOf(const Machine& machine, const Command& command) {
  const auto* mover = std::get_if<mover::Command>(&command.body);
  const auto* track = std::get_if<track::Command>(&command.body);
  if ((mover && LacksReference(machine, *mover)) || (track && LacksReference(machine, *track))) {
    return ErrorId::kReference;
  }
  const auto* group = std::get_if<group::Command>(&command.body);
  return group ? group::ErrorOf(*group) : ErrorId::kParameter;
}

ParsedCommand Refused(ErrorId error, std::string sentence) {
  ParsedCommand refused;
  refused.error = error;
  refused.sentence = std::move(sentence);
  return refused;
}

ParsedCommand UnknownTarget(const Machine& machine, std::string_view target) {
  std::vector<std::string_view> names = ComponentNames(machine);
  names.push_back(kMachine);
  std::string kinds;
  for (const ComponentKind& kind : ComponentKinds()) kinds += (kinds.empty() ? "" : ", ") + std::string(kind.one);
  return Refused(ErrorId::kUnknownTarget, "target: expected the name of " + kinds + " or machine, found " +
                                              Quoted(target) + DidYouMean(target, names));
}

ParsedCommand UnknownVerb(std::string_view kind, std::string_view verb) {
  std::vector<std::string_view> names;
  for (const Verb& known : Verbs()) {
    if (known.target_kind == kind) names.push_back(known.name);
  }
  return Refused(ErrorId::kUnknownVerb, "verb: expected a command of " + std::string(PhraseOf(kind)) +
                                            " (takt reference lists them), found " + Quoted(verb) +
                                            DidYouMean(verb, names));
}

}  // namespace

bool LetsGo(const Command& command) noexcept {
  for (const Entry& entry : Entries()) {
    if (const void* arguments = entry.find(command.body)) return entry.lets_go(arguments);
  }
  return false;
}

bool LetsGo(std::string_view target_kind, std::string_view verb, std::string_view arguments) {
  for (const Entry& entry : Entries()) {
    if (entry.verb.target_kind != target_kind || entry.verb.name != verb) continue;
    CommandBody body;
    Problem ignored;
    return entry.read(arguments, body, ignored) && entry.lets_go(entry.find(body));
  }
  return false;
}

std::span<const Verb> Verbs() {
  static const std::vector<Verb> verbs = [] {
    std::vector<Verb> all;
    for (const Entry& entry : Entries()) {
      if (!IsInternal(entry.verb)) all.push_back(entry.verb);
    }
    return all;
  }();
  return verbs;
}

ParsedCommand ParseCommand(const Machine& machine, std::string_view target, std::string_view verb,
                           std::string_view arguments, Giver giver) {
  const std::optional<std::uint32_t> found = FindTarget(machine, target);
  if (!found) return UnknownTarget(machine, target);
  const std::string_view kind = KindOf(machine, *found);
  for (const Entry& entry : Entries()) {
    if (entry.verb.target_kind != kind || entry.verb.name != verb) continue;
    if (IsInternal(entry.verb) && giver != Giver::kJournal) break;
    ParsedCommand parsed;
    parsed.command.target = *found;
    parsed.level_sensitive = entry.verb.level_sensitive;
    Problem problem;
    if (!entry.read(arguments, parsed.command.body, problem)) return Refused(ErrorId::kParameter, problem.Text());
    if (std::string sentence = Diagnose(machine, parsed.command); !sentence.empty()) {
      return Refused(ErrorOf(machine, parsed.command), std::move(sentence));
    }
    return parsed;
  }
  return UnknownVerb(kind, verb);
}

CommandText ToText(const Machine& machine, const Command& command) {
  const std::string target(NameOf(machine, command.target));
  for (const Entry& entry : Entries()) {
    if (const void* arguments = entry.find(command.body)) {
      return {target, std::string(entry.verb.name), WriteFlow(*entry.verb.arguments, arguments)};
    }
  }
  return {target, "", ""};
}

void describe(Description<StopAll>& d) {
  d.about("Stops every axis along its ramp.");
  d.defaulted<&StopAll::open_loops>("True: also opens the loop of every axis.");
}

void describe(Description<EmergencyStop>& d) {
  d.about(
      "Switches every drive off and closes every brake at once, without a ramp; faults are cleared, every axis is "
      "Disabled (GT_EStop). Axes must be powered again before they can move.");
  d.defaulted<&EmergencyStop::hold>(
      "True: the stop stays in force until it is released (by `release`, or release_emergency_stop); until then "
      "commands that request power or motion are refused with error 3100. The loss of the client does not release it.");
}

void describe(Description<ReleaseEmergencyStop>& d) {
  d.about(
      "Ends the emergency stop of any client. No axis moves as a result: axes stay Disabled until they are powered "
      "again.");
}

void describe(Description<FailAllAxes>& d) {
  d.about("Every axis brakes and enters ErrorStop with error 3007, as after too many late cycles in a row.");
}

void describe(Description<Release>& d) {
  d.about("Releases a level-sensitive command: a jog, a held stop.");
  d.required<&Release::ticket>("Ticket of the command.");
}

void describe(Description<Renew>& d) {
  d.about("Extends the lease of a level-sensitive command.");
  d.required<&Renew::ticket>("Ticket of the command.");
}

}  // namespace takt::engine
