// Offset of a tool that is braked on a carrier away from its path (PP-61): bends leave little deceleration, and the
// path leads down.
//
// The tool is offset from its path along Z of the object that carries it. The offset grows until the tool will come to
// rest at the demanded height; it never shrinks. It ends, at its present height, when the tool comes to rest on the
// carrier (RestOnBinding).
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/limits.h"

namespace takt::group {

// Starts a rise with a motion that is braked while the tool stays on its carrier (State::ends, not lets_go). `height`:
// of the tool at the end, in the coordinate system of the object that carries it [mm].
void BeginRise(const trajectory::Limits& limits, double height, State& s) noexcept;
// Advances the offset by a cycle and adds it to the tool on its path.
void StepRise(const Context& c, const Stretch& stretch, kinematics::MovingFrame& tool, State& s) noexcept;
// Returns true if the offset is at rest or unused.
bool RiseStands(const State& s) noexcept;

}  // namespace takt::group
