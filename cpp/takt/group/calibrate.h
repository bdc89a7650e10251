// Frames from measured places (GR-46), as python/takt/calibrate.py has them outside the engine.
//
// With places seen in the frame: the nearest one by the sum of squares (Kabsch, A solution for the best rotation to
// relate two sets of vectors, Acta Crystallographica A32, 1976).
#pragma once

#include <optional>

#include "takt/group/commands.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

struct Calibrated {
  kinematics::Pose pose;  // in the MCS
  double largest = 0;     // mm, of the residuals
};
// Nothing: the places coincide, or lie on one line.
std::optional<Calibrated> FrameOf(const Calibrate& command) noexcept;

}  // namespace takt::group
