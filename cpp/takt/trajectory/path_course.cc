#include "takt/trajectory/path_course.h"

#include <algorithm>
#include <cmath>

namespace takt::trajectory {

namespace {

constexpr std::size_t kMostSlow = 128;
constexpr std::size_t kMostNodes = 1024;
constexpr double kFast = 0.7;        // of the speed around it: a place is not slow
constexpr double kOfBuildUp = 0.25;  // of the time in which accelerations build up: an interval
constexpr double kShortest_s = 5e-4;
constexpr double kLongest_s = 0.025;
// Shares of jerk that steps at a node, by how the coordinates bend: it becomes a knot.
constexpr double kTurn = 0.15;
constexpr double kLeastParts = 16;
constexpr int kAttempts = 6, kEasings = 4;
constexpr double kEased = 0.97;
constexpr double kReferenceShare = 0.97;  // of the limits: what begins with it can be gone on with
// Of the limits of coordinates: between two nodes the slopes' bend is taken for even.
constexpr double kCoordinateShare = 0.98;
constexpr double kNoLimitFrom = 1e11;
constexpr double kHere = 1e-9;  // mm

double Or(double limit) {
  return limit < kNoLimitFrom ? limit : std::numeric_limits<double>::infinity();
}

// Slopes at a place behind a node.
struct Slopes {
  double first = 0, second = 0, third = 0;
};
Slopes SlopesAt(const PathNode& before, const PathNode& after, double place, std::size_t k) {
  const double length = after.at.s - before.at.s;
  const PathSlopes &a = before.at.slopes, &b = after.at.slopes;
  if (!(length > 0)) return {a.first[k], a.second[k], 0};
  const double x = std::clamp(place - before.at.s, 0.0, length);
  const double part = x / length;
  // The second slope is a parabola between the nodes; what is left between their first ones is rounding.
  const double bend = b.second[k] - a.second[k];
  const double sag = after.at.has_middle ? 4 * (after.at.middle[k] - 0.5 * (a.second[k] + b.second[k])) : 0;
  const double gap = b.first[k] - a.first[k] - length * (a.second[k] + 0.5 * bend + sag / 6);
  return {a.first[k] + x * (a.second[k] + part * (0.5 * (bend + sag) - part * sag / 3)) + part * gap,
          a.second[k] + part * (bend + sag * (1 - part)), (bend + sag * (1 - 2 * part)) / length};
}

const PathNode& Next(const PathWindow& window, std::uint64_t node) {
  const bool last = node + 1 >= window.end() || window[node].stop;
  return window[last ? node : node + 1];
}

// What the coordinates leave of acceleration and jerk along a straight piece of path.
struct AlongLimits {
  double acceleration, deceleration, jerk;
};
AlongLimits LimitsAt(const PathPoint& point, const CoordinateLimits& limits) {
  AlongLimits least{point.limits.acceleration, point.limits.deceleration, point.limits.jerk};
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    const double a = kCoordinateShare * point.left * limits.of[k].acceleration;
    const double j = kCoordinateShare * point.left * limits.of[k].jerk;
    if (slope * least.acceleration > a) least.acceleration = a / slope;
    if (slope * least.deceleration > a) least.deceleration = a / slope;
    if (slope * least.jerk > j) least.jerk = j / slope;
  }
  return least;
}

// The way in which a speed becomes another one, without acceleration at either end.
double WayBetween(double one, double other, double acceleration, double jerk) {
  const double change = std::abs(other - one);
  const double full = acceleration * acceleration / jerk;
  const double time = change > full ? change / acceleration + acceleration / jerk : 2 * std::sqrt(change / jerk);
  return 0.5 * (one + other) * time;
}

}  // namespace

std::uint64_t NodeAt(const PathWindow& window, std::uint64_t from, double place) noexcept {
  while (from + 1 < window.known() && !window[from].stop && window[from + 1].at.s <= place + kHere) ++from;
  return from;
}

std::uint64_t StopBehind(const PathWindow& window, std::uint64_t from) noexcept {
  while (from + 1 < window.known() && !window[from].stop) ++from;
  return from;
}

double UseOf(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept {
  const PathNode &before = window[node], &after = Next(window, node);
  const CoordinateLimits& limits = window.limits();
  const double v = along.velocity, a = along.acceleration;
  double use = v / before.at.limits.velocity;
  const double left = std::min(before.at.left, after.at.left);
  for (std::size_t k = 0; k < limits.count; ++k) {
    const CoordinateLimits::One& of = limits.of[k];
    const Slopes q = SlopesAt(before, after, along.position, k);
    use = std::max({use, std::abs(q.first * v) / (left * of.velocity),
                    std::abs(q.first * a + q.second * v * v) / (left * of.acceleration),
                    std::abs(q.first * jerk + 3 * q.second * v * a + q.third * v * v * v) / (left * of.jerk)});
  }
  return use;
}

PathCourse::PathCourse(std::size_t intervals) {
  steps_.reserve(intervals);
  lengths_.reserve(intervals);
  first_limits_.reserve(intervals);
  limits_.reserve(kPathCoordinates + 1);
  of_.reserve(kPathCoordinates);
  rates_.reserve(kPathCoordinates + 1);
  slow_.reserve(kMostSlow + 2);
  square_.reserve(kMostNodes);
  nodes_.reserve(kMostNodes);
  turns_.reserve(kMostNodes);
  knots_.reserve(kMostNodes + Profile::kCapacity);
}

// The mean of what holds between two places.
Limits PathCourse::Between(const PathWindow& window, const Slow& from, const Slow& to) const noexcept {
  double length = 0, velocity = 0, acceleration = 0, jerk = 0;
  for (std::uint64_t i = from.node; i <= to.node; ++i) {
    const double begin = std::max(window[i].at.s, from.place);
    const double end = i < to.node ? window[i + 1].at.s : to.place;
    const double way = std::max(end - begin, 1e-12);
    const AlongLimits along = LimitsAt(window[i].at, window.limits());
    length += way;
    velocity += way * std::sqrt(square_[i - slow_.front().node]);
    acceleration += way * std::min(along.acceleration, along.deceleration);
    jerk += way * along.jerk;
  }
  velocity = std::max({velocity / length, from.speed, to.speed});
  acceleration *= kReferenceShare / length;
  return {velocity, acceleration, acceleration, kReferenceShare * jerk / length};
}

// Places slower than what lies around them, from `begin` to rest at `end`.
void PathCourse::FindSlow(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
                          double factor) noexcept {
  square_.clear();
  turns_.clear();
  for (std::uint64_t i = node; i <= end; ++i) {
    const PathNode& at = window[i];
    const double most = factor * at.at.limits.velocity;
    double square = std::min(at.own, most < kNoLimitFrom ? most * most : factor * factor * at.own);
    for (const std::uint64_t k : {i - 1, i}) {  // two nodes at the same place
      if (k < node || k + 1 > end || window[k + 1].at.s > window[k].at.s) continue;
      square = std::min(square, JointSquare(window[k].at.slopes, window[k + 1].at.slopes, window.limits(), 1e-3));
    }
    square_.push_back(square);
    double turn = 0;
    if (i > node && i < end && window[i].at.s > window[i - 1].at.s && window[i + 1].at.s > window[i].at.s) {
      for (std::size_t k = 0; k < window.limits().count; ++k) {
        const double before = SlopesAt(window[i - 1], window[i], window[i].at.s, k).third;
        const double after = SlopesAt(window[i], window[i + 1], window[i].at.s, k).third;
        turn = std::max(turn, std::abs(after - before) / window.limits().of[k].jerk);
      }
    } else if (i > node && i < end) {
      turn = std::numeric_limits<double>::infinity();
    }
    turns_.push_back(turn * square * std::sqrt(square));
  }
  // What acceleration alone allows from either side; in place, the own squares are found again by comparing.
  slow_.clear();
  slow_.push_back({node, begin.position, begin.velocity});
  const std::size_t n = square_.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const bool lowest = square_[i] < square_[i - 1] && square_[i] <= square_[i + 1];
    if (!lowest || window[node + i].at.s <= begin.position + kHere) continue;
    const Slow slow{node + i, window[node + i].at.s, std::sqrt(square_[i])};
    // A place is slow beside the fastest one between it and its slow neighbours.
    const auto peak = [&](std::uint64_t from, std::uint64_t to) {
      const auto first = square_.begin() + static_cast<std::ptrdiff_t>(from - node);
      const auto last = square_.begin() + static_cast<std::ptrdiff_t>(to - node) + 1;
      return std::sqrt(*std::max_element(first, last));
    };
    while (slow_.size() > 1 && slow.speed <= slow_.back().speed &&
           slow_.back().speed > kFast * peak(slow_.back().node, slow.node)) {
      slow_.pop_back();
    }
    if (slow_.size() > 1 && slow.speed > kFast * peak(slow_.back().node, slow.node)) continue;
    if (slow_.size() > kMostSlow) break;
    slow_.push_back(slow);
  }
  while (slow_.size() > 1) {
    double most = 0;
    for (std::uint64_t i = slow_.back().node; i <= end; ++i) most = std::max(most, square_[i - node]);
    if (slow_.back().speed <= kFast * std::sqrt(most)) break;
    slow_.pop_back();
  }
  slow_.push_back({end, window[end].at.s, 0});
}

// No speed from which, or to which, the way to the next slow place is too short.
void PathCourse::MakeReachable(const PathWindow& window, const KinematicState& begin) noexcept {
  const auto lower = [&](const Slow& from, Slow& to) {
    const Limits limits = &from < &to ? Between(window, from, to) : Between(window, to, from);
    const double way = std::abs(to.place - from.place);
    if (to.speed <= from.speed || WayBetween(from.speed, to.speed, limits.acceleration, limits.jerk) <= way) return;
    double low = from.speed, high = to.speed;
    for (int i = 0; i < 24; ++i) {
      const double middle = 0.5 * (low + high);
      (WayBetween(from.speed, middle, limits.acceleration, limits.jerk) <= way ? low : high) = middle;
    }
    to.speed = low;
  };
  for (std::size_t i = slow_.size() - 1; i > 1; --i) lower(slow_[i], slow_[i - 1]);
  slow_.front().speed = begin.velocity;
  for (std::size_t i = 1; i + 1 < slow_.size(); ++i) lower(slow_[i - 1], slow_[i]);
}

// An interval of the reference, whatever its pieces are in between: place, speed and acceleration at both ends are its.
void PathCourse::Add(const PathWindow& window, const KinematicState& from, const KinematicState& to,
                     double length_s) noexcept {
  Step step;
  static_cast<Quintic&>(step) = Connect(length_s, from, to);
  step.begin_s = steps_.empty() ? 0 : steps_.back().begin_s + steps_.back().length;
  step.node = NodeAt(window, steps_.empty() ? slow_.front().node : steps_.back().node, from.position);
  steps_.push_back(step);
}

// Intervals of one motion of the reference: with knots where its jerk steps, and where the way coordinates bend does.
// False: there is no room for them.
bool PathCourse::Cut(const PathWindow& window, const Slow& from, const Slow& to, const Profile& profile,
                     double longest_s) noexcept {
  knots_.clear();
  for (int i = 0; i < profile.size(); ++i) knots_.push_back({profile.piece_ends_s[static_cast<std::size_t>(i)], kTurn});
  const std::uint64_t first = slow_.front().node;
  double at_s = 0;
  for (std::uint64_t node = from.node + 1; node < to.node; ++node) {
    const double turn = turns_[node - first];
    if (!(turn > kTurn) || !(window[node].at.s > profile.start().position)) continue;
    at_s = profile.TimeAt(window[node].at.s, at_s);
    if (std::isnan(at_s)) break;
    knots_.push_back({at_s, turn});
  }
  std::ranges::sort(knots_, {}, &Knot::at_s);
  const double end_s = profile.duration();
  double begin_s = 0;
  KinematicState begin = profile.start();
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    // Of knots that are too near to one another the sharpest stays.
    while (i + 1 < knots_.size() && knots_[i + 1].at_s - knots_[i].at_s < kShortest_s) {
      if (knots_[i].turn > knots_[i + 1].turn) std::swap(knots_[i], knots_[i + 1]);
      ++i;
    }
    double until_s = knots_[i].at_s;
    if (until_s > end_s - kShortest_s) until_s = end_s;
    if (until_s - begin_s < kShortest_s && until_s < end_s) continue;
    if (!(until_s > begin_s)) break;
    const auto parts = static_cast<int>(std::ceil((until_s - begin_s) / longest_s));
    const double length_s = (until_s - begin_s) / parts;
    for (int part = 1; part <= parts; ++part) {
      if (steps_.size() >= most_) return false;
      const KinematicState end = profile.At(part < parts ? begin_s + length_s * part : until_s);
      Add(window, begin, end, length_s);
      begin = end;
    }
    begin_s = until_s;
    if (until_s >= end_s) break;
  }
  return true;
}

bool PathCourse::Make(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
                      double factor, std::size_t most, Planner& planner) noexcept {
  most_ = std::min(most, steps_.capacity());
  factor_ = factor;
  begins_at_rest_ = begin.velocity == 0 && begin.acceleration == 0;
  // What is faster than it may be (the factor has become less) is braked as the reference is.
  brakes_ = begin.velocity > factor * window[node].at.limits.velocity;
  end = std::min(end, node + kMostNodes - 1);
  double of_build_up = kOfBuildUp;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (end <= node || !(window[end].at.s > begin.position + kHere)) return false;
    FindSlow(window, node, begin, end, factor);
    Laid laid = Laid::kWhole;
    for (int i = 0; i < kEasings; ++i) {
      MakeReachable(window, begin);
      laid = Lay(window, begin, of_build_up, planner);
      if (laid != Laid::kWhole) break;
      SetLimits(window, node, end);
      if (!Ease()) break;
    }
    if (laid == Laid::kTooNear) return false;
    if (laid == Laid::kWhole && steps_.size() >= 4) {
      end_place_ = window[end].at.s;
      return true;
    }
    if (laid == Laid::kWhole) {
      of_build_up *= 0.25;
      continue;
    }
    // Not so far: to a node at four fifths of what there is room for.
    const std::uint64_t nearer = NodeAt(window, node, steps_[most_ * 4 / 5].At(0).position);
    end = std::min(nearer, end - 1);
  }
  return false;
}

// The reference from slow place to slow place.
PathCourse::Laid PathCourse::Lay(const PathWindow& window, const KinematicState& begin, double of_build_up,
                                 Planner& planner) noexcept {
  steps_.clear();
  KinematicState from = begin;
  for (std::size_t i = 1; i < slow_.size();) {
    const Slow to = slow_[i];
    const Limits limits = Between(window, slow_[i - 1], to);
    Profile profile{};
    if (planner.ToPosition(from, to.place, to.speed, limits, profile).failed()) return Laid::kTooNear;
    const Profile::Range places = profile.PositionRange();
    const double rounding = 1e-9 * (1 + std::abs(to.place));
    const bool back = profile.VelocityRange().min < -1e-9 * limits.velocity;
    if (back || places.max > to.place + rounding || places.min < from.position - rounding) {
      if (i + 1 == slow_.size()) return Laid::kTooNear;
      slow_.erase(slow_.begin() + static_cast<std::ptrdiff_t>(i));  // on to the next one
      continue;
    }
    const double usual = std::min(of_build_up * limits.acceleration / limits.jerk, profile.duration() / kLeastParts);
    const double longest = std::clamp(usual, kShortest_s, kLongest_s);
    if (!Cut(window, slow_[i - 1], to, profile, longest)) return Laid::kNoRoom;
    from = {to.place, to.speed, 0};
    ++i;
  }
  return Laid::kWhole;
}

// Makes places slower at which the reference uses more than all of a limit: a plan is found the sooner. True: there
// were some.
bool PathCourse::Ease() noexcept {
  bool eased = false;
  std::size_t k = 0;
  for (std::size_t i = 1; i + 1 < slow_.size(); ++i) {
    const double until = 0.5 * (slow_[i].place + slow_[i + 1].place);
    double most = 0;
    for (; k < steps_.size() && steps_[k].At(0).position < until; ++k) {
      for (const double share : {0.0, 1.0}) {
        Rates(k, share, rates_);
        for (std::size_t q = 0; q < rates_.size(); ++q) {
          const RateLimits& l = q == 0 ? first_limits_[k] : limits_[q];
          most = std::max({most, std::abs(rates_[q].second) / l.acceleration, std::abs(rates_[q].third) / l.jerk});
        }
      }
    }
    if (most <= kEased) continue;
    slow_[i].speed *= std::max(0.6, std::sqrt(0.97 * kEased / most));
    eased = true;
  }
  return eased;
}

void PathCourse::SetLimits(const PathWindow& window, std::uint64_t node, std::uint64_t end) noexcept {
  const CoordinateLimits& limits = window.limits();
  nodes_.clear();
  first_node_ = node;
  for (std::uint64_t i = node; i <= end; ++i) nodes_.push_back(window[i]);
  limits_.assign(1, {});
  of_.clear();
  double left = 1;
  for (std::uint64_t i = node; i <= end; ++i) left = std::min(left, window[i].at.left);
  for (std::size_t k = 0; k < limits.count; ++k) {
    const CoordinateLimits::One& of = limits.of[k];
    bool moves = false;
    for (std::uint64_t i = node; i <= end && !moves; ++i) moves = window[i].at.slopes.first[k] != 0;
    if (!moves || !(std::isfinite(of.velocity) || std::isfinite(of.acceleration) || std::isfinite(of.jerk))) continue;
    const double share = kCoordinateShare * left;
    limits_.push_back({share * of.velocity, share * of.acceleration, share * of.acceleration, share * of.jerk});
    of_.push_back(k);
  }
  rates_.resize(limits_.size());
  lengths_.clear();
  first_limits_.clear();
  for (const Step& step : steps_) {
    lengths_.push_back(step.length);
    const KinematicState before = step.At(0), after = step.At(step.length);
    AlongPath along = window[step.node].at.limits;
    const std::uint64_t last = NodeAt(window, step.node, after.position);
    double square = square_[step.node - node];
    for (std::uint64_t i = step.node + 1; i <= std::min(last + 1, end); ++i) {
      if (i > last && window[i - 1].at.s >= after.position - kHere) break;
      along = Least(along, window[i].at.limits);
      if (window[i].at.s == window[i - 1].at.s) square = std::min(square, square_[i - node]);
    }
    double velocity = factor_ * along.velocity;
    if (along.velocity >= kNoLimitFrom) velocity = factor_ < 1 ? std::sqrt(square) : along.velocity;
    for (const std::uint64_t i : {step.node, last}) {
      if (i + 1 <= end && i >= node && window[i + 1].at.s == window[i].at.s) {
        velocity = std::min(velocity, std::sqrt(square_[i - node]));
      }
    }
    if (brakes_) {
      const double braked = 1.001 * std::max(before.velocity, after.velocity);
      velocity = std::max(velocity, std::min(braked, std::max(along.velocity, before.velocity)));
    }
    first_limits_.push_back({Or(velocity), Or(along.acceleration), Or(along.deceleration), Or(along.jerk)});
  }
}

void PathCourse::Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const noexcept {
  const Step& step = steps_[interval];
  const KinematicState at = step.At(share * step.length);
  const double v = at.velocity, a = at.acceleration;
  const auto& c = step.c;
  const double j = (6 * c[3] + share * (24 * c[4] + share * 60 * c[5])) / (step.length * step.length * step.length);
  out[0] = {v, a, j};
  const std::uint64_t node = step.node;
  // At the beginning what lies behind the place counts, at the end what lies before it.
  const double place = at.position + (share < 0.5 ? kHere : -kHere);
  std::size_t i = node - first_node_;
  while (i + 2 < nodes_.size() && nodes_[i + 1].at.s <= place) ++i;
  const PathNode &before = nodes_[i], &after = nodes_[i + 1];
  for (std::size_t k = 0; k < of_.size(); ++k) {
    const Slopes q = SlopesAt(before, after, at.position, of_[k]);
    out[k + 1] = {q.first * v, q.first * a + q.second * v * v,
                  q.first * j + 3 * q.second * v * a + q.third * v * v * v};
  }
}

PathPlanRequest PathCourse::Request() const noexcept {
  PathPlanRequest request;
  request.lengths = lengths_;
  request.limits = limits_;
  request.first_limits = first_limits_;
  request.motion.owner = this;
  request.motion.rates = [](const void* owner, std::size_t interval, double share,
                            std::span<ReferenceRate> out) noexcept {
    static_cast<const PathCourse*>(owner)->Rates(interval, share, out);
  };
  if (!begins_at_rest_) request.begin = ReferencePace{1, 0};
  return request;
}

KinematicState PathCourse::At(const ReferenceState& reference) const noexcept {
  const auto behind = std::upper_bound(steps_.begin(), steps_.end(), reference.time,
                                       [](double t, const Step& s) { return t < s.begin_s; });
  const Step& step = behind == steps_.begin() ? *behind : *(behind - 1);
  const KinematicState at = step.At(std::min(reference.time - step.begin_s, step.length));
  return {at.position, at.velocity * reference.rate,
          at.velocity * reference.acceleration + at.acceleration * reference.rate * reference.rate};
}

}  // namespace takt::trajectory
