// The cycle's part of a question whether a path is free (path_check_request.h).
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Somebody knows what stands around the mechanism.
bool HasWorkspace(const Context& c, const State& s) noexcept;

// The path that is planned begins on what moves.
bool BeginsOnCarrier(const Context& c) noexcept;
// And can be asked about: arcs and paths of the machine file that begin there cannot.
bool CanAsk(const Context& c, const State& s) noexcept;

// Goes into Stage::kCheck with the move that is planned, from where `ahead` ends.
void Ask(const Context& c, State& s) noexcept;

// In that stage: sends the question off if it is not yet. True: the answer is there.
bool IsAnswered(const Context& c, State& s) noexcept;

// False: this is not the answer that is waited for.
bool Take(const PathChecked& answer, State& s) noexcept;

}  // namespace takt::group
