#include "takt/trajectory/path_planner.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::trajectory {

namespace {

constexpr double kPlanShare = 0.99;  // share of each limit used by the rows; the rest is for values between knots
// Intervals after a given pace, which may use all of a limit, until that share holds.
constexpr std::size_t kFadeIntervals = 8;
constexpr int kVerifyRounds = 8;         // rounds of verifying and tightening
constexpr int kRoundsFromMotion = 6;     // with a given pace; after more rounds the law in force is usually faster
constexpr double kTighter = 1.002;       // factor on the measured use
constexpr int kStubborn = 2;             // rounds after which tightening is squared
constexpr double kNearly = 1.5;          // use of a limit below which a plan becomes feasible at a lower rate
constexpr double kLowerRounding = 1e-9;  // share of R
constexpr double kBeginRounding = 1e-6;  // share of a limit, in the first interval after a given pace
constexpr double kPrecision = 3e-4;      // gap and residual, from rest
constexpr double kPrecisionFromMotion = 1e-3;  // the same from a motion in progress: the plan has to be ready in time
constexpr double kToBoundary = 0.99;           // share of the step to where a slack or a multiplier is 0
constexpr double kLeastLeft = 0.2;             // share of an ordinate that is left after a step
constexpr double kFarSlack = 0.1;              // initial slack of rows, as a share of their terms: from a uniform rate
constexpr double kTightenedSlack = 0.02;       // from a plan whose rows were tightened
constexpr double kNearSlack = 1e-5;            // from a feasible plan
constexpr int kStepsPerRound = 80;             // Newton steps
constexpr int kHoldingSteps = 30;              // Newton steps
constexpr int kHoldingRounds = 4;              // rounds of verifying and tightening
constexpr std::size_t kRampSpace[] = {3, 6, 12};  // intervals left free on both sides of a held run, tried in turn
constexpr double kNearlyAtSpeed = 0.97;  // of the squared velocity limit: intervals above it are held at the limit
constexpr double kAtSpeed = 1 - 1e-9;    // of R where the reference cruises
constexpr double kCruises = 1e-9;        // share of a limit that is rounding
constexpr double kNearlyCruises = 1e-7;  // ... that is lost from one plan to the next
constexpr double kSamePace = 1e-6;       // of R and its slope
constexpr double kLost = 1e6;            // times the duration: gap or residual of a diverged solution
constexpr double kBetween = 0.2;         // of a second difference; more than the height of a parabola (1/8)
constexpr double kSmall = 1e-3;  // share of a limit below which no rows are needed; Verify checks it nevertheless
constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr double kNear = 0.4;       // use of a limit from which a coordinate has rows, once a use is known
constexpr double kOfUniform = 0.7;  // of the fastest uniform R: start of the Newton steps

bool Above0(double number) {
  return number > 0 && std::isfinite(number);
}

}  // namespace

PathPlanner::PathPlanner(std::size_t intervals, std::size_t coordinates)
    : most_intervals_(intervals),
      most_coordinates_(coordinates),
      ends_(2 * intervals * coordinates),
      merged_(2 * intervals),
      apart_(2 * intervals),
      near_(intervals),
      at_(coordinates),
      ordinates_(intervals),
      tighten_(intervals),
      use_(intervals),
      kept_(intervals),
      kept_tighten_(intervals),
      held_(intervals),
      cruises_(intervals),
      signed_(9 * coordinates),
      rows_(intervals * (6 * coordinates + 3) + 2),
      diagonal_(intervals),
      next_(intervals),
      second_next_(intervals),
      right_(intervals),
      step_(intervals) {}

// Reads the rates and masks. Returns false if the request is invalid.
bool PathPlanner::Read() noexcept {
  for (const double length : request_->lengths) {
    if (!Above0(length)) return false;
  }
  for (const auto& limits : {request_->limits, request_->first_limits}) {
    for (const RateLimits& l : limits) {
      for (const double limit : {l.velocity, l.acceleration, l.deceleration, l.jerk}) {
        if (!(limit > 0)) return false;
      }
    }
  }
  if (!request_->first_limits.empty() && request_->first_limits.size() != n_) return false;
  for (const auto& pace : {request_->begin, request_->end}) {
    if (pace && !(Above0(pace->square) && std::isfinite(pace->slope))) return false;
  }
  for (std::size_t k = 0; k < n_; ++k) {
    for (std::size_t e = 0; e < 2; ++e) {
      const std::span<ReferenceRate> out(&ends_[(2 * k + e) * count_], count_);
      request_->motion.rates(request_->motion.owner, k, static_cast<double>(e), out);
      for (const ReferenceRate& r : out) {
        if (!std::isfinite(r.first + r.second + r.third)) return false;
      }
      Merge(k, e);
    }
    const auto cruises = [&](std::size_t end) {
      const ReferenceRate& rate = ends_[end * count_];
      return std::abs(std::abs(rate.first) - merged_[end].velocity) <= kNearlyCruises * merged_[end].velocity &&
             std::abs(rate.second) <= kCruises * merged_[end].acceleration;
    };
    cruises_[k] = cruises(2 * k) && cruises(2 * k + 1) ? 1 : 0;
    held_[k] = 0;
    near_[k] = kAll;
  }
  return true;
}

// Merges limits at an end of an interval: on a straight line all coordinates are proportional to the first one, and of
// each kind only the smallest limit counts.
void PathPlanner::Merge(std::size_t k, std::size_t e) noexcept {
  const ReferenceRate* rates = &ends_[(2 * k + e) * count_];
  const ReferenceRate& first = rates[0];
  RateLimits& merged = merged_[2 * k + e];
  std::uint64_t& apart = apart_[2 * k + e];
  merged = LimitsOf(k, 0);
  apart = 0;
  for (std::size_t q = 1; q < count_; ++q) {
    const ReferenceRate& own = rates[q];
    const RateLimits& l = LimitsOf(k, q);
    // Without a limit of its own a rate may still be large compared to the other limits.
    const auto within = [](double rate, double limit) {
      return std::isfinite(limit) ? std::abs(rate) <= kSmall * limit : rate == 0;
    };
    const auto is_small = [&](double one, double two, double three) {
      return within(one, l.velocity) && within(two, l.acceleration) && within(three, l.jerk);
    };
    if (is_small(own.first, own.second, own.third)) continue;
    const double ratio = first.first != 0 ? own.first / first.first : first.third != 0 ? own.third / first.third : 0;
    if (!is_small(1e3 * (own.first - ratio * first.first), 1e3 * (own.second - ratio * first.second),
                  1e3 * (own.third - ratio * first.third))) {
      apart |= std::uint64_t{1} << q;
      continue;
    }
    const double size = std::abs(ratio);
    merged.velocity = std::min(merged.velocity, l.velocity / size);
    merged.acceleration = std::min(merged.acceleration, l.acceleration / size);
    merged.deceleration = std::min(merged.deceleration, l.acceleration / size);
    merged.jerk = std::min(merged.jerk, l.jerk / size);
  }
}

// Returns the largest constant R within all limits; 0 if the rates are not finite.
double PathPlanner::UniformSquare() noexcept {
  double velocity = 0, acceleration = 0, jerk = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    for (int i = 0; i <= kSamples; ++i) {
      request_->motion.rates(request_->motion.owner, k, static_cast<double>(i) / kSamples, at_);
      for (std::size_t q = 0; q < count_; ++q) {
        const RateLimits& l = LimitsOf(k, q);
        velocity = std::max(velocity, std::abs(at_[q].first) / l.velocity);
        acceleration = std::max({acceleration, at_[q].second / l.acceleration, -at_[q].second / l.deceleration});
        jerk = std::max(jerk, std::abs(at_[q].third) / l.jerk);
        if (!std::isfinite(at_[q].first + at_[q].second + at_[q].third)) return 0;
      }
    }
  }
  const double rate = std::max({velocity, std::sqrt(acceleration), maths::Cbrt(jerk)});
  return rate > 0 && std::isfinite(rate) ? 1 / (rate * rate) : 0;
}

PathPlanner::Shape PathPlanner::ShapeOf(std::size_t k) const noexcept {
  const std::span<const double> lengths = request_->lengths;
  Shape shape;
  // At the knot between the intervals i - 1 and i; their ordinates are `at` and `at + 1` of the three.
  const auto knot = [&](std::size_t i, std::size_t at, Linear& square, Linear& slope) {
    const double sum = 1 / (lengths[i - 1] + lengths[i]);
    const double before = lengths[i] * sum, after = lengths[i - 1] * sum;
    square.value = before * ordinates_[i - 1] + after * ordinates_[i];
    square.of[at] = before;
    square.of[at + 1] = after;
    slope.value = (ordinates_[i] - ordinates_[i - 1]) * sum;
    slope.of[at] = -sum;
    slope.of[at + 1] = sum;
  };
  // At an end of the plan: as given, or R is constant in the interval.
  const auto end = [&](const std::optional<ReferencePace>& pace, Linear& square, Linear& slope) {
    if (pace) {
      square.value = pace->square;
      slope.value = pace->slope;
    } else {
      square.value = ordinates_[k];
      square.of[1] = 1;
    }
  };
  if (k == 0) {
    end(request_->begin, shape.square[0], shape.slope[0]);
  } else {
    knot(k, 0, shape.square[0], shape.slope[0]);
  }
  if (k + 1 == n_) {
    end(request_->end, shape.square[1], shape.slope[1]);
  } else {
    knot(k + 1, 1, shape.square[1], shape.slope[1]);
  }
  const double inverse = 1 / lengths[k];
  shape.bend.value = (shape.slope[1].value - shape.slope[0].value) * inverse;
  for (std::size_t i = 0; i < 3; ++i) shape.bend.of[i] = (shape.slope[1].of[i] - shape.slope[0].of[i]) * inverse;
  return shape;
}

void PathPlanner::SettleEnds() noexcept {
  const auto& begin = request_->begin;
  const auto& end = request_->end;
  ordinates_[0] = begin ? begin->square + begin->slope * request_->lengths[0] : ordinates_[1];
  ordinates_[n_ - 1] = end ? end->square - end->slope * request_->lengths[n_ - 1] : ordinates_[n_ - 2];
}

void PathPlanner::Add(std::size_t k, double value, const std::array<double, 3>& gradient) noexcept {
  Row& row = rows_[row_count_++];
  row.value = value;
  row.gradient = gradient;
  row.first = static_cast<std::ptrdiff_t>(k) - 1;
}

void PathPlanner::MakeRows() noexcept {
  row_count_ = 0;
  const auto is_held = [&](std::size_t k) { return k < n_ && held_[k] != 0; };
  for (std::size_t k = 0; k < n_; ++k) {
    if (k > 0 && is_held(k - 1) && is_held(k) && is_held(k + 1)) continue;  // no unknown in it; Verify checks it
    const Shape shape = ShapeOf(k);
    const Shares& f = tighten_[k];
    for (std::size_t e = 0; e < 2; ++e) {
      const Linear& b = shape.square[e];
      const Linear& a = shape.slope[e];
      const double root = 1 / std::sqrt(b.value);
      const double root_slope = -0.5 * root / b.value;
      std::uint64_t near = near_[k];
      if (e == 1 && k + 1 < n_) near |= near_[k + 1];
      if (e == 0 && k > 0) near |= near_[k - 1];
      // Constraints at a knot are added once; a given pace is not constrained.
      const bool free_knot = e == 1 ? k + 1 < n_ || !request_->end : k == 0 && !request_->begin;
      double cap = std::numeric_limits<double>::infinity();
      for (std::size_t q = 0; q < count_; ++q) {
        const ReferenceRate& rate = ends_[(2 * k + e) * count_ + q];
        if (q > 0 && ((apart_[2 * k + e] & near) >> q & 1) == 0) continue;
        const RateLimits& l = q == 0 ? merged_[2 * k + e] : LimitsOf(k, q);
        const double speed = f[0] * rate.first;
        if (speed != 0) cap = std::min(cap, l.velocity * l.velocity / (speed * speed));
        if (rate.first == 0 && rate.second == 0 && rate.third == 0) continue;
        if (std::isfinite(l.jerk)) {
          const double d1 = f[2] * rate.first, d2 = f[2] * rate.second, d3 = f[2] * rate.third;
          const double value = d1 * shape.bend.value + 3 * d2 * a.value + d3 * b.value;
          std::array<double, 3> up{}, down{};
          for (std::size_t i = 0; i < 3; ++i) {
            const double own = d1 * shape.bend.of[i] + 3 * d2 * a.of[i] + d3 * b.of[i];
            const double room = l.jerk * root_slope * b.of[i];
            up[i] = room - own;
            down[i] = room + own;
          }
          Add(k, l.jerk * root - value, up);
          Add(k, l.jerk * root + value, down);
        }
        if (!free_knot || !std::isfinite(l.acceleration + l.deceleration)) continue;
        const double d1 = f[1] * rate.first, d2 = f[1] * rate.second;
        std::array<double, 3> up{}, down{};
        for (std::size_t i = 0; i < 3; ++i) {
          down[i] = d1 * a.of[i] + d2 * b.of[i];
          up[i] = -down[i];
        }
        const double value = d1 * a.value + d2 * b.value;
        Add(k, l.acceleration - value, up);
        Add(k, l.deceleration + value, down);
      }
      const bool both_held = is_held(k) && (e == 0 || is_held(k + 1));
      if (free_knot && !both_held && std::isfinite(cap)) Add(k, cap - b.value, {-b.of[0], -b.of[1], -b.of[2]});
    }
    if (k > 0 && k + 1 < n_) Add(k, ordinates_[k], {0, 1, 0});
  }
}

// Solves the pentadiagonal system between both ends by LDLᵀ. Returns false if the matrix is not positive definite.
bool PathPlanner::SolveLinear() noexcept {
  const std::size_t first = 1, last = n_ - 2;
  for (std::size_t i = first; i <= last; ++i) {
    if (!(diagonal_[i] > 0) || !std::isfinite(diagonal_[i])) return false;
    const double l1 = i + 1 <= last ? next_[i] : 0;
    const double l2 = i + 2 <= last ? second_next_[i] : 0;
    const double m1 = l1 / diagonal_[i], m2 = l2 / diagonal_[i];
    if (i + 1 <= last) {
      diagonal_[i + 1] -= m1 * l1;
      right_[i + 1] -= m1 * right_[i];
    }
    if (i + 2 <= last) {
      next_[i + 1] -= m1 * l2;
      diagonal_[i + 2] -= m2 * l2;
      right_[i + 2] -= m2 * right_[i];
    }
    next_[i] = m1;
    second_next_[i] = m2;
  }
  for (std::size_t i = last + 1; i-- > first;) {
    step_[i] = right_[i] / diagonal_[i];
    if (i + 1 <= last) step_[i] -= next_[i] * step_[i + 1];
    if (i + 2 <= last) step_[i] -= second_next_[i] * step_[i + 2];
  }
  return true;
}

// One primal-dual step. Returns false, with the ordinates unchanged, if rounding has spoilt it.
bool PathPlanner::Step(double centring, double start_slack, bool first) noexcept {
  MakeRows();
  const auto rows = std::span(rows_).first(row_count_);
  for (auto* vector : {&diagonal_, &next_, &second_next_, &right_}) {
    std::fill_n(vector->begin(), static_cast<std::ptrdiff_t>(n_), 0.0);
  }
  const auto of_row = [&](const Row& row, auto&& use) {  // those of its ordinates that exist
    for (std::size_t i = 0; i < 3; ++i) {
      const std::ptrdiff_t at = row.first + static_cast<std::ptrdiff_t>(i);
      if (at >= 0 && at < static_cast<std::ptrdiff_t>(n_)) use(static_cast<std::size_t>(at), i);
    }
  };
  // The duration: the sum of h / √R over the knots, h half the length of both neighbours.
  const std::span<const double> lengths = request_->lengths;
  double time = 0;
  for (std::size_t i = 1; i < n_; ++i) {
    const double sum = 1 / (lengths[i - 1] + lengths[i]);
    const double before = lengths[i] * sum, after = lengths[i - 1] * sum;
    const double b = before * ordinates_[i - 1] + after * ordinates_[i];
    double h = 0.5 * (lengths[i - 1] + lengths[i]);
    if (i == 1 && !request_->begin) h += 0.5 * lengths[0];
    if (i + 1 == n_ && !request_->end) h += 0.5 * lengths[n_ - 1];
    const double f = h / std::sqrt(b);
    const double slope = -0.5 * f / b, bend = 0.75 * f / (b * b);
    time += f;
    right_[i - 1] -= slope * before;
    right_[i] -= slope * after;
    diagonal_[i - 1] += bend * before * before;
    diagonal_[i] += bend * after * after;
    next_[i - 1] += bend * before * after;
  }
  if (!std::isfinite(time)) return false;
  const double per_row = time / static_cast<double>(row_count_);
  for (Row& row : rows) {
    if (first) {
      double scale = std::abs(row.value);
      of_row(row, [&](std::size_t at, std::size_t i) { scale += std::abs(row.gradient[i] * ordinates_[at]); });
      row.slack = std::max(row.value, start_slack * scale + 1e-9);
      row.multiplier = (start_slack < kFarSlack ? 0.02 : 1.0) * per_row / row.slack;
    } else {
      row.slack = std::max(row.slack, row.value);
    }
  }
  gap_ = infeasible_ = 0;
  std::copy_n(right_.begin(), n_, step_.begin());
  for (const Row& row : rows) {
    gap_ += row.multiplier * row.slack;
    infeasible_ = std::max(infeasible_, 1 - row.value / row.slack);
    of_row(row, [&](std::size_t at, std::size_t i) { step_[at] += row.multiplier * row.gradient[i]; });
  }
  if (!request_->begin) step_[1] += step_[0];
  if (!request_->end) step_[n_ - 2] += step_[n_ - 1];
  residual_ = 0;
  for (std::size_t i = 1; i + 1 < n_; ++i) {
    if (held_[i] == 0) residual_ += std::abs(step_[i] * ordinates_[i]);
  }
  residual_ /= time;
  const double target = std::max(centring * gap_ / static_cast<double>(row_count_), 0.3 * residual_ * per_row);
  gap_ /= time;
  for (const Row& row : rows) {
    const double weight = row.multiplier / row.slack;
    const double pull = target / row.slack - weight * (row.value - row.slack);
    const auto& g = row.gradient;
    of_row(row, [&](std::size_t at, std::size_t i) {
      diagonal_[at] += weight * g[i] * g[i];
      right_[at] += pull * g[i];
      if (i + 1 < 3) next_[at] += weight * g[i] * g[i + 1];
      if (i == 0) second_next_[at] += weight * g[0] * g[2];
    });
  }
  if (!request_->begin) {
    diagonal_[1] += 2 * next_[0] + diagonal_[0];
    next_[1] += second_next_[0];
    right_[1] += right_[0];
  }
  if (!request_->end) {
    diagonal_[n_ - 2] += 2 * next_[n_ - 2] + diagonal_[n_ - 1];
    next_[n_ - 3] += second_next_[n_ - 3];
    right_[n_ - 2] += right_[n_ - 1];
  }
  for (std::size_t i = 1; i + 1 < n_; ++i) {
    if (held_[i] == 0) continue;
    diagonal_[i] = 1;
    right_[i] = next_[i] = second_next_[i] = next_[i - 1] = 0;
    if (i > 1) second_next_[i - 2] = 0;
  }
  if (!SolveLinear()) return false;
  step_[0] = request_->begin ? 0 : step_[1];
  step_[n_ - 1] = request_->end ? 0 : step_[n_ - 2];
  primal_ = dual_ = 1;
  for (Row& row : rows) {
    row.change = row.value - row.slack;
    of_row(row, [&](std::size_t at, std::size_t i) { row.change += row.gradient[i] * step_[at]; });
    row.multiplier_change = (target - row.multiplier * row.change) / row.slack - row.multiplier;
    if (-row.change * primal_ > kToBoundary * row.slack) primal_ = kToBoundary * row.slack / -row.change;
    if (-row.multiplier_change * dual_ > kToBoundary * row.multiplier) {
      dual_ = kToBoundary * row.multiplier / -row.multiplier_change;
    }
  }
  for (std::size_t i = 1; i + 1 < n_; ++i) {
    if (!std::isfinite(step_[i])) return false;
    if (-step_[i] * primal_ > (1 - kLeastLeft) * ordinates_[i]) primal_ = (1 - kLeastLeft) * ordinates_[i] / -step_[i];
  }
  for (std::size_t i = 1; i + 1 < n_; ++i) ordinates_[i] += primal_ * step_[i];
  SettleEnds();
  for (Row& row : rows) {
    row.slack += primal_ * row.change;
    row.multiplier += dual_ * row.multiplier_change;
  }
  return true;
}

// Reduces the duration from the present ordinates by at most `most` steps. Returns false if they diverge.
bool PathPlanner::Solve(double start_slack, int most) noexcept {
  const double precision = request_->begin ? kPrecisionFromMotion : kPrecision;
  double centring = 0.2;
  for (int i = 0; i < most && steps_ < kMostSteps; ++i) {
    ++steps_;
    if (!Step(centring, start_slack, i == 0)) return false;
    if (!(gap_ < kLost && residual_ < kLost)) return false;
    if (gap_ < precision && residual_ < precision && infeasible_ < 1e-6) return true;
    const double share = std::min(primal_, dual_);
    centring = share > 0.9 ? 0.1 : share > 0.5 ? 0.25 : share > 0.2 ? 0.5 : 0.8;
  }
  return true;
}

// Returns the largest shares of the limits that an interval uses, and marks the coordinates that are near a limit;
// infinite if R is not above 0 or a value is not finite.
PathPlanner::Shares PathPlanner::UseOf(std::size_t k) noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const Shape shape = ShapeOf(k);
  const double b = shape.square[0].value, a = shape.slope[0].value, bend = shape.bend.value;
  const std::size_t width = 3 * count_;
  Shares use{};
  seen_ = over_ = 0;
  const auto shares = [&](int i) {
    const double share = static_cast<double>(i) / kSamples;
    const double way = share * request_->lengths[k];
    const double slope = i == kSamples ? shape.slope[1].value : a + bend * way;
    const double square = i == kSamples ? shape.square[1].value : b + way * (a + slope);
    if (!(square > 0) || !std::isfinite(square)) return false;
    const double rate = std::sqrt(square);
    request_->motion.rates(request_->motion.owner, k, share, at_);
    double* to = &signed_[static_cast<std::size_t>(i % 3) * width];
    for (std::size_t q = 0; q < count_; ++q) {
      const ReferenceRate& r = at_[q];
      to[3 * q] = r.first * rate;
      to[3 * q + 1] = r.first * slope + r.second * square;
      to[3 * q + 2] = rate * (r.first * bend + 3 * r.second * slope + r.third * square);
      if (!std::isfinite(to[3 * q] + to[3 * q + 1] + to[3 * q + 2])) return false;
    }
    return true;
  };
  const double slowest = std::min(b, shape.square[1].value);
  const double step_s = slowest > 0 ? request_->lengths[k] / kSamples / std::sqrt(slowest) : kInfinite;
  for (int i = 0; i <= kSamples; ++i) {
    if (!shares(i)) {
      seen_ = kAll;
      return {kInfinite, kInfinite, kInfinite};
    }
    if (i < 2) continue;
    for (std::size_t q = 0; q < count_; ++q) {
      const RateLimits& l = LimitsOf(k, q);
      for (std::size_t order = 0; order < 3; ++order) {
        const std::size_t at = 3 * q + order;
        const auto value = [&](int j) { return signed_[static_cast<std::size_t>(j % 3) * width + at]; };
        double bent = kBetween * std::abs(value(i) - 2 * value(i - 1) + value(i - 2));
        double high = std::max({value(i), value(i - 1), value(i - 2)});
        double low = std::min({value(i), value(i - 1), value(i - 2)});
        // Values between samples count where there may be an extreme, not where they rise or fall steadily. At an end
        // they do so if the derivative there, which is the next order, has the same sign.
        const bool steady = (value(i) - value(i - 1)) * (value(i - 1) - value(i - 2)) > 0;
        if (steady && (i == 2 || i == kSamples)) {
          const int end = i == 2 ? 0 : i;
          const double rise = i == 2 ? value(1) - value(0) : value(i) - value(i - 1);
          if (order < 2) {
            const double slope = signed_[static_cast<std::size_t>(end % 3) * width + at + 1];
            bent = slope * rise < 0 ? std::min(bent, std::abs(slope) * step_s) : 0;
          }
        }
        if (!steady || i == 2 || i == kSamples) {
          high += bent;
          low -= bent;
        }
        if (order == 0 && q == 0 && cruises_[k] != 0) continue;
        const double up = order == 1 ? l.acceleration : order == 0 ? l.velocity : l.jerk;
        const double down = order == 1 ? l.deceleration : up;
        const double own = std::max(high / up, -low / down);
        if (own > kNear) seen_ |= std::uint64_t{1} << q;
        if (own > 1) over_ |= std::uint64_t{1} << q;
        use[order] = std::max(use[order], own);
      }
    }
  }
  // Where the reference cruises the velocity is proportional to sqrt(R), and R a parabola with its ordinate as control
  // point.
  if (cruises_[k] != 0) {
    const double after = shape.square[1].value, control = b + a * request_->lengths[k];
    const double bent = 2 * control - b - after;  // may be pure rounding
    double square = std::max(b, after);
    if (control > square) {
      square = bent > 0 ? std::clamp((control * control - b * after) / bent, square, control) : control;
    }
    use[0] = std::max(use[0], std::sqrt(square) * std::abs(ends_[2 * k * count_].first) / LimitsOf(k, 0).velocity);
  }
  return use;
}

// Updates the mask of this interval after UseOf: coordinates near a limit have rows. Rows are only removed once, when
// the first use is known.
void PathPlanner::Mark(std::size_t k) noexcept {
  near_[k] = known_ ? near_[k] | seen_ : seen_;
}

// Returns true if all values are within the limits. Else tightens the intervals where they are not, and their
// neighbours.
bool PathPlanner::Verify(int round) noexcept {
  most_use_ = 0;
  tightened_ = false;
  for (std::size_t k = 0; k < n_; ++k) {
    use_[k] = UseOf(k);
    const std::uint64_t had_no_rows = (apart_[2 * k] | apart_[2 * k + 1]) & ~near_[k] & ~std::uint64_t{1};
    // A given pace may use all of a limit.
    const double rounding = k == 0 && request_->begin ? kBeginRounding : 0;
    for (const double use : use_[k]) most_use_ = std::max(most_use_, use - rounding);
    Mark(k);
    // Coordinates without rows get rows before any interval is tightened.
    if ((over_ & had_no_rows) != 0) use_[k].fill(1);
  }
  known_ = true;
  if (most_use_ <= 1) return true;
  if (round >= kStubborn) std::ranges::fill(near_, kAll);
  for (std::size_t k = 0; k < n_; ++k) {
    // Near a given pace only the kind of limit that is exceeded is tightened: the pace may use all of the others.
    // Elsewhere tightening all three kinds converges sooner.
    const bool apart = (request_->begin && k < kFadeIntervals) || (request_->end && n_ - k <= kFadeIntervals);
    for (std::size_t order = 0; order < 3; ++order) {
      double use = 0;
      for (const std::size_t near : {k > 0 ? k - 1 : k, k, k + 1 < n_ ? k + 1 : k}) {
        use = std::max(use, apart ? use_[near][order] : std::ranges::max(use_[near]));
      }
      // Repeated excess lies between the knots, where rows constrain it less.
      if (round >= kStubborn) use *= use;
      if (round >= 2 * kStubborn) use *= use;
      if (!(use > 1)) continue;
      tighten_[k][order] *= kTighter * std::min(use, 2.0);
      tightened_ = true;
    }
  }
  return false;
}

// Returns the duration [s] of the plan given by the ordinates.
double PathPlanner::TimeOf() const noexcept {
  double time = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    const Shape shape = ShapeOf(k);
    time += IntervalDuration(request_->lengths[k], shape.square[0].value, shape.square[1].value, shape.bend.value);
  }
  return time;
}

void PathPlanner::Publish(PathPlan& out) const noexcept {
  out.count_ = n_ + 1;
  double reference = 0, time = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    const Shape shape = ShapeOf(k);
    out.knots_[k] = {reference, time, shape.square[0].value, shape.slope[0].value, shape.bend.value};
    reference += request_->lengths[k];
    time += IntervalDuration(request_->lengths[k], shape.square[0].value, shape.square[1].value, shape.bend.value);
    if (k + 1 == n_) out.knots_[n_] = {reference, time, shape.square[1].value, shape.slope[1].value, shape.bend.value};
  }
}

// Fixes the ordinates of runs of cruising intervals at the velocity limit, with `space` intervals free at both ends of
// a run for the ramps. Returns true if there is any such run.
bool PathPlanner::Hold(std::size_t space) noexcept {
  const auto goes_on = [](const std::optional<ReferencePace>& pace) {
    return pace && std::abs(pace->square - 1) <= kSamePace && std::abs(pace->slope) <= kSamePace;
  };
  const auto at_speed = [&](std::size_t k) {
    const double before = merged_[2 * k].velocity / std::abs(ends_[2 * k * count_].first);
    const double after = merged_[2 * k + 1].velocity / std::abs(ends_[(2 * k + 1) * count_].first);
    const double rate = std::min(before, after);
    return kAtSpeed * rate * rate;
  };
  bool any = false;
  for (std::size_t first = 0, behind = 0; first < n_; first = behind + 1) {
    for (behind = first; behind < n_ && cruises_[behind] != 0;) ++behind;
    const std::size_t before = first == 0 && goes_on(request_->begin) ? 1 : space;
    const std::size_t after = behind == n_ && goes_on(request_->end) ? 1 : space;
    if (behind - first <= before + after) continue;
    any = true;
    // A plan that follows the reference from the given pace to the run starts as the reference itself.
    const auto like_reference = [](double c) { return c > kNearlyAtSpeed && c * kNearlyAtSpeed < 1; };
    const auto head = std::span(ordinates_).first(first + 1);
    const bool all = request_->begin && std::ranges::all_of(head, like_reference);
    if (all) std::ranges::fill(head, kAtSpeed);
    for (std::size_t k = first; k < behind; ++k) {
      const double in = all ? 1 : static_cast<double>(k - first + 1) / static_cast<double>(before + 1);
      const double out = static_cast<double>(behind - k) / static_cast<double>(after + 1);
      const double x = std::min({in, out, 1.0});
      held_[k] = k >= first + before && k + after < behind ? 1 : 0;
      ordinates_[k] = std::lerp(ordinates_[k], at_speed(k), x * x * (3 - 2 * x));
    }
  }
  return any;
}

// Rows use kPlanShare of the velocity limit, too. In a feasible plan this fixes intervals that cruise near the limit at
// the limit and plans the rest again; `out` changes if that is faster.
void PathPlanner::HoldSpeed(PathPlan& out) noexcept {
  for (std::size_t k = 0; k < n_; ++k) {
    const Shape shape = ShapeOf(k);
    if (!(std::min(shape.square[0].value, shape.square[1].value) > kNearlyAtSpeed)) cruises_[k] = 0;
  }
  const double use = most_use_;
  std::copy_n(ordinates_.begin(), n_, kept_.begin());
  for (const std::size_t space : kRampSpace) {
    if (!Hold(space)) break;
    SettleEnds();
    std::copy_n(tighten_.begin(), n_, kept_tighten_.begin());
    bool good = false;
    for (int round = 0; round < kHoldingRounds && !good; ++round) {
      Solve(kNearSlack, kHoldingSteps);
      good = Verify(round);
      if (most_use_ > kNearly) break;
    }
    std::copy_n(kept_tighten_.begin(), n_, tighten_.begin());
    const bool faster = good && TimeOf() < out.duration();
    if (faster) Publish(out);
    holds_ = faster;
    std::ranges::fill(held_, std::uint8_t{0});
    if (faster) return;
    std::copy_n(kept_.begin(), n_, ordinates_.begin());
  }
  most_use_ = use;
}

// Sets the shares of the limits that rows use before the first check: after a given pace they fall to kPlanShare within
// the time that the first coordinate needs to lose that share of its velocity.
void PathPlanner::SetShares() noexcept {
  const auto fade_s = [&](std::size_t end) {
    const RateLimits& l = merged_[end];
    const double seconds = 4 * std::sqrt((1 - kPlanShare) * l.velocity / l.jerk) + 2 * l.acceleration / l.jerk;
    return std::isfinite(seconds) ? seconds : 0.0;
  };
  const auto fade = [&](std::size_t k, bool given, std::size_t intervals, double at_s, double most_s) {
    if (!given) return;
    const double by_count = static_cast<double>(intervals) / kFadeIntervals;
    const double share = std::min({1.0, by_count, most_s > 0 ? at_s / most_s : 1.0});
    for (double& f : tighten_[k]) f = std::min(f, 1 + (f - 1) * share);
  };
  const double begin_s = fade_s(0), end_s = fade_s(2 * n_ - 1);
  double at_s = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    tighten_[k].fill(1 / kPlanShare);
    fade(k, request_->begin.has_value(), k, at_s, begin_s);
    at_s += request_->lengths[k];
  }
  at_s = 0;
  for (std::size_t k = n_; k-- > 0;) {
    fade(k, request_->end.has_value(), n_ - 1 - k, at_s, end_s);
    at_s += request_->lengths[k];
  }
}

PathPlanStatus PathPlanner::Plan(const PathPlanRequest& request, PathPlan& out) noexcept {
  request_ = &request;
  n_ = request.lengths.size();
  count_ = request.limits.size();
  steps_ = 0;
  holds_ = known_ = false;
  most_use_ = 0;
  if (n_ > most_intervals_ || count_ > most_coordinates_ || out.knots_.size() < n_ + 1)
    return PathPlanStatus::kTooLarge;
  if (n_ < 4 || count_ == 0 || request.motion.rates == nullptr) return PathPlanStatus::kInvalid;
  at_.resize(count_);  // never larger than in the constructor
  if (!Read()) return PathPlanStatus::kInvalid;
  const double uniform = UniformSquare();
  if (!(uniform > 0)) return PathPlanStatus::kInvalid;
  SetShares();
  double start = kOfUniform * uniform;
  // From a motion in progress: the reference continues it at this rate.
  if (request.begin) start = request.begin->square;
  std::fill_n(ordinates_.begin(), n_, start);
  SettleEnds();
  if (ordinates_[0] > 0 && ordinates_[n_ - 1] > 0) {
    double slack = kFarSlack;
    const int rounds = request.begin ? kRoundsFromMotion : kVerifyRounds;
    for (int round = 0; round < rounds && steps_ < kMostSteps; round += tightened_ ? 1 : 0) {
      const bool converges = Solve(slack, kStepsPerRound);
      if (Verify(round)) {
        Publish(out);
        HoldSpeed(out);
        return PathPlanStatus::kPlanned;
      }
      if (!converges && request.begin) break;
      slack = kTightenedSlack;
    }
  }
  if (request.begin || request.end) return PathPlanStatus::kNoPlan;
  // A lower rate brings a plan within the limits that exceeds them only slightly: shares of limits fall with the rate,
  // its square or its cube.
  if (most_use_ < kNearly) {
    const double lower = (1 - kLowerRounding) / (most_use_ * most_use_);
    for (std::size_t k = 0; k < n_; ++k) ordinates_[k] *= lower;
    if (Verify(0)) {
      Publish(out);
      return PathPlanStatus::kPlanned;
    }
  }
  // A constant rate that is low enough.
  double square = uniform;
  for (int i = 0; i < kVerifyRounds; ++i) {
    std::fill_n(ordinates_.begin(), n_, square);
    if (Verify(0)) {
      Publish(out);
      return PathPlanStatus::kScaled;
    }
    square *= 0.9 / std::min(most_use_ * most_use_, 4.0);
  }
  return PathPlanStatus::kNoPlan;
}

}  // namespace takt::trajectory
