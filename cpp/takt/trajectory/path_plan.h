// A plan of PathPlanner: the rate at which a reference time passes, R(t) = (dt/dtime)², a quadratic spline.
#pragma once

#include <cstddef>
#include <vector>

namespace takt::trajectory {

// The rate of the reference time at an end of a plan.
struct ReferencePace {
  double square = 1;  // R > 0
  double slope = 0;   // R' / 2 [1/s]
};

// A point of a plan: the reference time and its derivatives by time.
struct ReferenceState {
  double time = 0;          // reference time [s]
  double rate = 0;          // [1]
  double acceleration = 0;  // [1/s]
  double jerk = 0;          // [1/s²]
};

// A plan: R at the knots, quadratic between them. Evaluation is pure.
class PathPlan {
 public:
  explicit PathPlan(std::size_t intervals) : knots_(intervals + 1) {}

  double duration() const noexcept { return count_ > 0 ? knots_[count_ - 1].at_s : 0; }  // [s]
  std::size_t intervals() const noexcept { return count_ > 0 ? count_ - 1 : 0; }
  // Returns the pace at a knot, from which another plan can continue.
  ReferencePace pace(std::size_t knot) const noexcept { return {knots_[knot].square, knots_[knot].slope}; }
  double knot_time(std::size_t knot) const noexcept { return knots_[knot].at_s; }  // [s] from the beginning
  // Returns the state at `time_s` from the beginning; outside of the plan, the state at the nearer end, exactly.
  ReferenceState At(double time_s) const noexcept;
  // Returns the state within an interval, at `share` (0 to 1) of its length in reference time.
  ReferenceState Within(std::size_t interval, double share) const noexcept;

 private:
  friend class PathPlanner;
  struct Knot {
    double reference_s = 0;
    double at_s = 0;
    double square = 0;
    double slope = 0;
    double bend = 0;  // derivative of the slope by the reference time, constant up to the next knot
  };
  std::vector<Knot> knots_;
  std::size_t count_ = 0;
};

// Returns the duration [s] of an interval of `length` [s] in reference time, with these squared rates at its ends and
// this derivative of the slope (bend) in between.
double IntervalDuration(double length, double before, double after, double bend) noexcept;

}  // namespace takt::trajectory
