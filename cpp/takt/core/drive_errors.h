// Texts for the error codes of drives (CiA 402: 0x603F, and the codes of CANopen emergency messages).
#pragma once

#include <cstdint>
#include <string>

namespace takt {

// Returns "0x3210 (DC link overvoltage)"; for an unknown code the text of its group. 0xFFxx: manufacturer specific.
std::string DriveErrorText(std::int32_t code);

}  // namespace takt
