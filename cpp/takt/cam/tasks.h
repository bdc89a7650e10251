// Laws of motion between any velocities and accelerations at both ends: the motion tasks of VDI 2143 (rest, velocity,
// reversal and motion, in all combinations).
//
// Polynomials: those of degree 5 meet position, velocity and acceleration at both ends; degree 7 also jerk 0 there;
// degree 8 also acceleration 0 at the inflection.
//
// Laws with sines (modified sine, modified trapezoid, cycloid, sine-constant-cosine): their acceleration is a pulse
// before the inflection and the mirrored pulse after it, each with its own height, plus the accelerations at the ends,
// which fall linearly to 0 at the inflection. The two heights follow from the velocity and the position at the end, two
// linear equations. From rest to rest with the inflection in the middle this is the law of the textbooks. Ours; the
// inflection makes it asymmetric.
#pragma once

#include <vector>

#include "takt/cam/curve.h"
#include "takt/cam/laws.h"

namespace takt::cam {

struct Task {
  double length = 0;  // [x]
  Value begin, end;   // y, dy, ddy
  double inflection = 0.5;
  double sine_share = 0.25;  // sine-constant-cosine combination only
  double cosine_share = 0.5;
};

// Returns true if the law connects any velocities and accelerations.
bool ConnectsAny(Law law) noexcept;
// Returns true if it takes velocities and accelerations that are not given from the neighbours.
bool HasFreeEnds(Law law) noexcept;
// Returns the law that a segment is made with: itself, or the one that it selects (task, least_acceleration,
// least_jerk).
Law Resolved(Law law, const Task& task);
// Returns the pieces over the distance from the beginning. Requires: ConnectsAny(law), and a law from Resolved.
std::vector<LawPiece> PiecesOf(Law law, const Task& task);

}  // namespace takt::cam
