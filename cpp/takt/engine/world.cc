#include "takt/engine/world.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "takt/axis/coupling.h"
#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/engine/components.h"
#include "takt/engine/masters.h"
#include "takt/engine/mover_masters.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::engine {

namespace {

// Feedback of one cycle: each live command of an axis may start and end in it, and so may each newly arrived one.
constexpr std::size_t kEventsPerAxis = 4 * (axis::kBufferSize + 5);
constexpr std::size_t kEventsPerCommand = 4;
// A request may be abandoned and the next one made before it has been answered.
constexpr std::size_t kQuestionsPerGroup = 4;
constexpr std::size_t kEventsPerMover = 4 * mover::kSlots;
constexpr std::size_t kEventsPerPart = 6;
constexpr std::size_t kEventsPerGroup = 4 * (group::kQueue + group::kSynced + 5);  // likewise

template <typename... T>
void TouchTypes(const std::variant<T...>*) {
  (TypeOf<T>(), ...);
}

// Requires: an element of this name exists.
template <typename T>
std::uint32_t IndexNamed(const std::vector<T>& list, const std::string& name) {
  return static_cast<std::uint32_t>(std::ranges::find(list, name, &T::name) - list.begin());
}
template <typename T>
std::vector<std::string> CopiedNames(const std::vector<T>& list) {
  std::vector<std::string> names;
  for (const T& one : list) names.push_back(one.name);
  return names;
}
std::uint32_t CamNamed(const Machine& machine, const std::string& name) {
  return IndexNamed(machine.cams, name);
}

}  // namespace

mover::Context MoverContext(World& w, std::size_t i) {
  const mover::Fleet fleet{w.movers, w.mover_states, w.bodies, &w.routes};
  const auto index = static_cast<std::uint32_t>(i);
  return {mover::ParamsIn(fleet, w.cycle, index), w.cycle, w.planner, w.feedback, w.streets, w.grounds, index, fleet};
}

World::World(const Machine& machine)
    : cycle{0, machine.cycle.period_s},
      first_of(FirstNumbers(machine)),
      axis_params(machine.axes),
      cam_switches(machine.cam_switches),
      cams(machine.cams),
      axis_outputs(machine.axes.size()),
      axis_order(machine.axes.size() + 1),
      questions(kQuestionsPerGroup * machine.groups.size()),
      parts(machine.parts),
      part_inputs(machine.parts.size()),
      part_outputs(machine.parts.size()),
      part_faults(machine.parts.size()),
      surface(part::Make(machine.coordinate_systems, machine.parts)),
      routes(machine.movers.size()),
      streets(machine.movers.size(), CopiedNames(machine.tracks), &surface),
      tracks_now(machine.tracks.size()),
      tracks(machine.tracks, &surface),
      grounds(machine.movers.size(), machine.tracks.size(), machine.environments.size(),
              CopiedNames(machine.planar_groups)),
      planar_groups(machine.planar_groups.size()),
      environments(machine.environments),
      servo_inputs(machine.axes.size()),
      servo_outputs(machine.axes.size()),
      samplings(machine.axes.size()),
      feedback_storage(machine.axes.size() * kEventsPerAxis + machine.groups.size() * kEventsPerGroup +
                       machine.movers.size() * kEventsPerMover + machine.parts.size() * kEventsPerPart +
                       track::EventsOf(machine.tracks.size()) + planargroup::EventsOf(machine.planar_groups.size()) +
                       machine.environments.size() + cam::kDrafts +
                       (kCommandsPerCycle + kRenewalsPerCycle) * kEventsPerCommand),
      feedback(feedback_storage) {
  TypeOf<axis::State>();  // the first use of a type allocates
  TypeOf<plant::ServoState>();
  TypeOf<HeardDrive>();
  TypeOf<ServoInputs>();
  TypeOf<track::State>();
  TypeOf<track::PendingEdits>();
  TypeOf<track::Sketch>();
  TypeOf<cam::StoreState>();
  TypeOf<mover::SurfaceRoute>();
  TypeOf<mover::Visit>();
  TouchTypes(static_cast<const track::Command*>(nullptr));
  TouchTypes(static_cast<const MachineCommand*>(nullptr));
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    axis_states.push_back(axis::MakeState(axis_params[i]));
    axis_states.back().drive_homes = DriveHomes(machine, i);
    servo_params.push_back(ServoOf(machine, i));
    true_positions.push_back(std::numeric_limits<double>::quiet_NaN());
    servo_states.push_back(plant::MakeServoState(servo_params[i]));
    const auto index = static_cast<std::uint32_t>(i);
    if (const ExternalDrive* external = ExternalOf(machine, i)) {
      drives.push_back({.axis = index, .missing_cycles = external->missing_cycles});
    } else {
      simulated.push_back(index);
      plant::Step(servo_params[i], servo_outputs[i], cycle.period_s, servo_states[i], servo_inputs[i]);
    }
  }
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    axis_masters.push_back(engine::MasterOf(machine, i));
    const std::uint32_t wire = axis::FindAxis(machine.axes, machine.axes[i].inputs.touch_probe_of);
    probe_wires.push_back(wire == axis::kNoAxis ? static_cast<std::uint32_t>(i) : wire);
    if (axis_masters.back()) axis_states[*axis_masters.back()].leads = true;
  }
  MakeModules(machine);
  MakeGroups(machine);
  MakeBelts(machine);
  MakePickPlaces(machine);
  MakeParts(machine);
  MakeMovers(machine);
  MakePlanarGroups(machine);
  NameMasters(*this);
  surrounding = {axis_states, axis_params, cam_switches, cams.tables, mover_masters};
  for (FlexCam& module : flex_cams) {
    if (module.params.master) module.master = axis::FindMaster(surrounding, *module.params.master);
  }
  MakeOrder(*this);
}

void World::MakeModules(const Machine& machine) {
  TypeOf<flexcam::State>();
  TypeOf<flexcam::Settings>();
  TypeOf<flexcam::Configure>();
  TypeOf<flexcam::Inputs>();
  TypeOf<flexcam::Control>();
  TypeOf<flexcam::Jog>();
  TypeOf<flexcam::SetCam>();
  TypeOf<flexcam::ChangeCam>();
  TypeOf<flexcam::WithdrawChanges>();
  module_of.assign(machine.axes.size(), 0);
  for (const flexcam::FlexCamParams& params : machine.flex_cams) {
    FlexCam module{params, axis::FindAxis(machine.axes, params.slave), {}, {}};
    module.homing = machine.axes[module.slave].homing;
    std::array<std::uint32_t, flexcam::kSlots> slots{};
    for (std::size_t i = 0; i < params.cams.size(); ++i) slots[i] = CamNamed(machine, params.cams[i]) + 1;
    flex_cams.push_back(module);
    flex_cam_states.push_back(flexcam::MakeState(params, slots));
    module_of[module.slave] = static_cast<std::uint32_t>(flex_cams.size());
  }
  flex_cam_outputs.resize(flex_cams.size());
}

void World::MakeGroups(const Machine& machine) {
  TypeOf<group::State>();
  TypeOf<group::GroupParams>();
  TouchTypes(static_cast<const group::Command*>(nullptr));
  group_of.assign(machine.axes.size(), 0);
  for (const group::PathParams& path : machine.paths) paths.push_back(group::MakePathTable(path).table.value());
  for (const group::ZoneParams& zone : machine.zones) zones.push_back(group::MakeZone(zone, machine.groups));
  for (const group::GroupParams& params : machine.groups) {
    AxesGroup& group = groups.emplace_back();
    group.params = params;
    group.mounting = group::MakeMounting(params);
    if (params.kinematics) group.kinematics = kinematics::Make(*params.kinematics).kinematics;
    for (const std::string& axis : params.axes) group.axes.push_back(axis::FindAxis(machine.axes, axis));
    for (const std::uint32_t axis : group.axes) group_of[axis] = static_cast<std::uint32_t>(groups.size());
    group_states.push_back(group::MakeState(group.axes));
    look_aheads.emplace_back(trajectory::CoordinateLimits{}, cycle.period_s);
  }
  group_outputs.resize(groups.size());
  group_stepped.resize(groups.size());
}

void World::MakeBelts(const Machine& machine) {
  TypeOf<conveyor::State>();
  TouchTypes(static_cast<const conveyor::Command*>(nullptr));
  belts_after.resize(machine.axes.size());
  for (const conveyor::BeltParams& params : machine.belts) {
    const auto index = static_cast<std::uint32_t>(belts.size());
    const Belt& belt = belts.emplace_back(params, axis::FindAxis(machine.axes, params.axis));
    (IsMeasured(params) ? measured_belts : belts_after[belt.axis]).push_back(index);
  }
  TypeOf<conveyor::PoseState>();
  TouchTypes(static_cast<const conveyor::PoseCommand*>(nullptr));
  poses = machine.poses;
  pose_states.resize(poses.size());
  pose_outputs.resize(poses.size());
  belt_states.resize(belts.size());
  belt_outputs.resize(belts.size());
  for (std::uint32_t i = 0; i < groups.size(); ++i) riders.push_back({this, i});
}

void World::MakePickPlaces(const Machine& machine) {
  TypeOf<pickplace::State>();
  TypeOf<pickplace::Settings>();
  TypeOf<pickplace::BeltSettings>();
  TypeOf<pickplace::Inputs>();
  TouchTypes(static_cast<const pickplace::Command*>(nullptr));
  pick_place_of.assign(groups.size(), 0);
  for (const pickplace::PickPlaceParams& params : machine.pick_and_place) {
    PickPlace& module = pick_places.emplace_back();
    module.params = params;
    module.group = IndexNamed(machine.groups, params.group);
    for (const pickplace::PickPlaceBelt& belt : params.belts) {
      module.belts.push_back(IndexNamed(machine.belts, belt.belt));
    }
    pick_place_states.push_back(pickplace::MakeState(params));
    pick_place_of[module.group] = static_cast<std::uint32_t>(pick_places.size());
  }
  pick_place_outputs.resize(pick_places.size());
}

void World::MakeParts(const Machine& machine) {
  TypeOf<part::State>();
  TypeOf<part::Inputs>();
  TouchTypes(static_cast<const part::Command*>(nullptr));
  for (const part::PartParams& params : machine.parts) {
    part_states.push_back(part::MakeState(params));
    part_inputs[part_states.size() - 1].position = part_states.back().commanded + 1;
  }
}

void World::MakeMovers(const Machine& machine) {
  TypeOf<mover::State>();
  TypeOf<mover::Inputs>();
  TypeOf<planar::Rider>();
  TouchTypes(static_cast<const mover::Command*>(nullptr));
  movers = machine.movers;
  for (const mover::MoverParams& params : movers) {
    mover_states.push_back(mover::MakeState(params));
    bodies.emplace_back(params, movers.size());
    planar::Spot at;
    mover::FindSpot(params, surface, params.reference, {{params.initial.x, params.initial.y}, params.initial.c}, at);
    mover::PutAt(at, mover_states.back());
    mover_states.back().part = planar::PartAt(surface, at.system, at.origin, planar::kNoPart);
    mover_inputs.push_back(mover::Simulate(mover_states.back()));
  }
  mover_outputs.resize(movers.size());
}

void World::MakePlanarGroups(const Machine& machine) {
  TypeOf<planar::GroupReservations>();
  TypeOf<planargroup::State>();
  TypeOf<environment::State>();
  TypeOf<planar::Place>();
  TouchTypes(static_cast<const planargroup::Command*>(nullptr));
  TouchTypes(static_cast<const environment::Command*>(nullptr));
  for (std::uint32_t i = 0; i < machine.planar_groups.size(); ++i) {
    const planargroup::PlanarGroupParams& params = machine.planar_groups[i];
    for (const std::string& name : params.movers) grounds.group_of_mover[IndexNamed(machine.movers, name)] = i + 1;
    for (const std::string& name : params.tracks) grounds.group_of_track[IndexNamed(machine.tracks, name)] = i + 1;
    grounds.grounds[i].waits = params.moves_wait;
    if (params.environment) {
      grounds.group_of_environment[IndexNamed(machine.environments, *params.environment)] = i + 1;
    }
  }
  grounds.surfaces = environments.surfaces;
  grounds.on_parts = !surface.none();
  for (std::size_t i = 0; i < movers.size(); ++i) mover::Arrive(MoverContext(*this, i), mover_states[i]);
}

std::uint64_t World::StateHash() const noexcept {
  std::uint64_t hash = cycle.count;
  for (const axis::State& state : axis_states) hash = HashOf(state, hash);
  for (const axis::AxisParams& params : axis_params) hash = HashOf(params, hash);  // settings change them
  for (const flexcam::State& state : flex_cam_states) hash = HashOf(state, hash);
  for (const group::State& state : group_states) hash = HashOf(state, hash);
  for (const conveyor::State& state : belt_states) hash = HashOf(state, hash);
  for (const conveyor::PoseState& state : pose_states) hash = HashOf(state, hash);
  for (const pickplace::State& state : pick_place_states) hash = HashOf(state, hash);
  for (const part::State& state : part_states) hash = HashOf(state, hash);
  for (const part::Inputs& inputs : part_inputs) hash = HashOf(inputs, hash);
  for (const mover::State& state : mover_states) hash = HashOf(state, hash);
  for (const mover::Inputs& inputs : mover_inputs) hash = HashOf(inputs, hash);
  hash = mover::HashOf(routes, hash);
  if (!streets.names.empty()) {
    for (const planar::Rider& rider : streets.riders) hash = HashOf(rider, hash);
  }
  for (const track::State& state : tracks.states) hash = HashOf(state, hash);
  if (!tracks.states.empty()) hash = HashOf(tracks.works, hash);
  for (const planargroup::State& state : planar_groups.states) hash = HashOf(state, hash);
  for (const environment::State& state : environments.states) hash = HashOf(state, hash);
  if (!environments.states.empty()) hash = HashOf(environments.questions, hash);
  for (const planar::GroupReservations& ground : grounds.grounds) hash = HashOf(ground, hash);
  if (!grounds.grounds.empty()) {
    for (const auto* groups : {&grounds.group_of_mover, &grounds.group_of_track, &grounds.group_of_environment}) {
      for (const std::uint32_t group : *groups) hash = HashOf(group, hash);
    }
  }
  if (cams.state.drafts_begun != 0) hash = HashOf(cams.state, hash);
  for (const plant::ServoState& state : servo_states) hash = HashOf(state, hash);
  for (const HeardDrive& drive : drives) hash = HashOf(servo_inputs[drive.axis], HashOf(drive, hash));
  return hash;
}

}  // namespace takt::engine
