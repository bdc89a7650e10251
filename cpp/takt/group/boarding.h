// Boarding: how a tool at rest gets onto a belt or table that moves.
//
// A move from rest to a pose on such a carrier begins with boarding (TrackingParams::board): a clutch brings the tool
// into sync by a time-optimal profile along the carrier's travel, which may begin ahead of the carrier. The path lies
// on the carrier from its beginning and starts at the same time. What the profile takes of the velocity, acceleration
// and jerk of each coordinate is reserved from the path up to the arc length that the path can have reached when the
// tool is in sync (Boarding::reach). boarding_plan.h chooses the profile. If the carrier changes its velocity
// meanwhile, the path waits until the tool is in sync.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Margin on path speed and arc length that are estimated from the start of the path.
inline constexpr double kReachMargin = 1.2;

// Returns true if the tool may board, from rest, for the move that is planned next: nothing has to be known before it
// moves (workspace, zones, times of a module's moves), and the carrier is steady. Else the path has a transition
// between carrier bindings (carrier_bindings.h).
bool MayBoard(const Context& c, const State& s) noexcept;

// Returns true if it can board now for the move to be joined.
bool CanBoard(const Context& c, const State& s) noexcept;

// Begins boarding; the move is planned anew from there. Returns false, with nothing changed, if no profile keeps the
// limits or the members cannot be controlled.
bool Board(const Context& c, State& s) noexcept;

// Returns the boarding that reserves limits on a stretch; nullptr if there is none.
Boarding* BoardingOn(LookAhead& ahead, const Stretch& stretch) noexcept;

// Boarding::reach is the largest arc length that the raw motion can have reached when the tool is in sync, computed
// from the bounds of the nodes as they are appended. Called at the first node, ...
void BeginReserve(const Context& c, Boarding& boarding) noexcept;
// ... with the last node before the next is appended: returns an upper bound of the arc length of the next; ...
double UpdateReach(const trajectory::PathNode& last, Boarding& boarding) noexcept;
// ... after it was appended, with both; ...
void AdvanceReserve(const Context& c, const trajectory::PathNode& last, const trajectory::PathNode& node,
                    Boarding& boarding) noexcept;
// ... and when the nodes behind `last` are removed.
void CutReserve(const Context& c, const trajectory::PathNode& last, Boarding& boarding) noexcept;
// Returns an upper bound of the path speed until the tool is in sync, estimated from the bounds at a point [mm/s].
double PathSpeedBound(const trajectory::PathPoint& point, const trajectory::CoordinateLimits& limits, double build_up_s,
                      const Boarding& boarding) noexcept;

// Returns true if a tool that boards should come to rest at once for a move onto `carrier` (0: the world): it boards
// another one and is still in the first half of boarding.
bool ShouldAbortBoarding(const Context& c, const State& s, std::uint32_t carrier) noexcept;

// Ends boarding for a move that cannot be carried out with it: the tool stops, then the move is planned from rest with
// a transition between carrier bindings.
void GiveUpBoarding(const Context& c, State& s) noexcept;

}  // namespace takt::group
