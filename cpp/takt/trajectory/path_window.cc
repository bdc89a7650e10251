#include "takt/trajectory/path_window.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::trajectory {

namespace {

// Share of the coordinates' limits that is used: between nodes everything is taken as linear, and the mean of
// accelerations as the acceleration of the mean.
constexpr double kShare = 0.97;
// Share of the coordinates' jerk for bends travelled at constant speed.
constexpr double kDriftShare = 0.8;
constexpr std::size_t kKept = 64;

using Third = std::array<double, kPathCoordinates>;

Third ThirdBetween(const PathPoint& before, const PathPoint& after, const CoordinateLimits& limits) {
  Third third{};
  const double length = after.s - before.s;
  for (std::size_t k = 0; k < limits.count && length > 0; ++k) {
    third[k] = std::abs(after.slopes.second[k] - before.slopes.second[k]) / length;
  }
  return third;
}

double DriftSquare(const Third& third, const CoordinateLimits& limits, const PathPoint& from, const PathPoint& to) {
  double cube = CoordinateLimits::kNone;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double jerk = kDriftShare * std::min(from.left[k].jerk, to.left[k].jerk) * limits.of[k].jerk;
    if (third[k] * cube > jerk) cube = jerk / third[k];
  }
  const double v = maths::Cbrt(cube);
  return v * v;
}

}  // namespace

PathWindow::PathWindow(std::size_t capacity, const CoordinateLimits& limits, double period_s)
    : nodes_(capacity), limits_(limits), period_s_(period_s), build_up_s_(period_s) {
  kept_.reserve(kKept);
}

void PathWindow::Clear() noexcept {
  begin_ = known_ = next_ = low_ = lowest_ = end_;
}

void PathWindow::Append(const PathPoint& point, bool stop) noexcept {
  PathNode& node = Node(end_);
  node = {};
  node.at = point;
  node.stop = stop;
  node.build_up_s = build_up_s_;
  node.bounds = BoundsAt(point, limits_, build_up_s_, kShare);
  node.own = SquareAt(point, limits_, kShare);
  Third third{};
  if (!IsFirst(end_)) {
    PathNode& before = Node(end_ - 1);
    third = ThirdBetween(before.at, point, limits_);
    const double square = DriftSquare(third, limits_, before.at, point);
    node.own = std::min(node.own, square);
    before.own = std::min(before.own, square);
    before.cap = std::min(before.cap, square);
    const AccelerationCap strength = AccelerationCapAt(before.at, third, limits_, before.own, before.build_up_s);
    before.own_strength = Least(before.own_strength, strength, before.own);
    before.bounds.strength = Least(before.bounds.strength, strength, before.cap);
    Spread(end_ - 1);
  }
  node.cap = node.own;
  node.own_strength = node.bounds.strength = AccelerationCapAt(point, third, limits_, node.own, build_up_s_);
  Spread(end_++);
}

// Limits of a node hold for all nodes from which, or to which, the mean reaches. Where the velocity limit changes, also
// for the first node beyond: on the way to it the motion is no faster than the lower limit.
void PathWindow::Spread(std::uint64_t i) noexcept {
  PathNode& node = Node(i);
  const double half = 0.5 * node.build_up_s;
  const double reach = half * std::sqrt(node.own);
  for (std::uint64_t k = i; !IsFirst(k); --k) {
    PathNode& before = Node(k - 1);
    if (node.at.s - before.at.s > reach) {
      const double slow = node.at.limits.velocity;
      if (slow < before.at.limits.velocity && slow * slow < before.cap) {
        before.cap = slow * slow;
        lowest_ = std::min(lowest_, k - 1);
      }
      break;
    }
    const double cap = std::min(before.cap, node.own);
    const AccelerationCap strength = Least(before.bounds.strength, node.own_strength, cap);
    if (before.cap == cap && before.bounds.strength == strength) continue;
    before.cap = cap;
    before.bounds.strength = strength;
    lowest_ = std::min(lowest_, k - 1);
  }
  // No node further back than the fastest one reaches is slower and reaches as far.
  for (std::uint64_t k = i; !IsFirst(k) && !Node(k).at.renewed; --k) {
    const PathNode& before = Node(k - 1);
    const double distance = node.at.s - before.at.s;
    if (distance > reach) break;
    const double its_reach = half * std::sqrt(before.own);
    if (distance > its_reach) {
      const double slow = before.at.limits.velocity;
      const bool first_beyond = Node(i - 1).at.s - before.at.s <= its_reach;
      if (first_beyond && slow < node.at.limits.velocity) node.cap = std::min(node.cap, slow * slow);
      continue;
    }
    node.cap = std::min(node.cap, before.own);
    node.bounds.strength = Least(node.bounds.strength, before.own_strength, node.cap);
  }
}

std::uint64_t PathWindow::free_until() const noexcept {
  for (std::uint64_t i = known_; i > begin_; --i) {
    if ((*this)[i - 1].ceiling >= (*this)[i - 1].cap || (*this)[i - 1].stop) return i - 1;
  }
  return begin_;
}

void PathWindow::SweepFrom(std::uint64_t behind) noexcept {
  next_ = behind;
  low_ = std::max(begin_, std::min(kept_from_, behind));
  Sweep(nodes_.size());
}

void PathWindow::Weaken(double from, double to, std::uint64_t first, const PathShares& shares) noexcept {
  std::uint64_t behind = known_ - 1;  // the last node is a stop
  while (behind > first + 1 && Node(behind - 1).at.s > to) --behind;
  kept_.clear();
  std::uint64_t i = behind;
  while (i > first && (i == behind || Node(i).at.s > from) && kept_.size() < kKept) {
    PathNode& node = Node(--i);
    kept_.push_back(node);
    node.own *= shares.square;
    node.cap *= shares.square;
    for (std::size_t k = 0; k < node.bounds.count; ++k) node.bounds.reach[k] *= shares.acceleration;
    for (AccelerationCap* strength : {&node.own_strength, &node.bounds.strength}) {
      strength->at_rest *= shares.strength;
      strength->fading *= shares.strength;
      strength->least *= shares.strength;
    }
  }
  kept_from_ = i;
  SweepFrom(behind);
}

void PathWindow::TakeBack() noexcept {
  std::uint64_t i = kept_from_ + kept_.size();
  const std::uint64_t behind = i;
  for (const PathNode& node : kept_) Node(--i) = node;
  kept_.clear();
  SweepFrom(behind);
}

void PathWindow::Close() noexcept {
  if (known_ == end_) return;
  const std::uint64_t last = end_ - 1;
  std::uint64_t first = std::max(known_, begin_ + 1) - 1;  // the path that led to the old end now continues
  if (known_ > begin_ && Node(known_ - 1).stop) first = known_;
  if (!swept()) first = std::min(first, low_);
  low_ = std::max(begin_, std::min(first, lowest_));
  known_ = lowest_ = end_;
  PathNode& end = Node(last);
  end.ceiling = end.coast = 0;
  next_ = last;
  if (low_ > next_) low_ = next_;
}

bool PathWindow::Sweep(std::size_t nodes) noexcept {
  for (; nodes > 0 && next_ > low_; --nodes) Raise(--next_);
  // Beyond the required nodes: as long as ceilings change.
  for (; nodes > 0 && next_ == low_ && low_ > begin_ && !Node(low_ - 1).stop; --nodes) {
    if (!Raise(low_ - 1)) break;
    next_ = --low_;
  }
  return swept();
}

// Updates the ceiling of a node. Returns true if it has changed.
bool PathWindow::Raise(std::uint64_t i) noexcept {
  PathNode& node = Node(i);
  if (node.stop) {
    node.ceiling = node.coast = 0;
    return false;
  }
  const PathNode& next = Node(i + 1);
  const double length = next.at.s - node.at.s;
  const double before = node.ceiling;
  const double coast_before = node.coast;
  if (length > 0) {
    node.ceiling = SquareBefore(node.bounds, length, next.ceiling, node.cap);
  } else {
    node.ceiling = std::min({node.cap, next.ceiling, JointSquare(node.at.slopes, next.at.slopes, limits_, period_s_)});
  }
  node.coast = CoastFrom(i);
  return node.ceiling != before || node.coast != coast_before;
}

// Returns the largest squared speed that may be held for the time T from there without exceeding a ceiling, and for one
// cycle more, since an acceleration that ends at a node does so within a cycle.
double PathWindow::CoastFrom(std::uint64_t i) const noexcept {
  const double s = (*this)[i].at.s;
  double square = (*this)[i].ceiling;
  for (std::uint64_t k = i; k + 1 < known_ && !(*this)[k].stop; ++k) {
    const PathNode& node = (*this)[k];
    const PathNode& next = (*this)[k + 1];
    const double hold_s = node.build_up_s + period_s_;
    const double to_next = (next.at.s - s) / hold_s;  // speed that reaches the next node in that time
    if (std::min(square, next.ceiling) <= to_next * to_next) {
      // The speed u with u² = ceiling at s + u hold; the ceiling is linear up to there.
      const double length = next.at.s - node.at.s;
      const double tilt = length > 0 ? (next.ceiling - node.ceiling) / length : 0;
      const double half = 0.5 * tilt * hold_s;
      const double here = node.ceiling - tilt * (node.at.s - s);
      const double u = half + std::sqrt(std::max(0.0, half * half + here));
      return std::min(square, u * u);
    }
    square = std::min(square, next.ceiling);
  }
  return square;
}

void PathWindow::DropBefore(std::uint64_t node) noexcept {
  begin_ = std::clamp(node, begin_, end_);
  low_ = std::max(low_, begin_);
  next_ = std::max(next_, begin_);
  lowest_ = std::max(lowest_, begin_);
}

void PathWindow::Stay() noexcept {
  if (known_ > begin_) Node(known_ - 1).stop = true;
}

void PathWindow::CutBehind(std::uint64_t node) noexcept {
  end_ = node + 1;
  known_ = std::min(known_, node);
  lowest_ = std::min(lowest_, node);
  next_ = low_ = std::max(begin_, std::min(low_, node));
  Close();
  Sweep(nodes_.size());
}

}  // namespace takt::trajectory
