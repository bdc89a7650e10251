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

// Maximum number of commands applied in one cycle; the others wait in the queue. Each may plan a motion, which takes
// some µs.
inline constexpr std::size_t kCommandsPerCycle = 16;
// The same for renewals, which plan nothing and have a queue of their own.
inline constexpr std::size_t kRenewalsPerCycle = 64;

// A cam module: its parameters, with names resolved.
struct FlexCam {
  flexcam::FlexCamParams params;
  std::uint32_t slave = 0;
  std::optional<std::uint32_t> master{};
  axis::HomingParams homing;  // of the slave, from the machine file
};

// A group of axes: its parameters and what is made from them.
struct AxesGroup {
  group::GroupParams params;
  group::Mounting mounting;
  std::optional<kinematics::Kinematics> kinematics{};
  std::vector<std::uint32_t> axes;  // initial members
};

// A belt: its parameters, with names resolved.
struct Belt {
  conveyor::BeltParams params;
  std::uint32_t axis = 0;
};

struct World;

// A group in search of carriers: it does not carry itself.
struct Rider {
  World* world;
  std::uint32_t group;
};

// A pick and place module: its parameters, with names resolved.
struct PickPlace {
  pickplace::PickPlaceParams params;
  std::uint32_t group = 0;
  std::vector<std::uint32_t> belts;
};

// Faults to inject into the simulation of a part; for tests.
struct PartFaults {
  bool fault = false;  // it reports an error
  bool stuck = false;  // it never reaches its commanded position
  bool lost = false;   // its position is unknown
};

// Everything the cycle works on, in arrays by component; index i is axis i of the machine.
struct World {
  explicit World(const Machine& machine);
  World(const World&) = delete;  // `feedback` and `surrounding` point into the storage
  World& operator=(const World&) = delete;

  Cycle cycle;
  trajectory::Planner planner;
  EmergencyHolders emergency;

  std::vector<std::uint32_t> first_of;  // number of the first component of each kind (components.h)

  std::vector<axis::AxisParams> axis_params;
  std::vector<axis::CamSwitches> cam_switches;
  cam::Store cams;
  std::vector<axis::State> axis_states;
  std::vector<axis::Outputs> axis_outputs;
  axis::MachineView surrounding;  // all axes, as each of them sees the others
  // masters before followers; the movers are one node after all axes
  Order axis_order;
  std::vector<std::uint32_t> probe_wires;                  // the axis whose touch probe input each axis uses
  std::vector<std::optional<std::uint32_t>> axis_masters;  // the axis that each axis follows, if any

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
  // plans of groups are made outside the cycle: PathPlanned says that they are ready
  bool plans_elsewhere = false;
  group::PathCheckRequests questions;       // of all groups
  std::vector<std::uint32_t> group_of;      // the group that each axis is a member of, from 1; 0: none
  std::vector<std::uint8_t> group_stepped;  // already stepped in this cycle

  std::vector<Belt> belts;
  std::vector<conveyor::State> belt_states;
  std::vector<conveyor::Outputs> belt_outputs;
  std::vector<std::uint32_t> measured_belts;  // belts by measured position, which step before all axes ...
  // ... and belts by set position, which step after the axis of this index
  std::vector<std::vector<std::uint32_t>> belts_after;
  std::vector<Rider> riders;  // the groups

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
  planar::Parts surface;  // the parts as movers and tracks see them

  std::vector<mover::MoverParams> movers;
  std::vector<mover::Inputs> mover_inputs;
  std::vector<mover::State> mover_states;
  std::vector<mover::Body> bodies;  // by star of a formation
  mover::SurfaceRoutes routes;      // over the free surface
  std::vector<mover::Outputs> mover_outputs;
  mover::TrackNetworkState streets;
  std::vector<mover::TrackView> tracks_now;        // in this cycle
  std::uint64_t streets_changes = 0;               // value of Tracks::changes for which `streets.declared` is valid
  std::vector<axis::OutsideMaster> mover_masters;  // coordinates of movers and travel of belts, as masters for axes

  track::Tracks tracks;

  planar::GroupRegistry grounds;  // for movers, tracks, groups of movers and environments
  planargroup::Groups planar_groups;
  environment::Environments environments;

  std::vector<ServoInputs> servo_inputs;
  std::vector<ServoOutputs> servo_outputs;
  std::vector<plant::ServoParams> servo_params;
  std::vector<plant::ServoState> servo_states;
  std::vector<std::uint32_t> simulated;  // axes with a simulated servo ...
  std::vector<HeardDrive> drives;        // ... and the links of the external drives of the others
  std::vector<double> true_positions;    // [u] of axes whose plant reports it; else NaN
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
