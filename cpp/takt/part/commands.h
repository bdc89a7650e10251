// Commands to a part.
#pragma once

#include <cstdint>
#include <variant>

#include "takt/core/describe_fwd.h"

namespace takt::part {

struct ActivatePosition {
  std::uint32_t index = 1;  // of the position, from 1
};
struct AllowEnable {};
struct ForceDisable {};
struct Reset {};

using Command = std::variant<ActivatePosition, AllowEnable, ForceDisable, Reset>;

void describe(Description<ActivatePosition>&);
void describe(Description<AllowEnable>&);
void describe(Description<ForceDisable>&);
void describe(Description<Reset>&);

}  // namespace takt::part
