// Clutches between carriers and the tool, along the travel of a carrier.
//
// A tool that is coupled moves exactly with its carrier. To stop in the MCS it is released: the travel that the clutch
// gives it is braked to rest within limits, while the carrier moves on. Coupled again, that travel catches up with the
// carrier's, in the frame of the carrier, and from then on is the carrier's own, bit for bit; where the group's limits
// come first (AfterSync::kLimited) it follows as a demand (trajectory/demand_follower.h). The path keeps its shape and
// its pose on the object.
#pragma once

#include "takt/group/carrier_bindings.h"

namespace takt::group {

// Advances each clutch of the stretch in execution by a cycle: towards its carrier, or to rest (State::lets_go).
void StepClutches(const Context& c, const Stretch& stretch, State& s) noexcept;

// Returns true if the tool is on a carrier without a travel to be braked (kFree): to release it is to release the axes.
bool IsOnFreeCarrier(const Context& c, const State& s) noexcept;

// Returns true if a clutch is not coupled: the tool lags behind its carrier, or is ahead of it.
bool IsUncoupled(const State& s) noexcept;
// Returns true if the path waits for such a clutch: one that does not board.
bool WaitsForClutch(const State& s) noexcept;
// Plans how the tool gets into sync when it boards, in the frame of a carrier at this constant velocity.
Status ComeAboard(trajectory::Planner& planner, double velocity, const trajectory::Limits& limits,
                  const KinematicState& apart, trajectory::Profile& out) noexcept;
// Returns true if all clutches in use are released and at rest.
bool ClutchesAtRest(const State& s) noexcept;

// Returns the share of the deceleration limits for the path, and for the carriers, while both come to rest at once, so
// that the tool stays on its path. 1 if the path is not continued afterwards: then axes may lag.
double BrakeShare(const State& s) noexcept;

// Returns the tool at `way` of a stretch when its carriers have come to rest, braked from the next cycle on.
MovingFrame ToolBraked(const Context& c, const State& s, const Stretch& stretch, double way) noexcept;

// Returns true if the tool can still be braked within the reach of the axes, path and carriers at once, and the axes
// can move it there as fast as its carriers move now; sets s.reason if not.
bool CanRelease(const Context& c, State& s) noexcept;

// [s] over which the limits of a coupled clutch are computed ahead.
inline constexpr double kAhead_s = 0.15;

// Returns the limits of a carrier's travel that keep the limits of group and axes at `way` of a stretch, over
// `distance` from the travel `from`.
trajectory::Limits LimitsAlong(const Context& c, const State& s, const Stretch& stretch, double way, std::uint64_t ride,
                               const KinematicState& from, double distance) noexcept;
void SetLimits(const trajectory::Limits& limits, Clutch& clutch) noexcept;

}  // namespace takt::group
