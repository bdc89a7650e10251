// The reference motion and the limits that PathPlanner needs, for a path given by the nodes of a window.
//
// The reference is a sequence of time-optimal profiles between slow nodes, each with the mean limits between its ends.
// At a slow node its speed is what the bends allow there and its acceleration is 0. It is close to the plan, so few
// intervals suffice, and it need not keep any limit. (Ours.)
#pragma once

#include <vector>

#include "takt/trajectory/path_planner.h"
#include "takt/trajectory/path_window.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/quintic.h"

namespace takt::trajectory {

// Returns the last node at or before an arc length, from `from` on.
std::uint64_t NodeAt(const PathWindow& window, std::uint64_t from, double place) noexcept;

// Returns the first node from `from` on at which the motion stops, or the last known one.
std::uint64_t StopBehind(const PathWindow& window, std::uint64_t from) noexcept;

// Returns the limits along the path, with `share` of what the coordinates allow where it does not bend.
AlongPath LimitsAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept;

// Returns the largest share of a limit that velocity, acceleration and jerk of any coordinate use; `node`: the one at
// or before the position.
double UseOf(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept;

// Shares of the jerk of coordinates where a joint is passed: what accelerations step by in that cycle, and what the
// motion uses meanwhile. The rest is for set points: the step comes within a cycle, and velocities are to fit, too.
inline constexpr double kStepAtJoint = 0.4, kJerkAtJoint = 0.5;
// The share of jerk alone.
double JerkUse(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept;

// Allocates only in the constructor.
class PathCourse {
 public:
  PathCourse(std::size_t intervals, double period_s);

  // Copies what is needed of the window, for the cycle: a path from `begin`, behind `node`, to rest at the node `end`
  // or before. `factor`: of the speed along the path, above 0. Returns false if there is no distance to it.
  bool Take(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
            double factor) noexcept;
  // Copies a plan of another course, for the cycle, after Take: in it the motion is at `begin` at `from_s`. See Make.
  void Follow(const PathCourse& other, const PathPlan& plan, double from_s) noexcept;
  // Computes the reference; in another thread than Take if that has returned. If the intervals do not suffice it ends
  // at rest at an earlier node. Returns false if there is none.
  // `share`: of the limits of acceleration and jerk, used by the reference, above 0 to 1. A plan from a motion is found
  // more often with a small one.
  // `follow`: the reference is the plan of Follow at first, until that brakes to its end: it is within the limits.
  bool Make(Planner& planner, double share = 1, bool follow = false) noexcept;
  // Of the last Make: whether there is such a plan, and whether a plan of this course takes more than `share` of its
  // time until it brakes to its end.
  bool follows() const noexcept { return !followed_.empty(); }
  bool IsSlower(const PathPlan& plan, double share) const noexcept;

  // Takes a plan of another course as the reference: near to the optimum intervals lie where they are needed. Returns
  // false if they do not suffice.
  bool Make(const PathCourse& other, const PathPlan& plan) noexcept;

  // Returns what to plan; refers to this course.
  PathPlanRequest Request() const noexcept;
  // Returns the state along the path where the reference time passes so.
  KinematicState At(const ReferenceState& reference) const noexcept;
  double duration() const noexcept { return steps_.back().begin_s + steps_.back().length; }  // of the reference [s]
  double end_place() const noexcept { return end_place_; }  // arc length at which it rests [mm]

 private:
  // An interval of the reference.
  struct Step : Quintic {
    double begin_s = 0;  // reference time
    std::size_t node = 0;
  };
  struct Knot {
    double at_s = 0;
    double turn = 0;
  };
  struct Slow {
    std::size_t node = 0;
    double place = 0;
    double speed = 0;
    double uneased = 0;  // speed before it was made slower, for ...
    double use = 0;      // ... this share of a limit; 0: it was not
    bool stays = false;  // it is not made slower any more
  };
  struct Followed {
    double length_s = 0;  // of the interval before it
    KinematicState state;
  };
  enum class Laid : std::uint8_t { kWhole, kNoRoom, kTooNear };

  std::size_t NodeAt(std::size_t from, double place) const noexcept;
  static KinematicState At(const std::vector<Step>& steps, const ReferenceState& reference) noexcept;
  void Sample() noexcept;
  std::size_t FindJoint() const noexcept;
  // Where the reference leaves the plan of Follow, which is where it begins if there is none.
  const KinematicState& Joint() const noexcept { return joint_ == 0 ? begin_ : followed_[joint_ - 1].state; }
  void FindSlow(const KinematicState& begin, std::size_t end) noexcept;
  void MakeReachable(const KinematicState& begin) noexcept;
  Limits Between(const Slow& from, const Slow& to) const noexcept;
  Laid Lay(double of_build_up, Planner& planner) noexcept;
  bool Cut(const Slow& from, const Slow& to, const Profile& profile, double longest_s) noexcept;
  void Add(const KinematicState& from, const KinematicState& to, double length_s) noexcept;
  void Grade() noexcept;
  bool Ease() noexcept;
  void SetLimits(std::size_t end) noexcept;
  void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const noexcept;

  double period_s_;
  std::vector<PathNode> nodes_;  // of the window
  CoordinateLimits coordinates_;
  KinematicState begin_;
  std::vector<Step> other_steps_;  // of Follow; empty: none
  PathPlan other_plan_;
  double other_from_s_ = 0;
  std::vector<Followed> followed_;  // the knots of that plan
  std::size_t joint_ = 0;           // so many of them are knots of the reference
  double factor_ = 1;
  double share_ = 1;
  double end_place_ = 0;
  std::size_t end_ = 0;  // node there
  std::vector<Step> steps_;
  std::vector<double> lengths_;
  std::vector<RateLimits> limits_, first_limits_;
  std::vector<std::size_t> of_;  // coordinate of limits_[i + 1]
  std::vector<ReferenceRate> rates_;
  std::vector<Slow> slow_;
  std::vector<double> square_;  // of the largest speed at each node
  std::vector<double> joints_;  // of what a step of the second slopes at each node allows; it may be the largest speed
  std::vector<Knot> knots_;
  std::vector<double> turns_;  // share of the jerk limit that steps at each node, at that speed
};

}  // namespace takt::trajectory
