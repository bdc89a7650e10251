// Path check requests as the cycle sends them (path_check_request.h).
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Returns true if paths can be checked for collisions: the group has a workspace and a tool, and requests are taken.
bool HasWorkspace(const Context& c, const State& s) noexcept;

// Returns true if the path being planned begins on a moving carrier.
bool BeginsOnCarrier(const Context& c) noexcept;
// Returns true if the path being planned can be checked; arcs and paths of the machine file on a carrier cannot.
bool CanBeChecked(const Context& c, const State& s) noexcept;

// Enters Stage::kCheck with the move being planned, from the end of `ahead`.
void Ask(const Context& c, State& s) noexcept;

// In that stage: sends the request unless it is sent. Returns true if the answer has arrived.
bool HasAnswer(const Context& c, State& s) noexcept;

// Stores an answer. Returns false if it is not the one awaited.
bool Take(const PathChecked& answer, State& s) noexcept;

}  // namespace takt::group
