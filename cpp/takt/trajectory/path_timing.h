// Motion along the nodes of a window by laws, each known from its beginning to rest: at any time there is one that ends
// at rest on the path within all limits, whatever becomes of planning.
//
// From rest a bridge begins at once where the path is straight: one jerk-limited motion to rest before it bends.
// Meanwhile a plan as fast as may be (PathPlanner) is made outside the cycle, from a place that the motion is to pass;
// when it is there in time, and verified, it takes over at that place, else it is dropped and asked for again. The same
// brings longer paths and other speeds into force. What has to stop does so by a braking law, verified as well, from
// the instant at which there is one; until then the law in force goes on, which ends at rest, too.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "takt/trajectory/path_brake.h"
#include "takt/trajectory/path_course.h"
#include "takt/trajectory/path_pace.h"

namespace takt::trajectory {

// Takes memory only when it is made; nothing else allocates or throws. The same calls give the same bits.
class PathTiming {
 public:
  explicit PathTiming(double period_s);

  bool active() const noexcept { return active_; }
  void Clear() noexcept;
  // The motion stands at `pace.now`, on `pace.node`.
  void Begin(const PathPace& pace) noexcept;

  // One cycle: fills pace.now, raw, node, passed and raw_stands. `factor`: of the speed along the path, 0 to 1.
  void Advance(const PathWindow& window, double factor, PathPace& pace) noexcept;
  // The same, but it comes to rest as soon as it can.
  void Stop(const PathWindow& window, const PathBrake& brake, PathPace& pace) noexcept;
  // Asks for a plan, where one is wanted.
  void Ask(const PathWindow& window, double factor, const PathPace& pace) noexcept;
  // Outside the cycle, one thread: makes the plan that is asked for; its number, for TakePlan, or nothing.
  std::optional<std::uint64_t> MakePlan() noexcept;
  // In the cycle: a plan is there. What nobody has made yet, in a replay, is made here.
  void TakePlan(std::uint64_t number) noexcept;

  // Whatever lies behind a place becomes another path: the motion is to rest there at the latest until that is known.
  // False: it cannot, nothing has changed.
  bool StopBefore(const PathWindow& window, double place, const PathPace& pace) noexcept;

  // Where it comes to rest at the furthest if it is to stop now.
  double BrakesTo(const PathWindow& window, const PathPace& pace) const noexcept;
  double rest_place() const noexcept { return current_.EndPlace(); }  // mm along the path, where the law in force ends
  double rest_s() const noexcept;                                     // from now on until then
  std::uint64_t rest_cycles() const noexcept;
  // The law in force leads to a place, and no faster one is to come.
  bool Settles(double place) const noexcept;

 private:
  struct Law {
    std::uint64_t begin = 0;  // tick
    bool planned = false;
    Profile profile = {};
    PathCourse course{kIntervals};
    PathPlan plan{kIntervals};
    // From some time on instead.
    double tail_s = std::numeric_limits<double>::infinity();
    Profile tail = {};
    double factor = 1;

    double Duration() const noexcept;
    double EndPlace() const noexcept;
    KinematicState At(double t) const noexcept;
  };
  static constexpr std::size_t kIntervals = 256;

  KinematicState StateAt(std::uint64_t tick) const noexcept;
  bool Holds(const PathWindow& window, std::uint64_t node, const Profile& profile) const noexcept;
  bool Bridge(const PathWindow& window, double factor, bool slowly, const PathPace& pace) noexcept;
  void Take(const Profile& profile, double factor) noexcept;
  void Go(const PathWindow& window, PathPace& pace) noexcept;
  bool StartPlan(const PathWindow& window, double factor, const PathPace& pace) noexcept;
  void DropPlan() noexcept;

  double period_s_;
  Planner planner_;
  // What is asked for, in next_: the cycle leaves it alone until it is told that the plan is there.
  enum class Order : std::uint8_t { kNone, kAsked, kMade };
  struct Maker {
    explicit Maker(std::size_t intervals) : planner(intervals, kPathCoordinates + 1) {}
    PathPlanner planner;
    PathPlanRequest request;
    std::atomic<Order> order{Order::kNone};
    std::uint64_t number = 0;
    PathPlanStatus status = PathPlanStatus::kNoPlan;
  };
  std::unique_ptr<Maker> maker_;
  Law current_, next_;
  std::uint64_t tick_ = 0;
  bool active_ = false;
  bool braking_ = false;                                     // what is in force is
  bool final_ = false;                                       // nothing faster is to be had
  bool planning_ = false, ready_ = false, dropped_ = false;  // what is asked for is not wanted any more
  std::uint64_t asked_ = 0;                                  // tick
  bool no_plan_ = false;                                     // there is none from here
  bool from_rest_ = false;                                   // the plan being made begins at rest
  std::uint64_t late_ = 0;                                   // how many it has to be, as the last one came too late
  std::uint64_t wait_until_ = 0;                             // tick, to ask again
};

}  // namespace takt::trajectory
