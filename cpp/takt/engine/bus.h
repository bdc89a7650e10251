// Field buses of the machine file: which drives stand on them, for which axes. Only described and checked here; the
// process of the drives (`takt drives run`) works with it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::engine {

// From increments of a drive (0x6064) to the unit of its axis.
struct BusScaling {
  double increments_per_revolution = 0;  // of the motor
  double gear_motor = 1;                 // so many revolutions of the motor ...
  double gear_shaft = 1;                 // ... are so many of the shaft
  double feed = 0;                       // u in a revolution of the shaft
};

// Bits of the digital inputs of a drive (0x60FD); -1: the axis has no such wire.
struct BusInputs {
  std::int32_t limit_negative = 0;
  std::int32_t limit_positive = 1;
  std::int32_t reference = 2;
  std::int32_t touch_probe = -1;
};

// Homing by the drive itself (mode hm), before its axis is switched on for the first time.
struct BusHoming {
  std::int32_t method = 1;                  // 0x6098
  std::optional<double> velocity_switch{};  // u/s, 0x6099:1; unset: as the drive has it
  std::optional<double> velocity_pulse{};   // u/s, 0x6099:2
  std::optional<double> acceleration{};     // u/s^2, 0x609A
  double within_s = 60;                     // s from its begin to the reference
  std::optional<double> distance{};         // u, most distance from the start of the search; unset: unlimited
};

// Written to an object of a drive at start.
struct BusObject {
  std::string object;  // "0x6098:0"
  std::int64_t value = 0;
  std::uint8_t bits = 32;
};

struct BusDrive {
  std::string axis;                          // name of the axis
  std::optional<std::uint8_t> node{};        // CANopen: address on the bus
  std::optional<std::uint16_t> position{};   // EtherCAT: place on the wire, from 1
  std::optional<std::uint16_t> alias{};      // EtherCAT: instead of the position
  std::optional<std::string> vendor{};       // "0x2E1": that of the drive, else it is the wrong one
  std::optional<std::string> product{};      // the same of its product code
  std::optional<std::string> device_file{};  // EDS or ESI, from the folder of the machine file on
  std::optional<BusScaling> scaling{};       // unset: an increment of the drive is a count of the axis' encoder
  double velocity_factor = 1;                // units of velocity objects in 1 increment/s
  std::optional<double> rated_torque{};      // Nm or N; unset: the drive says it
  BusInputs inputs;
  std::uint8_t probe_latch = 0;  // touch probe of the drive (0x60B8) whose latches are used; 0: none
  std::optional<BusHoming> homing{};
  std::vector<BusObject> start_up;
  double ready_within_s = 10;  // s from the start of the process to a drive that has answered
};

struct Bus {
  std::string bus;                    // "canopen:can0", "ethercat:eth1"
  std::uint32_t bitrate = 1000000;    // bit/s; 0: as the interface is set
  std::uint8_t node = 127;            // address of this end
  bool dc = false;                    // EtherCAT: distributed clocks
  std::optional<std::string> ring{};  // EtherCAT: second interface, at the other end of the slaves
  double heartbeat_s = 0.1;           // s between two signs of life, of this end and of each drive
  std::uint32_t missing_cycles = 5;   // so many answers missing in a row are a drive error
  std::vector<BusDrive> drives;
};

void describe(Description<BusScaling>&);
void describe(Description<BusInputs>&);
void describe(Description<BusHoming>&);
void describe(Description<BusObject>&);
void describe(Description<BusDrive>&);
void describe(Description<Bus>&);

}  // namespace takt::engine
