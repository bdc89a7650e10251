// Joining a stretch to the path that is planned already: with a blend, as it is, or behind a stop.
#pragma once

#include "takt/group/plan.h"

namespace takt::group {

inline constexpr double kNoEnd = 1e12;  // mm

// Appends `ahead.next`, and a blend before it where there is one. How many inverses of the kinematics that took.
int Join(const Context& c, State& s) noexcept;

// The blend that a move, or an element of a path, asks for at the corner before it.
struct CornerBlend {
  Stretch stretch;
  double first = 0;           // so far before the corner it begins ...
  double second = 0;          // ... and so far behind it ends
  double reach = 0;           // what these may be at most ...
  double deviation = kNoEnd;  // ... and how far from the lines it
  bool to_middle = false;     // of one of the lines
};
// False: there is none. Depends on nothing but the arguments, the limits in `ahead.window` and where the corner is, in
// `ahead.end_joints`: what was checked is what is gone, but for chords of a curve, whose blends are made again from
// middle to middle. Where paths are checked, only chords no longer than the margin are: there it makes less than that.
bool FindBlend(const Context& c, const State& s, const Request& move, std::uint32_t element, const Stretch& before,
               const Stretch& after, int& work, CornerBlend& out) noexcept;

}  // namespace takt::group
