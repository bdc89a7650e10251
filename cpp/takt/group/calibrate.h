// Frames from measured points (GR-46); python/takt/calibrate.py is the counterpart outside the engine.
//
// With points also given in the frame: the best fit by least squares (Kabsch, A solution for the best rotation to
// relate two sets of vectors, Acta Crystallographica A32, 1976).
#pragma once

#include <optional>

#include "takt/group/commands.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

struct Calibrated {
  kinematics::Pose pose;  // in the MCS
  double largest = 0;     // [mm] largest residual
};
// Returns nothing if points coincide or lie on one line.
std::optional<Calibrated> FrameOf(const Calibrate& command) noexcept;

}  // namespace takt::group
