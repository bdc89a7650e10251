// EN-37, EN-38: URDF files as anyone may write them.
#include <cstdlib>
#include <string>

#include "takt/kinematics/serial.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string why;
  const auto chain = takt::kinematics::ReadUrdf(std::string(reinterpret_cast<const char*>(data), size), "", "", why);
  if (chain.has_value() != why.empty()) std::abort();
  return 0;
}
