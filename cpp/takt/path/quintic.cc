#include "takt/path/quintic.h"

#include <algorithm>
#include <cmath>

namespace takt::path {
namespace {

// Six points of Gauss and Legendre on (-1, 1): half of them, the others lie on the other side.
constexpr std::array<double, 3> kNodes{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
constexpr std::array<double, 3> kWeights{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
// Of the whole length: how well that of a cell is to be known.
constexpr double kCellError = 1e-12;

struct Cell {
  double from = 0;
  double to = 1;
  double length = 0;
  double error = 0;
  double middle_length = 0;  // of the first half
};

Cell MakeCell(const VectorPolynomial& place, double from, double to, double length) {
  const double middle = (from + to) / 2;
  const double first = LengthBetween(place, from, middle);
  const double second = LengthBetween(place, middle, to);
  return {from, to, first + second, std::abs(first + second - length), first};
}

}  // namespace

double LengthBetween(const VectorPolynomial& place, double from, double to) noexcept {
  const double middle = (from + to) / 2;
  const double half = (to - from) / 2;
  double sum = 0;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    sum +=
        kWeights[i] * (Slope(place, middle - half * kNodes[i]).norm() + Slope(place, middle + half * kNodes[i]).norm());
  }
  return half * sum;
}

void SetQuintic(Segment& segment, const VectorPolynomial& place) noexcept {
  std::array<Cell, kMaxCells> cells;
  cells[0] = MakeCell(place, 0, 1, LengthBetween(place, 0, 1));
  std::size_t count = 1;
  const double allowed = kCellError * cells[0].length;
  while (count < kMaxCells) {
    Cell& worst = *std::max_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(count),
                                    [](const Cell& a, const Cell& b) { return a.error < b.error; });
    if (worst.error <= allowed) break;
    const Cell whole = worst;
    const double middle = (whole.from + whole.to) / 2;
    worst = MakeCell(place, whole.from, middle, whole.middle_length);
    cells[count++] = MakeCell(place, middle, whole.to, whole.length - whole.middle_length);
  }
  const auto end = cells.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(cells.begin(), end, [](const Cell& a, const Cell& b) { return a.from < b.from; });
  segment.shape = Shape::kQuintic;
  segment.place = place;
  segment.cells = static_cast<std::uint8_t>(count);
  segment.cell_parameter = {};
  segment.cell_length = {};
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += LengthBetween(place, cells[i].from, cells[i].to);
    segment.cell_parameter[i] = cells[i].to;
    segment.cell_length[i] = sum;
  }
  segment.length = sum;
}

double ParameterAt(const Segment& segment, double s) noexcept {
  std::size_t cell = 0;
  while (cell + 1u < segment.cells && s > segment.cell_length[cell]) ++cell;
  const double u0 = cell == 0 ? 0 : segment.cell_parameter[cell - 1];
  const double s0 = cell == 0 ? 0 : segment.cell_length[cell - 1];
  const double h = segment.cell_parameter[cell] - u0;
  const double length = segment.cell_length[cell] - s0;
  const double way = s - s0;
  // Where a cubic over s puts it that has the right speed at both ends; then Halley's step, twice where that is not
  // enough. The first leaves an error of the third power of the guess's.
  const double share = way / length;
  const double begin = length / (h * Slope(segment.place, u0).norm());
  const double end = length / (h * Slope(segment.place, u0 + h).norm());
  double x = share * (begin + share * (3 - 2 * begin - end + share * (begin + end - 2)));
  if (!(x >= 0 && x <= 1)) x = share;
  double u = u0 + h * x;
  for (int i = 0; i < 4; ++i) {
    const auto p = Evaluate(segment.place, u);
    const double speed = p.first.norm();
    const double error = (way - LengthBetween(segment.place, u0, u)) / speed;
    const double bend = p.first.dot(p.second) / (speed * speed);
    const double step = error * (1 - std::clamp(bend * error / 2, -0.5, 0.5));
    u = std::clamp(u + step, u0, u0 + h);
    if (std::abs(step) <= 1e-4 * h) break;
  }
  return u;
}

Derivatives<Vector> ByLength(const VectorPolynomial& place, double parameter) noexcept {
  const auto p = Evaluate(place, parameter);
  const double squared = p.first.squaredNorm();
  const double speed = std::sqrt(squared);
  const Vector tangent = p.first / speed;
  return {p.value, tangent, (p.second - tangent * tangent.dot(p.second)) / squared};
}

}  // namespace takt::path
