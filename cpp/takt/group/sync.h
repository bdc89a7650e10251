// Paths that follow a master, and axes that follow a path.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// The path that begins now, or goes on behind a stop, follows the master of its move, or nobody. `number` is the
// move's.
void BeginFollowing(const Context& c, const Request& move, std::uint64_t number, State& s) noexcept;
// Whether the motion, where it has got to, is one that follows a master.
bool Follows(const Context& c, const State& s) noexcept;
// The speed along the path with which the tool is where the master wants it, mm/s. Once a cycle.
double WishOfMaster(const Context& c, State& s) noexcept;
// Whether it is there; what comes behind that move does not follow.
void WatchMaster(const Context& c, State& s) noexcept;

ErrorId Sync(const Context& c, Ticket ticket, const SyncAxis& command, State& s) noexcept;
// Set points of the axes that follow the path.
void LeadSynced(const Context& c, State& s) noexcept;
void LetGoOfSynced(const Context& c, FeedbackState feedback, State& s) noexcept;

}  // namespace takt::group
