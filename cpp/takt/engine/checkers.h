// Collision checkers for the paths of groups.
#pragma once

#include <optional>
#include <vector>

#include "takt/workspace/checker.h"

namespace takt::engine {

// One entry for each group of a machine; empty if the group has no workspace.
using Checkers = std::vector<std::optional<workspace::Checker>>;

}  // namespace takt::engine
