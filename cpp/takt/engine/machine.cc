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
  d.about("The cycle of the engine.");
  d.defaulted<&CycleParams::period_s>(unit::s, between(0.00025, 0.02), "Period of the cycle.");
  d.defaulted<&CycleParams::overruns_in_a_row>(
      "Number of late cycles in a row, or of periods without a cycle, that stops every axis; 0: never.");
}

void describe(Description<ChannelRate>& d) {
  d.about("Rate at which one axis or other component is published.");
  d.required<&ChannelRate::axis>("Name of the axis or other component.");
  d.required<&ChannelRate::rate_hz>(unit::hz, between(0, 4000), "Publications per second; 0: never.");
}

void describe(Description<LcmParams>& d) {
  using L = LcmParams;
  d.about("Communication over LCM.");
  d.defaulted<&L::url>(
      "Provider of LCM. Unset: from the environment (LCM_DEFAULT_URL), else udpm://239.255.76.67:7667?ttl=0, whose "
      "messages stay on this host (ttl 0).");
  d.defaulted<&L::axis_rate_hz>(
      unit::hz, between(0, 4000),
      "Rate at which each axis and each other component is published, at most once a cycle; 0: never.");
  d.defaulted<&L::rates>("Axes and other components with a rate of their own.");
  d.defaulted<&L::engine_rate_hz>(unit::hz, between(0.1, 1000),
                                  "Rate at which the engine's own figures are published.");
  d.defaulted<&L::dead_man_s>(
      unit::s, between(0.02, 60),
      "Longest time without a heartbeat of a client; then its level-sensitive commands are released.");
  d.defaulted<&L::command_age_s>(unit::s, between(0.05, 60),
                                 "Longest time after a command was given until the cycle takes it; later it is "
                                 "refused, unless it stops, releases or switches off.");
}

void describe(Description<SimulatedServo>& d) {
  using S = SimulatedServo;
  d.about("The simulated servo behind an axis.");
  d.required<&S::axis>("Name of the axis.");
  d.defaulted<&S::drive>("The drive.");
  d.defaulted<&S::mechanics>("Motor and mechanics.");
  d.defaulted<&S::switches>("Positions of the switches.");
  d.defaulted<&S::encoder>("The encoder; unset: as the axis expects it.");
  d.defaulted<&S::load_encoder>("The encoder on the load; unset: as the axis expects it, if any.");
}

void describe(Description<Simulation>& d) {
  d.about("Simulation of the hardware. Axes without a servo here get an ideal one that fits their parameters.");
  d.defaulted<&Simulation::servos>("Simulated servos.");
}

void describe(Description<ExternalDrive>& d) {
  using E = ExternalDrive;
  d.about("A drive with its encoder and switches that runs in another process and is connected over LCM.");
  d.required<&E::axis>("Name of the axis.");
  d.defaulted<&E::missing_cycles>(
      unit::cycles, between(1, 100000),
      "Number of missing answers of the drive in a row that is a drive error (ErrorStop 3002).");
}

void describe(Description<External>& d) {
  using E = External;
  d.about("Drives and field buses in other processes.");
  d.defaulted<&E::drives>(
      "Drives. Their axes are not simulated by the engine; takt plant simulates them in another process.");
  d.defaulted<&E::buses>("Field buses whose drives move axes; takt drives run is the process that connects them.");
  d.defaulted<&E::answer_within_s>(unit::s, between(0.001, 3600),
                                   "Simulated time: longest wait for the answers to one cycle, by the wall clock; then "
                                   "the cycle continues without them.");
}

void describe(Description<ViewParams>& d) {
  d.about("The live page, takt view.");
  d.defaulted<&ViewParams::commands>(
      "True: the page may switch on, jog, halt, reset and stop everything; else it only displays.");
}

void describe(Description<Machine>& d) {
  using M = Machine;
  d.about("A machine: the complete configuration of an engine.");
  d.required<&M::name>("Name of the machine.");
  d.defaulted<&M::cycle>("The cycle.");
  d.defaulted<&M::lcm>("Communication over LCM.");
  d.required<&M::axes>("The axes.");
  d.defaulted<&M::cams>("Cams, usable by any axis.");
  d.defaulted<&M::cam_switches>("Lists of cam switches.");
  d.defaulted<&M::flex_cams>("Cam modules.");
  d.defaulted<&M::groups>("Groups of axes.");
  d.defaulted<&M::paths>("Paths, usable by any group.");
  d.defaulted<&M::zones>("Boxes that groups share; one group may be inside at a time.");
  d.defaulted<&M::belts>("Belts and rotary tables.");
  d.defaulted<&M::poses>("Poses that come from elsewhere.");
  d.defaulted<&M::pick_and_place>("Pick and place modules.");
  d.defaulted<&M::coordinate_systems>("Planes in which parts of the surface lie.");
  d.defaulted<&M::parts>("Parts of the surface on which movers float; without any the surface is unbounded.");
  d.defaulted<&M::movers>("Planar movers.");
  d.defaulted<&M::tracks>("Tracks for movers in the plane.");
  d.defaulted<&M::planar_groups>("Groups of movers that avoid collisions with one another.");
  d.defaulted<&M::environments>("Environments: surfaces on which movers float.");
  d.defaulted<&M::simulation>("Simulation of the hardware.");
  d.defaulted<&M::external>("Drives and field buses in other processes.");
  d.defaulted<&M::twin>("A twin in a physics engine.");
  d.defaulted<&M::view>("The live page.");
}

}  // namespace takt::engine
