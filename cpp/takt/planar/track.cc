#include "takt/planar/track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "takt/core/describe.h"
#include "takt/path/place.h"
#include "takt/path/vectors.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

TrackPoint OnQuintic(const Piece& piece, double s) {
  const path::VectorPolynomial& place = piece.segment.place;
  const Bent p = BentAt(place, path::ParameterAt(piece.segment, s));
  const double turned = AngleTo(Heading(piece.direction), p.first);
  return {ToPlace(p.value), piece.direction + turned, p.curvature(), p.curvature_rate()};
}

TrackPoint OnGiven(const Piece& piece, double s) {
  const path::Segment& segment = piece.segment;
  const Place place = ToPlace(path::PlaceAt(segment, s).value.head<2>());
  if (segment.shape == path::Shape::kLine) return {place, piece.direction, 0, 0};
  // Counterclockwise if the tangent is to the left of the radius.
  const bool left = Cross(ToFlat(segment.place[1]), ToFlat(segment.place[2])) > 0;
  const double curvature = left ? segment.rate : -segment.rate;
  return {place, piece.direction + curvature * s, curvature, 0};
}

struct OnPiece {
  const Piece& piece;
  double s;  // [mm] from the start of the piece
};

OnPiece PieceAt(const Track& track, double s) {
  s = Within(track, s);
  const auto end = std::lower_bound(track.ends.begin(), track.ends.end() - 1, s);
  const Piece& piece = track.pieces[static_cast<std::size_t>(end - track.ends.begin())];
  return {piece, s - piece.start};
}

}  // namespace

TrackPoint At(const Piece& piece, double s) noexcept {
  s = std::clamp(s, 0.0, piece.segment.length);
  return piece.segment.shape == path::Shape::kQuintic ? OnQuintic(piece, s) : OnGiven(piece, s);
}

Place PlaceAt(const Piece& piece, double s) noexcept {
  s = std::clamp(s, 0.0, piece.segment.length);
  if (piece.segment.shape != path::Shape::kQuintic) return ToPlace(path::PlaceAt(piece.segment, s).value.head<2>());
  return ToPlace(path::Place(piece.segment.place, path::ParameterAt(piece.segment, s)).head<2>());
}

double Within(const Track& track, double s) noexcept {
  if (s >= 0 && s <= track.length) return s;
  if (!track.closed) return s > 0 ? track.length : 0;
  s = std::fmod(s, track.length);
  if (s < 0) s += track.length;
  return s >= 0 ? s : 0;  // NaN becomes 0
}

TrackPoint At(const Track& track, double s) noexcept {
  const OnPiece at = PieceAt(track, s);
  return At(at.piece, at.s);
}

Place PlaceAt(const Track& track, double s) noexcept {
  const OnPiece at = PieceAt(track, s);
  return PlaceAt(at.piece, at.s);
}

double SpeedBound(const TrackPoint& point, double lateral) noexcept {
  const double curvature = std::abs(point.curvature);
  return curvature > 0 ? std::sqrt(lateral / curvature) : std::numeric_limits<double>::infinity();
}

double PeakCurvature(const Track& track, double from, double to) noexcept {
  auto cell =
      std::lower_bound(track.cells.begin(), track.cells.end(), from, [](const Cell& c, double s) { return c.to < s; });
  double most = 0;
  for (; cell != track.cells.end() && cell->from <= to; ++cell) most = std::max(most, cell->curvature);
  return most;
}

void describe(Enumeration<ElementShape>& e) {
  e.about("Shape of an element of a track.");
  e.value(ElementShape::kPosition, "position",
          "A point that the track passes through, in the direction that its neighbours require.");
  e.value(ElementShape::kLine, "line", "A straight line.");
  e.value(ElementShape::kArc, "circle", "A circular arc; a full circle if it ends at its start.");
}

void describe(Description<Element>& d) {
  d.about("An element of a track.");
  d.defaulted<&Element::shape>("Shape of the element.");
  d.defaulted<&Element::start>("Start of a line or an arc.");
  d.defaulted<&Element::end>("End of a line or an arc; the point of a position.");
  d.defaulted<&Element::center>("Centre of an arc.");
  d.defaulted<&Element::clockwise>("True: an arc runs clockwise.");
}

}  // namespace takt::planar
