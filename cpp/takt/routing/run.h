// A run: a straight motion from rest to rest, jerk-limited and time-optimal, with the same limit for acceleration and
// deceleration. Closed form: jerk, constant acceleration, jerk, constant velocity, and the mirror image of the ramp.
#pragma once

#include <array>

namespace takt::routing {

struct Dynamics {
  double velocity = 0;      // [mm/s]
  double acceleration = 0;  // [mm/s²] also of braking
  double jerk = 0;          // [mm/s³]
};

class StraightRun {
 public:
  // Requires: length [mm] >= 0, all dynamics above 0.
  StraightRun(double length, const Dynamics& dynamics) noexcept;

  double length() const noexcept { return length_; }
  double duration() const noexcept { return duration_; }  // [s]

  // Returns the distance [mm] from the start after t [s].
  double At(double t) const noexcept;
  // Returns the position [mm] at which a stop with the maximum dynamics from t [s] on would end; never beyond the
  // length.
  double StopAt(double t) const noexcept;
  // Returns the time [s] at which the distance s [mm] is covered.
  double TimeAt(double s) const noexcept;
  // Returns the last time [s] from which a stop would still end within s [mm].
  double LastStopWithin(double s) const noexcept;

 private:
  struct Motion {
    double s = 0, v = 0, a = 0;
  };
  Motion MotionAt(double t) const noexcept;

  double length_, duration_ = 0;
  Dynamics dynamics_;
  double jerk_time_ = 0, constant_time_ = 0, cruise_time_ = 0;
};

}  // namespace takt::routing
