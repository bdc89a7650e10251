// Boarding: how a tool at rest gets onto a belt or table that moves.
//
// A move from rest to a place on such a carrier begins with boarding (TrackingParams::board): a clutch moves the tool
// into step by a time-optimal profile along the carrier's travel, which may begin ahead of the carrier. The path lies
// on the carrier from its beginning and starts at the same time. What the profile takes of the velocity, acceleration
// and jerk of each coordinate is reserved from the path up to the place that the path can have reached when the tool is
// in step (Boarding::reach). boarding_plan.h chooses the profile. If the carrier changes its velocity meanwhile, the
// path waits until the tool is in step.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Margin on speed and distance along the path that are estimated from its beginning.
inline constexpr double kReachesFurther = 1.2;

// Whether the tool may board for the move that is planned next, from rest: not where something has to be known before
// the tool moves, nor where the carrier is not steady. Then the path has a transition between rides
// (carrier_bindings.h).
bool MayBoard(const Context& c, const State& s) noexcept;

// Whether it can board now for the move that is to be joined.
bool CanBoard(const Context& c, const State& s) noexcept;

// Begins to board; the move is planned anew from there. False: no profile keeps the limits, or the members cannot be
// controlled; nothing was changed.
bool Board(const Context& c, State& s) noexcept;

// Returns the boarding that reserves limits on a stretch; nullptr if there is none.
Boarding* BoardingOn(LookAhead& ahead, const Stretch& stretch) noexcept;

// Boarding::reach is the arc length that the raw motion reaches at the earliest when the tool is in step, computed from
// the bounds of the nodes as they are appended. Called at the first node, ...
void BeginReserve(const Context& c, Boarding& boarding) noexcept;
// ... with the last node before the next is appended: returns an upper bound for the arc length of that one; ...
double FindReach(const trajectory::PathNode& last, Boarding& boarding) noexcept;
// ... and with both.
void PassNode(const Context& c, const trajectory::PathNode& last, const trajectory::PathNode& node,
              Boarding& boarding) noexcept;
// ... and where the nodes behind one are removed.
void CutReserve(const Context& c, const trajectory::PathNode& last, Boarding& boarding) noexcept;
// Returns an upper bound of the path speed until the tool is in step, estimated from the bounds at a point [mm/s].
double SpeedBesideBoarding(const trajectory::PathPoint& point, const trajectory::CoordinateLimits& limits,
                           double build_up_s, const Boarding& boarding) noexcept;

// Whether a tool that boards another carrier than this one (0: the world) had better come to rest at once.
bool TurnsBack(const Context& c, const State& s, std::uint32_t carrier) noexcept;

// Ends boarding for a move that cannot be carried out that way: the tool stops, then the move is planned from rest with
// a transition between rides.
void GiveUpBoarding(const Context& c, State& s) noexcept;

}  // namespace takt::group
