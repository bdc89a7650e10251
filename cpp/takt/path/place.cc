#include "takt/path/place.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::path {
namespace {

// Six-point Gauss-Legendre rule on (-1, 1).
constexpr std::array<double, 6> kNodes{-0.9324695142031521, -0.6612093864662645, -0.2386191860831969,
                                       0.2386191860831969,  0.6612093864662645,  0.9324695142031521};
constexpr std::array<double, 6> kWeights{0.1713244923791704, 0.3607615730481386, 0.4679139345726910,
                                         0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
// Pieces, each divided into two cells. Error of a piece's length relative to the whole length; its halves are known
// better by three powers of ten.
constexpr std::size_t kFewestPieces = 4;
constexpr std::size_t kMostPieces = kMaxCells / 2;
constexpr double kPieceError = 1e-11;

// Share of a cell: after a step this short the remaining error is negligible.
constexpr double kCloseEnough = 3e-4;

struct Piece {
  double from = 0;
  double to = 0;
  double first = 0;   // [mm] length of its first half
  double second = 0;  // [mm] length of its second half
  double error = 0;   // [mm] estimate

  double middle() const { return (from + to) / 2; }
};

Piece MakePiece(const VectorPolynomial& place, double from, double to, double length) {
  const double middle = (from + to) / 2;
  const double first = LengthBetween(place, from, middle);
  const double second = LengthBetween(place, middle, to);
  return {from, to, first, second, std::abs(first + second - length)};
}

}  // namespace

double LengthBetween(const VectorPolynomial& place, double from, double to) noexcept {
  // All points at once, coordinate by coordinate, so that compilers vectorise it.
  std::array<double, kNodes.size()> u, squared{};
  const double middle = (from + to) / 2;
  const double half = (to - from) / 2;
  for (std::size_t n = 0; n < u.size(); ++n) u[n] = middle + half * kNodes[n];
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = place[1][i], b = 2 * place[2][i], c = 3 * place[3][i], d = 4 * place[4][i], e = 5 * place[5][i];
    for (std::size_t n = 0; n < u.size(); ++n) {
      const double slope = a + u[n] * (b + u[n] * (c + u[n] * (d + u[n] * e)));
      squared[n] += slope * slope;
    }
  }
  double sum = 0;
  for (std::size_t n = 0; n < u.size(); ++n) squared[n] = std::sqrt(squared[n]);
  for (std::size_t n = 0; n < u.size(); ++n) sum += kWeights[n] * squared[n];
  return half * sum;
}

void SetQuintic(Segment& segment, const VectorPolynomial& place) noexcept {
  std::array<Piece, kMostPieces> pieces;
  std::size_t count = 0;
  double length = 0;
  while (count < kFewestPieces) {
    const double from = static_cast<double>(count) / kFewestPieces;
    const double to = static_cast<double>(count + 1) / kFewestPieces;
    pieces[count] = MakePiece(place, from, to, LengthBetween(place, from, to));
    length += pieces[count].first + pieces[count].second;
    ++count;
  }
  while (count < kMostPieces) {
    Piece* const end = pieces.data() + count;
    Piece* const worst =
        std::max_element(pieces.data(), end, [](const Piece& a, const Piece& b) { return a.error < b.error; });
    if (worst->error <= kPieceError * length) break;
    const Piece whole = *worst;
    std::move_backward(worst + 1, end, end + 1);
    worst[0] = MakePiece(place, whole.from, whole.middle(), whole.first);
    worst[1] = MakePiece(place, whole.middle(), whole.to, whole.second);
    ++count;
  }
  segment.shape = Shape::kQuintic;
  segment.place = place;
  segment.cells = static_cast<std::uint8_t>(2 * count);
  segment.cell_parameter = {};
  segment.cell_length = {};
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    segment.cell_parameter[2 * i] = pieces[i].middle();
    segment.cell_length[2 * i] = sum += pieces[i].first;
    segment.cell_parameter[2 * i + 1] = pieces[i].to;
    segment.cell_length[2 * i + 1] = sum += pieces[i].second;
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
  // Start at the cubic over s that has the right speed at both ends; then Halley's method, usually one or two steps.
  // The first step leaves an error of the third power of the guess's.
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
    if (std::abs(step) <= kCloseEnough * h) break;
  }
  return u;
}

namespace {

Derivatives<Vector> ByLength(const VectorPolynomial& place, double parameter) {
  const auto p = Evaluate(place, parameter);
  const double squared = p.first.squaredNorm();
  const double speed = std::sqrt(squared);
  const Vector tangent = p.first / speed;
  return {p.value, tangent, (p.second - tangent * tangent.dot(p.second)) / squared};
}

}  // namespace

Derivatives<Vector> PlaceAt(const Segment& segment, double s) noexcept {
  const VectorPolynomial& c = segment.place;
  if (segment.shape == Shape::kLine) return {ToVector(c[0]) + s * ToVector(c[1]), ToVector(c[1]), Vector::Zero()};
  if (segment.shape == Shape::kQuintic) return ByLength(c, ParameterAt(segment, s));
  // Relative to the start, not to the centre, which may be far away. 1 - cos = 2 sin².
  const double half = segment.rate * s / 2;
  const auto [sine_half, cosine_half] = maths::SinCos(half);
  const double sine = 2 * sine_half * cosine_half;
  const double less = 2 * sine_half * sine_half;
  const Vector radius = ToVector(c[1]);
  const Vector side = ToVector(c[2]);
  const Vector rise = ToVector(c[3]);
  const Vector along = (1 - less) * side - sine * radius;
  const Vector outward = (1 - less) * radius + sine * side;
  return {ToVector(c[0]) + sine * side - less * radius + s * rise, segment.rate * along + rise,
          -segment.rate * segment.rate * outward};
}

}  // namespace takt::path
