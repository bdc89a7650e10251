// A tool that is braked on a carrier rises meanwhile, away from its path (PP-61): bends leave little to brake with, and
// the path leads down.
//
// The tool is offset from its path along Z of what it is carried by. The offset grows until the tool will rest as high
// as it is to be; it never shrinks. It ends where the tool sits down on the carrier (Sit), as high as it is then.
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/limits.h"

namespace takt::group {

// Begins with a motion that is braked in step (State::ends, not lets_go). `height`: of the tool in the end, in the
// coordinate system of the object that carries it, mm.
void BeginRise(const trajectory::Limits& limits, double height, State& s) noexcept;
// The tool on its path becomes that which has risen, a cycle later.
void StepRise(const Context& c, const Stretch& stretch, kinematics::MovingFrame& tool, State& s) noexcept;
// The offset is at rest, or there is none.
bool RiseStands(const State& s) noexcept;

}  // namespace takt::group
