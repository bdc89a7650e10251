// What people tell a group of movers. What is in it is told itself to come into it and to leave it.
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
