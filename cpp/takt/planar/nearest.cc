#include "takt/planar/nearest.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/path/place.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// [mm] Distances that differ by less are equal.
constexpr double kAsNear = 1e-9;
// [mm] along the track.
constexpr double kSameValley = 0.1;

double DistanceToLine(const Flat& begin, const Flat& end, const Flat& point) {
  const Flat way = end - begin;
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp((point - begin).dot(way) / squared, 0.0, 1.0) : 0;
  return (begin + share * way - point).norm();
}

// The search, with the best point so far.
class NearestSearch {
 public:
  NearestSearch(const Track& track, const Flat& point, double bound) : track_(track), point_(point), bound_(bound) {}

  void Look(const Cell& cell) {
    const path::Segment& segment = track_.pieces[cell.piece].segment;
    switch (segment.shape) {
      case path::Shape::kLine:
        return LookAtLine(cell);
      case path::Shape::kArc:
        return LookAtArc(segment, cell);
      case path::Shape::kQuintic: {
        cell_ = &cell;
        const double u0 = cell.begin_parameter, u1 = cell.end_parameter;
        return Between(segment.place, u0, Off(segment.place, u0), u1, Off(segment.place, u1), kHalvings);
      }
    }
  }

  Nearest best() const { return best_; }

 private:
  static constexpr int kHalvings = 10;
  static constexpr int kMostSteps = 60;

  // Half the derivative of the squared distance with respect to the parameter, and its derivative.
  struct Slope {
    Bent at;
    double value = 0;
    double change = 0;
  };
  Slope Off(const path::VectorPolynomial& place, double u) const {
    Slope out{BentAt(place, u)};
    const Flat off = out.at.value - point_;
    out.value = off.dot(out.at.first);
    out.change = out.at.first.squaredNorm() + off.dot(out.at.second);
    return out;
  }

  // A slightly nearer point counts only within the same minimum; else the first minimum is kept.
  void Take(double s, const Flat& place) {
    const double distance = (place - point_).norm();
    const double margin = s - best_.s < kSameValley ? 0 : kAsNear;
    if (!(distance < best_.distance - margin)) return;
    best_ = {s, ToPlace(place), distance};
    bound_ = std::min(bound_, distance);
  }

  void LookAtLine(const Cell& cell) {
    const Flat begin = ToFlat(cell.begin), way = ToFlat(cell.end) - begin;
    const double share = std::clamp((point_ - begin).dot(way) / way.squaredNorm(), 0.0, 1.0);
    Take(std::lerp(cell.from, cell.to, share), begin + share * way);
  }

  void LookAtArc(const path::Segment& segment, const Cell& cell) {
    const Flat radius = ToFlat(segment.place[1]), across = ToFlat(segment.place[2]);
    const Flat off = point_ - (ToFlat(segment.place[0]) - radius);
    // From the middle of the cell.
    const double start = track_.pieces[cell.piece].start;
    const double middle = (cell.from + cell.to) / 2;
    const auto [sine, cosine] = maths::SinCos(segment.rate * (middle - start));
    const Flat out = cosine * radius + sine * across;
    const Flat along = cosine * across - sine * radius;
    const double half = (cell.to - cell.from) / 2;
    const bool center = off.norm() < kAsNear;
    const double way =
        center ? -half : std::clamp(maths::Atan2(off.dot(along), off.dot(out)) / segment.rate, -half, half);
    const double s = std::clamp(middle + way, cell.from, cell.to);
    Take(s, path::PlaceAt(segment, s - start).value.head<2>());
  }

  // Bisects until there is at most one extremum.
  void Between(const path::VectorPolynomial& place, double u0, const Slope& begin, double u1, const Slope& end,
               int halvings) {
    if (begin.value >= 0) At(place, u0);
    if (end.value <= 0) At(place, u1);
    const double half = (u1 - u0) / 2;
    const Slope middle = Off(place, u0 + half);
    // No point is farther from the middle than `reach`; `change` is assumed to stay near its values at the three
    // points.
    const double speed = std::max({begin.at.first.norm(), middle.at.first.norm(), end.at.first.norm()});
    const double reach = 1.2 * speed * half;
    const double distance = (middle.at.value - point_).norm();
    if (distance - reach > bound_ + kAsNear) return;
    const double lowest = std::min({begin.change, middle.change, end.change});
    const double highest = std::max({begin.change, middle.change, end.change});
    if (halvings == 0 || (lowest > 0 && highest < 4 * lowest)) {
      if (begin.value < 0 && end.value > 0) Solve(place, u0, u1, u0 + half);
      return;
    }
    Between(place, u0, begin, u0 + half, middle, halvings - 1);
    Between(place, u0 + half, middle, u1, end, halvings - 1);
  }

  // Newton's method within bounds.
  void Solve(const path::VectorPolynomial& place, double low, double high, double u) {
    for (int i = 0; i < kMostSteps; ++i) {
      const Slope p = Off(place, u);
      (p.value < 0 ? low : high) = u;
      double next = u - p.value / p.change;
      if (!(next > low && next < high)) next = (low + high) / 2;
      const double step = std::abs(next - u);
      u = next;
      if (step < 1e-14) break;
    }
    At(place, u);
  }

  void At(const path::VectorPolynomial& place, double u) {
    const Flat p = BentAt(place, u).value;
    if ((p - point_).norm() >= best_.distance) return;
    double s = cell_->to;
    if (u < cell_->end_parameter) s = cell_->from + path::LengthBetween(place, cell_->begin_parameter, u);
    Take(s, p);
  }

  const Track& track_;
  const Flat point_;
  double bound_;
  const Cell* cell_ = nullptr;
  Nearest best_{0, {}, INFINITY};
};

}  // namespace

Nearest NearestTo(const Track& track, const Place& place) noexcept {
  const Flat point = ToFlat(place);
  double bound = INFINITY;
  for (const Cell& cell : track.cells) {
    bound = std::min(bound, DistanceToLine(ToFlat(cell.begin), ToFlat(cell.end), point) + cell.off);
  }
  NearestSearch search(track, point, bound);
  for (const Cell& cell : track.cells) {
    const double least = DistanceToLine(ToFlat(cell.begin), ToFlat(cell.end), point) - cell.off;
    if (least <= bound + kAsNear) search.Look(cell);
  }
  return search.best();
}

}  // namespace takt::planar
