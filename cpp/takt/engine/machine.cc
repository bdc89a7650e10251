#include "takt/engine/machine.h"

#include "takt/core/describe.h"
#include "takt/core/problem.h"

namespace takt::engine {

namespace {

// Returns an encoder that sends what the axis expects.
plant::ServoEncoder MatchingEncoder(const axis::Encoder& expected) {
  plant::ServoEncoder encoder;
  const bool incremental = expected.type == axis::EncoderType::kIncremental;
  encoder.type = incremental ? plant::ServoEncoderType::kIncremental : plant::ServoEncoderType::kAbsolute;
  encoder.increments_per_unit = expected.increments_per_unit;
  encoder.inverted = expected.invert;
  encoder.ssi_bits = expected.ssi_bits;
  encoder.coding =
      expected.coding == axis::SsiCoding::kGray ? plant::ServoEncoderCoding::kGray : plant::ServoEncoderCoding::kBinary;
  if (expected.coded_marks) {
    encoder.index_distance = expected.coded_marks->distance;
    encoder.index_step = expected.coded_marks->step;
    encoder.index_offset = expected.coded_marks->position;
    encoder.index_reversed = expected.coded_marks->reversed;
  }
  return encoder;
}

// Returns mechanics with torque for twice the axis' largest acceleration; otherwise the defaults.
plant::ServoMechanics MatchingMechanics(const axis::AxisParams& axis, const plant::ServoDrive& drive) {
  plant::ServoMechanics mechanics;
  mechanics.inertia = drive.max_torque / (2 * axis.limits.acceleration);
  return mechanics;
}

}  // namespace

plant::ServoParams ServoOf(const Machine& machine, std::size_t index) {
  const axis::AxisParams& axis = machine.axes[index];
  plant::ServoParams servo;
  servo.drive.velocity_at_10v = axis.loop.velocity_at_10v;
  servo.drive.inverted = axis.drive.invert;
  servo.mechanics = MatchingMechanics(axis, servo.drive);
  servo.encoder = MatchingEncoder(axis.encoder);
  if (axis.load_encoder) servo.load_encoder = MatchingEncoder(*axis.load_encoder);
  for (const SimulatedServo& given : machine.simulation.servos) {
    if (given.axis != axis.name) continue;
    servo.drive = given.drive;
    servo.mechanics = given.mechanics;
    servo.switches = given.switches;
    if (given.encoder) servo.encoder = *given.encoder;
    if (given.load_encoder) servo.load_encoder = given.load_encoder;
  }
  return servo;
}

const ExternalDrive* ExternalOf(const Machine& machine, std::size_t axis) {
  for (const ExternalDrive& drive : machine.external.drives) {
    if (drive.axis == machine.axes[axis].name) return &drive;
  }
  return nullptr;
}

bool DriveHomes(const Machine& machine, std::size_t axis) {
  for (const Bus& bus : machine.external.buses) {
    for (const BusDrive& drive : bus.drives) {
      if (drive.axis == machine.axes[axis].name) return drive.homing.has_value();
    }
  }
  return false;
}

std::string WhyNoMember(const Machine& machine, std::string_view axis) {
  for (const axis::AxisParams& params : machine.axes) {
    if (params.name == axis && params.follows) {
      return "expected an axis that does not follow another, found " + Quoted(axis);
    }
  }
  for (const flexcam::FlexCamParams& module : machine.flex_cams) {
    if (module.slave == axis) return "expected an axis that no cam module moves, found " + Quoted(axis);
  }
  return {};
}

void describe(Description<CycleParams>& d) {
  d.about("The engine's cycle.");
  d.defaulted<&CycleParams::period_s>(unit::s, between(0.00025, 0.02), "How long a cycle lasts.");
  d.defaulted<&CycleParams::overruns_in_a_row>(
      "So many late cycles in a row, or so many periods without a cycle, stop every axis; 0: never.");
}

void describe(Description<ChannelRate>& d) {
  d.about("How often one axis or other component is published.");
  d.required<&ChannelRate::axis>("Name of the axis or other component.");
  d.required<&ChannelRate::rate_hz>(unit::hz, between(0, 4000), "How often; 0: never.");
}

void describe(Description<LcmParams>& d) {
  using L = LcmParams;
  d.about("What goes out and comes in over LCM.");
  d.defaulted<&L::url>(
      "LCM's provider. Unset: that of the environment (LCM_DEFAULT_URL), else udpm://239.255.76.67:7667?ttl=0, whose "
      "messages stay on this host (ttl 0).");
  d.defaulted<&L::axis_rate_hz>(
      unit::hz, between(0, 4000),
      "How often each axis and each other component is published, at most once a cycle; 0: never.");
  d.defaulted<&L::rates>("Axes and other components with a rate of their own.");
  d.defaulted<&L::engine_rate_hz>(unit::hz, between(0.1, 1000), "How often the engine's own figures are published.");
  d.defaulted<&L::dead_man_s>(unit::s, between(0.02, 60),
                              "Without a heartbeat for so long, a client's level-sensitive commands are released.");
  d.defaulted<&L::command_age_s>(
      unit::s, between(0.05, 60),
      "A command that the cycle did not take within this time after it was given is refused, "
      "unless it stops, releases or switches off.");
}

void describe(Description<SimulatedServo>& d) {
  using S = SimulatedServo;
  d.about("The simulated servo behind an axis.");
  d.required<&S::axis>("Name of the axis.");
  d.defaulted<&S::drive>("The drive.");
  d.defaulted<&S::mechanics>("Motor and load.");
  d.defaulted<&S::switches>("Where the switches are.");
  d.defaulted<&S::encoder>("The encoder; unset: the one the axis expects.");
  d.defaulted<&S::load_encoder>("The encoder on the load; unset: the one the axis expects, if any.");
}

void describe(Description<Simulation>& d) {
  d.about("What stands in for the metal. Axes without a servo here get an ideal one that fits their parameters.");
  d.defaulted<&Simulation::servos>("Servos.");
}

void describe(Description<ExternalDrive>& d) {
  using E = ExternalDrive;
  d.about("A drive with its encoder and switches that lives in another process and is reached over LCM.");
  d.required<&E::axis>("Name of the axis.");
  d.defaulted<&E::missing_cycles>(unit::cycles, between(1, 100000),
                                  "So many answers of the drive missing in a row are a drive error (ErrorStop 3002).");
}

void describe(Description<External>& d) {
  using E = External;
  d.about("What lives in other processes.");
  d.defaulted<&E::drives>(
      "Drives. Their axes are simulated no more; takt plant puts the simulation in another process.");
  d.defaulted<&E::buses>("Field buses whose drives move axes; takt drives run is the process for them.");
  d.defaulted<&E::answer_within_s>(unit::s, between(0.001, 3600),
                                   "Simulated time waits so long for the answers to one cycle, by the wall clock; then "
                                   "the cycle goes on without them.");
}

void describe(Description<ViewParams>& d) {
  d.about("The live page, takt view.");
  d.defaulted<&ViewParams::commands>(
      "From the page one may switch on, jog, halt, reset and stop everything; else it only shows what is.");
}

void describe(Description<Machine>& d) {
  using M = Machine;
  d.about("A machine: everything an engine is made from.");
  d.required<&M::name>("Of the machine.");
  d.defaulted<&M::cycle>("The cycle.");
  d.defaulted<&M::lcm>("Messages.");
  d.required<&M::axes>("The axes.");
  d.defaulted<&M::cams>("Cams, for any axis.");
  d.defaulted<&M::cam_switches>("Lists of cam switches.");
  d.defaulted<&M::flex_cams>("Cam modules.");
  d.defaulted<&M::groups>("Groups of axes.");
  d.defaulted<&M::paths>("Paths, for any group.");
  d.defaulted<&M::zones>("Boxes that groups share: one is inside at a time.");
  d.defaulted<&M::belts>("Belts, and tables that turn.");
  d.defaulted<&M::poses>("Poses that come from elsewhere.");
  d.defaulted<&M::pick_and_place>("Pick and place modules.");
  d.defaulted<&M::coordinate_systems>("Planes in which parts of the surface lie.");
  d.defaulted<&M::parts>("Parts of the surface that movers float on; without any it goes on for ever.");
  d.defaulted<&M::movers>("Planar movers.");
  d.defaulted<&M::tracks>("Tracks for movers in the plane.");
  d.defaulted<&M::planar_groups>("Groups of movers that do not collide.");
  d.defaulted<&M::environments>("Surfaces that movers float on.");
  d.defaulted<&M::simulation>("What stands in for the metal.");
  d.defaulted<&M::external>("What lives in other processes.");
  d.defaulted<&M::twin>("A twin in a physics engine.");
  d.defaulted<&M::view>("The live page.");
}

}  // namespace takt::engine
