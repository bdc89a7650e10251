// Builds a track from its layout: each element gets its begin and end, positions from their neighbours; then the gaps
// are filled.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/path/make.h"
#include "takt/path/place.h"
#include "takt/path/spline.h"
#include "takt/planar/flat.h"
#include "takt/planar/track.h"
#include "takt/planar/transition.h"

namespace takt::planar {
namespace {

// An element in the plane.
struct Standing {
  path::Segment segment;  // not for a position
  TrackPoint begin;
  TrackPoint end;
};

// [mm] Positions farther away are not exact enough.
constexpr double kFarthest = 1e6;

bool Sound(const Place& place) {
  return std::abs(place.x) <= kFarthest && std::abs(place.y) <= kFarthest;
}

Problem Check(const std::optional<TrackPoint>& link) {
  if (!link) return Problem::kNone;
  if (!Sound(link->place) || !std::isfinite(link->direction) || !std::isfinite(link->curvature)) {
    return Problem::kNotFinite;
  }
  return std::abs(link->curvature) * kLeastRadius > 1.001 ? Problem::kTooTight : Problem::kNone;
}

path::Point ToPoint(const Place& p) {
  return {kinematics::Frame(KDL::Vector(p.x, p.y, 0)), {}};
}

// Reduces an angle to [-pi, pi].
double Plain(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

Piece PieceOf(const path::Segment& segment, bool given) {
  Piece piece{.segment = segment, .given = given};
  const bool quintic = segment.shape == path::Shape::kQuintic;
  const Flat heading = quintic ? BentAt(segment.place, 0.5).first : Flat(path::PlaceAt(segment, 0).first.head<2>());
  piece.direction = maths::Atan2(heading.y(), heading.x());
  return piece;
}

Problem Stand(const Element& element, Standing& out) {
  if (!Sound(element.start) || !Sound(element.end) || !Sound(element.center)) return Problem::kNotFinite;
  if (element.shape == ElementShape::kPosition) {
    out.begin.place = out.end.place = element.end;
    return Problem::kNone;
  }
  const bool line = element.shape == ElementShape::kLine;
  const path::Circle circle{
      .mode = path::CircMode::kCenter,
      .auxiliary_point = path::ToTriple(ToSpace(ToFlat(element.center))),
      .choice = element.clockwise ? path::PathChoice::kClockwise : path::PathChoice::kCounterclockwise,
      .normal = {0, 0, 1}};
  const path::Point start = ToPoint(element.start), end = ToPoint(element.end);
  const path::Problem problem =
      line ? path::MakeLine(start, end, out.segment) : path::MakeArc(start, circle, end, out.segment);
  if (problem != path::Problem::kNone) return FromPath(problem);
  if (!line && out.segment.rate * kLeastRadius > 1) return Problem::kTooTight;
  const Piece piece = PieceOf(out.segment, true);
  out.begin = At(piece, 0);
  out.end = At(piece, out.segment.length);
  return Problem::kNone;
}

constexpr double kStep = 1;          // [mm] sampling step of bends ...
constexpr double kMostSteps = 16;    // ... or this many steps in a cell, which turns little
constexpr double kUneven = 1.2;      // largest ratio of curvatures within a bend: 1.1 in speed
constexpr double kUnevenRate = 1.4;  // largest ratio of their rates: 1.12 in speed
constexpr double kStraight = 1e-5;   // [1/mm] anything below is straight
// The rate is sampled three times in a step.
constexpr double kRateMargin = 1.02;
// A curvature below this share of the square root of its rate may vary, and a rate below this share of the square of
// the curvature: the other one bounds the speed there.
constexpr double kMinor = 0.1;

// Returns an estimate of the largest curvature between two points: if it grows at the first and falls at the second, at
// most the intersection of the tangents.
double MostBetween(const TrackPoint& a, const TrackPoint& b, double way) {
  const double from = std::abs(a.curvature), to = std::abs(b.curvature);
  const double grows = a.curvature < 0 ? -a.curvature_rate : a.curvature_rate;
  const double falls = b.curvature < 0 ? b.curvature_rate : -b.curvature_rate;
  if (grows <= 0 || falls <= 0) return std::max(from, to);
  const double there = std::clamp((to - from + falls * way) / (grows + falls), 0.0, way);
  return std::max({from, to, from + grows * there});
}

// Range of a quantity over the steps of a bend.
struct StepRange {
  double least = 0, most = 0;

  StepRange With(double value) const { return {std::min(least, value), std::max(most, value)}; }
  bool IsEven(double factor) const { return most <= factor * least; }
};

std::vector<Bend> BendsOf(const Track& track) {
  std::vector<Bend> bends;
  StepRange curvatures, rates;
  const auto add = [&](double from, double curvature, double rate) {
    const double counts = std::max(curvature, kMinor * std::sqrt(rate));
    const double rate_counts = std::max(rate, kMinor * curvature * curvature);
    const StepRange curvatures_with = curvatures.With(counts), rates_with = rates.With(rate_counts);
    if (!bends.empty() && curvatures_with.IsEven(kUneven) && rates_with.IsEven(kUnevenRate)) {
      Bend& bend = bends.back();
      bend.curvature = std::max(bend.curvature, curvature);
      bend.rate = std::max(bend.rate, rate);
      curvatures = curvatures_with;
      rates = rates_with;
    } else {
      bends.push_back({from, curvature, rate});
      curvatures = {counts, counts};
      rates = {rate_counts, rate_counts};
    }
  };
  for (const Cell& cell : track.cells) {
    const bool straight = cell.curvature < kStraight;
    const double steps = straight ? 1 : std::clamp(std::ceil((cell.to - cell.from) / kStep), 1.0, kMostSteps);
    const double step = (cell.to - cell.from) / steps;
    for (double i = 0; i < steps; ++i) {
      const double from = cell.from + i * step;
      double most = 0, rate = 0;
      if (!straight) {
        const double half = 0.5 * step;
        // The first and the last point are of this cell, not of its neighbours: the rate may jump there.
        const TrackPoint begin = At(track, from + step * 1e-9), middle = At(track, from + half);
        const TrackPoint end = At(track, from + step * (1 - 1e-9));
        most = std::max(MostBetween(begin, middle, half), MostBetween(middle, end, half));
        for (const TrackPoint& p : {begin, middle, end})
          rate = std::max(rate, kRateMargin * std::abs(p.curvature_rate));
      }
      if (most < kStraight) most = rate = 0;
      add(from, most, rate);
    }
  }
  return bends;
}

class LayoutBuilder {
 public:
  explicit LayoutBuilder(const Layout& layout) : layout_(layout), standing_(layout.elements.size()) {}

  Making Make(Track& out) {
    for (const auto* link : {&layout_.from, &layout_.to}) {
      if (const Problem p = Check(*link); p != Problem::kNone) return {p, 0};
    }
    if (layout_.closed && (layout_.from || layout_.to)) return {Problem::kLinked, 0};
    for (const auto step : {&LayoutBuilder::StandAll, &LayoutBuilder::DirectPositions, &LayoutBuilder::Join}) {
      if (const Making making = (this->*step)(); making.problem != Problem::kNone) return making;
    }
    if (track_.pieces.empty()) return {Problem::kEmpty, 0};
    Finish();
    out = std::move(track_);
    return {};
  }

 private:
  std::size_t count() const { return standing_.size(); }
  bool is_position(std::size_t i) const { return layout_.elements[i].shape == ElementShape::kPosition; }

  // The neighbours of an element; null at the ends of a track. In a loop the last element precedes the first.
  const TrackPoint* Before(std::size_t i) const {
    if (i > 0) return &standing_[i - 1].end;
    if (layout_.closed && count() > 1) return &standing_.back().end;
    return layout_.from ? &*layout_.from : nullptr;
  }
  const TrackPoint* Behind(std::size_t i) const {
    if (i + 1 < count()) return &standing_[i + 1].begin;
    if (layout_.closed && count() > 1) return &standing_.front().begin;
    return layout_.to ? &*layout_.to : nullptr;
  }

  Making StandAll() {
    for (std::size_t i = 0; i < count(); ++i) {
      if (const Problem p = Stand(layout_.elements[i], standing_[i]); p != Problem::kNone) return {p, i};
    }
    return {};
  }

  // Positions get the direction and curvature of a spline through them and the neighbouring points.
  Making DirectPositions() {
    std::size_t positions = 0;
    for (std::size_t i = 0; i < count(); ++i) positions += is_position(i) ? 1 : 0;
    if (layout_.closed && positions == count()) return DirectLoop();
    for (std::size_t i = 0; i < count(); ++i) {
      const bool goes_on = (i > 0 || layout_.closed) && is_position(i > 0 ? i - 1 : count() - 1);
      if (!is_position(i) || goes_on) continue;
      if (const Problem p = DirectFrom(i); p != Problem::kNone) return {p, i};
    }
    return {};
  }

  // Consecutive positions, starting with `first`.
  Problem DirectFrom(std::size_t first) {
    std::vector<path::Point> points;
    path::SplineOptions options;
    const auto end = [&](const TrackPoint* neighbour, std::optional<path::Triple>& direction) {
      if (!neighbour) return;
      points.push_back(ToPoint(neighbour->place));
      direction = path::ToTriple(ToSpace(Heading(neighbour->direction)));
    };
    const TrackPoint* const before = Before(first);
    end(before, options.start_direction);
    std::size_t run = 0;
    while ((first + run < count() || layout_.closed) && is_position((first + run) % count())) {
      points.push_back(ToPoint(standing_[(first + run) % count()].end.place));
      ++run;
    }
    end(Behind((first + run - 1) % count()), options.end_direction);
    return DirectBySpline(points, options, before ? 1 : 0, first, run);
  }

  // A loop of positions only: a spline of several rounds, of which the middle one counts.
  Making DirectLoop() {
    if (count() < 2) return {Problem::kEmpty, 0};
    constexpr std::size_t kEnough = 24;  // positions from its ends on, at which a spline is independent of them
    const std::size_t rounds = (kEnough + count() - 1) / count();
    std::vector<path::Point> points;
    for (std::size_t i = 0; i <= (2 * rounds + 1) * count(); ++i) {
      points.push_back(ToPoint(standing_[i % count()].end.place));
    }
    return {DirectBySpline(points, {}, rounds * count(), 0, count()), 0};
  }

  // The points of the spline from `offset` on are the positions from `first` on.
  Problem DirectBySpline(const std::vector<path::Point>& points, const path::SplineOptions& options, std::size_t offset,
                         std::size_t first, std::size_t run) {
    std::vector<path::Segment> spline;
    if (points.size() < 2) return Problem::kNone;
    const path::Problem problem = path::MakeSpline(points, options, spline);
    if (problem != path::Problem::kNone) return FromPath(problem);
    for (std::size_t i = 0; i < run; ++i) {
      const std::size_t k = offset + i;
      const bool last = k == spline.size();
      const path::Segment& segment = spline[last ? k - 1 : k];
      const auto at = path::PlaceAt(segment, last ? segment.length : 0);
      Standing& here = standing_[(first + i) % count()];
      here.end.direction = maths::Atan2(at.first.y(), at.first.x());
      here.end.curvature = Cross(at.first.head<2>(), at.second.head<2>());
      here.begin = here.end;
    }
    return Problem::kNone;
  }

  Making Join() {
    const TrackPoint* end = layout_.from ? &*layout_.from : nullptr;
    for (std::size_t i = 0; i < count(); ++i) {
      if (end) {
        if (const Problem p = Fill(*end, standing_[i].begin); p != Problem::kNone) return {p, i};
      }
      if (!is_position(i)) track_.pieces.push_back(PieceOf(standing_[i].segment, true));
      end = &standing_[i].end;
    }
    const TrackPoint* goal = layout_.to ? &*layout_.to : nullptr;
    if (layout_.closed && count() > 0) goal = &standing_.front().begin;
    if (!end || !goal) return {};
    return {Fill(*end, *goal), count()};
  }

  Problem Fill(const TrackPoint& end, const TrackPoint& begin) {
    if (SamePoint(end.place, begin.place)) {
      if (!SameDirection(end, begin)) return Problem::kKink;
      return SameCurvature(end, begin) ? Problem::kNone : Problem::kCurvatureJump;
    }
    std::vector<path::Segment> segments;
    const Problem problem = MakeTransition(end, begin, segments);
    for (const path::Segment& segment : segments) track_.pieces.push_back(PieceOf(segment, false));
    return problem;
  }

  void Finish() {
    double direction = 0;
    for (std::size_t i = 0; i < track_.pieces.size(); ++i) {
      Piece& piece = track_.pieces[i];
      piece.start = track_.length;
      if (i > 0) {
        const double ahead = At(piece, 0).direction;
        piece.direction += direction + Plain(ahead - direction) - ahead;
      } else {
        const double begin = At(piece, 0).direction;
        piece.direction += Plain(begin) - begin;
      }
      direction = At(piece, piece.segment.length).direction;
      track_.length += piece.segment.length;
      track_.ends.push_back(track_.length);
      AppendCells(piece.segment, piece.start, static_cast<std::uint32_t>(i), track_.cells);
    }
    track_.closed = layout_.closed;
    track_.bends = BendsOf(track_);
  }

  const Layout& layout_;
  std::vector<Standing> standing_;
  Track track_;
};

}  // namespace

Making MakeTrack(const Layout& layout, Track& out) {
  return LayoutBuilder(layout).Make(out);
}

}  // namespace takt::planar
