// Timing of a motion along the nodes of a window by timing laws, each known from its start to rest.
//
// Invariant: at any time one law is in force that keeps all limits and ends at rest on the path; planning only ever
// replaces it by another one with this property. From rest a bridge starts at once if the path is straight there: one
// jerk-limited motion to rest before the first bend; where no plan was found from this rest, also over bends, at most
// as fast as the slowest of its nodes. Meanwhile a time-optimal plan (PathPlanner) is computed outside the cycle, from
// a state that the law in force will reach; it takes over at that instant if it is verified and in time; otherwise it
// is dropped and ordered again. Longer paths and other speed factors come into force in the same way; the motion behind
// a stop is planned before the law in force ends there. Braking is one jerk-limited motion, verified over all nodes
// ahead, replaced by a harder one as soon as one is found; if none is found, because the path bends, the law in force
// stays. If no plan is found for a lower speed factor the motion also brakes, until there is one. (Ours.)
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "takt/trajectory/path_course.h"
#include "takt/trajectory/path_pace.h"

namespace takt::trajectory {

// Allocates only in the constructor; the same calls give the same bits.
class PathTiming {
 public:
  explicit PathTiming(double period_s);

  bool active() const noexcept { return active_; }
  void Clear() noexcept;
  // Requires: the motion is at rest at `pace.now`, at or behind `pace.node`.
  void Begin(const PathPace& pace) noexcept;

  // One cycle: updates now, raw, node, passed, entered and raw_stands of `pace`. `factor` in (0, 1]: speed factor along
  // the path. Requires: active(); for a factor of 0 call Stop.
  void Advance(const PathWindow& window, double factor, PathPace& pace) noexcept;
  // One cycle, braking to rest.
  void Stop(const PathWindow& window, const PathBrake& brake, PathPace& pace) noexcept;
  // Orders a plan if one is needed.
  void Ask(const PathWindow& window, double factor, const PathPace& pace) noexcept;
  // Outside the cycle, in one thread: computes the ordered plan. Returns its number for TakePlan; nothing if none is
  // ordered.
  std::optional<std::uint64_t> MakePlan() noexcept;
  // In the same thread: the number could not be passed on; MakePlan will return it again.
  void RepeatPlan() noexcept;
  // In the cycle: the plan with this number has been computed (in a replay it is computed here).
  void TakePlan(std::uint64_t number) noexcept;

  // The path behind an arc length [mm] is about to change: makes the motion come to rest there at the latest. Returns
  // false, with nothing changed, if it cannot.
  bool StopBefore(const PathWindow& window, double place, const PathPace& pace) noexcept;

  // Returns an estimate of the arc length [mm] at which braking from now on ends, exact while it brakes; not a bound:
  // over bends braking may be softer.
  double EstimatedStop(const PathWindow& window, const PathPace& pace) const noexcept;
  double rest_place() const noexcept {
    return current_.EndArcLength();
  }                                // arc length at which the law in force ends [mm]
  double rest_s() const noexcept;  // time until the law in force ends [s]
  std::uint64_t rest_cycles() const noexcept;
  // Returns true if the law in force leads to an arc length [mm] and no faster law is to come.
  bool IsFinalTo(double place) const noexcept;

 private:
  struct Law {
    explicit Law(double period_s) : course(kIntervals, period_s) {}

    std::uint64_t begin = 0;  // tick
    double begin_place = 0;   // arc length at which a plan begins [mm]
    bool planned = false;
    Profile profile = {};
    PathCourse course;
    PathPlan plan{kIntervals};
    // Time from which `tail` replaces the rest of the law.
    double tail_s = std::numeric_limits<double>::infinity();
    Profile tail = {};
    double factor = 1;

    double Duration() const noexcept;
    double EndArcLength() const noexcept;
    KinematicState At(double t) const noexcept;
  };
  static constexpr std::size_t kIntervals = 256;

  KinematicState StateAt(std::uint64_t tick) const noexcept;
  bool Holds(const PathWindow& window, std::uint64_t node, const Profile& profile, double within) const noexcept;
  bool Bridge(const PathWindow& window, double factor, bool slowly, const PathPace& pace) noexcept;
  bool Brake(const PathWindow& window, const PathBrake& brake, double least, const PathPace& pace) noexcept;
  bool EndsSooner() const noexcept;
  void Take(const Profile& profile, double factor) noexcept;
  void Go(const PathWindow& window, PathPace& pace) noexcept;
  std::uint64_t Lead() const noexcept;
  bool Order(const PathWindow& window, double factor, const PathPace& pace) noexcept;
  bool OrderFrom(const PathWindow& window, std::uint64_t node, const KinematicState& begin, double factor) noexcept;
  void OrderBehind(const PathWindow& window, std::uint64_t stop, double factor) noexcept;
  void DropPlan() noexcept;
  void KeepPlanTo(double place) noexcept;

  double period_s_;
  Planner planner_;
  // While a plan is ordered next_ belongs to the thread that computes it.
  enum class OrderState : std::uint8_t { kNone, kOrdered, kMade };
  struct PlanWorker {
    explicit PlanWorker(double period_s) : course(kIntervals, period_s) {}

    Planner profiles;
    PathPlanner planner{kIntervals, kPathCoordinates + 1};
    std::atomic<OrderState> order{OrderState::kNone};
    std::uint64_t number = 0;
    bool urgent = false;
    int refinements = 0;
    PathPlanStatus status = PathPlanStatus::kNoPlan;
    PathCourse course;  // of a refinement
    PathPlan plan{kIntervals};
  };
  std::unique_ptr<PlanWorker> maker_;
  Law current_, next_;
  std::uint64_t tick_ = 0;
  bool active_ = false;
  bool braking_ = false;       // the law in force brakes ...
  bool full_ = false;          // ... as hard as the coordinates can
  bool slows_ = false;         // no plan was found for a lower speed factor: the motion brakes until there is one
  double braked_ = 1;          // share of the limits with which the law in force brakes
  double braked_within_ = 1;   // ... and the largest use of the limits accepted for it where the path bends
  std::uint64_t refused_ = 0;  // cycles in which no motion to rest was found
  std::uint64_t tried_ = 0;    // tick at which a harder braking was last tried
  bool final_ = false;         // no plan would be faster ...
  bool reserved_ = false;      // ... except for the margin that the law in force leaves for a plan that leads further
  bool planning_ = false;      // a plan is ordered ...
  bool dropped_ = false;       // ... and no longer wanted
  bool ready_ = false;         // next_ takes over at its begin ...
  bool behind_ = false;        // ... or with the start of the motion behind the stop ahead
  bool from_rest_ = false;     // next_ begins at rest
  bool no_plan_ = false;       // none was found from the present rest
  double known_to_ = 0;        // arc length up to which the path is as it was when the plan was ordered [mm]
  std::uint64_t ordered_ = 0;  // tick
  std::uint64_t late_ = 0;     // lead of the next order [ticks], because the last plan came too late; 0: the usual lead
  std::uint64_t took_ = 0;     // longest recent time from an order to its plan [ticks]
  std::uint64_t wait_until_ = 0;  // tick before which nothing is ordered
};

}  // namespace takt::trajectory
