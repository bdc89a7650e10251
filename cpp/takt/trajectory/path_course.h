// The reference motion and the limits for PathPlanner, for a path given by the nodes of a window.
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

// Returns the index of the last node at or before an arc length [mm], searching from `from` on.
std::uint64_t NodeAt(const PathWindow& window, std::uint64_t from, double place) noexcept;

// Returns the index of the first node from `from` on at which the motion stops, or of the last known node.
std::uint64_t StopBehind(const PathWindow& window, std::uint64_t from) noexcept;

// Returns the limits along the path, reduced to `share` of what the coordinates' limits allow without the effect of
// bends.
AlongPath LimitsAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept;

// Returns the largest share of a limit used by the velocity, acceleration and jerk of any coordinate or by the velocity
// along the path. `node`: the one at or before the position.
double UseOf(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept;

// Shares of the coordinates' jerk where a joint is passed: for the step of accelerations in that cycle, and for the
// jerk of the motion itself meanwhile. The rest is a margin for set points: the step falls within a cycle, and
// velocities have to fit, too.
inline constexpr double kStepAtJoint = 0.4, kJerkAtJoint = 0.5;
// The same for jerk only.
double JerkUse(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept;

// Allocates only in the constructor.
class PathCourse {
 public:
  PathCourse(std::size_t intervals, double period_s);

  // In the cycle: copies what is needed of the window: a path from `begin`, behind `node`, to rest at the node `end` or
  // before. `factor`: speed factor along the path, above 0. Returns false if there is no distance to it.
  bool Take(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
            double factor) noexcept;
  // In the cycle, after Take: copies a plan of another course in which the motion is at `begin` at the time `from_s`
  // [s]. See Make.
  void Follow(const PathCourse& other, const PathPlan& plan, double from_s) noexcept;
  // Computes the reference; may run in another thread than Take once that has returned. If the intervals do not suffice
  // the reference ends at rest at an earlier node. Returns false if no reference is found.
  // `share`: share of the acceleration and jerk limits that the reference uses, above 0 to 1. From a motion in progress
  // a small one often finds a plan where 1 does not.
  // `follow`: the reference begins with the plan copied by Follow, which is within the limits, until that brakes to its
  // end.
  bool Make(Planner& planner, double share = 1, bool follow = false) noexcept;
  // Valid after Make. follows: returns true if there is a plan copied by Follow. IsSlower: returns true if `plan`, a
  // plan of this course, needs more than `share` times the time that the plan copied by Follow takes until it brakes to
  // its end.
  bool follows() const noexcept { return !followed_.empty(); }
  bool IsSlower(const PathPlan& plan, double share) const noexcept;

  // Takes a plan of another course as the reference: close to the optimum the intervals lie where they are needed.
  // Returns false if they do not suffice.
  bool Make(const PathCourse& other, const PathPlan& plan) noexcept;

  // Returns the request for PathPlanner; it refers to this course.
  PathPlanRequest Request() const noexcept;
  // Returns the state along the path for this state of the reference time.
  KinematicState At(const ReferenceState& reference) const noexcept;
  double duration() const noexcept { return steps_.back().begin_s + steps_.back().length; }  // of the reference [s]
  double end_place() const noexcept { return end_place_; }  // arc length at which it ends at rest [mm]

 private:
  // An interval of the reference.
  struct Step : Quintic {
    double begin_s = 0;  // reference time [s]
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
    double uneased = 0;  // speed before it was lowered [mm/s] ...
    double use = 0;      // ... because of this share of a limit; 0: not lowered yet
    bool stays = false;  // not lowered any more
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
  // State at which the reference leaves the plan copied by Follow; its start if it does not follow one.
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
  std::vector<PathNode> nodes_;  // copied from the window
  CoordinateLimits coordinates_;
  KinematicState begin_;
  std::vector<Step> other_steps_;  // of the course given to Follow; empty: none
  PathPlan other_plan_;
  double other_from_s_ = 0;
  std::vector<Followed> followed_;  // knots of the plan given to Follow
  std::size_t joint_ = 0;           // the reference follows this many of them
  double factor_ = 1;
  double share_ = 1;
  double end_place_ = 0;
  std::size_t end_ = 0;  // node at end_place_
  std::vector<Step> steps_;
  std::vector<double> lengths_;
  std::vector<RateLimits> limits_, first_limits_;
  std::vector<std::size_t> of_;  // index of the coordinate of limits_[i + 1]
  std::vector<ReferenceRate> rates_;
  std::vector<Slow> slow_;
  std::vector<double> square_;  // squared speed limit at each node [mm²/s²]
  // Squared speed that the step of the second slopes at a joint allows; may be the speed limit.
  std::vector<double> joints_;
  std::vector<Knot> knots_;
  std::vector<double> turns_;  // jerk step at each node at that speed, as a share of the jerk limit
};

}  // namespace takt::trajectory
