// Executes the motion along the planned path.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Puts the group in control of its members. Returns an error, with none controlled, if a member cannot be.
ErrorId TakeMembers(const Context& c, State& s) noexcept;
void ReleaseMembers(const Context& c, State& s) noexcept;

// Returns true if PathTiming can time a move: it is not carried and follows no master.
bool IsTimed(const Context& c, const Request& move, const Stretch& stretch) noexcept;
// At rest, before a motion: starts PathTiming if the group plans ahead and can time all moves before the next stop.
void BeginTiming(const Context& c, State& s) noexcept;

// Computes the next set points of the members and ends moves that are complete. Returns false, with no set points
// given, if the axes cannot follow.
bool Advance(const Context& c, State& s) noexcept;

// Returns true if the path is at rest at the end of all that is planned.
bool IsAtRestAtEnd(const Context& c, const State& s) noexcept;

// Returns true if the motion is at rest along the path, with the rise, and if carriers are released with their
// clutches.
bool Rests(const State& s) noexcept;

// Brakes to rest on the path, which is then discarded. `lets_go`: releases the carriers, too.
void EndMotion(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept;

// The same in any stage of planning and motion: what is only planned is discarded at once.
void GiveUpPath(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept;

// Returns the arc length of the path at which braking from now on ends at the furthest [mm].
double RestAt(const Context& c, const State& s) noexcept;

// Returns the stretch in execution; null if there is none.
const Stretch* Here(const Context& c, const State& s) noexcept;
// Returns true if a moving carrier carries the tool, fully or in part.
bool IsOnCarrier(const Context& c, const State& s) noexcept;
// Returns true if the tool is changing over between two carrier bindings.
bool IsInTransition(const Context& c, const State& s) noexcept;
// Binds the tool at its present pose to a carrier, with `travel` [mm or rad] as the carrier's travel. Returns the
// clutch between them, which is not coupled.
Clutch& BindAtRest(const Context& c, const CarriedTarget& cargo, double travel, State& s) noexcept;
// Discards the path and keeps the tool where it is on its carrier binding.
void RestOnBinding(const Context& c, State& s) noexcept;
// The same on another binding, at a point in its planning frame.
void RestOn(const Context& c, const CarrierBinding& ride, const path::Point& place, State& s) noexcept;

}  // namespace takt::group
