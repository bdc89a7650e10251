#include "takt/core/drive_errors.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace takt {
namespace {

struct DriveText {
  std::int32_t code;
  std::string_view text;
};

// The codes that drive profiles and CANopen share. If a code is not listed, its group is used: the last two digits 00,
// then the last three.
constexpr auto kDriveTexts = std::to_array<DriveText>({
    {0x0000, "no error"},
    {0x1000, "generic error"},
    {0x2000, "current"},
    {0x2100, "current on the mains side"},
    {0x2110, "short circuit or earth leakage on the mains side"},
    {0x2120, "earth leakage on the mains side"},
    {0x2130, "short circuit on the mains side"},
    {0x2200, "current inside the drive"},
    {0x2211, "overcurrent inside the drive, first"},
    {0x2212, "overcurrent inside the drive, second"},
    {0x2220, "continuous overcurrent inside the drive"},
    {0x2230, "short circuit or earth leakage inside the drive"},
    {0x2240, "earth leakage inside the drive"},
    {0x2250, "short circuit inside the drive"},
    {0x2300, "current on the motor side"},
    {0x2310, "continuous overcurrent"},
    {0x2320, "short circuit or earth leakage at the motor"},
    {0x2330, "earth leakage at the motor"},
    {0x2340, "short circuit at the motor"},
    {0x3000, "voltage"},
    {0x3100, "mains voltage"},
    {0x3110, "mains overvoltage"},
    {0x3120, "mains undervoltage"},
    {0x3130, "mains phase missing"},
    {0x3140, "mains frequency"},
    {0x3200, "DC link voltage"},
    {0x3210, "DC link overvoltage"},
    {0x3220, "DC link undervoltage"},
    {0x3230, "load error of the DC link"},
    {0x3300, "output voltage"},
    {0x3310, "output overvoltage"},
    {0x3320, "armature circuit"},
    {0x3330, "field circuit"},
    {0x4000, "temperature"},
    {0x4100, "ambient temperature"},
    {0x4110, "ambient temperature too high"},
    {0x4120, "ambient temperature too low"},
    {0x4200, "temperature of the drive"},
    {0x4210, "drive too hot"},
    {0x4220, "drive too cold"},
    {0x4300, "temperature of the motor"},
    {0x4310, "motor too hot"},
    {0x4320, "motor too cold"},
    {0x4400, "temperature of the supply"},
    {0x5000, "hardware of the drive"},
    {0x5100, "supply of the control electronics"},
    {0x5112, "supply of 24 V"},
    {0x5113, "supply of 5 V"},
    {0x5200, "control electronics"},
    {0x5300, "operating unit"},
    {0x5400, "power section"},
    {0x5430, "input stages"},
    {0x5440, "contacts"},
    {0x5441, "safe torque off or enable contact"},
    {0x5450, "fuses"},
    {0x5500, "memory"},
    {0x5530, "non-volatile memory"},
    {0x6000, "software of the drive"},
    {0x6010, "software watchdog"},
    {0x6100, "internal software"},
    {0x6200, "user software"},
    {0x6300, "parameters"},
    {0x6310, "loss of parameters"},
    {0x6320, "parameter error"},
    {0x7000, "modules beside the drive"},
    {0x7100, "power modules"},
    {0x7110, "brake chopper"},
    {0x7112, "overcurrent of the brake chopper"},
    {0x7120, "motor"},
    {0x7121, "motor blocked"},
    {0x7122, "motor or commutation error"},
    {0x7200, "measurement circuit"},
    {0x7300, "sensors"},
    {0x7305, "incremental encoder 1"},
    {0x7306, "incremental encoder 2"},
    {0x7310, "speed sensor"},
    {0x7320, "position sensor"},
    {0x7380, "absolute encoder"},
    {0x7500, "communication inside the drive"},
    {0x8000, "monitoring"},
    {0x8100, "communication"},
    {0x8110, "CAN overrun: frames lost"},
    {0x8120, "CAN in error passive mode"},
    {0x8130, "heartbeat or node guarding lost"},
    {0x8140, "recovered from bus off"},
    {0x8150, "CAN identifiers collide"},
    {0x8180, "process data lost"},
    {0x8200, "protocol"},
    {0x8210, "process data shorter than mapped"},
    {0x8220, "process data longer than mapped"},
    {0x8240, "length of SYNC"},
    {0x8250, "process data did not come in time"},
    {0x8300, "torque control"},
    {0x8311, "torque too large"},
    {0x8400, "speed control"},
    {0x8480, "speed above its limit"},
    {0x8500, "position control"},
    {0x8600, "positioning"},
    {0x8611, "following error"},
    {0x8612, "reference limit"},
    {0x8613, "homing error"},
    {0x8700, "synchronisation with the bus"},
    {0x8800, "winding"},
    {0x9000, "external error"},
    {0xA000, "EtherCAT communication"},
    {0xF000, "additional functions"},
    {0xFF00, "of the maker of the drive"},
});

std::string_view KnownDriveText(std::int32_t code) {
  const auto* const found = std::ranges::find(kDriveTexts, code, &DriveText::code);
  return found == kDriveTexts.end() ? std::string_view() : found->text;
}

}  // namespace

std::string DriveErrorText(std::int32_t code) {
  std::string_view text = "unknown";
  for (const std::int32_t group : {code, code & 0xFF00, code & 0xF000}) {
    if (const std::string_view known = KnownDriveText(group); !known.empty()) {
      text = known;
      break;
    }
  }
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "0x%04X", static_cast<unsigned>(code));
  return std::string(number.data()) + " (" + std::string(text) + ")";
}

}  // namespace takt
