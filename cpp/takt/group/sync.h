// Paths that follow a master, and axes that follow a path.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// For the path that begins now, or continues after a stop: follows the master of its move, if there is one. `number`:
// of the move.
void BeginFollowing(const Context& c, const Request& move, std::uint64_t number, State& s) noexcept;
// Returns true if the motion, at its present position, follows a master.
bool Follows(const Context& c, const State& s) noexcept;
// Returns the path speed that brings the tool to the position that the master demands [mm/s]. Once per cycle.
double WishOfMaster(const Context& c, State& s) noexcept;
// Updates MasterState::in_step; the path stops following after the move.
void WatchMaster(const Context& c, State& s) noexcept;

ErrorId Sync(const Context& c, Ticket ticket, const SyncAxis& command, State& s) noexcept;
// Computes the set points of the axes that follow the path.
void LeadSynced(const Context& c, State& s) noexcept;
void ReleaseSynced(const Context& c, FeedbackState feedback, State& s) noexcept;

}  // namespace takt::group
