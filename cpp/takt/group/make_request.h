// From a command that moves a group to what is kept of it.
#pragma once

#include <optional>

#include "takt/group/group.h"

namespace takt::group {

// Nothing: the command does not move along a path. An error: it cannot.
struct MadeRequest {
  Request move;
  ErrorId error = ErrorId::kNone;
};
std::optional<MadeRequest> MakeRequest(const Context& c, const State& s, const Command& command) noexcept;

}  // namespace takt::group
