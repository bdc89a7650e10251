#include "takt/planar/environment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::planar {
namespace {

constexpr double kFurthest = 1e6;  // [mm]

// The plane divided along all sides of stators into cells, each covered or not.
class Cut {
 public:
  explicit Cut(std::span<const Place> stators) : stators_(stators) {
    for (const Place& p : stators) {
      xs_.insert(xs_.end(), {p.x, p.x + kStatorSide});
      ys_.insert(ys_.end(), {p.y, p.y + kStatorSide});
    }
    for (std::vector<double>* lines : {&xs_, &ys_}) {
      std::ranges::sort(*lines);
      const auto same = [](double a, double b) { return b - a < kSame; };
      lines->erase(std::unique(lines->begin(), lines->end(), same), lines->end());
    }
    owner_.assign(xs_.size() * ys_.size(), kNobody);
  }

  // Marks the covered cells; returns stators that overlap, if any do.
  SurfaceResult Cover() {
    for (std::uint32_t s = 0; s < stators_.size(); ++s) {
      const Place& p = stators_[s];
      for (std::size_t y = LineOf(ys_, p.y); y < LineOf(ys_, p.y + kStatorSide); ++y) {
        for (std::size_t x = LineOf(xs_, p.x); x < LineOf(xs_, p.x + kStatorSide); ++x) {
          std::uint32_t& owner = owner_[y * xs_.size() + x];
          if (owner != kNobody) return {StatorProblem::kOverlap, s, owner};
          owner = s;
        }
      }
    }
    return {};
  }

  // Returns the outlines. Requires: Cover() has succeeded.
  std::vector<Outline> Trace() {
    std::vector<bool> seen(owner_.size());
    std::vector<Outline> outlines;
    for (std::size_t y = 0; y < ys_.size(); ++y) {
      for (std::size_t x = 0; x < xs_.size(); ++x) {
        // Eastwards, so that each outline begins at a corner.
        if (Leads({x, y, kEast}) && !seen[y * xs_.size() + x]) outlines.push_back(Follow({x, y, kEast}, seen));
      }
    }
    return outlines;
  }

 private:
  static constexpr std::uint32_t kNobody = static_cast<std::uint32_t>(-1);
  enum Way : int { kEast, kNorth, kWest, kSouth };

  // From one grid point to the next one.
  struct Side {
    std::size_t x = 0;
    std::size_t y = 0;
    int way = kEast;

    bool operator==(const Side&) const = default;
  };

  // Returns the index of the line that stands for this coordinate, at most kSame below it.
  static std::size_t LineOf(const std::vector<double>& lines, double at) {
    return static_cast<std::size_t>(std::ranges::upper_bound(lines, at) - lines.begin()) - 1;
  }

  // Returns true if the cell to the upper right of a grid point is covered. Row and column may be -1: no cell.
  bool Covered(std::size_t x, std::size_t y) const {
    return x < xs_.size() && y < ys_.size() && owner_[y * xs_.size() + x] != kNobody;
  }

  // Returns true if the surface lies to the left of this side, and nothing to its right.
  bool Leads(const Side& s) const {
    const bool upper_right = Covered(s.x, s.y), upper_left = Covered(s.x - 1, s.y);
    const bool lower_right = Covered(s.x, s.y - 1), lower_left = Covered(s.x - 1, s.y - 1);
    switch (s.way) {
      case kEast:
        return upper_right && !lower_right;
      case kNorth:
        return upper_left && !upper_right;
      case kWest:
        return lower_left && !upper_left;
      default:
        return lower_right && !lower_left;
    }
  }

  // Where two stators meet in a corner only, the outline stays with the stator that it follows: left first.
  Side Next(Side s) const {
    s.x += s.way == kEast ? 1 : s.way == kWest ? static_cast<std::size_t>(-1) : 0;
    s.y += s.way == kNorth ? 1 : s.way == kSouth ? static_cast<std::size_t>(-1) : 0;
    const int before = s.way;
    for (const int turn : {1, 0, 3}) {
      s.way = (before + turn) % 4;
      if (Leads(s)) break;
    }
    return s;
  }

  Outline Follow(const Side& start, std::vector<bool>& seen) const {
    Outline out;
    double twice_area = 0;
    int last = -1;
    Side side = start;
    do {
      if (side.way == kEast) seen[side.y * xs_.size() + side.x] = true;
      if (side.way != last) out.corners.push_back({xs_[side.x], ys_[side.y]});
      last = side.way;
      const Side next = Next(side);
      twice_area += xs_[side.x] * ys_[next.y] - xs_[next.x] * ys_[side.y];
      side = next;
    } while (side != start);
    out.hole = twice_area < 0;
    return out;
  }

  std::span<const Place> stators_;
  std::vector<double> xs_;
  std::vector<double> ys_;
  std::vector<std::uint32_t> owner_;
};

// Calls `is` for all sides until it returns true.
bool AnySide(const Environment& environment, const auto& is) {
  for (const Outline& outline : environment.outlines) {
    const Place* from = &outline.corners.back();
    for (const Place& to : outline.corners) {
      if (is(*from, to)) return true;
      from = &to;
    }
  }
  return false;
}

bool IsOn(const Environment& environment, const Place& place) {
  bool on = false;
  AnySide(environment, [&](const Place& from, const Place& to) {
    if ((from.y > place.y) != (to.y > place.y) && from.x > place.x) on = !on;
    return false;
  });
  return on;
}

}  // namespace

std::string_view Text(StatorProblem problem) noexcept {
  switch (problem) {
    case StatorProblem::kNone:
      return "";
    case StatorProblem::kEmpty:
      return "there are no stators";
    case StatorProblem::kTooMany:
      return "there are more than 2000 stators";
    case StatorProblem::kNotFinite:
      return "the corner of a stator is not finite, or more than 1 km away";
    case StatorProblem::kOverlap:
      return "two stators overlap";
  }
  return "";
}

SurfaceResult MakeEnvironment(std::span<const Place> stators, Environment& out) {
  if (stators.empty()) return {StatorProblem::kEmpty};
  if (stators.size() > kMostStators) return {StatorProblem::kTooMany, kMostStators};
  for (std::size_t i = 0; i < stators.size(); ++i) {
    const bool near = std::abs(stators[i].x) <= kFurthest && std::abs(stators[i].y) <= kFurthest;
    if (!near) return {StatorProblem::kNotFinite, i};
  }
  Cut cut(stators);
  if (const SurfaceResult overlap = cut.Cover(); overlap.problem != StatorProblem::kNone) return overlap;
  out.outlines = cut.Trace();
  out.stators.assign(stators.begin(), stators.end());
  return {};
}

bool Carries(const Environment& environment, const Area& area) noexcept {
  return !Crosses(environment, area, ExtentOf(area)) && IsOn(environment, area.places[0]);
}

bool Crosses(const Environment& environment, const Area& area, const Extent& extent) noexcept {
  return AnySide(environment, [&](const Place& from, const Place& to) {
    const Extent side{{std::min(from.x, to.x), std::min(from.y, to.y)},
                      {std::max(from.x, to.x), std::max(from.y, to.y)}};
    if (Apart(extent, side, -kSame)) return false;
    return Near(area, {.places = {from, to}, .count = 2}, -kSame);
  });
}

void describe(Enumeration<StatorProblem>& e) {
  e.about("Why stators do not make a surface.");
  e.value(StatorProblem::kNone, "none", "No problem.");
  e.value(StatorProblem::kEmpty, "empty", "There are no stators.");
  e.value(StatorProblem::kTooMany, "too_many", "There are too many stators.");
  e.value(StatorProblem::kNotFinite, "not_finite", "A corner is not finite, or too far away.");
  e.value(StatorProblem::kOverlap, "overlap", "Two stators overlap.");
}

}  // namespace takt::planar
