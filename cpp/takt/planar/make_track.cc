// From what is given to a track: every element gets its begin and end, positions from their neighbours; then the gaps
// are filled.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/path/make.h"
#include "takt/path/place.h"
#include "takt/planar/flat.h"
#include "takt/planar/track.h"
#include "takt/planar/transition.h"

namespace takt::planar {
namespace {

// An element as it stands in the plane.
struct Standing {
  path::Segment segment;  // not of a position
  TrackPoint begin;
  TrackPoint end;
};

bool Finite(const Place& place) {
  return std::isfinite(place.x) && std::isfinite(place.y);
}
bool Finite(const std::optional<TrackPoint>& point) {
  return !point || (Finite(point->place) && std::isfinite(point->direction) && std::isfinite(point->curvature));
}

path::Point ToPoint(const Place& p) {
  return {kinematics::Frame(KDL::Vector(p.x, p.y, 0)), {}};
}

// 0 to 2 pi are the same.
double Plain(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

Piece PieceOf(const path::Segment& segment, bool given) {
  Piece piece{.segment = segment, .given = given};
  const bool quintic = segment.shape == path::Shape::kQuintic;
  const Flat heading = quintic ? BentAt(segment.place, 0.5).first : Flat(path::PlaceAt(segment, 0).first.head<2>());
  piece.direction = std::atan2(heading.y(), heading.x());
  return piece;
}

Problem Stand(const Element& element, Standing& out) {
  if (!Finite(element.start) || !Finite(element.end) || !Finite(element.center)) return Problem::kNotFinite;
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

// Direction and curvature in the middle place of three on a circle.
Problem ThroughThree(const Place& before, TrackPoint& point, const Place& behind) {
  if (SamePlace(before, behind)) return Problem::kTooFew;
  if (SamePlace(before, point.place) || SamePlace(point.place, behind)) return Problem::kLengthZero;
  const Flat a = ToFlat(point.place) - ToFlat(before);
  const Flat b = ToFlat(behind) - ToFlat(point.place);
  const double turn = AngleTo(a, b);
  // The angle between tangent and chord is that at the far end of the other chord.
  point.direction = std::atan2(b.y(), b.x()) - AngleTo(a, a + b);
  point.curvature = 2 * std::sin(turn) / (a + b).norm();
  return Problem::kNone;
}

// Where the circle through a place that goes on from a neighbour arrives; or, `before`, where it comes from.
Problem AlongCircle(const TrackPoint& neighbour, TrackPoint& point, bool before) {
  if (SamePlace(neighbour.place, point.place)) return Problem::kLengthZero;
  const Flat way = ToFlat(point.place) - ToFlat(neighbour.place);
  const Flat chord = before ? Flat(-way) : way;
  const double off = AngleTo(Heading(neighbour.direction), chord);
  point.direction = neighbour.direction + 2 * off;
  point.curvature = (before ? -2 : 2) * std::sin(off) / chord.norm();
  return Problem::kNone;
}

class Maker {
 public:
  explicit Maker(const Layout& layout) : layout_(layout), standing_(layout.elements.size()) {}

  Making Make(Track& out) {
    if (!Finite(layout_.from) || !Finite(layout_.to)) return {Problem::kNotFinite, 0};
    if (layout_.closed && (layout_.from || layout_.to)) return {Problem::kLinked, 0};
    for (const auto step : {&Maker::StandAll, &Maker::DirectPositions, &Maker::DirectEnds, &Maker::Join}) {
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

  // The neighbours of an element; null where the track ends. Of a loop the last one is before the first.
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

  Making DirectPositions() {
    for (std::size_t i = 0; i < count(); ++i) {
      if (!is_position(i) || !Before(i) || !Behind(i)) continue;
      Standing& here = standing_[i];
      const Problem p = ThroughThree(Before(i)->place, here.end, Behind(i)->place);
      if (p != Problem::kNone) return {p, i};
      here.begin = here.end;
    }
    return {};
  }

  // A position at an end of an open track.
  Making DirectEnds() {
    if (count() == 0) return {};
    const std::size_t last = count() - 1;
    const bool first_free = is_position(0) && !Before(0);
    const bool last_free = is_position(last) && !Behind(last);
    if (first_free && last_free && last <= 1) return DirectLine();
    if (first_free) {
      Standing& here = standing_.front();
      const Problem p = AlongCircle(*Behind(0), here.begin, true);
      if (p != Problem::kNone) return {p, 0};
      here.end = here.begin;
    }
    if (last_free) {
      Standing& here = standing_.back();
      const Problem p = AlongCircle(*Before(last), here.end, false);
      if (p != Problem::kNone) return {p, last};
      here.begin = here.end;
    }
    return {};
  }

  // Nothing but two positions, or one.
  Making DirectLine() {
    const Flat way = ToFlat(standing_.back().end.place) - ToFlat(standing_.front().end.place);
    for (Standing& here : standing_) here.begin.direction = here.end.direction = std::atan2(way.y(), way.x());
    return {};
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
    if (SamePlace(end.place, begin.place)) {
      if (!SameDirection(end, begin)) return Problem::kKink;
      return SameCurvature(end, begin) ? Problem::kNone : Problem::kCurvatureJump;
    }
    path::Segment segment;
    const Problem problem = MakeTransition(end, begin, segment);
    if (problem == Problem::kNone) track_.pieces.push_back(PieceOf(segment, false));
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
  }

  const Layout& layout_;
  std::vector<Standing> standing_;
  Track track_;
};

}  // namespace

Making MakeTrack(const Layout& layout, Track& out) {
  return Maker(layout).Make(out);
}

}  // namespace takt::planar
