// Laws of motion (CAM-02), as curves from (0, 0) to (1, 1).
//
// Parabola, modified trapezoid, modified sine, cycloid and harmonic are members of one family: the acceleration rises
// along a sine over half of the share b of the length, is constant over half of 1 - b - d, falls along a cosine over
// the share d to its opposite, and returns to 0 symmetrically. The sine-constant-cosine combination is that family with
// b and d free.
//
// Peak factors of each law: docs/cams.md.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "takt/cam/curve.h"
#include "takt/core/describe_fwd.h"

namespace takt::cam {

enum class Law : std::uint8_t {
  kDwell,
  kLine,
  kQuintic,  // with velocity and acceleration at both ends
  // From rest to rest.
  kParabola,           // constant acceleration, then constant deceleration
  kModifiedTrapezoid,  // b = 1/4, d = 1/4
  kModifiedSine,       // b = 1/4, d = 3/4
  kCycloid,            // b = 1/2, d = 1/2; inclined sine
  kHarmonic,           // b = 0, d = 1; simple harmonic motion
  kPolynomial345,
  kPolynomial4567,
  kSineConstantCosine,
  kDoubleHarmonic,      // from rest to a reversal, with its acceleration
  kDoubleHarmonicBack,  // from a reversal to rest
  // Between any velocities and accelerations (tasks.h).
  kPolynomial8,
  kTask,               // the law that VDI 2143 recommends for the ends
  kLeastAcceleration,  // of several laws the one with the smallest peak
  kLeastJerk,
};

// A piece of a law: from `begin` to the next piece, or to 1.
struct LawPiece {
  double begin = 0;
  Curve curve;  // over the distance from `begin`
};

// `sine_share` (b) and `cosine_share` (d) are for the sine-constant-cosine combination, both in [0, 1], b + d <= 1.
// Requires: not kDwell. kQuintic is that without velocity and acceleration at the ends.
std::vector<LawPiece> PiecesOf(Law law, double sine_share = 0, double cosine_share = 0);

// Returns true if its acceleration jumps at the ends between dwells.
bool JumpsInAcceleration(Law law, double sine_share) noexcept;

// Largest |y'|, |y''|, |y'''| over the length; the jerk is infinite if the acceleration jumps.
struct PeakFactors {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};
PeakFactors PeakFactorsOf(Law law, double sine_share = 0, double cosine_share = 0);

void describe(Enumeration<Law>&);

}  // namespace takt::cam
