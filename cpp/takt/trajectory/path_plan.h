// A plan of PathPlanner: the rate at which a reference time passes, R(t) = (dt/dtime)², a quadratic spline.
#pragma once

#include <cstddef>
#include <vector>

namespace takt::trajectory {

// How fast the reference time passes at an end of a plan.
struct ReferencePace {
  double square = 1;  // R > 0
  double slope = 0;   // R' / 2 [1/s]
};

// A place on a plan: the reference time and its derivatives by time.
struct ReferenceState {
  double time = 0;          // reference time [s]
  double rate = 0;          // 1
  double acceleration = 0;  // 1/s
  double jerk = 0;          // 1/s²
};

// A plan: R at the knots, quadratic between them. Evaluation is pure.
class PathPlan {
 public:
  explicit PathPlan(std::size_t intervals) : knots_(intervals + 1) {}

  double duration() const noexcept { return count_ > 0 ? knots_[count_ - 1].at_s : 0; }  // s
  std::size_t intervals() const noexcept { return count_ > 0 ? count_ - 1 : 0; }
  // The pace at a knot, to go on from there with another plan.
  ReferencePace pace(std::size_t knot) const noexcept { return {knots_[knot].square, knots_[knot].slope}; }
  double knot_time(std::size_t knot) const noexcept { return knots_[knot].at_s; }  // s from the beginning
  // At `time_s` from the beginning; before it and behind the end what is there, at the ends exactly.
  ReferenceState At(double time_s) const noexcept;
  // Of an interval at `share` (0 to 1) of its length.
  ReferenceState Within(std::size_t interval, double share) const noexcept;

 private:
  friend class PathPlanner;
  struct Knot {
    double reference_s = 0;
    double at_s = 0;
    double square = 0;
    double slope = 0;
    double bend = 0;  // of the slope, up to the next knot
  };
  std::vector<Knot> knots_;
  std::size_t count_ = 0;
};

// Returns the time over an interval of the reference time [s] with these squared rates at its ends and this bend of the
// slope between them.
double IntervalDuration(double length, double before, double after, double bend) noexcept;

}  // namespace takt::trajectory
