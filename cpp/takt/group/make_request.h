// Makes the request that is kept of a motion command.
#pragma once

#include <optional>

#include "takt/group/group.h"

namespace takt::group {

// Returns nothing if the command is not a motion along a path. With `error`: the motion is refused.
struct MadeRequest {
  Request move;
  ErrorId error = ErrorId::kNone;
};
std::optional<MadeRequest> MakeRequest(const Context& c, const State& s, const Command& command) noexcept;

}  // namespace takt::group
