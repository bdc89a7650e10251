// A path as PathPlanner gets to see it: a reference motion along the nodes of a window, and the limits on the way.
//
// The reference goes from one slow place of the path to the next as fast as one motion with the limits that hold
// between them in the mean; at a slow place it has the speed that bends allow there, and no acceleration. So it is
// nearly what the plan will be, and needs few intervals. It need not keep any limit.
#pragma once

#include <vector>

#include "takt/trajectory/path_planner.h"
#include "takt/trajectory/path_window.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/quintic.h"

namespace takt::trajectory {

// The node of a window that a place lies on or behind, from `from` on.
std::uint64_t NodeAt(const PathWindow& window, std::uint64_t from, double place) noexcept;

// The first node from `from` on at which the motion stops, or the last one known.
std::uint64_t StopBehind(const PathWindow& window, std::uint64_t from) noexcept;

// Velocity, acceleration and jerk of all coordinates, as shares of their limits; `node` is where the place lies.
double UseOf(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept;

// Takes memory only when it is made.
class PathCourse {
 public:
  explicit PathCourse(std::size_t intervals);

  // From `begin` on, which lies behind `node`, to rest at `end` or, where that takes more than `most` intervals, at a
  // node before. `factor`: of the speed along the path. False: there is no such reference.
  bool Make(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end, double factor,
            std::size_t most, Planner& planner) noexcept;

  // What to plan; it refers to this course.
  PathPlanRequest Request() const noexcept;
  // Along the path, where the reference time passes so.
  KinematicState At(const ReferenceState& reference) const noexcept;
  double end_place() const noexcept { return end_place_; }  // mm along the path, where it rests
  std::size_t coordinates() const noexcept { return limits_.size(); }
  std::size_t intervals() const noexcept { return steps_.size(); }

 private:
  // An interval of the reference.
  struct Step : Quintic {
    double begin_s = 0;  // reference time
    std::uint64_t node = 0;
  };
  struct Knot {
    double at_s = 0;
    double turn = 0;
  };
  struct Slow {
    std::uint64_t node = 0;
    double place = 0;
    double speed = 0;
  };

  void FindSlow(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
                double factor) noexcept;
  void MakeReachable(const PathWindow& window, const KinematicState& begin) noexcept;
  trajectory::Limits Between(const PathWindow& window, const Slow& from, const Slow& to) const noexcept;
  bool Cut(const PathWindow& window, const Slow& from, const Slow& to, const Profile& profile,
           double longest_s) noexcept;
  void Add(const PathWindow& window, const KinematicState& from, const KinematicState& to, double length_s) noexcept;
  enum class Laid : std::uint8_t { kWhole, kNoRoom, kTooNear };
  Laid Lay(const PathWindow& window, const KinematicState& begin, double of_build_up, Planner& planner) noexcept;
  bool Ease() noexcept;
  void SetLimits(const PathWindow& window, std::uint64_t node, std::uint64_t end) noexcept;
  void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const noexcept;

  std::vector<PathNode> nodes_;  // of the window, from `first_node_` on
  std::uint64_t first_node_ = 0;
  std::size_t most_ = 0;
  double factor_ = 1;
  double end_place_ = 0;
  bool begins_at_rest_ = false, brakes_ = false;
  std::vector<Step> steps_;
  std::vector<double> lengths_;
  std::vector<RateLimits> limits_, first_limits_;
  std::vector<std::size_t> of_;  // the coordinate of the window behind each of these but the first
  std::vector<ReferenceRate> rates_;
  std::vector<Slow> slow_;
  std::vector<double> square_;  // of the largest speed at each node
  std::vector<Knot> knots_;
  std::vector<double> turns_;  // share of jerk that steps there, at that speed
};

}  // namespace takt::trajectory
