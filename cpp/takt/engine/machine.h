// The machine file: everything an engine is made from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/axis/cam_switch.h"
#include "takt/axis/params.h"
#include "takt/cam/params.h"
#include "takt/conveyor/params.h"
#include "takt/conveyor/pose.h"
#include "takt/core/describe_fwd.h"
#include "takt/engine/bus.h"
#include "takt/environment/params.h"
#include "takt/flexcam/params.h"
#include "takt/group/params.h"
#include "takt/mover/params.h"
#include "takt/part/params.h"
#include "takt/pickplace/params.h"
#include "takt/planargroup/params.h"
#include "takt/plant/servo.h"
#include "takt/plant/twin.h"
#include "takt/track/params.h"

namespace takt::engine {

struct CycleParams {
  double period_s = 0.001;  // [s] 250 µs to 20 ms
  // Late periods, without a cycle in time between them, after which everything stops; 0: never. As long as the watchdog
  // of an external drive (takt/drive.py).
  std::uint32_t overruns_in_a_row = 100;
};

struct ChannelRate {
  std::string axis;  // name of the axis or other component
  double rate_hz = 100;
};

struct LcmParams {
  std::optional<std::string> url{};  // unset: from the environment, else one that stays on this host (EN-25)
  double axis_rate_hz = 100;         // [Hz] of each component's state channel; at most once a cycle
  std::vector<ChannelRate> rates{};  // components with a rate of their own
  double engine_rate_hz = 10;        // [Hz] of the engine's own channel
  double dead_man_s = 0.25;          // [s] without a heartbeat after which a level-sensitive command is released
  double command_age_s = 1;          // [s] after which a command that no cycle has taken is refused
};

// The simulated servo of an axis. Axes without one get an ideal servo that fits their own parameters.
struct SimulatedServo {
  std::string axis;  // name of the axis
  plant::ServoDrive drive;
  plant::ServoMechanics mechanics;
  plant::ServoSwitches switches;
  std::optional<plant::ServoEncoder> encoder;       // unset: the one the axis expects
  std::optional<plant::ServoEncoder> load_encoder;  // likewise, if any
};

struct Simulation {
  std::vector<SimulatedServo> servos;
};

// A drive, with its encoder and switches, in another process instead of a simulated one.
struct ExternalDrive {
  std::string axis;                  // name of the axis
  std::uint32_t missing_cycles = 5;  // consecutive missing answers that are a drive error
};

struct External {
  std::vector<ExternalDrive> drives;
  std::vector<Bus> buses;
  double answer_within_s = 2;  // [s] of wall-clock time that simulated time waits for the answers to one cycle
};

// The live page (`takt view`). The engine itself accepts commands from any client.
struct ViewParams {
  bool commands = false;
};

struct Machine {
  std::string name;
  CycleParams cycle;
  LcmParams lcm;
  std::vector<axis::AxisParams> axes;
  std::vector<cam::CamParams> cams;
  std::vector<axis::CamSwitches> cam_switches;
  std::vector<flexcam::FlexCamParams> flex_cams;
  std::vector<group::GroupParams> groups;
  std::vector<group::PathParams> paths;
  std::vector<group::ZoneParams> zones;
  std::vector<conveyor::BeltParams> belts;
  std::vector<conveyor::PoseParams> poses;
  std::vector<pickplace::PickPlaceParams> pick_and_place;
  std::vector<part::CoordinateSystemParams> coordinate_systems;
  std::vector<part::PartParams> parts;
  std::vector<mover::MoverParams> movers;
  std::vector<track::TrackParams> tracks;
  std::vector<planargroup::PlanarGroupParams> planar_groups;
  std::vector<environment::EnvironmentParams> environments;
  Simulation simulation;
  External external;
  std::optional<plant::TwinParams> twin{};  // unset: no twin
  ViewParams view;
};

// Returns the external drive of this axis; null if its drive is simulated.
const ExternalDrive* ExternalOf(const Machine& machine, std::size_t axis);
// Returns true if the drive of the axis homes before it is ready for the first time.
bool DriveHomes(const Machine& machine, std::size_t axis);
// Returns why the axis of this name cannot be a member of a group (what was expected, what was found); empty if it can.
std::string WhyNoMember(const Machine& machine, std::string_view axis);

// Returns the parameters of the simulated servo of an axis in this machine.
plant::ServoParams ServoOf(const Machine& machine, std::size_t axis);

void describe(Description<CycleParams>&);
void describe(Description<LcmParams>&);
void describe(Description<ChannelRate>&);
void describe(Description<SimulatedServo>&);
void describe(Description<Simulation>&);
void describe(Description<ExternalDrive>&);
void describe(Description<External>&);
void describe(Description<ViewParams>&);
void describe(Description<Machine>&);

}  // namespace takt::engine
