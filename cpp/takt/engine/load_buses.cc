#include "takt/engine/load_buses.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "takt/axis/params.h"
#include "takt/core/scalar.h"
#include "takt/core/yaml_reader.h"

namespace takt::engine {

namespace {

constexpr std::string_view kCanopen = "canopen:";
constexpr std::string_view kEthercat = "ethercat:";

// The watchdog of process data (register 0x0420) has 16 bits and counts steps of 100 us by default [ETG.1000.4].
constexpr double kLongestEthercatHeartbeatS = 2.1845;

// Returns true if the bus is of this kind, with a channel after the colon.
bool IsOf(std::string_view bus, std::string_view kind) {
  return bus.starts_with(kind) && bus.size() > kind.size();
}

// Returns true for "0x6098", up to `largest`.
bool IsHex(std::string_view text, std::uint64_t largest) {
  if (!text.starts_with("0x") && !text.starts_with("0X")) return false;
  text.remove_prefix(2);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return error == std::errc() && end == text.data() + text.size() && value <= largest;
}

// Returns true for "0x6098:0", both hexadecimal or the second one decimal.
bool IsObject(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || !IsHex(text.substr(0, colon), 0xFFFF)) return false;
  const std::string_view sub = text.substr(colon + 1);
  std::uint8_t number = 0;
  const auto [end, error] = std::from_chars(sub.data(), sub.data() + sub.size(), number);
  return IsHex(sub, 0xFF) || (error == std::errc() && !sub.empty() && end == sub.data() + sub.size());
}

bool FitsBits(std::int64_t value, int bits) {
  if (bits == 64) return true;
  const std::int64_t half = std::int64_t{1} << (bits - 1);
  return value >= -half && value < 2 * half;  // signed or unsigned
}

class BusChecker {
 public:
  BusChecker(const SourceMap& source, const Machine& machine) : source_(source), machine_(machine) {
    for (const axis::AxisParams& axis : machine.axes) names_.push_back(axis.name);
  }

  std::vector<Problem> Run() {
    const std::vector<Bus>& buses = machine_.external.buses;
    for (std::size_t i = 0; i < buses.size(); ++i) {
      const std::string path = "external.buses[" + std::to_string(i) + "]";
      CheckBus(path, buses[i]);
      for (std::size_t k = 0; k < i; ++k) {
        if (!buses[i].bus.empty() && buses[i].bus == buses[k].bus) {
          Add(path + ".bus", "expected each bus once, found " + Quoted(buses[i].bus) + " again");
          break;
        }
      }
    }
    const std::vector<ExternalDrive>& drives = machine_.external.drives;
    for (std::size_t i = 0; i < drives.size(); ++i) {
      if (drives[i].missing_cycles < 3 && std::ranges::find(axes_, drives[i].axis) != axes_.end()) {
        Add("external.drives[" + std::to_string(i) + "].missing_cycles",
            "expected at least 3 cycles, for answers over a bus come a cycle later, found " +
                std::to_string(drives[i].missing_cycles));
      }
    }
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& message) {
    problems_.push_back(source_.ProblemAt(path, message));
  }

  void CheckBus(const std::string& path, const Bus& bus) {
    const bool ethercat = IsOf(bus.bus, kEthercat);
    if (!bus.bus.empty() && !ethercat && !IsOf(bus.bus, kCanopen)) {
      Add(path + ".bus",
          "expected canopen:CHANNEL or canopen:INTERFACE:CHANNEL or ethercat:INTERFACE, found " + Quoted(bus.bus));
    }
    if (bus.dc && !ethercat) Add(path + ".dc", "expected this key on a bus ethercat:INTERFACE only");
    if (bus.ring && !ethercat) Add(path + ".ring", "expected this key on a bus ethercat:INTERFACE only");
    if (bus.ring && (bus.ring->empty() || bus.bus == std::string(kEthercat) + *bus.ring)) {
      Add(path + ".ring", "expected an interface other than that of bus, found " + Quoted(*bus.ring));
    }
    if (ethercat && bus.bitrate != Bus().bitrate) Add(path + ".bitrate", "expected this key on CANopen only");
    if (ethercat && bus.node != Bus().node) Add(path + ".node", "expected this key on CANopen only");
    if (ethercat && bus.heartbeat_s > kLongestEthercatHeartbeatS) {
      Add(path + ".heartbeat_s", "expected at most " + FormatReal(kLongestEthercatHeartbeatS) +
                                     " s on a bus ethercat:INTERFACE, for a watchdog of its drives (three times this) "
                                     "is 6.5535 s at the most, found " +
                                     FormatReal(bus.heartbeat_s));
    }
    if (!bus.bus.empty() && bus.drives.empty()) Add(path + ".drives", "expected at least one drive");
    for (std::size_t i = 0; i < bus.drives.size(); ++i) {
      const BusDrive& drive = bus.drives[i];
      const std::string at = path + ".drives[" + std::to_string(i) + "]";
      CheckAxis(at, drive);
      ethercat ? CheckPlace(at, bus, i) : CheckNode(at, bus, i);
      for (const auto& [key, given] : {std::pair{".vendor", &drive.vendor}, std::pair{".product", &drive.product}}) {
        if (*given && !IsHex(**given, 0xFFFFFFFF)) {
          Add(at + key, "expected a number of 32 bits like \"0x2E1\", found " + Quoted(**given));
        }
      }
      if (drive.homing) CheckHoming(at, drive);
      CheckInputs(at + ".inputs", drive.inputs);
      CheckScaling(at, drive);
      for (std::size_t k = 0; k < drive.start_up.size(); ++k) {
        CheckObject(at + ".start_up[" + std::to_string(k) + "]", drive.start_up[k]);
      }
    }
  }

  void CheckAxis(const std::string& at, const BusDrive& drive) {
    if (drive.axis.empty()) return;  // reported as missing
    const std::uint32_t index = axis::FindAxis(machine_.axes, drive.axis);
    if (index == axis::kNoAxis) {
      return Add(at + ".axis",
                 "expected the name of an axis, found " + Quoted(drive.axis) + DidYouMean(drive.axis, names_));
    }
    if (std::ranges::find(axes_, drive.axis) != axes_.end()) {
      return Add(at + ".axis", "expected each axis once, found " + Quoted(drive.axis) + " again");
    }
    axes_.push_back(drive.axis);
    const axis::AxisParams& axis = machine_.axes[index];
    if (axis.drive.mode == DriveMode::kAnalog) {
      Add(at + ".axis", "expected an axis whose drive: mode is cyclic_position or cyclic_velocity, found " +
                            Quoted(drive.axis) + ", which is analog");
    }
    if (axis.drive.torque_offset) {
      Add(at + ".axis", "expected an axis without drive: torque_offset, which is not sent to drives on a bus, found " +
                            Quoted(drive.axis));
    }
    const axis::Encoder& encoder = axis.encoder;
    if (encoder.type != axis::EncoderType::kIncremental &&
        (encoder.ssi_bits != 32 || encoder.coding != axis::SsiCoding::kBinary)) {
      Add(at + ".axis",
          "expected an encoder that is incremental, or absolute with ssi_bits: 32 and coding: binary, as "
          "drives on a bus send it, found another one on " +
              Quoted(drive.axis));
    }
  }

  void CheckInputs(const std::string& at, const BusInputs& inputs) {
    if (inputs.limit_positive < 0 || inputs.limit_positive != inputs.limit_negative) return;
    Add(at + ".limit_positive",
        "expected another bit than that of limit_negative, found " + std::to_string(inputs.limit_positive) + " again");
  }

  // A drive counts with 32 bits: in a cycle an axis must move less than half their range, otherwise its direction is
  // ambiguous. And the velocity of csv has 32 bits.
  void CheckScaling(const std::string& at, const BusDrive& drive) {
    const std::uint32_t index = axis::FindAxis(machine_.axes, drive.axis);
    if (index == axis::kNoAxis) return;  // reported elsewhere
    const axis::AxisParams& axis = machine_.axes[index];
    double per_unit = axis.encoder.increments_per_unit;
    std::string key = at + ".axis";
    if (drive.scaling) {
      const BusScaling& s = *drive.scaling;
      per_unit = s.increments_per_revolution * s.gear_motor / s.gear_shaft / s.feed;
      key = at + ".scaling";
    }
    constexpr double kHalfRange = 2147483647;
    const double speed = axis.limits.velocity * per_unit;  // increments/s
    if (!(per_unit > 0) || !(speed * machine_.cycle.period_s < kHalfRange)) {
      return Add(key,
                 "expected fewer than 2147483647 increments of the drive in a cycle at the velocity limit of the axis, "
                 "found " +
                     FormatReal(speed * machine_.cycle.period_s));
    }
    if (axis.drive.mode == DriveMode::kCyclicVelocity && !(speed * drive.velocity_factor <= kHalfRange)) {
      Add(drive.scaling ? key : at + ".velocity_factor",
          "expected a velocity limit of the axis of 2147483647 units of the drive (0x60FF) at the most, found " +
              FormatReal(speed * drive.velocity_factor));
    }
  }

  void CheckNode(const std::string& at, const Bus& bus, std::size_t i) {
    const BusDrive& drive = bus.drives[i];
    if (drive.position) Add(at + ".position", "expected this key on a bus ethercat:INTERFACE only; here it is node");
    if (drive.alias) Add(at + ".alias", "expected this key on a bus ethercat:INTERFACE only; here it is node");
    if (!drive.node) return Add(at + ".node", "expected this key with a whole number from 1 to 127, found nothing");
    if (*drive.node == bus.node) {
      Add(at + ".node",
          "expected another address than that of this end of the bus, found " + std::to_string(*drive.node));
    }
    CheckOnce(at + ".node", "each address", bus, i, &BusDrive::node);
  }

  void CheckPlace(const std::string& at, const Bus& bus, std::size_t i) {
    const BusDrive& drive = bus.drives[i];
    if (drive.node) Add(at + ".node", "expected position or alias on a bus ethercat:INTERFACE, found node");
    if (drive.position && drive.alias) {
      Add(at + ".alias", "expected either position or alias, found both");
    } else if (!drive.position && !drive.alias && !drive.node) {
      Add(at + ".position", "expected this key, or alias, with a whole number from 1 to 65535, found nothing");
    }
    CheckOnce(at + ".position", "each position", bus, i, &BusDrive::position);
    CheckOnce(at + ".alias", "each alias", bus, i, &BusDrive::alias);
  }

  template <typename Address>
  void CheckOnce(const std::string& at, const std::string& what, const Bus& bus, std::size_t i,
                 std::optional<Address> BusDrive::*key) {
    const std::optional<Address>& mine = bus.drives[i].*key;
    for (std::size_t k = 0; mine && k < i; ++k) {
      if (bus.drives[k].*key != mine) continue;
      return Add(at, "expected " + what + " once on a bus, found " + std::to_string(*mine) + " again");
    }
  }

  void CheckHoming(const std::string& at, const BusDrive& drive) {
    const BusHoming& homing = *drive.homing;
    if (homing.method == 0) Add(at + ".homing.method", "expected a homing method (0x6098) other than 0, found 0");
    const std::uint32_t index = axis::FindAxis(machine_.axes, drive.axis);
    if (index == axis::kNoAxis) return;  // reported elsewhere
    const axis::AxisParams& axis = machine_.axes[index];
    if (axis.encoder.type != axis::EncoderType::kIncremental) {
      Add(at + ".homing",
          "expected this key with an incremental encoder, found an absolute one, which needs no homing, on " +
              Quoted(drive.axis));
    }
    CheckMost(at + ".homing.velocity_switch", homing.velocity_switch, axis.limits.velocity, "velocity");
    CheckMost(at + ".homing.velocity_pulse", homing.velocity_pulse, axis.limits.velocity, "velocity");
    CheckMost(at + ".homing.acceleration", homing.acceleration, axis.limits.acceleration, "acceleration");
    if (axis.drive.ready_timeout_s <= homing.within_s) {
      Add(at + ".homing.within_s",
          "expected less than drive: ready_timeout_s of the axis, which is switched on meanwhile: " +
              FormatReal(axis.drive.ready_timeout_s) + " s, found " + FormatReal(homing.within_s) + " s");
    }
  }

  // Motions of the drive itself must respect the limits of the axis, too.
  void CheckMost(const std::string& at, const std::optional<double>& found, double most, const std::string& what) {
    if (!found || *found <= most) return;
    Add(at, "expected the " + what + " limit of the axis at the most, " + FormatReal(most) + ", found " +
                FormatReal(*found));
  }

  void CheckObject(const std::string& at, const BusObject& object) {
    if (!object.object.empty() && !IsObject(object.object)) {
      Add(at + ".object", "expected index and subindex like \"0x6098:0\", found " + Quoted(object.object));
    }
    if (object.bits != 8 && object.bits != 16 && object.bits != 32 && object.bits != 64) {
      Add(at + ".bits", "expected 8, 16, 32 or 64, found " + std::to_string(object.bits));
    } else if (!FitsBits(object.value, object.bits)) {
      Add(at + ".value",
          "expected a number of " + std::to_string(object.bits) + " bits, found " + std::to_string(object.value));
    }
  }

  const SourceMap& source_;
  const Machine& machine_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> axes_;  // on a bus
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> CheckBuses(const SourceMap& source, const Machine& machine) {
  return BusChecker(source, machine).Run();
}

void AddDrivesOfBuses(Machine& machine) {
  std::vector<ExternalDrive>& drives = machine.external.drives;
  for (const Bus& bus : machine.external.buses) {
    for (const BusDrive& drive : bus.drives) {
      const auto same = [&](const ExternalDrive& listed) { return listed.axis == drive.axis; };
      if (std::ranges::none_of(drives, same)) {
        drives.push_back({.axis = drive.axis, .missing_cycles = bus.missing_cycles});
      }
    }
  }
}

}  // namespace takt::engine
