// What the error code of a drive (CiA 402: 0x603F, and that of emergency messages of CANopen) means, in words.
#pragma once

#include <cstdint>
#include <string>

namespace takt {

// "0x3210 (DC link overvoltage)". Of a code that is not known what its group is about; 0xFFxx is the maker's.
std::string DriveErrorText(std::int32_t code);

}  // namespace takt
