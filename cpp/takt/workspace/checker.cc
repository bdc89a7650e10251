#include "takt/workspace/checker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace takt::workspace {
namespace {

using kinematics::Joints;
using kinematics::LinkFrameArray;
using kinematics::Reason;
using kinematics::Sweep;

constexpr double kFar = std::numeric_limits<double>::infinity();
// [mm] Rounding of positions at the bounds.
constexpr double kRounding = 1e-6;
// If the motion over this share of a segment (between two samples) cannot be bounded, the mechanism is singular.
constexpr double kSmallestShare = 1e-7;
// Steps of this share of a segment do not reach its end.
constexpr double kNoProgress = 1e-12;
// [mm] Distances beyond the margin by more than this are not computed exactly.
constexpr double kLookAhead = 100;

// A position on the path: after sample `index` by a share of the segment to the next one.
struct Place {
  std::size_t index = 0;
  double share = 0;

  auto operator<=>(const Place&) const = default;
};

struct Hit {
  Place at;
  double distance = 0;
  Reason reason = Reason::kNone;
};

// A moving object, and the link in whose frame its motion is measured.
struct Mover {
  std::size_t link = 0;
  std::size_t seen_from = 0;
  std::span<const KDL::Vector> points;
  double radius = 0;
};

class Walker {
 public:
  // `sweeps`: one for each sample, the last one without motion.
  Walker(const Cell& cell, std::span<const Sample> path, std::span<const Sweep> sweeps)
      : cell_(cell), path_(path), sweeps_(sweeps), end_{sweeps.size() - 1, 0} {}

  // Returns the first position up to the end at which `distance` of the links' frames is below `keep`.
  std::optional<Hit> Follow(const Mover& mover, double keep, const auto& distance) {
    Place at;
    Reason reason = Reason::kNone;
    for (;;) {
      const double seen = distance(at.share == 0 ? sweeps_[at.index].start : ahead_.start);
      if (seen < keep) return Hit{at, seen};
      if (at >= end_) return std::nullopt;
      reason = GoOn(mover, std::max(seen - keep, cell_.resolution), at);
      if (reason != Reason::kNone) return Hit{at, 0, reason};
    }
  }

  void EndAt(const Place& place) { end_ = place; }

  Joints JointsAt(const Place& at) const {
    Joints joints = path_[at.index].joints;
    if (at.share == 0) return joints;
    for (std::size_t i = 0; i < cell_.kinematics.count; ++i)
      joints[i] += at.share * (path_[at.index + 1].joints[i] - joints[i]);
    return joints;
  }

  double DistanceAlong(const Place& at) const {
    const double s = path_[at.index].s;
    return at.share == 0 ? s : s + at.share * (path_[at.index + 1].s - s);
  }

 private:
  double MoveOf(const Mover& mover, const Sweep& sweep) const {
    double move = 0;
    for (const KDL::Vector& point : mover.points) {
      move = std::max(move, kinematics::DisplacementBound(cell_.kinematics, sweep, mover.link, mover.seen_from, point,
                                                          mover.radius));
    }
    return move;
  }

  // Advances as far as no point of the mover moves by more than `budget`, at most to the end of the path.
  Reason GoOn(const Mover& mover, double budget, Place& at) {
    const Place start = at;
    const Sweep* sweep = at.share == 0 ? &sweeps_[at.index] : &ahead_;
    double move = MoveOf(mover, *sweep);
    while (move <= budget) {
      budget -= move;
      at = {at.index + 1, 0};
      if (at >= end_ || at.index + 1 == sweeps_.size()) return Reason::kNone;
      sweep = &sweeps_[at.index];
      move = MoveOf(mover, *sweep);
    }
    double part = 1 - at.share;
    while (!std::isfinite(move)) {
      part /= 4;
      if (part < kSmallestShare) return Reason::kSingular;
      if (const Reason reason = SweepFrom(at, part); reason != Reason::kNone) return reason;
      move = MoveOf(mover, ahead_);
    }
    if (move > budget) part *= budget / move;
    if (at == start && part < kNoProgress) return Reason::kOutOfReach;
    at.share += part;
    return SweepFrom(at, 1 - at.share);
  }

  Reason SweepFrom(const Place& at, double part) {
    return kinematics::MakeSweep(cell_.kinematics, JointsAt(at), JointsAt({at.index, at.share + part}), ahead_);
  }

  const Cell& cell_;
  std::span<const Sample> path_;
  std::span<const Sweep> sweeps_;
  Place end_;
  Sweep ahead_;  // from the last checked position to the next sample
};

struct Bound {
  std::string_view name;
  int axis = 0;
  double sign = 1;
  double value = 0;
};

std::vector<Bound> BoundsOf(const BoundsParams& p) {
  std::vector<Bound> bounds;
  const auto add = [&](std::string_view name, int axis, double sign, const std::optional<double>& value) {
    if (value) bounds.push_back({name, axis, sign, *value});
  };
  add("lower x", 0, -1, p.lower.x);
  add("lower y", 1, -1, p.lower.y);
  add("lower z", 2, -1, p.lower.z);
  add("upper x", 0, 1, p.upper.x);
  add("upper y", 1, 1, p.upper.y);
  add("upper z", 2, 1, p.upper.z);
  return bounds;
}

// One check of a path: of all moving objects in turn, each only up to the first finding so far.
class Run {
 public:
  Run(Cell& cell, std::span<const Sample> path, std::span<const Sweep> sweeps)
      : cell_(cell), sweeps_(sweeps), walker_(cell, path, sweeps) {}

  std::optional<Finding> All() {
    Bounds();
    for (std::size_t body = 0; body < cell_.bodies.size(); ++body) Obstacles(body);
    for (const auto& [a, b] : cell_.pairs) Pair(a, b);
    return std::move(first_);
  }

 private:
  void Take(const std::optional<Hit>& hit, Trouble trouble, const std::string& first, const std::string& second) {
    if (!hit || (first_ && hit->at >= found_at_)) return;
    found_at_ = hit->at;
    walker_.EndAt(hit->at);
    const bool lost = hit->reason != Reason::kNone;
    first_ = Finding{.trouble = lost ? Trouble::kNoPose : trouble,
                     .first = first,
                     .second = lost ? "" : second,
                     .s = walker_.DistanceAlong(hit->at),
                     .index = hit->at.index,
                     .distance = std::abs(hit->distance),
                     .joints = walker_.JointsAt(hit->at),
                     .reason = hit->reason};
  }

  void Bounds() {
    const std::vector<Bound> bounds = BoundsOf(cell_.bounds);
    if (bounds.empty()) return;
    const std::size_t tool = kinematics::LinksOf(cell_.kinematics).size() - 1;
    const std::array<KDL::Vector, 1> centre = {cell_.tool_centre};
    std::string_view nearest;
    const auto distance = [&](const LinkFrameArray& frames) {
      double least = kFar;
      const KDL::Vector at = frames[tool] * cell_.tool_centre;
      for (const Bound& bound : bounds) {
        const double room = bound.sign * (bound.value - at(bound.axis));
        if (room < least) nearest = bound.name;
        least = std::min(least, room);
      }
      return least;
    };
    const std::optional<Hit> hit = walker_.Follow({tool, 0, centre, 0}, -kRounding, distance);
    Take(hit, Trouble::kBounds, "tool", std::string(nearest));
  }

  void Obstacles(std::size_t index) {
    const Body& body = cell_.bodies[index];
    const std::vector<std::size_t>& obstacles = cell_.obstacles_of[index];
    if (obstacles.empty()) return;
    const kinematics::Frame& start = sweeps_.front().start[body.link];
    for (const std::size_t o : obstacles) {
      const Obstacle& obstacle = cell_.obstacles[o];
      if (Swallows(obstacle.shape, {}, body.shape, start) || Swallows(body.shape, start, obstacle.shape, {}))
        Take(Hit{}, Trouble::kCollision, body.name, obstacle.name);
    }
    std::size_t nearest = 0;
    const auto distance = [&](const LinkFrameArray& frames) {
      const Scene::Nearest found = cell_.scene.NearestObstacle(index, frames[body.link], cell_.margin + kLookAhead);
      nearest = found.obstacle;
      return found.distance;
    };
    const std::optional<Hit> hit =
        walker_.Follow({body.link, 0, body.shape.points, body.shape.radius}, cell_.margin, distance);
    Take(hit, Trouble::kCollision, body.name, cell_.obstacles[nearest].name);
  }

  void Pair(std::size_t first, std::size_t second) {
    const Body& a = cell_.bodies[first];
    const Body& b = cell_.bodies[second];
    const LinkFrameArray& start = sweeps_.front().start;
    if (Swallows(a.shape, start[a.link], b.shape, start[b.link]) ||
        Swallows(b.shape, start[b.link], a.shape, start[a.link]))
      Take(Hit{}, Trouble::kCollision, a.name, b.name);
    const auto distance = [&](const LinkFrameArray& frames) {
      return cell_.scene.Between(first, frames[a.link], second, frames[b.link], cell_.margin + kLookAhead);
    };
    Take(walker_.Follow({a.link, b.link, a.shape.points, a.shape.radius}, cell_.margin, distance), Trouble::kCollision,
         a.name, b.name);
  }

  Cell& cell_;
  std::span<const Sweep> sweeps_;
  Walker walker_;
  std::optional<Finding> first_;
  Place found_at_;
};

}  // namespace

std::optional<Finding> Checker::Check(std::span<const Sample> path) {
  sweeps_.resize(path.size());
  Reason reason = Reason::kNone;
  std::size_t good = 0;
  for (; good < path.size(); ++good) {
    const Joints& next = path[std::min(good + 1, path.size() - 1)].joints;
    reason = MakeSweep(cell_.kinematics, path[good].joints, next, sweeps_[good]);
    if (reason != Reason::kNone) break;
  }
  if (good > 0) {
    // At the end of the path, or at the last sample with a position, there is no further motion.
    const Joints& last = path[good - 1].joints;
    MakeSweep(cell_.kinematics, last, last, sweeps_[good - 1]);
    const std::span<const Sweep> sweeps(sweeps_.data(), good);
    std::optional<Finding> found = Run(cell_, path.first(good), sweeps).All();
    if (found) return found;
  }
  if (reason == Reason::kNone) return std::nullopt;
  return Finding{.trouble = Trouble::kNoPose,
                 .first = "tool",
                 .second = {},
                 .s = path[good].s,
                 .index = good,
                 .joints = path[good].joints,
                 .reason = reason};
}

std::string Checker::Describe(const Finding& finding, std::string_view unit) const {
  std::ostringstream text;
  text << std::fixed;
  text.precision(1);
  const auto place = [&] { text << ' ' << finding.s << ' ' << unit << " along the path"; };
  switch (finding.trouble) {
    case Trouble::kNone:
      break;
    case Trouble::kCollision:
      text << finding.first << " meets " << finding.second;
      place();
      text << std::defaultfloat << " (" << cell_.margin << " mm are to be kept)";
      break;
    case Trouble::kBounds:
      text << finding.first << " leaves the workspace at its bound " << finding.second;
      place();
      break;
    case Trouble::kNoPose:
      text << "the links have no position";
      place();
      text << ": " << Text(finding.reason);
      break;
  }
  return text.str();
}

std::vector<std::pair<std::string, std::string>> Checker::NearAtRest() const {
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& [a, b] : cell_.near_at_rest) names.emplace_back(cell_.bodies[a].name, cell_.bodies[b].name);
  return names;
}

MakeResult Make(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder,
                const KDL::Vector& tool_centre) {
  MadeCell made = MakeCell(params, kinematics, folder);
  if (!made.cell) return {.checker = std::nullopt, .path = std::move(made.path), .problem = std::move(made.problem)};
  made.cell->tool_centre = tool_centre;
  return {.checker = Checker(std::move(*made.cell)), .path = {}, .problem = {}};
}

}  // namespace takt::workspace
