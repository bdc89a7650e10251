#include "takt/cam/extremes.h"

#include <algorithm>
#include <cmath>

#include "takt/cam/roots.h"
#include "takt/core/maths.h"

namespace takt::cam {

namespace {

double LengthOf(const Table& table, std::size_t i) {
  return table.EndOf(i) - table.BeginOf(i);
}

// Returns a bound of |curve(d) - c[0]| in [0, h]: cheap, and mostly enough to exclude that a piece has an extreme.
double ReachOf(const Curve& curve, double h) {
  double reach = std::abs(curve.c[kCoefficients - 1]);
  for (std::size_t k = kCoefficients - 1; k-- > 1;) reach = reach * h + std::abs(curve.c[k]);
  return reach * h + std::abs(curve.amplitude) + std::abs(curve.amplitude2);
}

// Returns an upper bound of |curve|.
double MostOf(const Curve& curve, double h) {
  return std::abs(curve.c[0]) + ReachOf(curve, h);
}

void Include(const Curve& curve, double begin, double h, Bounds& bounds) {
  const double reach = ReachOf(curve, h);
  if (curve.c[0] - reach >= bounds.least.value && curve.c[0] + reach <= bounds.greatest.value) return;
  for (const double d : ExtremePlaces(curve, h)) {
    const Extreme here{begin + d, curve.At(d)};
    if (here.value < bounds.least.value) bounds.least = here;
    if (here.value > bounds.greatest.value) bounds.greatest = here;
  }
}

// Merges the largest |curve|, times `factor`.
void Include(const Curve& curve, double begin, double h, double factor, Extreme& largest) {
  if (factor * MostOf(curve, h) <= largest.value) return;
  for (const double d : ExtremePlaces(curve, h)) {
    const double magnitude = factor * std::abs(curve.At(d));
    if (magnitude > largest.value) largest = {begin + d, magnitude};
  }
}

// Returns the positions at which a piece has this y.
Roots Places(const Table& table, std::size_t i, double y) {
  Curve curve = table.CurveOf(i);
  const double h = LengthOf(table, i);
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * (std::abs(y) + std::abs(curve.c[0]));
  curve.c[0] -= y;
  double reach = std::abs(curve.amplitude) + std::abs(curve.amplitude2) + rounding;
  for (std::size_t k = curve.c.size(); k-- > 1;)
    reach += std::abs(curve.c[k]) * maths::Power(h, static_cast<unsigned>(k));
  if (std::abs(curve.c[0]) > reach) return {};
  return RootsOf(curve, h, rounding);
}

}  // namespace

Extremes ExtremesOf(const Table& table) noexcept {
  Extremes extremes;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double begin = table.BeginOf(i), h = LengthOf(table, i);
    Curve curve = table.CurveOf(i);
    for (Bounds* bounds : {&extremes.y, &extremes.dy, &extremes.ddy, &extremes.dddy}) {
      Include(curve, begin, h, *bounds);
      curve = Derivative(curve);
    }
  }
  return extremes;
}

void Include(const Table& table, std::size_t i, double master_velocity, double master_acceleration,
             SlavePeaks& peaks) noexcept {
  const double begin = table.BeginOf(i), h = LengthOf(table, i);
  const Curve y = table.CurveOf(i), dy = Derivative(y), ddy = Derivative(dy);
  Include(y, begin, h, peaks.position);
  Include(dy, begin, h, master_velocity, peaks.velocity);
  const double v2 = master_velocity * master_velocity;
  if (v2 * MostOf(ddy, h) + master_acceleration * MostOf(dy, h) <= peaks.acceleration.value) return;
  // The sum of two magnitudes is the larger one of the magnitudes of sum and difference.
  for (const double a : {master_acceleration, -master_acceleration}) {
    Include(Combined(v2, ddy, a, dy), begin, h, 1, peaks.acceleration);
  }
}

SlavePeaks SlavePeaksOf(const Table& table, double master_velocity, double master_acceleration) noexcept {
  SlavePeaks peaks;
  for (std::size_t i = 0; i < table.size(); ++i) Include(table, i, master_velocity, master_acceleration, peaks);
  return peaks;
}

std::vector<double> AllX(const Table& table, double y) {
  std::vector<double> all;
  const double same = 1e-12 * table.length();  // a joint is found from both sides
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (const double d : Places(table, i, y)) {
      const double x = table.BeginOf(i) + d;
      if (all.empty() || x - all.back() > same) all.push_back(x);
    }
  }
  return all;
}

namespace {

// Returns the x nearest to `near` among those that `places(piece)` returns, at most `most` pieces away.
template <typename PlacesOf>
std::optional<double> Nearest(const Table& table, double near, std::size_t most, const PlacesOf& places) {
  std::optional<double> nearest;
  const auto look = [&](std::size_t i) {
    for (const double d : places(i)) {
      const double x = table.BeginOf(i) + d;
      if (!nearest || std::abs(x - near) < std::abs(*nearest - near)) nearest = x;
    }
  };
  const std::size_t middle = table.PieceAt(near);
  const std::size_t end = table.size() - middle > most ? middle + most + 1 : table.size();
  const std::size_t begin = middle > most ? middle - most : 0;
  look(middle);
  // Outwards on both sides, while a nearer one is possible.
  for (std::size_t i = middle + 1; i < end; ++i) {
    if (nearest && table.BeginOf(i) - near >= std::abs(*nearest - near)) break;
    look(i);
  }
  for (std::size_t i = middle; i-- > begin;) {
    if (nearest && near - table.EndOf(i) >= std::abs(*nearest - near)) break;
    look(i);
  }
  return nearest;
}

}  // namespace

std::optional<double> NearestX(const Table& table, double y, double near) noexcept {
  return Nearest(table, near, table.size(), [&](std::size_t i) { return Places(table, i, y); });
}

std::optional<double> NearestSlope(const Table& table, double slope, double near, std::size_t most) noexcept {
  return Nearest(table, near, most, [&](std::size_t i) {
    Curve difference = Derivative(table.CurveOf(i));
    difference.c[0] -= slope;
    return RootsOf(difference, LengthOf(table, i));
  });
}

}  // namespace takt::cam
