// Between what carries the tool and the tool: clutches along the travel of a carrier.
//
// A tool that rides goes with its carrier exactly. To stop in the machine's own space it lets go: what it takes for the
// carrier's travel is braked to rest within limits, while the carrier goes on. Taken along again, that travel catches
// up with the carrier's, as seen from the carrier, and from then on is the carrier's own, bit for bit; where the
// group's limits come first (AfterSync::kLimited) it chases it (trajectory/demand_follower.h). The path between keeps
// its shape and its place on the object.
#pragma once

#include "takt/group/carrier_bindings.h"

namespace takt::group {

// Each clutch of the stretch that the tool is on goes on by a cycle: along, or to rest (State::lets_go).
void StepClutches(const Context& c, const Stretch& stretch, State& s) noexcept;

// It goes along with something that has no travel of its own to be braked: to let go of it is to let go of the axes.
bool RidesFreely(const Context& c, const State& s) noexcept;

// The tool is not where its carriers are, and comes after them.
bool Slips(const State& s) noexcept;
// The same, and the path waits for that.
bool WaitsForClutch(const State& s) noexcept;
// The way into step, seen from a carrier at this constant velocity, from so far apart: of a tool that boards.
Status ComeAboard(trajectory::Planner& planner, double velocity, const trajectory::Limits& limits,
                  const KinematicState& apart, trajectory::Profile& out) noexcept;
// Nothing that was let go of moves on.
bool ClutchesStand(const State& s) noexcept;

// Of what can be braked with: path and carriers share it while both come to rest at once, so that the tool stays on its
// path. Not where that is not gone on with: then axes may come late.
double BrakeShare(const State& s) noexcept;

// The tool at a place of a stretch when all that carries it has come to rest, braked from the next cycle on.
MovingFrame ToolBraked(const Context& c, const State& s, const Stretch& stretch, double way) noexcept;

// Whether the tool could still be braked within what the axes reach, path and carriers at once, and the axes could move
// it there as fast as its carriers do now; s.reason if not.
bool CanLetGo(const Context& c, State& s) noexcept;

// A tool that goes along: so far ahead, s.
inline constexpr double kAhead_s = 0.15;

// What the travel of a carrier may do so that group and axes keep their limits, at a place of a stretch, from a travel
// to some distance on.
trajectory::Limits LimitsAlong(const Context& c, const State& s, const Stretch& stretch, double way, std::uint64_t ride,
                               const KinematicState& from, double distance) noexcept;
void SetLimits(const trajectory::Limits& limits, Clutch& clutch) noexcept;

}  // namespace takt::group
