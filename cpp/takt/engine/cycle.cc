#include "takt/engine/cycle.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "takt/core/maths.h"
#include "takt/engine/carriers.h"
#include "takt/engine/masters.h"
#include "takt/engine/mover_masters.h"
#include "takt/engine/parts.h"
#include "takt/mover/formation.h"
#include "takt/mover/gear.h"
#include "takt/mover/on_parts.h"

namespace takt::engine {

namespace {

axis::Context ContextOf(World& w, std::size_t i) {
  const axis::State* master = w.axis_masters[i] ? &w.axis_states[*w.axis_masters[i]] : nullptr;
  return {w.axis_params[i], w.cycle, w.planner, w.feedback, master, w.surrounding};
}

flexcam::Context ContextOf(World& w, const FlexCam& module) {
  return {module.params, ContextOf(w, module.slave), module.master, module.homing};
}

conveyor::Context ContextOf(World& w, const Belt& belt) {
  return {belt.params, w.axis_states[belt.axis], w.axis_params[belt.axis], w.cycle, w.feedback};
}

group::Context ContextOf(World& w, AxesGroup& group) {
  const auto index = static_cast<std::size_t>(&group - w.groups.data());
  const auto of_axis = [](void* owner, std::size_t i) noexcept { return ContextOf(*static_cast<World*>(owner), i); };
  return {group.params,
          group.mounting,
          group.kinematics ? &*group.kinematics : nullptr,
          w.paths,
          w.group_of,
          static_cast<std::uint32_t>(index + 1),
          {w.axis_states, w.axis_params, of_axis, &w},
          w.cycle,
          w.feedback,
          w.look_aheads[index],
          CarriersFor(w.riders[index]),
          group.params.workspace ? &w.questions : nullptr,
          {w.zones, w.group_states},
          w.plans_elsewhere};
}

pickplace::Context ContextOf(World& w, const PickPlace& module) {
  pickplace::Context c{
      module.params, ContextOf(w, w.groups[module.group]), {}, w.group_outputs[module.group].path_error};
  for (std::size_t i = 0; i < module.belts.size(); ++i) {
    c.belts[i] = {&w.belts[module.belts[i]].params, &w.belt_states[module.belts[i]]};
  }
  return c;
}

track::Context TrackContext(World& w) {
  return {w.tracks, w.grounds, w.cycle, w.feedback};
}
planargroup::Context PlanarGroupContext(World& w) {
  return {w.planar_groups, w.grounds, w.cycle, w.feedback};
}
environment::Context EnvironmentContext(World& w) {
  return {w.environments, w.grounds, w.cycle, w.feedback};
}

bool UsesCam(const void* world, std::uint32_t index) noexcept {
  const World& w = *static_cast<const World*>(world);
  return std::ranges::any_of(w.axis_states, [&](const axis::State& s) { return axis::UsesTable(s, index); }) ||
         std::ranges::any_of(w.flex_cam_states, [&](const flexcam::State& s) { return flexcam::UsesCam(s, index); });
}
cam::Context CamContext(World& w) {
  return {w.cams, w.cycle.count, w.feedback, UsesCam, &w};
}

// Updates the views of tracks for movers.
void RefreshStreets(World& w) {
  for (std::size_t i = 0; i < w.tracks_now.size(); ++i) {
    const track::TrackParams& params = w.tracks.params[i];
    const std::uint32_t part = w.tracks.part_of[i];
    const planar::PartNow* on = part == planar::kNoPart ? nullptr : &w.surface.now[part];
    const bool carried = !on || (!on->away && (on->enabled || on->enabling));
    w.tracks_now[i] = {w.tracks.ways[i],
                       w.tracks.states[i].length,
                       w.tracks.states[i].state == planar::ObjectState::kEnabled && carried,
                       w.tracks.start_nodes[i],
                       w.tracks.end_nodes[i],
                       maths::Hypot(params.mover_width, params.mover_height),
                       part,
                       w.tracks.spot(i),
                       w.tracks.goal(i),
                       params.collision_range_mode == track::CollisionRangeMode::kManual,
                       params.collision_range_at_start,
                       params.collision_range_at_end,
                       params.mover_width,
                       params.mover_height};
  }
  if (w.streets_changes != w.tracks.changes) {
    w.streets_changes = w.tracks.changes;
    std::ranges::fill(w.streets.declared, planar::Links{});
    for (std::uint32_t i = 0; i < w.tracks.states.size(); ++i) {
      const track::State& state = w.tracks.states[i];
      for (std::uint32_t k = 0; k < state.starts_from.count; ++k) {
        w.streets.declared[state.starts_from.tracks[k]].Add(i);
      }
      for (std::uint32_t k = 0; k < state.ends_at.count; ++k) w.streets.declared[i].Add(state.ends_at.tracks[k]);
    }
  }
  mover::Refresh(w.tracks_now, w.streets);
  for (std::size_t i = 0; i < w.tracks_now.size(); ++i) {
    w.grounds.areas[i] = w.tracks.areas[i];
    w.grounds.spots[i] = w.tracks.spot(i);
  }
}

// Updates the use of each track by movers, for the commands of the next cycle, and the modes of tracks.
void UseTracks(World& w) {
  std::ranges::fill(w.streets.uses, mover::TrackUse{});
  const auto use = [&w](std::uint32_t track, std::uint32_t mover) -> mover::TrackUse& {
    mover::TrackUse& its = w.streets.uses[track];
    its.one = mover;
    return its;
  };
  for (std::uint32_t i = 0; i < w.movers.size(); ++i) {
    const planar::Rider& rider = w.streets.riders[i];
    if (rider.on) ++use(rider.route.first(), i).movers;
  }
  for (std::uint32_t i = 0; i < w.movers.size(); ++i) {
    const mover::State& s = w.mover_states[i];
    const planar::Rider& rider = w.streets.riders[i];
    if (!rider.on) continue;
    if (s.mode == mover::CommandMode::kJoiningTrack || s.mode == mover::CommandMode::kLeavingTrack) {
      ++use(s.track, i).configuring;
    } else if ((rider.aim != planar::Aim::kRest && !rider.there) || rider.at.velocity != 0) {
      for (const std::uint32_t track : rider.route.all()) ++use(track, i).moving;
    }
  }
  for (std::size_t i = 0; i < w.streets.uses.size(); ++i) {
    const mover::TrackUse& its = w.streets.uses[i];
    track::Use({its.movers, its.moving > 0, its.configuring > 0, its.one}, i, w.tracks);
    w.grounds.moving[i] = its.moving > 0 ? 1 : 0;
  }
  planar::AdvanceTracks(w.grounds);
}

mover::RoutedMovers AllMovers(World& w) {
  const auto context = [](void* owner, std::size_t i) noexcept { return MoverContext(*static_cast<World*>(owner), i); };
  return {&w, context, w.mover_states, w.routes};
}

void FailMovers(World& w, ErrorId error) {
  for (std::size_t i = 0; i < w.movers.size(); ++i) mover::Fail(MoverContext(w, i), error, w.mover_states[i]);
}

// AX-82: after an internal fault nothing may continue to move: all loops open, all outputs are zero. Movers brake.
void OpenAllLoops(World& w) {
  FailMovers(w, ErrorId::kInternal);
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    axis::Fail(ContextOf(w, i), ErrorId::kInternal, true, w.axis_states[i]);
    axis::Control(ContextOf(w, i), w.axis_states[i], w.servo_outputs[i]);
  }
}

// A master stops if a follower has failed (AX-55). A coupling made at run time ends with the failure of its follower,
// so this happens once; one of the machine file remains.
void StopMasters(World& w, std::uint32_t follower) {
  axis::State& s = w.axis_states[follower];
  const auto stop = [&](std::uint32_t master) {
    axis::State& its = w.axis_states[master];
    const bool moves = !axis::AtRest(its) || its.active.kind != axis::RequestKind::kNone || its.superimposed;
    if (!moves || its.plc == axis::PlcState::kErrorStop) return;
    // In a chain of followers, the axis whose own fault it is.
    its.fault_of = s.error == ErrorId::kAxisFault && s.fault_of != axis::kNoAxis ? s.fault_of : follower;
    axis::Fail(ContextOf(w, master), ErrorId::kAxisFault, false, its);
  };
  if (w.axis_masters[follower]) stop(*w.axis_masters[follower]);
  for (axis::CouplingTerm& term : s.coupling.law.terms) {
    if (term.master < w.axis_states.size()) stop(term.master);  // movers are not stopped
    term.master = axis::kNoAxis;
  }
}

// Returns true for commands that a member of an enabled group accepts itself: those that cause no motion and change
// neither its limits nor its positions, on which the path of the group is planned; and those that switch it on or off,
// or reset it.
bool IsForMembers(const axis::Command& command) {
  return std::visit(
      []<typename T>(const T&) {
        return std::is_same_v<T, axis::Power> || std::is_same_v<T, axis::Reset> ||
               std::is_same_v<T, axis::ReadParameter> || std::is_same_v<T, axis::CamTableSelect> ||
               std::is_same_v<T, axis::TouchProbe> || std::is_same_v<T, axis::SetLoad> ||
               std::is_same_v<T, axis::AbortTrigger> || std::is_same_v<T, axis::AbortPassiveHoming> ||
               std::is_same_v<T, axis::DigitalCamSwitch> || std::is_same_v<T, axis::WriteOutput>;
      },
      command);
}

bool IsOwned(const World& w, std::size_t axis) {
  return w.group_of[axis] != 0 && group::Owns(w.group_states[w.group_of[axis] - 1]);
}

// Returns the axis that all members of a gantry follow.
std::size_t LeaderOf(const World& w, std::size_t axis) {
  while (w.axis_masters[axis]) axis = *w.axis_masters[axis];
  return axis;
}

// A command that stops one member of a gantry stops all, along the ramp of the leader (AX-101).
void ApplyToMember(World& w, std::size_t i, const Command& command, const axis::Command& body) {
  const auto apply = [&](std::size_t to, Ticket ticket) {
    axis::Apply(ContextOf(w, to), ticket, command.lease_s, body, w.axis_states[to]);
  };
  const bool alone = !w.axis_masters[i] && !w.axis_states[i].leads;
  if (alone) return apply(i, command.ticket);
  const std::size_t leader = LeaderOf(w, i);
  if (std::holds_alternative<axis::Stop>(body) || std::holds_alternative<axis::Halt>(body)) {
    for (std::size_t k = 0; k < w.axis_states.size(); ++k) {  // the leader is at rest while a follower is straightened
      if (w.axis_states[k].skew.straightens && LeaderOf(w, k) == leader) apply(k, 0);
    }
    return apply(leader, command.ticket);
  }
  const auto* power = std::get_if<axis::Power>(&body);
  const bool off = power && !power->enable && power->buffer_mode == axis::BufferMode::kAborting;
  for (std::size_t k = 0; off && k < w.axis_states.size(); ++k) {
    const bool on = w.axis_states[k].enable || w.axis_states[k].loop_closed;
    if (k != i && on && LeaderOf(w, k) == leader) apply(k, 0);
  }
  apply(i, command.ticket);
}

struct MachineApplier {
  World& world;
  Ticket ticket;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone) const {
    world.feedback.Report({ticket, world.cycle.count, state, false, error, 0});
  }
  void Report(const planar::Verdict& why) const {
    const bool good = why.error == ErrorId::kNone;
    world.feedback.Report({ticket, world.cycle.count, good ? FeedbackState::kDone : FeedbackState::kError, false,
                           why.error, why.value, why.object});
  }
  void operator()(const StopAll& c) const {
    // A group stops its members.
    for (std::size_t i = 0; i < world.groups.size(); ++i) {
      group::State& state = world.group_states[i];
      if (!group::Owns(state)) continue;
      const group::Context context = ContextOf(world, world.groups[i]);
      if (c.open_loops) {
        group::Apply(context, 0, 0, group::Power{.enable = false}, state);
      } else if (state.state != group::GroupState::kErrorStop) {
        group::Apply(context, 0, 0, group::Stop{}, state);
      }
    }
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      if (IsOwned(world, i)) continue;
      axis::State& state = world.axis_states[i];
      if (c.open_loops) {
        axis::Apply(ContextOf(world, i), 0, 0, axis::Power{.enable = false}, state);
      } else if ((state.loop_closed || state.enable || state.direct_voltage_v != 0) &&
                 state.plc != axis::PlcState::kErrorStop) {
        axis::Apply(ContextOf(world, i), 0, 0, axis::Stop{}, state);
      }
    }
    for (std::size_t i = 0; i < world.movers.size(); ++i) {
      ToMover(i, c.open_loops ? mover::Command(mover::Disable{}) : StopOf(world.movers[i]));
    }
    Report(FeedbackState::kDone);
  }
  // Groups first, while their members still show what they were doing; modules last, which keep that in their own
  // state.
  void operator()(const EmergencyStop& c) const {
    for (std::size_t i = 0; i < world.groups.size(); ++i) {
      group::EmergencyStop(ContextOf(world, world.groups[i]), world.group_states[i]);
    }
    for (std::size_t i = 0; i < world.movers.size(); ++i) ToMover(i, mover::Disable{});
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      axis::EmergencyStop(ContextOf(world, i), world.axis_states[i]);
    }
    for (std::size_t i = 0; i < world.flex_cams.size(); ++i) {
      const FlexCam& module = world.flex_cams[i];
      flexcam::EmergencyStop(ContextOf(world, module), world.axis_states[module.slave], world.flex_cam_states[i]);
    }
    for (std::size_t i = 0; i < world.pick_places.size(); ++i) {
      const PickPlace& module = world.pick_places[i];
      pickplace::EmergencyStop(ContextOf(world, module), world.group_states[module.group], world.pick_place_states[i]);
    }
    world.emergency.Pulse(world.cycle.count);
    const bool held = !c.hold || world.emergency.Add(ticket);
    EndEmergency();
    held ? Report(FeedbackState::kDone) : Report(FeedbackState::kError, ErrorId::kBufferFull);
  }
  void operator()(const ReleaseEmergencyStop&) const {
    world.emergency.Clear();
    EndEmergency();
    Report(FeedbackState::kDone);
  }
  void EndEmergency() const {
    if (world.emergency.held()) return;
    for (axis::State& state : world.axis_states) axis::ReleaseEmergencyStop(state);
  }
  void operator()(const FailAllAxes&) const {
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      axis::Fail(ContextOf(world, i), ErrorId::kOverrun, false, world.axis_states[i]);
    }
    FailMovers(world, ErrorId::kOverrun);
    Report(FeedbackState::kDone);
  }
  void operator()(const Release& c) const {
    if (world.emergency.Remove(c.ticket)) {
      EndEmergency();
      return Report(FeedbackState::kDone);
    }
    ToOwner(c.ticket, axis::Release, flexcam::Release, group::Release, pickplace::Release);
  }
  void operator()(const Renew& c) const {
    ToOwner(c.ticket, axis::Renew, flexcam::Renew, group::Renew, pickplace::Renew);
  }

  void operator()(const mover::StartRoutes& c) const { Report(mover::Start(AllMovers(world), c)); }

  void operator()(const mover::HoldRoutes& c) const { Report(mover::Hold(AllMovers(world), c)); }

  // Commands that make cams.
  template <typename OfCams>
  void operator()(const OfCams& c) const {
    cam::Apply(CamContext(world), ticket, c);
  }

  // A mover cannot be released: it stops with its maximum dynamics.
  static mover::Command StopOf(const mover::MoverParams& params) {
    const trajectory::Limits most = params.xy.maximum.limits();
    return mover::Halt{.deceleration = most.deceleration, .jerk = most.jerk};
  }
  void ToMover(std::size_t i, const mover::Command& command) const {
    mover::Apply(MoverContext(world, i), 0, command, world.mover_states[i]);
  }

  template <typename OfAxis, typename OfModule, typename OfGroup, typename OfPickPlace>
  void ToOwner(Ticket of, OfAxis change, OfModule of_module, OfGroup of_group, OfPickPlace of_pick_place) const {
    bool found = false;
    for (std::size_t i = 0; i < world.axis_states.size() && !found; ++i) {
      found = change(ContextOf(world, i), of, world.axis_states[i]);
    }
    for (std::size_t i = 0; i < world.flex_cams.size() && !found; ++i) {
      found = of_module(ContextOf(world, world.flex_cams[i]), of, world.flex_cam_states[i]);
    }
    for (std::size_t i = 0; i < world.groups.size() && !found; ++i) {
      found = of_group(ContextOf(world, world.groups[i]), of, world.group_states[i]);
    }
    for (std::size_t i = 0; i < world.pick_places.size() && !found; ++i) {
      found = of_pick_place(ContextOf(world, world.pick_places[i]), of, world.pick_place_states[i]);
    }
    Report(FeedbackState::kDone);  // releasing a command that has ended is no error
  }
};

}  // namespace

bool Take(World& w, const DriveSample& sample) noexcept {
  for (HeardDrive& drive : w.drives) {
    if (drive.axis != sample.axis) continue;
    if (!Take(w.cycle, sample, drive, w.servo_inputs[drive.axis])) return false;
    w.true_positions[drive.axis] = sample.true_position;
    return true;
  }
  return false;
}

axis::Forecast Foresee(World& w, std::size_t axis) {
  return axis::Foresee(ContextOf(w, axis), w.axis_states.at(axis));
}

axis::Forecast Foresee(World& w, std::size_t axis, const axis::Command& command) {
  return axis::Foresee(ContextOf(w, axis), command, w.axis_states.at(axis));
}

namespace {

// Returns inputs with the touch probe of another axis: several axes may share one probe.
ServoInputs WithProbeOf(const ServoInputs& wire, ServoInputs in) noexcept {
  in.touch_probe = wire.touch_probe;
  in.probe_rises = wire.probe_rises;
  in.probe_falls = wire.probe_falls;
  in.probe_rise_age_s = wire.probe_rise_age_s;
  in.probe_fall_age_s = wire.probe_fall_age_s;
  return in;
}

}  // namespace

void Sense(World& w) noexcept {
  for (HeardDrive& drive : w.drives) w.samplings[drive.axis] = SamplingIn(w.cycle, drive);
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    const std::uint32_t wire = w.probe_wires[i];
    if (wire == i) {
      axis::Sense(ContextOf(w, i), w.servo_inputs[i], w.axis_states[i], w.samplings[i]);
    } else {
      axis::Sense(ContextOf(w, i), WithProbeOf(w.servo_inputs[wire], w.servo_inputs[i]), w.axis_states[i],
                  w.samplings[i]);
    }
  }
}

void Apply(World& w, const Command& command) noexcept {
  const auto refuse = [&](ErrorId error) {
    w.feedback.Report({command.ticket, w.cycle.count, FeedbackState::kError, false, error, 0});
  };
  const bool emergency = w.emergency.on(w.cycle.count);
  if (const auto* for_machine = std::get_if<MachineCommand>(&command.body)) {
    if (emergency && AsksToMove(command)) return refuse(ErrorId::kEmergencyStop);
    return std::visit(MachineApplier{w, command.ticket}, *for_machine);
  }
  const std::size_t kind = command.body.index() - 1;
  const std::uint32_t component = command.target - 1;  // out of range for the machine's own target
  if (component < w.first_of[kind] || component >= w.first_of[kind + 1]) return refuse(ErrorId::kUnknownTarget);
  const std::size_t i = component - w.first_of[kind];
  if (emergency && AsksToMove(command)) return refuse(ErrorId::kEmergencyStop);
  if (const auto* for_axis = std::get_if<axis::Command>(&command.body)) {
    // Stopping a follower stops its leader, which may be a member of the group (AX-101, GR-03).
    const bool of_leader =
        std::holds_alternative<axis::Stop>(*for_axis) || std::holds_alternative<axis::Halt>(*for_axis);
    const std::size_t leader = of_leader ? LeaderOf(w, i) : i;
    if ((IsOwned(w, i) || IsOwned(w, leader)) && !IsForMembers(*for_axis)) {
      const ObjectInfo member = IsOwned(w, i) ? ObjectInfo{} : ObjectAt(ObjectKind::kAxis, leader);
      w.feedback.Report(
          {command.ticket, w.cycle.count, FeedbackState::kError, false, ErrorId::kGroupMember, 0, member});
      return;
    }
    axis::CouplingRequest coupling;
    if (axis::CouplingOf(ContextOf(w, i), *for_axis, coupling) &&
        !MakeOrder(w, {.coupling = &coupling, .of = component})) {
      return refuse(ErrorId::kCouplingLoop);
    }
    ApplyToMember(w, i, command, *for_axis);
  } else if (const auto* for_module = std::get_if<flexcam::Command>(&command.body)) {
    const FlexCam& module = w.flex_cams[i];
    flexcam::Apply(ContextOf(w, module), command.ticket, command.lease_s, *for_module, w.axis_states[module.slave],
                   w.flex_cam_states[i]);
  } else if (const auto* for_group = std::get_if<group::Command>(&command.body)) {
    const Wanted wanted = WantedBy(w, *for_group, i);
    if (wanted.added != axis::kNoAxis && w.module_of[wanted.added] != 0) return refuse(ErrorId::kState);
    if (Changes(wanted) && !MakeOrder(w, wanted)) return refuse(ErrorId::kCouplingLoop);
    if (TakesToolAway(*for_group) && IsRidden(w, i)) return refuse(ErrorId::kState);
    group::Apply(ContextOf(w, w.groups[i]), command.ticket, command.lease_s, *for_group, w.group_states[i]);
  } else if (const auto* for_belt = std::get_if<conveyor::Command>(&command.body)) {
    conveyor::Apply(ContextOf(w, w.belts[i]), command.ticket, *for_belt, w.belt_states[i]);
  } else if (const auto* for_pose = std::get_if<conveyor::PoseCommand>(&command.body)) {
    conveyor::Apply(w.cycle, w.feedback, command.ticket, *for_pose, w.pose_states[i]);
  } else if (const auto* for_pick_place = std::get_if<pickplace::Command>(&command.body)) {
    const PickPlace& module = w.pick_places[i];
    pickplace::Apply(ContextOf(w, module), command.ticket, command.lease_s, *for_pick_place,
                     w.group_states[module.group], w.pick_place_states[i]);
  } else if (const auto* for_mover = std::get_if<mover::Command>(&command.body)) {
    const Wanted wanted{.movers = AxisFollowedBy(w, *for_mover)};
    if (Changes(wanted) && !MakeOrder(w, wanted)) return refuse(ErrorId::kCouplingLoop);
    mover::Apply(MoverContext(w, i), command.ticket, *for_mover, w.mover_states[i]);
  } else if (const auto* for_track = std::get_if<track::Command>(&command.body)) {
    UseTracks(w);  // with this cycle's commands to movers; below, movers see the change of the track
    track::Apply(TrackContext(w), i, command.ticket, *for_track);
    RefreshStreets(w);
  } else if (const auto* for_planar_group = std::get_if<planargroup::Command>(&command.body)) {
    planargroup::Apply(PlanarGroupContext(w), i, command.ticket, *for_planar_group);
  } else if (const auto* for_environment = std::get_if<environment::Command>(&command.body)) {
    environment::Apply(EnvironmentContext(w), i, command.ticket, *for_environment);
  } else if (const auto* for_part = std::get_if<part::Command>(&command.body)) {
    ApplyToPart(w, i, command.ticket, *for_part);
    RefreshStreets(w);  // later commands in this cycle see which tracks are joined now
  }
}

namespace {

// Steps a group before the first of its members, and after the module that moves it.
void StepOnce(World& w, std::size_t group) {
  if (std::exchange(w.group_stepped[group], std::uint8_t{1}) != 0) return;
  if (const std::uint32_t module = w.pick_place_of[group]; module != 0) {
    pickplace::Step(ContextOf(w, w.pick_places[module - 1]), w.group_states[group], w.pick_place_states[module - 1]);
  }
  group::Step(ContextOf(w, w.groups[group]), w.group_states[group]);
}

void StepBelts(World& w, std::span<const std::uint32_t> belts) {
  for (const std::uint32_t i : belts) {
    conveyor::Step(ContextOf(w, w.belts[i]), w.belt_states[i]);
    ShowBelt(w, i);
  }
}

// Returns true if the machine has anything that StepMovers steps.
bool HasPlanar(const World& w) {
  return !w.movers.empty() || !w.tracks.states.empty() || !w.planar_groups.states.empty();
}

// Steps all movers: after the axes that they follow, before the axes that follow them.
void StepMovers(World& w) {
  if (!HasPlanar(w)) return;
  mover::FollowRoutes(AllMovers(w));
  RefreshStreets(w);
  ShowAxesToMovers(w);
  ShowMovers(w);  // commands have changed some
  for (std::size_t i = 0; i < w.movers.size(); ++i) mover::Lead(MoverContext(w, i), w.mover_states[i]);
  if (!w.streets.names.empty()) {
    w.streets.traffic.Step(w.cycle, w.planner, w.streets.network, w.streets.riders, &w.grounds.guard);
  }
  // Planets of formations after their stars.
  for (const bool planets : {false, true}) {
    for (std::size_t i = 0; i < w.movers.size(); ++i) {
      if (mover::IsPlanet(w.mover_states[i]) != planets) continue;
      mover::Step(MoverContext(w, i), w.mover_inputs[i], w.mover_states[i]);
    }
  }
  ShowMovers(w);
  UseTracks(w);
  planargroup::Step(PlanarGroupContext(w));
}

}  // namespace

void Move(World& w) noexcept {
  // A master stops if a follower has failed.
  for (const std::uint32_t i : w.axis_order.sequence()) {
    if (i < w.axis_states.size() && w.axis_states[i].plc == axis::PlcState::kErrorStop) StopMasters(w, i);
  }
  StepParts(w);
  track::Step(TrackContext(w));
  std::ranges::fill(w.group_stepped, std::uint8_t{0});
  StepBelts(w, w.measured_belts);
  for (const std::uint32_t i : w.axis_order.sequence()) {
    if (i == w.axis_states.size()) {
      StepMovers(w);
      continue;
    }
    if (w.group_of[i] != 0) StepOnce(w, w.group_of[i] - 1);
    if (const std::uint32_t module = w.module_of[i]; module != 0) {
      flexcam::Step(ContextOf(w, w.flex_cams[module - 1]), w.axis_states[i], w.flex_cam_states[module - 1]);
    }
    axis::Move(ContextOf(w, i), w.axis_states[i]);
    StepBelts(w, w.belts_after[i]);
  }
  for (std::size_t i = 0; i < w.groups.size(); ++i) StepOnce(w, i);  // groups without members
}

void Control(World& w) noexcept {
  const auto publish = [&w](std::size_t i) { axis::Publish(w.axis_params[i], w.axis_states[i], w.axis_outputs[i]); };
  // Each axis publishes while its state is in the cache: a thousand states do not fit into it.
  bool sound = true;
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    sound &= axis::Control(ContextOf(w, i), w.axis_states[i], w.servo_outputs[i]);
    publish(i);
  }
  if (!sound) {
    OpenAllLoops(w);
    for (std::size_t i = 0; i < w.axis_states.size(); ++i) publish(i);
  }
  for (const std::uint32_t i : w.simulated) w.axis_outputs[i].true_position = w.servo_states[i].load_position;
  for (const HeardDrive& drive : w.drives) w.axis_outputs[drive.axis].true_position = w.true_positions[drive.axis];
  for (std::size_t i = 0; i < w.flex_cams.size(); ++i) {
    const FlexCam& module = w.flex_cams[i];
    flexcam::Publish(ContextOf(w, module), w.axis_states[module.slave], w.flex_cam_states[i], w.flex_cam_outputs[i]);
  }
  for (std::size_t i = 0; i < w.groups.size(); ++i) {
    group::Publish(ContextOf(w, w.groups[i]), w.group_states[i], w.group_outputs[i]);
  }
  for (std::size_t i = 0; i < w.belts.size(); ++i) {
    conveyor::Publish(ContextOf(w, w.belts[i]), w.belt_states[i], w.belt_outputs[i]);
  }
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    conveyor::Publish(w.poses[i], w.cycle, w.pose_states[i], w.pose_outputs[i]);
  }
  for (std::size_t i = 0; i < w.pick_places.size(); ++i) {
    const PickPlace& module = w.pick_places[i];
    pickplace::Publish(ContextOf(w, module), w.group_states[module.group], w.pick_place_states[i],
                       w.pick_place_outputs[i]);
  }
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    mover::Publish(MoverContext(w, i), w.mover_inputs[i], w.mover_states[i], w.mover_outputs[i]);
  }
  track::Publish(TrackContext(w));
  planargroup::Publish(PlanarGroupContext(w));
  environment::Publish(EnvironmentContext(w));
  PublishParts(w);
}

void Actuate(World& w) noexcept {
  for (const std::uint32_t i : w.simulated) {
    plant::Step(w.servo_params[i], w.servo_outputs[i], w.cycle.period_s, w.servo_states[i], w.servo_inputs[i]);
  }
  for (std::size_t i = 0; i < w.movers.size(); ++i) w.mover_inputs[i] = mover::Simulate(w.mover_states[i]);
  SimulateParts(w);
}

}  // namespace takt::engine
