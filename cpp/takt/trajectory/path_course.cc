#include "takt/trajectory/path_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace takt::trajectory {

namespace {

constexpr std::size_t kMostSlow = 128;
constexpr std::size_t kMostNodes = 1024;
constexpr double kFast = 0.7;        // share of the largest speed around it above which a node is not slow
constexpr double kOfBuildUp = 0.25;  // length of an interval, as a share of the time in which accelerations build up
constexpr double kShortest_s = 5e-4, kLongest_s = 0.025;  // of an interval
constexpr double kBesideJoint_s = 0.002;                  // of an interval that ends at a joint, at least ...
constexpr double kBesideJointCycles = 4;                  // ... and in cycles
constexpr double kTurn = 0.15;      // jerk step at a node above this share of the jerk limit: it is a knot
constexpr double kLeastParts = 16;  // about the least number of intervals between two slow nodes
constexpr int kAttempts = 6, kEasings = 4;
constexpr double kEased = 0.97;  // largest share of a limit that the reference is to use at slow nodes
// Share of the previous use, reached at most once a slow node is slower; else its speed is restored.
constexpr double kHelps = 0.995;
constexpr double kHarder[] = {1,   1.01, 1.02, 1.04,
                              1.1, 1.25, 1.5,  2};  // shares of its limits, tried for the reference from a motion
constexpr double kNoSlower = 0.9;                   // least speed in between, as a share of the slower end's
constexpr double kNoSpeed = 1e-9;                   // share of the velocity that is rounding
constexpr double kMostGrowth = 2.5;                 // ratio of the lengths of neighbouring intervals
constexpr double kReferenceShare = 0.97;  // of the limits, used by the reference, so that a plan can start from it
// Share of the coordinates' limits: between nodes the second slopes are taken as parabolas.
constexpr double kCoordinateShare = 0.98;
constexpr double kNoLimitFrom = 1e11;
constexpr double kStillBrakes = 1 + 1e-6;  // of the speed an interval later
constexpr double kAtLimit = 1 - 1e-6;      // of the velocity limit
constexpr double kNoAcceleration = 1e-6;   // share of the limit
constexpr double kHere = 1e-9;             // [mm]

double InfiniteIfNone(double limit) {
  return limit < kNoLimitFrom ? limit : std::numeric_limits<double>::infinity();
}

// Slopes at an arc length behind a node.
struct Slopes {
  double first = 0, second = 0, third = 0;
};
Slopes SlopesAt(const PathNode& before, const PathNode& after, double place, std::size_t k) {
  const double length = after.at.s - before.at.s;
  const PathSlopes &a = before.at.slopes, &b = after.at.slopes;
  if (!(length > 0)) return {a.first[k], a.second[k], 0};
  const double x = std::clamp(place - before.at.s, 0.0, length);
  const double part = x / length;
  // The second slope is a parabola between the nodes; the remaining gap between their first slopes is rounding.
  const double bend = b.second[k] - a.second[k];
  const double sag = after.at.has_middle ? 4 * (after.at.middle[k] - 0.5 * (a.second[k] + b.second[k])) : 0;
  const double gap = b.first[k] - a.first[k] - length * (a.second[k] + 0.5 * bend + sag / 6);
  return {a.first[k] + x * (a.second[k] + part * (0.5 * (bend + sag) - part * sag / 3)) + part * gap,
          a.second[k] + part * (bend + sag * (1 - part)), (bend + sag * (1 - 2 * part)) / length};
}

// Returns the jerk of a coordinate.
double JerkAt(const Slopes& q, const KinematicState& along, double jerk) {
  const double v = along.velocity;
  return q.first * jerk + 3 * q.second * v * along.acceleration + q.third * v * v * v;
}

const PathNode& Next(const PathWindow& window, std::uint64_t node) {
  const bool last = node + 1 >= window.end() || window[node].stop;
  return window[last ? node : node + 1];
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

AlongPath LimitsAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept {
  AlongPath least = point.limits;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    const double a = share * limits.of[k].acceleration;
    const double j = share * limits.of[k].jerk;
    if (slope * least.acceleration > a) least.acceleration = a / slope;
    if (slope * least.deceleration > a) least.deceleration = a / slope;
    if (slope * least.jerk > j) least.jerk = j / slope;
  }
  return least;
}

double JerkUse(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept {
  const PathNode &before = window[node], &after = Next(window, node);
  const CoordinateLimits& limits = window.limits();
  double use = 0;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const Slopes q = SlopesAt(before, after, along.position, k);
    use = std::max(use, std::abs(JerkAt(q, along, jerk)) / limits.of[k].jerk);
  }
  return use;
}

double UseOf(const PathWindow& window, std::uint64_t node, const KinematicState& along, double jerk) noexcept {
  const PathNode &before = window[node], &after = Next(window, node);
  const CoordinateLimits& limits = window.limits();
  const double v = along.velocity, a = along.acceleration;
  double use = v / before.at.limits.velocity;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const CoordinateLimits::One& of = limits.of[k];
    const Slopes q = SlopesAt(before, after, along.position, k);
    use =
        std::max({use, std::abs(q.first * v) / of.velocity, std::abs(q.first * a + q.second * v * v) / of.acceleration,
                  std::abs(JerkAt(q, along, jerk)) / of.jerk});
  }
  return use;
}

PathCourse::PathCourse(std::size_t intervals, double period_s) : period_s_(period_s), other_plan_(intervals) {
  steps_.reserve(intervals);
  other_steps_.reserve(intervals);
  followed_.reserve(intervals);
  lengths_.reserve(intervals);
  first_limits_.reserve(intervals);
  limits_.reserve(kPathCoordinates + 1);
  of_.reserve(kPathCoordinates);
  rates_.reserve(kPathCoordinates + 1);
  slow_.reserve(kMostSlow + 2);
  square_.reserve(kMostNodes);
  joints_.reserve(kMostNodes);
  nodes_.reserve(kMostNodes);
  turns_.reserve(kMostNodes);
  knots_.reserve(kMostNodes + Profile::kCapacity);
}

// Returns the mean limits between two slow nodes.
Limits PathCourse::Between(const Slow& from, const Slow& to) const noexcept {
  double length = 0, velocity = 0, acceleration = 0, jerk = 0;
  for (std::size_t i = from.node; i <= to.node; ++i) {
    const double begin = std::max(nodes_[i].at.s, from.place);
    const double end = i < to.node ? nodes_[i + 1].at.s : to.place;
    const double way = std::max(end - begin, 1e-12);
    const AlongPath along = LimitsAt(nodes_[i].at, coordinates_, kCoordinateShare);
    length += way;
    velocity += way * std::sqrt(square_[i]);
    acceleration += way * std::min(along.acceleration, along.deceleration);
    jerk += way * along.jerk;
  }
  // A start faster than the speed limit (the factor has been lowered) is braked to it.
  const bool brakes = &from == &slow_.front() && begin_.velocity > factor_ * nodes_.front().at.limits.velocity;
  velocity = std::max({velocity / length, brakes ? 0 : from.speed, to.speed});
  acceleration *= kReferenceShare * share_ / length;
  return {velocity, acceleration, acceleration, kReferenceShare * share_ * jerk / length};
}

// Computes the largest speed and the jerk step at each node, and the slow nodes from `begin` to rest at `end`.
void PathCourse::FindSlow(const KinematicState& begin, std::size_t end) noexcept {
  square_.clear();
  joints_.clear();
  turns_.clear();
  const auto at = [&](std::size_t i) { return nodes_[i].at.s; };
  for (std::size_t i = 0; i <= end; ++i) {
    const PathNode& node = nodes_[i];
    const double most = factor_ * node.at.limits.velocity;
    double square = std::min(node.own, most < kNoLimitFrom ? most * most : factor_ * factor_ * node.own);
    const bool joins_before = i > 0 && !(at(i) > at(i - 1)), joins_behind = i < end && !(at(i + 1) > at(i));
    const auto joint = [&](std::size_t k) {
      return kStepAtJoint * JointSquare(nodes_[k].at.slopes, nodes_[k + 1].at.slopes, coordinates_, period_s_);
    };
    double step = std::numeric_limits<double>::infinity();
    if (joins_before) step = std::min(step, joint(i - 1));
    if (joins_behind) step = std::min(step, joint(i));
    square = std::min(square, step);
    square_.push_back(square);
    joints_.push_back(step);
    double turn = joins_before || joins_behind ? std::numeric_limits<double>::infinity() : 0;
    if (turn == 0 && i > 0 && i < end) {
      for (std::size_t k = 0; k < coordinates_.count; ++k) {
        const double before = SlopesAt(nodes_[i - 1], node, at(i), k).third;
        const double after = SlopesAt(node, nodes_[i + 1], at(i), k).third;
        turn = std::max(turn, std::abs(after - before) / coordinates_.of[k].jerk);
      }
    }
    turns_.push_back(turn * square * std::sqrt(square));
  }
  slow_.clear();
  slow_.push_back({0, begin.position, begin.velocity});
  const auto peak = [&](std::size_t from, std::size_t to) {  // largest speed between two nodes
    const auto first = square_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto last = square_.begin() + static_cast<std::ptrdiff_t>(to) + 1;
    return std::sqrt(*std::max_element(first, last));
  };
  for (std::size_t i = 1; i < end && slow_.size() <= kMostSlow; ++i) {
    const bool lowest = square_[i] < square_[i - 1] && square_[i] <= square_[i + 1];
    if (!lowest || at(i) <= begin.position + kHere) continue;
    const Slow slow{i, at(i), std::sqrt(square_[i])};
    while (slow_.size() > 1 && slow.speed <= slow_.back().speed &&
           slow_.back().speed > kFast * peak(slow_.back().node, i)) {
      slow_.pop_back();
    }
    if (slow_.size() == 1 || slow.speed <= kFast * peak(slow_.back().node, i)) slow_.push_back(slow);
  }
  while (slow_.size() > 1 && slow_.back().speed > kFast * peak(slow_.back().node, end)) slow_.pop_back();
  slow_.push_back({end, at(end), 0});
}

// Lowers speeds from which, or to which, the distance to the next slow node is too short.
void PathCourse::MakeReachable(const KinematicState& begin) noexcept {
  const auto lower = [&](const Slow& from, Slow& to) {
    const Limits limits = &from < &to ? Between(from, to) : Between(to, from);
    const double way = std::abs(to.place - from.place);
    if (to.speed <= from.speed || RampLength(from.speed, to.speed, limits.acceleration, limits.jerk) <= way) return;
    double low = from.speed, high = to.speed;
    for (int i = 0; i < 24; ++i) {
      const double middle = 0.5 * (low + high);
      (RampLength(from.speed, middle, limits.acceleration, limits.jerk) <= way ? low : high) = middle;
    }
    to.speed = low;
  };
  for (std::size_t i = slow_.size() - 1; i > 1; --i) lower(slow_[i], slow_[i - 1]);
  slow_.front().speed = begin.velocity;
  for (std::size_t i = 1; i + 1 < slow_.size(); ++i) lower(slow_[i - 1], slow_[i]);
}

// Appends an interval of the reference; whatever its pieces in between, position, speed and acceleration match at both
// ends.
void PathCourse::Add(const KinematicState& from, const KinematicState& to, double length_s) noexcept {
  Step step;
  static_cast<Quintic&>(step) = Connect(length_s, from, to);
  step.begin_s = steps_.empty() ? 0 : steps_.back().begin_s + steps_.back().length;
  step.node = NodeAt(steps_.empty() ? 0 : steps_.back().node, from.position);
  steps_.push_back(step);
}

// Appends the intervals of one motion of the reference: with knots where its jerk steps, and where the third derivative
// of a coordinate by the arc length does. Returns false if there is no room for them.
bool PathCourse::Cut(const Slow& from, const Slow& to, const Profile& profile, double longest_s) noexcept {
  knots_.clear();
  for (int i = 0; i < profile.size(); ++i) knots_.push_back({profile.piece_ends_s[static_cast<std::size_t>(i)], kTurn});
  double at_s = 0;
  for (std::size_t i = from.node + 1; i < to.node; ++i) {
    if (!(turns_[i] > kTurn) || !(nodes_[i].at.s > profile.start().position)) continue;
    at_s = profile.TimeAt(nodes_[i].at.s, at_s);
    if (std::isnan(at_s)) break;
    knots_.push_back({at_s, turns_[i]});
  }
  // Intervals that end at a joint are nowhere faster than the joint allows.
  const double end_s = profile.duration();
  const double beside_s = std::max(kBesideJoint_s, kBesideJointCycles * period_s_);
  if (joints_[from.node] <= square_[from.node]) knots_.push_back({beside_s, kTurn});
  if (joints_[to.node] <= square_[to.node]) knots_.push_back({end_s - beside_s, kTurn});
  std::ranges::sort(knots_, {}, &Knot::at_s);
  double begin_s = 0;
  KinematicState begin = profile.start();
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    // Of knots that are too close to one another the sharpest one stays.
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
      if (steps_.size() == steps_.capacity()) return false;
      const KinematicState end = profile.At(part < parts ? begin_s + length_s * part : until_s);
      Add(begin, end, length_s);
      begin = end;
    }
    begin_s = until_s;
    if (until_s >= end_s) break;
  }
  return true;
}

bool PathCourse::Take(const PathWindow& window, std::uint64_t node, const KinematicState& begin, std::uint64_t end,
                      double factor) noexcept {
  if (end <= node || !(window[end].at.s > begin.position + kHere)) return false;
  nodes_.clear();
  for (std::uint64_t i = node; i <= std::min(end, node + kMostNodes - 1); ++i) nodes_.push_back(window[i]);
  coordinates_ = window.limits();
  begin_ = begin;
  other_steps_.clear();
  factor_ = factor;
  return true;
}

void PathCourse::Follow(const PathCourse& other, const PathPlan& plan, double from_s) noexcept {
  other_steps_ = other.steps_;  // there is room: neither allocates
  other_plan_ = plan;
  other_from_s_ = from_s;
}

// Computes the knots of the plan copied by Follow, up to where it brakes to its end.
void PathCourse::Sample() noexcept {
  followed_.clear();
  if (other_steps_.empty()) return;
  const PathPlan& plan = other_plan_;
  const auto state = [&](std::size_t k) { return At(other_steps_, plan.At(plan.knot_time(k))); };
  std::size_t last = plan.intervals();
  for (double behind = -1; last > 0 && plan.knot_time(last) > other_from_s_; --last) {
    const double speed = state(last).velocity;
    if (speed <= kStillBrakes * behind) break;
    behind = speed;
  }
  double before_s = other_from_s_;
  for (std::size_t k = 1; k <= last; ++k) {
    const double at_s = plan.knot_time(k);
    if (at_s < before_s + kShortest_s) continue;
    followed_.push_back({at_s - before_s, state(k)});
    before_s = at_s;
  }
}

// Returns the number of knots of that plan that are followed: until it brakes to its end, or until it first stops
// cruising. From there on the reference is as fast, while the plan need not be: before it brakes its speed may vary by
// a percent.
std::size_t PathCourse::FindJoint() const noexcept {
  std::size_t node = 0;
  bool cruised = false;
  for (std::size_t k = 0; k < followed_.size(); ++k) {
    const KinematicState& at = followed_[k].state;
    node = NodeAt(node, at.position);
    const PathNode& here = nodes_[node];
    const bool cruises = at.velocity >= kAtLimit * factor_ * here.at.limits.velocity &&
                         std::abs(at.acceleration) <= kNoAcceleration * here.at.limits.acceleration;
    if (cruised && !cruises) return k;
    cruised = cruises;
  }
  return followed_.size();
}

bool PathCourse::IsSlower(const PathPlan& plan, double share) const noexcept {
  if (followed_.empty()) return false;
  double until_s = 0;
  for (const Followed& followed : followed_) until_s += share * followed.length_s;
  return until_s < plan.duration() && At(plan.At(until_s)).position < followed_.back().state.position;
}

bool PathCourse::Make(Planner& planner, double share, bool follow) noexcept {
  Sample();
  joint_ = follow ? FindJoint() : 0;
  share_ = share;
  std::size_t end = nodes_.size() - 1;
  double of_build_up = kOfBuildUp;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (end == 0 || !(nodes_[end].at.s > begin_.position + kHere)) return false;
    FindSlow(Joint(), end);
    Laid laid = Laid::kWhole;
    for (int i = 0; i < kEasings; ++i) {
      MakeReachable(Joint());
      laid = Lay(of_build_up, planner);
      if (laid != Laid::kWhole) break;
      Grade();
      SetLimits(end);
      if (!Ease()) break;
    }
    if (laid == Laid::kTooNear && joint_ > 0) {
      joint_ /= 2;
      continue;
    }
    if (laid == Laid::kTooNear) return false;
    if (laid == Laid::kWhole && steps_.size() >= 4) {
      end_ = end;
      end_place_ = nodes_[end].at.s;
      return true;
    }
    if (laid == Laid::kWhole) {
      of_build_up *= 0.25;
      continue;
    }
    // Too far: end at a node at four fifths of what there is room for.
    end = std::min(NodeAt(0, steps_[steps_.capacity() * 4 / 5].At(0).position), end - 1);
  }
  return false;
}

bool PathCourse::Make(const PathCourse& other, const PathPlan& plan) noexcept {
  nodes_ = other.nodes_;  // there is room: it does not allocate
  square_ = other.square_;
  joints_ = other.joints_;
  coordinates_ = other.coordinates_;
  begin_ = other.begin_;
  factor_ = other.factor_;
  share_ = other.share_;
  end_ = other.end_;
  end_place_ = other.end_place_;
  steps_.clear();
  KinematicState from = begin_;
  for (std::size_t k = 0; k < plan.intervals(); ++k) {
    const double begin_s = plan.knot_time(k), length_s = plan.knot_time(k + 1) - begin_s;
    const auto parts = static_cast<int>(std::clamp(std::ceil(length_s / kLongest_s), 1.0, 64.0));
    for (int part = 1; part <= parts; ++part) {
      if (steps_.size() == steps_.capacity()) return false;
      const bool last = k + 1 == plan.intervals() && part == parts;
      const KinematicState to =
          last ? KinematicState{end_place_, 0, 0} : other.At(plan.At(begin_s + length_s * part / parts));
      Add(from, to, length_s / parts);
      from = to;
    }
  }
  Grade();
  SetLimits(end_);
  return true;
}

std::size_t PathCourse::NodeAt(std::size_t from, double place) const noexcept {
  while (from + 1 < nodes_.size() && nodes_[from + 1].at.s <= place + kHere) ++from;
  return from;
}

// Lays the reference from slow node to slow node.
PathCourse::Laid PathCourse::Lay(double of_build_up, Planner& planner) noexcept {
  steps_.clear();
  KinematicState from = begin_;
  for (const Followed& followed : std::span(followed_).first(joint_)) {
    if (steps_.size() == steps_.capacity()) return Laid::kNoRoom;
    Add(from, followed.state, followed.length_s);
    from = followed.state;
  }
  for (std::size_t i = 1; i < slow_.size();) {
    const Slow to = slow_[i];
    const Limits usual_limits = Between(slow_[i - 1], to);
    Limits limits = usual_limits;
    Profile profile{}, tried{};
    double least = -std::numeric_limits<double>::infinity();  // speed of the profile
    bool slows = false;
    // A motion in progress may brake harder than the reference does: it passes no slow node because of that, and is not
    // slower in between than there.
    for (const double share : kHarder) {
      Limits harder = usual_limits;
      harder.acceleration *= share;
      harder.deceleration *= share;
      harder.jerk *= share;
      if (planner.ToPosition(from, to.place, to.speed, harder, tried).failed()) return Laid::kTooNear;
      const Profile::Range places = tried.PositionRange(), speeds = tried.VelocityRange();
      const double rounding = 1e-9 * (1 + std::abs(to.place));
      const bool back = speeds.min < -kNoSpeed * harder.velocity;
      const bool reaches = !back && places.max <= to.place + rounding && places.min >= from.position - rounding;
      if (reaches && speeds.min > least) {
        least = speeds.min;
        limits = harder;
        profile = tried;
      }
      // The speed that a braking motion loses until it stops braking is lost in any case.
      const double brakes = std::min(from.acceleration, 0.0);
      const double unavoidable = from.velocity - brakes * brakes / (2 * harder.jerk);
      slows = speeds.min < kNoSlower * std::min(unavoidable, to.speed) - kNoSpeed * harder.velocity;
      if (i > 1 || (reaches && !slows)) break;
    }
    const bool reaches = std::isfinite(least);
    // Following a plan is preferred to a motion that comes nearly to rest.
    if (i == 1 && slows && share_ == 1 && joint_ == 0 && follows()) return Laid::kTooNear;
    if (!reaches) {
      if (i + 1 == slow_.size()) return Laid::kTooNear;
      slow_.erase(slow_.begin() + static_cast<std::ptrdiff_t>(i));  // continue with the next one
      continue;
    }
    const double usual = std::min(of_build_up * limits.acceleration / limits.jerk, profile.duration() / kLeastParts);
    const double longest = std::clamp(usual, kShortest_s, kLongest_s);
    if (!Cut(slow_[i - 1], to, profile, longest)) return Laid::kNoRoom;
    from = {to.place, to.speed, 0};
    ++i;
  }
  return Laid::kWhole;
}

// Halves intervals that are much longer than a neighbour, as far as there is room: where the speed changes by orders of
// magnitude the plan has to, too.
void PathCourse::Grade() noexcept {
  for (std::size_t k = 0; k < steps_.size();) {
    double beside = std::numeric_limits<double>::infinity();
    if (k > 0) beside = steps_[k - 1].length;
    if (k + 1 < steps_.size()) beside = std::min(beside, steps_[k + 1].length);
    if (steps_[k].length <= kMostGrowth * beside || steps_.size() == steps_.capacity()) {
      ++k;
      continue;
    }
    const Step whole = steps_[k];
    const double half_s = 0.5 * whole.length;
    const KinematicState begin = whole.At(0), middle = whole.At(half_s), end = whole.At(whole.length);
    Step second = whole;
    static_cast<Quintic&>(steps_[k]) = Connect(half_s, begin, middle);
    static_cast<Quintic&>(second) = Connect(half_s, middle, end);
    second.begin_s = whole.begin_s + half_s;
    second.node = NodeAt(whole.node, middle.position);
    steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(k) + 1, second);
    if (k > 0) --k;
  }
}

// Lowers the speed of slow nodes at which the reference uses more than kEased of a limit: a plan is found sooner.
// Returns true if any speed has changed.
bool PathCourse::Ease() noexcept {
  bool eased = false;
  std::size_t k = joint_;
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
    Slow& slow = slow_[i];
    if (most <= kEased || slow.stays) continue;
    if (slow.use > 0 && most > kHelps * slow.use) {
      slow.speed = slow.uneased;  // the cause is elsewhere
      slow.stays = true;
    } else {
      if (slow.use == 0) slow.uneased = slow.speed;
      slow.use = most;
      slow.speed *= std::max(0.6, std::sqrt(0.97 * kEased / most));
    }
    eased = true;
  }
  return eased;
}

// Collects the coordinates that move with their limits, and the limits of the path in each interval.
void PathCourse::SetLimits(std::size_t end) noexcept {
  limits_.assign(1, {});
  of_.clear();
  for (std::size_t k = 0; k < coordinates_.count; ++k) {
    const CoordinateLimits::One& of = coordinates_.of[k];
    bool moves = false;
    for (std::size_t i = 0; i <= end && !moves; ++i) moves = nodes_[i].at.slopes.first[k] != 0;
    if (!moves || !(std::isfinite(of.velocity) || std::isfinite(of.acceleration) || std::isfinite(of.jerk))) continue;
    const double a = kCoordinateShare * of.acceleration;
    limits_.push_back({kCoordinateShare * of.velocity, a, a, kCoordinateShare * of.jerk});
    of_.push_back(k);
  }
  rates_.resize(limits_.size());
  lengths_.clear();
  first_limits_.clear();
  // A start faster than the speed limit (the factor has been lowered) is braked as the reference is.
  const bool brakes = begin_.velocity > factor_ * nodes_.front().at.limits.velocity;
  for (const Step& step : steps_) {
    lengths_.push_back(step.length);
    const KinematicState before = step.At(0), after = step.At(step.length);
    AlongPath along = nodes_[step.node].at.limits;
    double joints = std::numeric_limits<double>::infinity();  // squared speeds: those that joints allow ...
    double own = joints;                                      // ... and those of a path without a speed limit
    for (std::size_t i = step.node;; ++i) {
      along = Least(along, nodes_[i].at.limits);
      const bool within = nodes_[i].at.s >= before.position - kHere && nodes_[i].at.s <= after.position + kHere;
      if (within) joints = std::min(joints, joints_[i]);
      if (within && joints_[i] <= square_[i]) {
        along.jerk = std::min(along.jerk, kJerkAtJoint * LimitsAt(nodes_[i].at, coordinates_, kCoordinateShare).jerk);
      }
      if (factor_ < 1 && along.velocity >= kNoLimitFrom) own = std::min(own, square_[i]);
      if (i == end || nodes_[i].at.s >= after.position - kHere) break;
    }
    double velocity = along.velocity >= kNoLimitFrom ? along.velocity : factor_ * along.velocity;
    velocity = std::min(velocity, std::sqrt(own));
    if (brakes) {
      const double braked = 1.001 * std::max(before.velocity, after.velocity);
      velocity = std::max(velocity, std::min(braked, std::max(along.velocity, before.velocity)));
    }
    velocity = std::min(velocity, std::sqrt(joints));
    first_limits_.push_back({InfiniteIfNone(velocity), InfiniteIfNone(along.acceleration),
                             InfiniteIfNone(along.deceleration), InfiniteIfNone(along.jerk)});
  }
}

void PathCourse::Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const noexcept {
  const Step& step = steps_[interval];
  const KinematicState at = step.At(share * step.length);
  const double v = at.velocity, a = at.acceleration;
  const auto& c = step.c;
  const double j = (6 * c[3] + share * (24 * c[4] + share * 60 * c[5])) / (step.length * step.length * step.length);
  out[0] = {v, a, j};
  // At the beginning of the interval the slopes behind a node count, at its end those before it.
  const double place = at.position + (share < 0.5 ? kHere : -kHere);
  std::size_t i = step.node;
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
  if (begin_.velocity != 0 || begin_.acceleration != 0) request.begin = ReferencePace{1, 0};
  return request;
}

KinematicState PathCourse::At(const ReferenceState& reference) const noexcept {
  return At(steps_, reference);
}

KinematicState PathCourse::At(const std::vector<Step>& steps, const ReferenceState& reference) noexcept {
  const auto behind = std::upper_bound(steps.begin(), steps.end(), reference.time,
                                       [](double t, const Step& s) { return t < s.begin_s; });
  const Step& step = behind == steps.begin() ? *behind : *(behind - 1);
  const KinematicState at = step.At(std::min(reference.time - step.begin_s, step.length));
  return {at.position, at.velocity * reference.rate,
          at.velocity * reference.acceleration + at.acceleration * reference.rate * reference.rate};
}

}  // namespace takt::trajectory
