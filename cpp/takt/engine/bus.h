// Field buses of the machine file: the drives on each bus and the axes that they move. This module only describes and
// checks them; the drive process (`takt drives run`) works with it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::engine {

// Scaling from increments of the drive (0x6064) to the unit of its axis.
struct BusScaling {
  double increments_per_revolution = 0;  // of the motor
  double gear_motor = 1;                 // revolutions of the motor ...
  double gear_shaft = 1;                 // ... for this many revolutions of the shaft
  double feed = 0;                       // [u] travel of the axis per revolution of the shaft
};

// Bits of the digital inputs of a drive (0x60FD); -1: not wired.
struct BusInputs {
  std::int32_t limit_negative = 0;
  std::int32_t limit_positive = 1;
  std::int32_t reference = 2;
  std::int32_t touch_probe = -1;
};

// Homing by the drive itself (mode hm), before its axis is switched on for the first time.
struct BusHoming {
  std::int32_t method = 1;                  // 0x6098
  std::optional<double> velocity_switch{};  // [u/s] 0x6099:1; unset: the drive's own setting
  std::optional<double> velocity_pulse{};   // [u/s] 0x6099:2; unset: the drive's own setting
  std::optional<double> acceleration{};     // [u/s^2] 0x609A; unset: the drive's own setting
  double within_s = 60;                     // [s] timeout of the whole homing
  std::optional<double> distance{};         // [u] maximum distance from the start of the search; unset: unlimited
};

// A value that is written to an object of a drive at start.
struct BusObject {
  std::string object;  // "0x6098:0"
  std::int64_t value = 0;
  std::uint8_t bits = 32;
};

struct BusDrive {
  std::string axis;                          // name of the axis
  std::optional<std::uint8_t> node{};        // CANopen: address on the bus
  std::optional<std::uint16_t> position{};   // EtherCAT: position on the wire, from 1
  std::optional<std::uint16_t> alias{};      // EtherCAT: configured station alias, instead of the position
  std::optional<std::string> vendor{};       // "0x2E1": expected vendor; a drive of another vendor is refused
  std::optional<std::string> product{};      // expected product code, likewise
  std::optional<std::string> device_file{};  // EDS or ESI file, relative to the folder of the machine file
  std::optional<BusScaling> scaling{};       // unset: one increment of the drive is one count of the axis' encoder
  double velocity_factor = 1;                // units of velocity objects per increment/s
  std::optional<double> rated_torque{};      // [Nm], or [N] on linear motors; unset: read from the drive
  BusInputs inputs;
  std::uint8_t probe_latch = 0;  // touch probe of the drive (0x60B8) whose latches are used; 0: none
  std::optional<BusHoming> homing{};
  std::vector<BusObject> start_up;
  double ready_within_s = 10;  // [s] timeout from the start of the process to the first answer of the drive
};

struct Bus {
  std::string bus;                    // "canopen:can0", "ethercat:eth1"
  std::uint32_t bitrate = 1000000;    // [bit/s]; 0: the interface's own setting
  std::uint8_t node = 127;            // address of this end of the bus
  bool dc = false;                    // EtherCAT: distributed clocks
  std::optional<std::string> ring{};  // EtherCAT: second interface, at the other end of the slaves
  double heartbeat_s = 0.1;           // [s] between two signs of life, of this end and of each drive
  std::uint32_t missing_cycles = 5;   // consecutive missing answers that are a drive error
  std::vector<BusDrive> drives;
};

void describe(Description<BusScaling>&);
void describe(Description<BusInputs>&);
void describe(Description<BusHoming>&);
void describe(Description<BusObject>&);
void describe(Description<BusDrive>&);
void describe(Description<Bus>&);

}  // namespace takt::engine
