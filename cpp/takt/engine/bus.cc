#include "takt/engine/bus.h"

#include "takt/core/describe.h"

namespace takt::engine {

void describe(Description<BusScaling>& d) {
  using S = BusScaling;
  d.about("Resolution, gear and feed: conversion from increments of the drive to the unit of the axis.");
  d.required<&S::increments_per_revolution>(positive, "Increments (0x6064) per revolution of the motor.");
  d.defaulted<&S::gear_motor>(positive, "Gear ratio: revolutions of the motor ...");
  d.defaulted<&S::gear_shaft>(positive, "... per this number of revolutions of the shaft.");
  d.required<&S::feed>(unit::u_rev, positive, "Displacement of the axis per revolution of the shaft.");
}

void describe(Description<BusInputs>& d) {
  using I = BusInputs;
  d.about("Bits of the digital inputs of a drive (0x60FD); -1: the axis has no such input.");
  d.defaulted<&I::limit_negative>(between(-1, 31), "Negative limit switch.");
  d.defaulted<&I::limit_positive>(between(-1, 31), "Positive limit switch.");
  d.defaulted<&I::reference>(between(-1, 31), "Reference switch.");
  d.defaulted<&I::touch_probe>(between(-1, 31), "Touch probe.");
}

void describe(Description<BusHoming>& d) {
  using H = BusHoming;
  d.about(
      "Homing by the drive itself (mode hm). MC_Power carries it out when the axis is switched on for the first time "
      "after the start of the drive or of takt drives run. Unset values are left as they are in the drive.");
  d.required<&H::method>(between(-128, 127), "Homing method (0x6098); 0: none.");
  d.defaulted<&H::velocity_switch>(unit::u_s, positive, "Velocity of the search for a switch (0x6099:1).");
  d.defaulted<&H::velocity_pulse>(unit::u_s, positive, "Velocity of the search for the index pulse (0x6099:2).");
  d.defaulted<&H::acceleration>(unit::u_s2, positive,
                                "Acceleration (0x609A), in increments/s^2 times velocity_factor.");
  d.defaulted<&H::within_s>(unit::s, between(0.1, 3600),
                            "Longest duration of homing; drive: ready_timeout_s of the axis must be longer.");
  d.defaulted<&H::distance>(
      unit::u, positive,
      "Largest distance from the position at which homing began; beyond it the axis is stopped. Unset: unlimited.");
}

void describe(Description<BusObject>& d) {
  using O = BusObject;
  d.about("An object that is written to a drive at the start, before the drive is operational.");
  d.required<&O::object>("Index and subindex, \"0x6098:0\".");
  d.required<&O::value>("Value to write.");
  d.defaulted<&O::bits>(between(8, 64), "Length of the object in bits: 8, 16, 32 or 64.");
}

void describe(Description<BusDrive>& d) {
  using B = BusDrive;
  d.about("A CiA 402 drive on a field bus that moves an axis.");
  d.required<&B::axis>(
      "Name of the axis. Its drive: mode (cyclic_position, cyclic_velocity) is also the mode of the drive.");
  d.defaulted<&B::node>(between(1, 127), "CANopen: address of the drive on the bus.");
  d.defaulted<&B::position>(between(1, 65535), "EtherCAT: position of the drive on the wire; 1 is next to this end.");
  d.defaulted<&B::alias>(between(1, 65535),
                         "EtherCAT: configured station alias of the drive, instead of its position.");
  d.defaulted<&B::vendor>("Vendor of the drive (0x1018:1), \"0x2E1\"; a drive of another vendor is refused.");
  d.defaulted<&B::product>("Product code of the drive (0x1018:2); a drive with another one is refused.");
  d.defaulted<&B::device_file>(
      "The manufacturer's description of the drive, EDS (CANopen) or ESI (EtherCAT), relative to the folder of the "
      "machine file. It gives vendor and product unless they are given here; objects that are mapped or written are "
      "checked against it.");
  d.defaulted<&B::scaling>(
      "Conversion to the unit of the axis; unset: an increment of the drive is a count of the axis' encoder.");
  d.defaulted<&B::velocity_factor>(positive, "Units of the drive's velocity objects (0x60FF) per increment/s.");
  d.defaulted<&B::rated_torque>(unit::nm, positive,
                                "Rated torque, a force in N on linear motors; unset: read from the drive (0x6076).");
  d.defaulted<&B::inputs>("Digital inputs of the drive that are inputs of the axis.");
  d.defaulted<&B::probe_latch>(between(0, 2),
                               "Touch probe of the drive, 1 or 2, whose latched positions (0x60BA to 0x60BD) are "
                               "captures of the axis' touch probe; 0: the input is only sampled once a cycle.");
  d.defaulted<&B::homing>("Homing in the drive; unset: the engine does the homing, with the inputs.");
  d.defaulted<&B::start_up>("Objects to write at the start, in this order.");
  d.defaulted<&B::ready_within_s>(unit::s, between(0.1, 600),
                                  "Longest time in which the drive must answer at the start.");
}

void describe(Description<Bus>& d) {
  using B = Bus;
  d.about("A field bus with drives that takt drives run connects with the engine.");
  d.required<&B::bus>(
      "Kind and channel: canopen:can0, canopen:INTERFACE:CHANNEL (interfaces of python-can), ethercat:eth1.");
  d.defaulted<&B::bitrate>("CANopen: bits per second; 0: as the interface is set.");
  d.defaulted<&B::node>(between(1, 127), "CANopen: address of this end.");
  d.defaulted<&B::dc>("EtherCAT: the drives are synchronised by their distributed clocks (SYNC0); else by the frames.");
  d.defaulted<&B::ring>(
      "EtherCAT: interface of this host at the other end of the slaves, \"eth2\", so that a break of one cable is "
      "tolerated.");
  d.defaulted<&B::heartbeat_s>(unit::s, between(0.01, 10),
                               "Period of the heartbeats of this end and of each drive; three missing ones are a "
                               "fault. EtherCAT: a third of the watchdog of the drives, 2.1845 s at most.");
  d.defaulted<&B::missing_cycles>(
      unit::cycles, between(3, 100000),
      "Number of missing answers of a drive in a row that is a drive error (ErrorStop 3002).");
  d.required<&B::drives>("Drives on the bus. Their axes are external drives and need not be named under drives.");
}

}  // namespace takt::engine
