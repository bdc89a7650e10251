// Time along a path within limits of velocity, acceleration and jerk of the path and of every coordinate: an
// interior-point method over a reference time.
//
// A reference motion over a reference time t gives each coordinate as q(t): where the path may stand it stands
// (q' = q'' = 0), so nothing is singular there. It need not keep any limit. The plan says at which rate the reference
// time passes: R(t) = (dt/dtime)², a quadratic spline, with the slope a = R'/2. Then
//   velocity q' √R,   acceleration q' a + q'' R,   jerk √R (q' a' + 3 q'' a + q''' R).
// Divided by √R the jerk limit becomes a row that is convex in R, and the inside of its linearisation lies inside of
// it: Newton steps with rows linearised where they are stay within the true ones.
//
// Sources: the squared rate as variable: Verscheure et al., Time-Optimal Path Tracking for Robots: A Convex
// Optimization Approach, IEEE TAC 54 (2009); third-order rows, linearised one after the other: arXiv 2105.15095 and
// 2404.07889; primal-dual steps with slacks: Nocedal and Wright, Numerical Optimization, chapter 19. The reference
// time, the fold of its ends and the check between knots are ours: with R constant in the first and the last interval
// the motion begins and ends like the reference does, at another scale.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "takt/trajectory/path_plan.h"

namespace takt::trajectory {

// Derivatives of one coordinate of the reference motion by the reference time.
struct ReferenceRate {
  double first = 0;
  double second = 0;
  double third = 0;
};

// Limits of one coordinate, above 0; infinite: none. The deceleration bounds negative accelerations: of the path, those
// at which its speed falls; of an axis it equals the acceleration.
struct RateLimits {
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double deceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
};

// The reference motion. `rates` writes the derivatives of all coordinates at `share` (0 to 1) of an interval, at 0 and
// 1 those of its inside. They have to be smooth within an interval: borders of pieces are knots.
struct ReferenceMotion {
  void (*rates)(const void* owner, std::size_t interval, double share, std::span<ReferenceRate> out) noexcept = nullptr;
  const void* owner = nullptr;
};

struct PathPlanRequest {
  std::span<const double> lengths;     // of the intervals of the reference time [s], > 0
  std::span<const RateLimits> limits;  // of each coordinate
  // Of the first coordinate in each interval, instead of those for all; empty: they are the same everywhere.
  std::span<const RateLimits> first_limits;
  ReferenceMotion motion;
  // At the beginning and at the end; none: the reference stands there, and so does the motion.
  std::optional<ReferencePace> begin;
  std::optional<ReferencePace> end;
};

enum class PathPlanStatus : std::uint8_t {
  kPlanned,   // within the limits, as fast as the steps found
  kScaled,    // within the limits: the reference motion at a constant rate, as no better plan was found
  kInvalid,   // a number is not finite, a length or a limit is not above 0, or there are fewer than 4 intervals
  kTooLarge,  // more intervals or coordinates than the planner has room for
  kNoPlan,    // from or to the given pace no plan was found within the limits
};

// What holds for every plan handed out (kPlanned, kScaled), whatever was asked:
//
// Velocity, acceleration and jerk of every coordinate stay within its limits, to 1e-6 of them, if the rates are smooth
// within the intervals: each interval is looked at in kSamples places, and what may lie between two of them is bounded
// by their second differences.
//
// The plan begins and ends with the paces asked for, bit for bit, and covers the whole reference time. R is above 0 and
// nothing is NaN. From rest to rest there always is a plan.
//
// With any other status `out` is untouched. Takes memory only when it is made; Plan neither allocates nor throws, and
// its time is bounded by kMostSteps Newton steps, each linear in intervals times coordinates. Not for two threads at
// once.
class PathPlanner {
 public:
  static constexpr int kSamples = 16;
  static constexpr int kMostSteps = 400;

  PathPlanner(std::size_t intervals, std::size_t coordinates);

  // `out` must have room for the intervals.
  PathPlanStatus Plan(const PathPlanRequest& request, PathPlan& out) noexcept;

  bool holds() const noexcept { return holds_; }          // the last plan keeps the velocity limit somewhere, exactly
  int steps() const noexcept { return steps_; }           // Newton steps of the last call
  double most_use() const noexcept { return most_use_; }  // largest share of a limit that the last plan uses

 private:
  // A value that is linear in three neighbouring ordinates.
  struct Linear {
    double value = 0;
    std::array<double, 3> of{};
  };
  // value >= 0 is asked for.
  struct Row {
    double value = 0;
    std::array<double, 3> gradient{};
    std::ptrdiff_t first = 0;  // the ordinate of gradient[0]
    double slack = 0, change = 0;
    double multiplier = 0, multiplier_change = 0;
  };
  // Of an interval: square and slope at both ends and the bend between, over the ordinates k - 1, k, k + 1.
  struct Shape {
    std::array<Linear, 2> square, slope;
    Linear bend;
  };

  using Shares = std::array<double, 3>;  // of velocity, acceleration and jerk

  const RateLimits& LimitsOf(std::size_t k, std::size_t q) const noexcept {
    return q == 0 && !request_->first_limits.empty() ? request_->first_limits[k] : request_->limits[q];
  }
  bool Read() noexcept;
  void Merge(std::size_t k, std::size_t e) noexcept;
  double UniformSquare() noexcept;
  Shape ShapeOf(std::size_t k) const noexcept;
  void SettleEnds() noexcept;
  void Add(std::size_t k, double value, const std::array<double, 3>& gradient) noexcept;
  void MakeRows() noexcept;
  bool Solve(double start_slack, int most) noexcept;
  bool Step(double centring, double start_slack, bool first) noexcept;
  bool SolveLinear() noexcept;
  Shares UseOf(std::size_t k) noexcept;
  void Mark(std::size_t k) noexcept;
  bool Verify(int round) noexcept;
  double TimeOf() const noexcept;
  void Publish(PathPlan& out) const noexcept;
  void SetShares() noexcept;
  bool Hold(std::size_t space) noexcept;
  void HoldSpeed(PathPlan& out) noexcept;

  const PathPlanRequest* request_ = nullptr;
  std::size_t n_ = 0, count_ = 0;  // intervals, coordinates
  std::size_t most_intervals_, most_coordinates_;
  std::vector<ReferenceRate> ends_;    // of all coordinates at the beginning and at the end of each interval
  std::vector<RateLimits> merged_;     // of the first one there, those of coordinates that go like it included
  std::vector<std::uint64_t> apart_;   // coordinates that do not, a mask
  std::vector<std::uint64_t> near_;    // coordinates near a limit in each interval: only they have rows, a mask
  std::uint64_t seen_ = 0, over_ = 0;  // coordinates that UseOf saw near a limit, and over it
  std::vector<ReferenceRate> at_;      // of all coordinates
  std::vector<double> ordinates_;      // c: R's control ordinate above the middle of each interval
  std::vector<Shares> tighten_;        // factors of the rates of each interval
  std::vector<Shares> use_;            // of the limits in each interval
  std::vector<double> kept_;           // ordinates of a feasible plan ...
  std::vector<Shares> kept_tighten_;   // ... and its factors
  std::vector<std::uint8_t> held_;     // of each interval: its ordinate is fixed
  std::vector<std::uint8_t> cruises_;  // its reference moves at the velocity limit of the first coordinate
  std::vector<double> signed_;         // velocity, acceleration and jerk of all coordinates at three samples
  std::vector<Row> rows_;
  std::vector<double> diagonal_, next_, second_next_, right_, step_;
  std::size_t row_count_ = 0;
  int steps_ = 0;
  bool holds_ = false;
  bool tightened_ = false;  // by the last Verify
  bool known_ = false;      // near_ is, from a use
  double most_use_ = 0;
  double gap_ = 0, residual_ = 0, infeasible_ = 0, primal_ = 0, dual_ = 0;  // of the last step
};

}  // namespace takt::trajectory
