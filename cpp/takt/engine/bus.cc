#include "takt/engine/bus.h"

#include "takt/core/describe.h"

namespace takt::engine {

void describe(Description<BusScaling>& d) {
  using S = BusScaling;
  d.about("Resolution, gear and feed: from increments of the drive to the unit of the axis.");
  d.required<&S::increments_per_revolution>(positive, "Increments (0x6064) in a revolution of the motor.");
  d.defaulted<&S::gear_motor>(positive, "Gear: so many revolutions of the motor ...");
  d.defaulted<&S::gear_shaft>(positive, "... are so many of the shaft.");
  d.required<&S::feed>(unit::u_rev, positive, "Way of the axis in a revolution of the shaft.");
}

void describe(Description<BusInputs>& d) {
  using I = BusInputs;
  d.about("Bits of the digital inputs of a drive (0x60FD), -1: the axis has no such wire.");
  d.defaulted<&I::limit_negative>(between(-1, 31), "Negative limit switch.");
  d.defaulted<&I::limit_positive>(between(-1, 31), "Positive limit switch.");
  d.defaulted<&I::reference>(between(-1, 31), "Reference switch.");
  d.defaulted<&I::touch_probe>(between(-1, 31), "Touch probe.");
}

void describe(Description<BusHoming>& d) {
  using H = BusHoming;
  d.about(
      "Homing by the drive itself (mode hm): MC_Power carries it out when the axis is switched on for the first time "
      "after the start of the drive or of takt drives run. What is unset stays as the drive has it.");
  d.required<&H::method>(between(-128, 127), "Homing method (0x6098); 0 is none.");
  d.defaulted<&H::velocity_switch>(unit::u_s, positive, "Velocity of the search for a switch (0x6099:1).");
  d.defaulted<&H::velocity_pulse>(unit::u_s, positive, "Velocity of the search for the index pulse (0x6099:2).");
  d.defaulted<&H::acceleration>(unit::u_s2, positive,
                                "Acceleration (0x609A), in increments/s^2 times velocity_factor.");
  d.defaulted<&H::within_s>(unit::s, between(0.1, 3600),
                            "How long it may take; drive: ready_timeout_s of the axis must be longer.");
  d.defaulted<&H::distance>(unit::u, positive,
                            "The axis is stopped where it gets further away than that from where the homing began; "
                            "unset: it is not.");
}

void describe(Description<BusObject>& d) {
  using O = BusObject;
  d.about("An object that is written to a drive at start, before it is operational.");
  d.required<&O::object>("Index and subindex, \"0x6098:0\".");
  d.required<&O::value>("What is written.");
  d.defaulted<&O::bits>(between(8, 64), "Length of the object: 8, 16, 32 or 64.");
}

void describe(Description<BusDrive>& d) {
  using B = BusDrive;
  d.about("A drive on a field bus that speaks CiA 402 and moves an axis.");
  d.required<&B::axis>("Name of the axis. Its drive: mode (cyclic_position, cyclic_velocity) is that of the drive.");
  d.defaulted<&B::node>(between(1, 127), "CANopen: address of the drive on the bus.");
  d.defaulted<&B::position>(between(1, 65535), "EtherCAT: place of the drive on the wire, 1 next to this end.");
  d.defaulted<&B::alias>(between(1, 65535),
                         "EtherCAT: configured station alias of the drive, instead of its position.");
  d.defaulted<&B::vendor>("Vendor of the drive (0x1018:1), \"0x2E1\": another one is refused.");
  d.defaulted<&B::product>("Product code of the drive (0x1018:2): another one is refused.");
  d.defaulted<&B::device_file>(
      "The maker's description of the drive, EDS (CANopen) or ESI (EtherCAT), from the folder of the machine file on: "
      "vendor and product are those of the file unless they are given, and what is mapped and written is checked.");
  d.defaulted<&B::scaling>("Unset: an increment of the drive is a count of the axis' encoder.");
  d.defaulted<&B::velocity_factor>(positive, "Units of the drive's velocities (0x60FF) in 1 increment/s.");
  d.defaulted<&B::rated_torque>(unit::nm, positive,
                                "Rated torque, N on linear motors; unset: the drive says it (0x6076).");
  d.defaulted<&B::inputs>("Which of its inputs are wires of the axis.");
  d.defaulted<&B::probe_latch>(between(0, 2),
                               "Touch probe of the drive, 1 or 2, whose latched positions (0x60BA to 0x60BD) are those "
                               "of the axis' touch probe; 0: the wire alone, once a cycle.");
  d.defaulted<&B::homing>("Homing in the drive; unset: the engine does it, with the inputs.");
  d.defaulted<&B::start_up>("Objects to write at start, in this order.");
  d.defaulted<&B::ready_within_s>(unit::s, between(0.1, 600), "How long the drive may take to answer at start.");
}

void describe(Description<Bus>& d) {
  using B = Bus;
  d.about("A field bus with drives, which takt drives run connects with the engine.");
  d.required<&B::bus>(
      "Kind and channel: canopen:can0, canopen:INTERFACE:CHANNEL (interfaces of python-can), ethercat:eth1.");
  d.defaulted<&B::bitrate>("CANopen: bits per second; 0: as the interface is set.");
  d.defaulted<&B::node>(between(1, 127), "CANopen: address of this end.");
  d.defaulted<&B::dc>("EtherCAT: the drives work in step with their distributed clocks (SYNC0), else with the frames.");
  d.defaulted<&B::ring>(
      "EtherCAT: interface of this host at the other end of the slaves, \"eth2\", so that one cable may break.");
  d.defaulted<&B::heartbeat_s>(unit::s, between(0.01, 10),
                               "Between two signs of life of this end and of each drive; three missing are a fault. "
                               "EtherCAT: a third of the watchdog of the drives, 2.1845 s at the most.");
  d.defaulted<&B::missing_cycles>(unit::cycles, between(3, 100000),
                                  "So many answers of a drive missing in a row are a drive error (ErrorStop 3002).");
  d.required<&B::drives>("The drives. Their axes are external drives without being named under drives.");
}

}  // namespace takt::engine
