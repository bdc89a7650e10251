// Finds what is forgotten or wrong in a description. For tests: each described type, or the root that holds them, goes
// through it.
#pragma once

#include <string>
#include <vector>

#include "takt/core/describe.h"

namespace takt {

// One sentence for each fault, of the type and all types inside it: members that are not described, missing texts,
// defaults out of range or not finite (state fields may be NaN), enum names that YAML reads as something else or that
// come twice.
std::vector<std::string> Verify(const Type& type);

}  // namespace takt
