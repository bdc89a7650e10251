// Moving along what is planned.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Puts the group in control of its members. An error: a member cannot be.
ErrorId TakeMembers(const Context& c, State& s) noexcept;
void LetGoOfMembers(const Context& c, State& s) noexcept;

// Returns whether PathTiming can time a move: it is not carried and follows no master.
bool IsTimed(const Context& c, const Request& move, const Stretch& stretch) noexcept;
// At rest, before a motion: starts PathTiming if the group plans ahead and all before the next stop is such.
void BeginTiming(const Context& c, State& s) noexcept;

// The next set points of the members; ends moves that are over. False: the axes cannot be there, nothing was set.
bool Advance(const Context& c, State& s) noexcept;

// At rest at the end of what is known of the path.
bool StandsAtEnd(const Context& c, const State& s) noexcept;

// At rest, with everything ended: nothing to do but what waits in the queue.
bool Rests(const State& s) noexcept;

// Comes to rest on the path, which is then forgotten. mm/s²; 0: as the path says.
void EndMotion(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept;

// The same wherever it has got to with that: what is only planned is forgotten at once.
void GiveUpPath(const Context& c, const Brake& brake, bool lets_go, State& s) noexcept;

// Along the path, where it comes to rest at the furthest if it is braked from now on.
double RestAt(const Context& c, const State& s) noexcept;

// The stretch that the tool is on; null: none.
const Stretch* Here(const Context& c, const State& s) noexcept;
// Something that moves carries the tool, or takes part in it.
bool IsOnRide(const Context& c, const State& s) noexcept;
// It goes over from one ride to another.
bool IsBetweenRides(const Context& c, const State& s) noexcept;
// Sits down, where it stands, on a carrier whose travel is `travel` [mm or rad] as far as the tool is concerned.
// Returns the clutch between them, which is not coupled.
Clutch& SitDown(const Context& c, const CarriedTarget& cargo, double travel, State& s) noexcept;
// Forgets the path and stays where it is on the ride.
void Sit(const Context& c, State& s) noexcept;
// The same on another ride, at a place of its still world.
void SitOn(const Context& c, const CarrierBinding& ride, const path::Point& place, State& s) noexcept;

}  // namespace takt::group
