// Finds omissions and mistakes in descriptions. For tests: call it for each described type, or for the root that
// contains them.
#pragma once

#include <string>
#include <vector>

#include "takt/core/describe.h"

namespace takt {

// Returns one sentence for each mistake in the type and all types inside it: members that are not described, missing
// texts, defaults out of range or not finite (state fields may be NaN), enum names that YAML reads as something else or
// that occur twice.
std::vector<std::string> Verify(const Type& type);

}  // namespace takt
