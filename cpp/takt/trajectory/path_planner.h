// Timing along a path within limits of velocity, acceleration and jerk of the path and of every coordinate: an
// interior-point method over a reference time.
//
// A reference motion over a reference time t gives each coordinate as q(t): where the path may be at rest the reference
// is at rest (q' = q'' = 0), so nothing is singular there. It need not keep any limit. The plan gives the rate of the
// reference time: R(t) = (dt/dtime)², a quadratic spline, with the slope a = R'/2. Then
//   velocity q' √R,   acceleration q' a + q'' R,   jerk √R (q' a' + 3 q'' a + q''' R).
// Divided by √R the jerk limit becomes a row that is convex in R, and the feasible set of its linearisation lies inside
// the true one: Newton steps with rows linearised at the current plan stay within the true rows.
//
// Sources: the squared rate as variable: Verscheure et al., Time-Optimal Path Tracking for Robots: A Convex
// Optimization Approach, IEEE TAC 54 (2009); third-order rows, linearised successively: arXiv 2105.15095 and
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

// Limits of one coordinate, above 0; infinite: no limit. The deceleration bounds negative accelerations: of the path,
// those at which its speed falls; for an axis it equals the acceleration.
struct RateLimits {
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double deceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
};

// The reference motion. `rates` writes the derivatives of all coordinates at `share` (0 to 1) of an interval, at 0 and
// 1 the one-sided limits from inside the interval. Requires: they are smooth within an interval; borders of pieces are
// knots.
struct ReferenceMotion {
  void (*rates)(const void* owner, std::size_t interval, double share, std::span<ReferenceRate> out) noexcept = nullptr;
  const void* owner = nullptr;
};

struct PathPlanRequest {
  std::span<const double> lengths;     // of the intervals of the reference time [s], > 0
  std::span<const RateLimits> limits;  // of each coordinate
  // Limits of the first coordinate in each interval, in place of its entry in `limits`; empty: `limits` holds
  // everywhere.
  std::span<const RateLimits> first_limits;
  ReferenceMotion motion;
  // Pace at the beginning and at the end; none: the reference is at rest there, and so is the motion.
  std::optional<ReferencePace> begin;
  std::optional<ReferencePace> end;
};

enum class PathPlanStatus : std::uint8_t {
  kPlanned,   // within the limits, as fast as the Newton steps found
  kScaled,    // within the limits: the reference motion at a constant rate, as no better plan was found
  kInvalid,   // a number is not finite, a length or a limit is not above 0, or there are fewer than 4 intervals
  kTooLarge,  // more intervals or coordinates than the planner has memory for
  kNoPlan,    // no plan from or to the given pace was found within the limits
};

// Guarantees for every plan returned (kPlanned, kScaled), whatever the request:
//
// Velocity, acceleration and jerk of every coordinate stay within its limits, to 1e-6 of them, if the rates are smooth
// within the intervals: each interval is checked at kSamples + 1 points, and what may lie between two of them is
// bounded by their second differences.
//
// The plan begins and ends with the requested paces, bit for bit, and covers the whole reference time. R is above 0 and
// nothing is NaN. From rest to rest there always is a plan.
//
// With any other status `out` is unchanged. Memory is allocated in the constructor only; Plan neither allocates nor
// throws, and its time is bounded by kMostSteps Newton steps, each linear in intervals times coordinates. Not
// thread-safe.
class PathPlanner {
 public:
  static constexpr int kSamples = 16;
  static constexpr int kMostSteps = 400;

  PathPlanner(std::size_t intervals, std::size_t coordinates);

  // Requires: `out` has room for the intervals.
  PathPlanStatus Plan(const PathPlanRequest& request, PathPlan& out) noexcept;

  bool holds() const noexcept { return holds_; }  // true if the last plan runs exactly at the velocity limit somewhere
  int steps() const noexcept { return steps_; }   // Newton steps of the last call
  double most_use() const noexcept { return most_use_; }  // largest share of a limit used by the last plan

 private:
  // A value that depends linearly on three neighbouring ordinates.
  struct Linear {
    double value = 0;
    std::array<double, 3> of{};
  };
  // The constraint value >= 0.
  struct Row {
    double value = 0;
    std::array<double, 3> gradient{};
    std::ptrdiff_t first = 0;  // index of the ordinate of gradient[0]
    double slack = 0, change = 0;
    double multiplier = 0, multiplier_change = 0;
  };
  // An interval: square and slope at both ends and the bend in between, over the ordinates k - 1, k, k + 1.
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
  std::vector<ReferenceRate> ends_;  // of all coordinates at the beginning and at the end of each interval
  std::vector<RateLimits> merged_;   // of the first coordinate there, including those of coordinates proportional to it
  std::vector<std::uint64_t> apart_;   // mask of coordinates that are not
  std::vector<std::uint64_t> near_;    // mask of coordinates near a limit in each interval: only they have rows
  std::uint64_t seen_ = 0, over_ = 0;  // masks of coordinates that UseOf found near a limit, and over it
  std::vector<ReferenceRate> at_;      // of all coordinates
  std::vector<double> ordinates_;      // c: R's control ordinate at the middle of each interval
  std::vector<Shares> tighten_;        // factors of the rates of each interval
  std::vector<Shares> use_;            // largest use of the limits in each interval
  std::vector<double> kept_;           // ordinates of a feasible plan ...
  std::vector<Shares> kept_tighten_;   // ... and its factors
  std::vector<std::uint8_t> held_;     // of each interval: 1 if its ordinate is fixed
  // Of each interval: 1 if its reference moves at the velocity limit of the first coordinate.
  std::vector<std::uint8_t> cruises_;
  std::vector<double> signed_;  // velocity, acceleration and jerk of all coordinates at three samples
  std::vector<Row> rows_;
  std::vector<double> diagonal_, next_, second_next_, right_, step_;
  std::size_t row_count_ = 0;
  int steps_ = 0;
  bool holds_ = false;
  bool tightened_ = false;  // by the last Verify
  bool known_ = false;      // near_ is known from a use
  double most_use_ = 0;
  double gap_ = 0, residual_ = 0, infeasible_ = 0, primal_ = 0, dual_ = 0;  // of the last step
};

}  // namespace takt::trajectory
