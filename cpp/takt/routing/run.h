// One run: a straight motion from rest to rest, jerk-limited and time-optimal, with the same limit for accelerating and
// braking. Closed form: jerk, constant acceleration, jerk, constant velocity, and the mirror image of that.
#pragma once

#include <array>

namespace takt::routing {

struct Dynamics {
  double velocity = 0;      // mm/s
  double acceleration = 0;  // mm/s², of braking, too
  double jerk = 0;          // mm/s³
};

class StraightRun {
 public:
  // Requires: length [mm] >= 0, all dynamics above 0.
  StraightRun(double length, const Dynamics& dynamics) noexcept;

  double length() const noexcept { return length_; }
  double duration() const noexcept { return duration_; }  // s

  // Returns the distance [mm] from its start after t [s].
  double At(double t) const noexcept;
  // Returns where [mm] it would come to rest if it braked as hard as it may from t [s] on; never beyond its length.
  double StopAt(double t) const noexcept;
  // Returns when [s] it has gone s [mm].
  double TimeAt(double s) const noexcept;
  // Returns the last time [s] at which it could still come to rest within s [mm].
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
