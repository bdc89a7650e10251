// A curve of the clutch over the master's displacement, and the master's speed at which the slave can follow it.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/quintic.h"

namespace takt::flexcam {

struct ClutchCurve {
  trajectory::Quintic over;  // over the master's displacement from `begin`, in `sense`
  double begin = 0;          // [master's u] over all turns
  double sense = 1;          // of the master on the curve
  bool closes = true;        // false: it opens the clutch
  double slave_zero = 0;     // zero of the conversion to the slave at the begin: identifies the turn of a rotary slave
  double fastest = 0;        // [master's u/s] largest steady speed at which the slave keeps its limits on the curve
};

// Returns the quintic curve between two states; derivatives of both are over the master's position (not in `sense`).
ClutchCurve MakeCurve(double begin, double length, double sense, bool closes, const KinematicState& from,
                      const KinematicState& to, const trajectory::Limits& slave) noexcept;

// Returns the displacement of the master on the curve; negative before its begin.
inline double On(const ClutchCurve& curve, double master) noexcept {
  return curve.sense * (master - curve.begin);
}
inline double EndOf(const ClutchCurve& curve) noexcept {
  return curve.begin + curve.sense * curve.over.length;
}
// Returns position and derivatives over the master's position.
KinematicState OverMaster(const ClutchCurve& curve, double master) noexcept;

// Returns true if the slave nowhere moves against the master; a slope of zero within rounding is allowed.
bool Monotone(const ClutchCurve& curve) noexcept;
// Returns true if a slave with these limits follows the curve while the master keeps this speed.
inline bool Follows(const ClutchCurve& curve, double master_speed) noexcept {
  return master_speed <= curve.fastest * (1 + 1e-9);
}

// Returns true if peak velocity, acceleration and jerk of a quintic over time are within the limits.
bool Within(const trajectory::Quintic& over_time, const trajectory::Limits& limits) noexcept;

void describe(Description<ClutchCurve>&);

}  // namespace takt::flexcam
