// Commands to a group of movers. Members receive the commands to enter and leave it themselves.
#pragma once

#include <variant>

#include "takt/core/describe_fwd.h"

namespace takt::planargroup {

struct Enable {};
struct Disable {};
struct Reset {};

using Command = std::variant<Enable, Disable, Reset>;

void describe(Description<Enable>&);
void describe(Description<Disable>&);
void describe(Description<Reset>&);

}  // namespace takt::planargroup
