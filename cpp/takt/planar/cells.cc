#include "takt/planar/cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/path/place.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

using Controls = std::array<Flat, 6>;

// Returns the Bezier control points of the part of a polynomial between two parameters.
Controls ControlsOf(const path::VectorPolynomial& place, double from, double to) {
  const path::VectorPolynomial c = PartOf(place, from, to);
  constexpr double kShare[6][6] = {{1, 0, 0, 0, 0, 0},       {1, 0.2, 0, 0, 0, 0},       {1, 0.4, 0.1, 0, 0, 0},
                                   {1, 0.6, 0.3, 0.1, 0, 0}, {1, 0.8, 0.6, 0.4, 0.2, 0}, {1, 1, 1, 1, 1, 1}};
  Controls out;
  for (std::size_t i = 0; i < 6; ++i) {
    out[i] = Flat::Zero();
    for (std::size_t k = 0; k <= i; ++k) out[i] += kShare[i][k] * ToFlat(c[k]);
  }
  return out;
}

// Returns the range of directions [rad]: all lie between those of the control vectors.
double Spread(const Controls& controls) {
  const Flat first = controls[1] - controls[0];
  double least = 0, most = 0;
  for (std::size_t i = 1; i < 5; ++i) {
    const double angle = AngleTo(first, controls[i + 1] - controls[i]);
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  return most - least;
}

// Returns the largest distance from the chord [mm]: the curve lies in the hull of its control points.
double OffChord(const Controls& controls) {
  const Flat chord = controls[5] - controls[0];
  const double squared = chord.squaredNorm();
  double most = 0;
  for (std::size_t i = 1; i < 5; ++i) {
    const Flat p = controls[i] - controls[0];
    const double share = squared > 0 ? std::clamp(p.dot(chord) / squared, 0.0, 1.0) : 0;
    most = std::max(most, (p - share * chord).norm());
  }
  return most;
}

// By dense samples, and the vertices of parabolas through three of them.
double LargestCurvature(const path::VectorPolynomial& place, double from, double to) {
  constexpr std::size_t kPlaces = 16;
  std::array<double, kPlaces + 1> k{};
  double most = 0;
  for (std::size_t i = 0; i <= kPlaces; ++i) {
    const double share = static_cast<double>(i) / kPlaces;
    k[i] = std::abs(BentAt(place, std::lerp(from, to, share)).curvature());
    most = std::max(most, k[i]);
  }
  for (std::size_t i = 1; i < kPlaces; ++i) {
    const double bend = 2 * k[i] - k[i - 1] - k[i + 1];
    const double slope = (k[i + 1] - k[i - 1]) / 2;
    if (bend > 0 && std::abs(slope) < bend) most = std::max(most, k[i] + slope * slope / (2 * bend));
  }
  return most;
}

void AppendQuintic(const path::Segment& segment, double u0, double u1, double s0, double s1, int halvings,
                   const Cell& pattern, std::vector<Cell>& out) {
  const Controls controls = ControlsOf(segment.place, u0, u1);
  const double turn = Spread(controls);
  if (turn > kCellTurn && halvings > 0) {
    const double u = (u0 + u1) / 2;
    const double s = s0 + path::LengthBetween(segment.place, u0, u);
    AppendQuintic(segment, u0, u, s0, s, halvings - 1, pattern, out);
    AppendQuintic(segment, u, u1, s, s1, halvings - 1, pattern, out);
    return;
  }
  Cell cell = pattern;
  cell.from += s0;
  cell.to = pattern.from + s1;
  cell.begin = ToPlace(controls[0]);
  cell.end = ToPlace(controls[5]);
  cell.off = OffChord(controls);
  cell.turn = turn;
  cell.curvature = LargestCurvature(segment.place, u0, u1);
  cell.begin_parameter = u0;
  cell.end_parameter = u1;
  out.push_back(cell);
}

}  // namespace

double StrayOf(const Cell& cell, double half, double radius) noexcept {
  // The curvature of a cell is known to 0.1 %.
  const double turn = std::min(cell.turn, 1.01 * cell.curvature * half);
  return 2 * maths::Sin(turn / 2) * (half + radius);
}

void AppendCells(const path::Segment& segment, double start, std::uint32_t piece, std::vector<Cell>& out) {
  Cell pattern;
  pattern.from = start;
  pattern.piece = piece;
  if (segment.shape == path::Shape::kQuintic) {
    constexpr int kHalvings = 6;
    double u = 0, s = 0;
    for (std::size_t i = 0; i < segment.cells; ++i) {
      AppendQuintic(segment, u, segment.cell_parameter[i], s, segment.cell_length[i], kHalvings, pattern, out);
      u = segment.cell_parameter[i];
      s = segment.cell_length[i];
    }
    return;
  }
  const double angle = segment.shape == path::Shape::kArc ? segment.rate * segment.length : 0;
  const int count = std::max(1, static_cast<int>(std::ceil(angle / kCellTurn)));
  for (int i = 0; i < count; ++i) {
    const double s0 = segment.length * i / count;
    const double s1 = segment.length * (i + 1) / count;
    Cell cell = pattern;
    cell.from = start + s0;
    cell.to = start + s1;
    cell.begin = ToPlace(path::PlaceAt(segment, s0).value.head<2>());
    cell.end = ToPlace(path::PlaceAt(segment, s1).value.head<2>());
    cell.turn = angle / count;
    cell.curvature = angle > 0 ? segment.rate : 0;
    if (angle > 0) cell.off = 2 / segment.rate * maths::Power(maths::Sin(cell.turn / 4), 2);
    out.push_back(cell);
  }
}

}  // namespace takt::planar
