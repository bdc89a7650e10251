// Everything that a cycle works on, and how it is made from a machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/axis/outputs.h"
#include "takt/axis/params.h"
#include "takt/axis/state.h"
#include "takt/cam/store.h"
#include "takt/conveyor/belt.h"
#include "takt/conveyor/pose.h"
#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/core/ports.h"
#include "takt/engine/drives.h"
#include "takt/engine/emergency.h"
#include "takt/engine/machine.h"
#include "takt/engine/order.h"
#include "takt/environment/environments.h"
#include "takt/flexcam/module.h"
#include "takt/group/group.h"
#include "takt/mover/mover.h"
#include "takt/mover/routes.h"
#include "takt/part/part.h"
#include "takt/pickplace/module.h"
#include "takt/planargroup/groups.h"
#include "takt/plant/servo.h"
#include "takt/track/tracks.h"
#include "takt/trajectory/planner.h"

namespace takt::engine {

// So many commands are applied in one cycle at most; the others wait in the queue. Each may plan a motion, which takes
// some µs.
inline constexpr std::size_t kCommandsPerCycle = 16;
// The same for renewals, which plan nothing and wait in a queue of their own.
inline constexpr std::size_t kRenewalsPerCycle = 64;

// What a cam module is made from, with its names looked up.
struct FlexCam {
  flexcam::FlexCamParams params;
  std::uint32_t slave = 0;
  std::optional<std::uint32_t> master{};
  axis::HomingParams homing;  // of the slave, as the machine file has it
};

// What a group of axes is made from.
struct AxesGroup {
  group::GroupParams params;
  group::Mounting mounting;
  std::optional<kinematics::Kinematics> kinematics{};
  std::vector<std::uint32_t> axes;  // members at the start
};

// What a belt is made from.
struct Belt {
  conveyor::BeltParams params;
  std::uint32_t axis = 0;
};

struct World;

// A group as one who looks for what carries: it does not carry itself.
struct Rider {
  World* world;
  std::uint32_t group;
};

// What a pick and place module is made from, with its names looked up.
struct PickPlace {
  pickplace::PickPlaceParams params;
  std::uint32_t group = 0;
  std::vector<std::uint32_t> belts;
};

// What is broken in the simulation of a part; for tests.
struct PartFaults {
  bool fault = false;  // it reports one
  bool stuck = false;  // it never gets where it is to be
  bool lost = false;   // it is nowhere
};

// Everything the cycle works on, in arrays by component; index i is axis i of the machine.
struct World {
  explicit World(const Machine& machine);
  World(const World&) = delete;  // the sink and what surrounds an axis point into the storage
  World& operator=(const World&) = delete;

  Cycle cycle;
  trajectory::Planner planner;
  EmergencyHolders emergency;

  std::vector<std::uint32_t> first_of;  // of each kind the number of its first component (components.h)

  std::vector<axis::AxisParams> axis_params;
  std::vector<axis::CamSwitches> cam_switches;
  cam::Store cams;
  std::vector<axis::State> axis_states;
  std::vector<axis::Outputs> axis_outputs;
  axis::MachineView surrounding;                           // all axes, as each of them sees it
  Order axis_order;                                        // masters before followers; behind all axes: the movers
  std::vector<std::uint32_t> probe_wires;                  // the axis whose touch probe each has
  std::vector<std::optional<std::uint32_t>> axis_masters;  // which axis each follows, if any

  std::vector<FlexCam> flex_cams;
  std::vector<flexcam::State> flex_cam_states;
  std::vector<flexcam::Outputs> flex_cam_outputs;
  std::vector<std::uint32_t> module_of;  // the cam module that moves each axis, from 1; 0: none

  std::vector<AxesGroup> groups;
  std::vector<group::State> group_states;
  std::vector<group::Outputs> group_outputs;
  std::vector<group::LookAhead> look_aheads;
  std::vector<group::PathTable> paths;
  std::vector<group::Zone> zones;
  bool plans_elsewhere = false;             // of groups: PathPlanned tells that they are there
  group::PathCheckRequests questions;       // of all groups
  std::vector<std::uint32_t> group_of;      // the group that each axis is a member of, from 1; 0: none
  std::vector<std::uint8_t> group_stepped;  // in this cycle

  std::vector<Belt> belts;
  std::vector<conveyor::State> belt_states;
  std::vector<conveyor::Outputs> belt_outputs;
  std::vector<std::uint32_t> measured_belts;            // step before all axes ...
  std::vector<std::vector<std::uint32_t>> belts_after;  // ... and those of set positions behind each axis
  std::vector<Rider> riders;                            // the groups

  std::vector<conveyor::PoseParams> poses;
  std::vector<conveyor::PoseState> pose_states;
  std::vector<conveyor::PoseOutputs> pose_outputs;

  std::vector<PickPlace> pick_places;
  std::vector<pickplace::State> pick_place_states;
  std::vector<pickplace::Outputs> pick_place_outputs;
  std::vector<std::uint32_t> pick_place_of;  // the module that moves each group, from 1; 0: none

  std::vector<part::PartParams> parts;
  std::vector<part::State> part_states;
  std::vector<part::Inputs> part_inputs;
  std::vector<part::Outputs> part_outputs;
  std::vector<PartFaults> part_faults;
  planar::Parts surface;  // as movers and tracks see the parts

  std::vector<mover::MoverParams> movers;
  std::vector<mover::Inputs> mover_inputs;
  std::vector<mover::State> mover_states;
  std::vector<mover::Body> bodies;  // by star of a formation
  mover::SurfaceRoutes routes;      // over the free surface
  std::vector<mover::Outputs> mover_outputs;
  mover::TrackNetworkState streets;
  std::vector<mover::TrackView> tracks_now;        // of this cycle
  std::uint64_t streets_changes = 0;               // Tracks::changes as of which the links between them are known
  std::vector<axis::OutsideMaster> mover_masters;  // the coordinates of movers, as axes follow them

  track::Tracks tracks;

  planar::GroupRegistry grounds;  // of movers, tracks, groups of movers and environments
  planargroup::Groups planar_groups;
  environment::Environments environments;

  std::vector<ServoInputs> servo_inputs;
  std::vector<ServoOutputs> servo_outputs;
  std::vector<plant::ServoParams> servo_params;
  std::vector<plant::ServoState> servo_states;
  std::vector<std::uint32_t> simulated;  // axes whose drive is a servo here ...
  std::vector<HeardDrive> drives;        // ... and those of the others
  std::vector<double> true_positions;    // u, of axes whose plant says them; else NaN
  std::vector<Sampling> samplings;

  std::vector<FeedbackEvent> feedback_storage;
  FeedbackSink feedback;

  std::uint64_t StateHash() const noexcept;

 private:
  void MakeModules(const Machine& machine);
  void MakeGroups(const Machine& machine);
  void MakeBelts(const Machine& machine);
  void MakePickPlaces(const Machine& machine);
  void MakeParts(const Machine& machine);
  void MakeMovers(const Machine& machine);
  void MakePlanarGroups(const Machine& machine);
};

mover::Context MoverContext(World& world, std::size_t mover);

}  // namespace takt::engine
