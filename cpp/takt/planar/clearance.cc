#include "takt/planar/clearance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// A rectangle with a margin around it.
struct Box {
  Flat center;
  Flat along;   // half the side
  Flat across;  // half the side
  double margin = 0;

  Flat corner(int i) const { return center + ((i & 1) != 0 ? along : -along) + ((i & 2) != 0 ? across : -across); }
};

double Radius(const Footprint& mover) {
  return maths::Hypot(mover.width, mover.height) / 2;
}

Box BoxOf(const TrackPoint& point, const Footprint& mover) {
  if (mover.any_angle) return {ToFlat(point.place), Flat::Zero(), Flat::Zero(), Radius(mover)};
  const Flat heading = Heading(point.direction);
  return {ToFlat(point.place), mover.width / 2 * heading, mover.height / 2 * Left(heading), 0};
}

// Returns the distance of `other` from the box along the two axes of the box; the larger of both.
double OffSides(const Box& box, const Box& other) {
  const double length = box.along.norm(), breadth = box.across.norm();
  if (length == 0 && breadth == 0) return -INFINITY;  // a point has no axes
  const Flat forward = length > 0 ? Flat(box.along / length) : Flat(-Left(box.across) / breadth);
  const auto off = [&](const Flat& normal, double half) {
    const double reach = half + std::abs(normal.dot(other.along)) + std::abs(normal.dot(other.across));
    return std::abs(normal.dot(other.center - box.center)) - reach;
  };
  return std::max(off(forward, length), off(Left(forward), breadth));
}

double FromBox(const Flat& point, const Box& box) {
  Flat off = point - box.center;
  Flat outside = off;
  for (const Flat& side : {box.along, box.across}) {
    const double squared = side.squaredNorm();
    if (squared > 0) outside -= std::clamp(off.dot(side) / squared, -1.0, 1.0) * side;
  }
  return outside.norm();
}

double Separation(const Box& a, const Box& b) {
  const double margins = a.margin + b.margin;
  const double off = std::max(OffSides(a, b), OffSides(b, a));
  if (off <= 0 && off > -INFINITY) return off - margins;
  // Disjoint: the least distance of a corner of one of them from the other.
  double least = INFINITY;
  for (int i = 0; i < 4; ++i) least = std::min({least, FromBox(a.corner(i), b), FromBox(b.corner(i), a)});
  return least - margins;
}

// Part of a cell, seen from its middle. All that a mover covers on it lies within `stray` of `swept`, which is the
// mover extended along its direction in the middle; and within `spread` of the mover in the middle.
struct CellStretch {
  double from = 0;
  double to = 0;
  Flat heading;
  Box middle;
  Box swept;
  double stray = 0;
  double spread = 0;
};

CellStretch StretchOf(const Track& track, const Footprint& mover, const Cell& cell, double from, double to) {
  const double half = (to - from) / 2;
  const TrackPoint point = At(track, from + half);
  const double radius = mover.any_angle ? 0 : Radius(mover);
  const double stray = StrayOf(cell, half, radius);
  const double corner = stray - StrayOf(cell, half, 0);
  CellStretch out{from, to, Heading(point.direction), BoxOf(point, mover), {}, stray, half + corner};
  out.swept = out.middle;
  out.swept.along += half * out.heading;
  return out;
}

class ConflictSearch {
 public:
  ConflictSearch(const Track& a, const Footprint& on_a, const Track& b, const Footprint& on_b, double clearance,
                 double resolution)
      : a_(a), on_a_(on_a), b_(b), on_b_(on_b), clearance_(clearance), resolution_(std::max(kFinest, resolution)) {
    for (const Cell& cell : b.cells) others_.push_back(StretchOf(b, on_b, cell, cell.from, cell.to));
  }

  std::vector<Range> Run() {
    for (const Cell& cell : a_.cells) Look(cell, cell.from, cell.to);
    return std::move(ranges_);
  }

 private:
  static constexpr double kFinest = 1e-3;  // [mm]

  enum class Occupancy { kFree, kPerhaps, kConflict };

  void Look(const Cell& cell, double from, double to) {
    const CellStretch stretch = StretchOf(a_, on_a_, cell, from, to);
    Occupancy answer = Occupancy::kFree;
    for (std::size_t i = 0; i < others_.size() && answer != Occupancy::kConflict; ++i) {
      answer = std::max(answer, Against(stretch, b_.cells[i], others_[i]));
    }
    if (answer == Occupancy::kFree) return;
    if (answer == Occupancy::kConflict || stretch.spread <= resolution_ / 5) return Add(from, to);
    Look(cell, from, (from + to) / 2);
    Look(cell, (from + to) / 2, to);
  }

  Occupancy Against(const CellStretch& stretch, const Cell& cell, const CellStretch& other) const {
    const double least = (other.middle.center - stretch.middle.center).norm() - Radius(on_a_) - Radius(on_b_);
    if (least - (stretch.to - stretch.from + other.to - other.from) / 2 >= clearance_) return Occupancy::kFree;
    if (Separation(stretch.swept, other.swept) - stretch.stray - other.stray >= clearance_) return Occupancy::kFree;
    if (Separation(stretch.middle, Facing(stretch, other)) + stretch.spread < clearance_) return Occupancy::kConflict;
    if (other.stray <= stretch.spread / 4) return Occupancy::kPerhaps;
    const double middle = (other.from + other.to) / 2;
    const Occupancy first = Against(stretch, cell, StretchOf(b_, on_b_, cell, other.from, middle));
    if (first == Occupancy::kConflict) return first;
    return std::max(first, Against(stretch, cell, StretchOf(b_, on_b_, cell, middle, other.to)));
  }

  // Returns the other mover approximately where it comes nearest to the middle of the stretch.
  Box Facing(const CellStretch& stretch, const CellStretch& other) const {
    const double half = (other.to - other.from) / 2;
    const double ahead = other.heading.dot(stretch.middle.center - other.middle.center);
    return BoxOf(At(b_, other.from + half + std::clamp(ahead, -half, half)), on_b_);
  }

  void Add(double from, double to) {
    if (!ranges_.empty() && ranges_.back().to >= from) {
      ranges_.back().to = to;
    } else {
      ranges_.push_back({from, to});
    }
  }

  const Track& a_;
  const Footprint& on_a_;
  const Track& b_;
  const Footprint& on_b_;
  const double clearance_;
  const double resolution_;
  std::vector<CellStretch> others_;
  std::vector<Range> ranges_;
};

}  // namespace

double ClearGap(const Footprint& mover, double turn) noexcept {
  const auto [sine, cosine] = maths::SinCos(turn);
  return std::min(mover.width / std::abs(cosine), mover.height / std::abs(sine));
}

double ClearGapAlong(const Track& track, const Footprint& mover, double turned, double from, double to,
                     double least) noexcept {
  constexpr double kStride = 10, kStep = 1, kFine = 1e-3;  // [mm]
  const double reach = 2 * Radius(mover), most = 3 * reach;
  const auto place = [&](double s) { return TrackPoint{.place = PlaceAt(track, s), .direction = turned}; };
  const auto end = [&](double s) { return track.closed ? s : std::min(s, track.length); };
  for (double s = from; s <= to; s += kStride) {
    const double wanted = std::max(least, kStep);
    if (end(s + wanted) - s < wanted) break;
    // Across the start of a closed track a bend is assumed.
    const double peak = s + wanted <= track.length ? PeakCurvature(track, s, s + wanted) : 1 / reach;
    // Schur: the chord is no shorter than that of a circle.
    const double half = peak * wanted / 2;
    if (half == 0 || (half < std::numbers::pi / 2 && 2 / peak * maths::Sin(half) >= reach)) continue;
    const TrackPoint here = place(s);
    const auto clear = [&](double gap) { return Separation(here, mover, place(s + gap), mover) >= -kSame; };
    double gap = wanted;
    while (gap < most && end(s + gap) - s >= gap && !clear(gap)) gap += kStep;
    if (gap == wanted) continue;
    double enough = gap, less = gap - kStep;
    while (enough - less > kFine) {
      const double middle = (enough + less) / 2;
      (clear(middle) ? enough : less) = middle;
    }
    least = enough;
  }
  return least;
}

double Separation(const TrackPoint& a, const Footprint& on_a, const TrackPoint& b, const Footprint& on_b) noexcept {
  return Separation(BoxOf(a, on_a), BoxOf(b, on_b));
}

std::vector<Range> Conflicts(const Track& a, const Footprint& on_a, const Track& b, const Footprint& on_b,
                             double clearance, double resolution) {
  return ConflictSearch(a, on_a, b, on_b, clearance, resolution).Run();
}

double ReachFromStart(const std::vector<Range>& ranges) noexcept {
  return !ranges.empty() && ranges.front().from <= 0 ? ranges.front().to : 0;
}

double ReachFromEnd(const std::vector<Range>& ranges, double length) noexcept {
  return !ranges.empty() && ranges.back().to >= length ? length - ranges.back().from : 0;
}

void describe(Description<Footprint>& d) {
  d.about("Rectangular area that a mover covers.");
  d.required<&Footprint::width>(unit::mm, positive, "Size along its own x.");
  d.required<&Footprint::height>(unit::mm, positive, "Size along its own y.");
  d.defaulted<&Footprint::any_angle>("True: it may be at any angle, and covers the circle around it.");
}

}  // namespace takt::planar
