#include "takt/planar/crossing.h"

#include <algorithm>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// Part of a cell.
struct CellPart {
  double from = 0;
  double to = 0;
  Flat begin;
  Flat end;
  double off = 0;  // from the chord between its ends
  double turn = 0;

  double length() const { return to - from; }
};

CellPart CellPartOf(const Cell& cell) {
  return {cell.from, cell.to, ToFlat(cell.begin), ToFlat(cell.end), cell.off, cell.turn};
}

// Returns the largest distance from its chord of a curve of this length that turns by at most `turn`.
double OffOf(double length, double turn) {
  return length / 2 * maths::Sin(std::min(turn, std::numbers::pi / 2));
}

double FromLine(const Flat& p, const CellPart& line) {
  const Flat way = line.end - line.begin;
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp((p - line.begin).dot(way) / squared, 0.0, 1.0) : 0;
  return (line.begin + share * way - p).norm();
}

double Distance(const CellPart& a, const CellPart& b) {
  const auto sides = [](const CellPart& line, const CellPart& other) {
    const Flat way = line.end - line.begin;
    return Cross(way, other.begin - line.begin) * Cross(way, other.end - line.begin);
  };
  if (sides(a, b) < 0 && sides(b, a) < 0) return 0;
  return std::min({FromLine(a.begin, b), FromLine(a.end, b), FromLine(b.begin, a), FromLine(b.end, a)});
}

std::optional<Crossing> Meet(const Track& track, const CellPart& a, const CellPart& b) {
  if (Distance(a, b) > a.off + b.off + kTouch / 2) return {};
  const bool first = a.length() >= b.length();
  if ((first ? a : b).length() < kTouch / 2) return Crossing{(a.from + a.to) / 2, (b.from + b.to) / 2};
  // Bisect the longer one; each half turns by no more than its curvature allows.
  const CellPart& whole = first ? a : b;
  const double s = (whole.from + whole.to) / 2;
  const Flat middle = ToFlat(PlaceAt(track, s));
  const double turn = std::min(whole.turn, 1.01 * PeakCurvature(track, whole.from, whole.to) * whole.length() / 2);
  const double off = OffOf(whole.length() / 2, turn);
  const CellPart halves[] = {{whole.from, s, whole.begin, middle, off, turn},
                             {s, whole.to, middle, whole.end, off, turn}};
  for (const CellPart& half : halves) {
    if (const auto found = first ? Meet(track, half, b) : Meet(track, a, half)) return found;
  }
  return {};
}

}  // namespace

std::optional<Crossing> SelfCrossing(const Track& track) noexcept {
  double whole = 0;
  for (const Cell& cell : track.cells) whole += cell.turn;
  for (std::size_t i = 0; i < track.cells.size(); ++i) {
    double turn = track.cells[i].turn;
    double others = whole;  // along the other side of a loop
    for (std::size_t k = i + 1; k < track.cells.size(); ++k) {
      turn += track.cells[k].turn;
      others -= track.cells[k - 1].turn;
      // A curve that turns by less than half a turn does not meet itself.
      if (turn < std::numbers::pi) continue;
      if (track.closed && others + track.cells[i].turn < std::numbers::pi) continue;
      if (const auto found = Meet(track, CellPartOf(track.cells[i]), CellPartOf(track.cells[k]))) return found;
    }
  }
  return {};
}

}  // namespace takt::planar
