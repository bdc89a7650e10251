// Joins a stretch to the planned path: with a blend, directly, or after a stop.
#pragma once

#include "takt/group/plan.h"

namespace takt::group {

inline constexpr double kNoEnd = 1e12;  // [mm]

// Appends `ahead.next`, and a blend before it if there is one. Returns the number of inverse kinematics used, about.
int Join(const Context& c, State& s) noexcept;

// The blend that a move, or an element of a path, demands at the corner before it.
struct CornerBlend {
  Stretch stretch;
  double first = 0;           // [mm] from the corner back to its start ...
  double second = 0;          // ... and from the corner on to its end
  double reach = 0;           // [mm] largest value of both ...
  double deviation = kNoEnd;  // ... and of the distance from the lines to the blend
  bool to_middle = false;     // it reaches the middle of one of the lines
};
// Returns false if there is no blend. Depends on nothing but the arguments, the limits in `ahead.window` and the axes
// at the corner, in `ahead.end_joints`: the blend that was checked is the one that is executed, except for chords of a
// curve, whose blends are made again from middle to middle. Where paths are checked this is done only for chords no
// longer than the margin: there it makes less than that.
bool FindBlend(const Context& c, const State& s, const Request& move, std::uint32_t element, const Stretch& before,
               const Stretch& after, int& work, CornerBlend& out) noexcept;

}  // namespace takt::group
