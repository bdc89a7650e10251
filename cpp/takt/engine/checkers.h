// What knows whether the paths of groups are free.
#pragma once

#include <optional>
#include <vector>

#include "takt/workspace/checker.h"

namespace takt::engine {

// One for each group of a machine; none: it has no workspace.
using Checkers = std::vector<std::optional<workspace::Checker>>;

}  // namespace takt::engine
