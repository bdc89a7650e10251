#include "takt/cam/table.h"

#include <algorithm>

#include "takt/cam/roots.h"
#include "takt/core/maths.h"

namespace takt::cam {

namespace {

constexpr std::size_t kBucketsPerPiece = 2;

void AddSine(double amplitude, double frequency, double phase, double d, Value& value) noexcept {
  const maths::SineCosine wave = maths::SinCos(frequency * d + phase);
  const double sine = amplitude * wave.sine;
  const double cosine = amplitude * wave.cosine;
  const double f2 = frequency * frequency;
  value.y += sine;
  value.dy += frequency * cosine;
  value.ddy -= f2 * sine;
  value.dddy -= f2 * frequency * cosine;
}

}  // namespace

Table::Table(CamParams source, std::span<const double> begins, std::span<const Curve> curves, double end)
    : begin_(begins.front()), end_(end), source_(std::move(source)) {
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const Curve& curve = curves[i];
    Piece piece;
    piece.x = begins[i];
    std::copy_n(curve.c.begin(), 6, piece.c);
    const bool polynomial = curve.c[6] != 0 || curve.c[7] != 0 || curve.c[8] != 0;
    if (polynomial || curve.amplitude != 0 || curve.amplitude2 != 0) {
      const More more{polynomial,      curve.c[6],  curve.c[7],       curve.c[8],  curve.amplitude,
                      curve.frequency, curve.phase, curve.amplitude2, curve.phase2};
      piece.more = static_cast<std::uint32_t>(more_.size());
      more_.push_back(more);
    }
    pieces_.push_back(piece);
  }
  const std::size_t buckets = kBucketsPerPiece * pieces_.size();
  buckets_per_x_ = static_cast<double>(buckets) / (end_ - begin_);
  before_.assign(BucketOf(end_) + 2, 0);
  for (const Piece& piece : pieces_) ++before_[BucketOf(piece.x) + 1];
  for (std::size_t i = 1; i < before_.size(); ++i) before_[i] += before_[i - 1];
  first_ = ValueOf(curves.front(), 0);
  last_ = ValueOf(curves.back(), end - begins.back());
  lowest_ = highest_ = first_.y;
  for (std::size_t i = 0; i < size(); ++i) {
    const Curve curve = CurveOf(i);
    for (const double d : ExtremePlaces(curve, EndOf(i) - BeginOf(i))) {
      lowest_ = std::min(lowest_, curve.At(d));
      highest_ = std::max(highest_, curve.At(d));
    }
  }
  last_.y = source_.segments.empty() ? source_.points.back().y : source_.segments.back().to.y;
}

std::size_t Table::PieceAt(double x) const noexcept {
  if (!(x > begin_)) return 0;
  if (x >= end_) return pieces_.size() - 1;
  // BucketOf is monotonic: pieces of earlier buckets begin before x, those of later ones after it.
  const std::size_t bucket = BucketOf(x);
  std::size_t low = std::max<std::size_t>(before_[bucket], 1) - 1;
  std::size_t high = before_[bucket + 1] - 1;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (pieces_[middle].x <= x) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

inline void Table::Add(const More& m, double d, Value& value) noexcept {
  if (m.polynomial) {
    const double d2 = d * d, d4 = d2 * d2;
    value.y += d4 * d2 * (m.c6 + d * (m.c7 + d * m.c8));
    value.dy += d4 * d * (6 * m.c6 + d * (7 * m.c7 + d * 8 * m.c8));
    value.ddy += d4 * (30 * m.c6 + d * (42 * m.c7 + d * 56 * m.c8));
    value.dddy += d2 * d * (120 * m.c6 + d * (210 * m.c7 + d * 336 * m.c8));
  }
  if (m.amplitude != 0) AddSine(m.amplitude, m.frequency, m.phase, d, value);
  if (m.amplitude2 != 0) AddSine(m.amplitude2, 2 * m.frequency, m.phase2, d, value);
}

Value Table::At(double x) const noexcept {
  if (!(x > begin_)) return first_;
  if (x >= end_) return last_;
  const Piece& piece = pieces_[PieceAt(x)];
  const double d = x - piece.x;
  const auto& c = piece.c;
  Value value{c[0] + d * (c[1] + d * (c[2] + d * (c[3] + d * (c[4] + d * c[5])))),
              c[1] + d * (2 * c[2] + d * (3 * c[3] + d * (4 * c[4] + d * 5 * c[5]))),
              2 * c[2] + d * (6 * c[3] + d * (12 * c[4] + d * 20 * c[5])), 6 * c[3] + d * (24 * c[4] + d * 60 * c[5])};
  if (piece.more != kPlain) Add(more_[piece.more], d, value);
  return value;
}

Curve Table::CurveOf(std::size_t i) const noexcept {
  const Piece& piece = pieces_[i];
  Curve curve;
  std::copy_n(piece.c, 6, curve.c.begin());
  if (piece.more == kPlain) return curve;
  const More& more = more_[piece.more];
  curve.c[6] = more.c6;
  curve.c[7] = more.c7;
  curve.c[8] = more.c8;
  curve.amplitude = more.amplitude;
  curve.frequency = more.frequency;
  curve.phase = more.phase;
  curve.amplitude2 = more.amplitude2;
  curve.phase2 = more.phase2;
  return curve;
}

std::optional<std::uint32_t> Find(std::span<const Table> tables, std::string_view name) noexcept {
  for (std::size_t i = tables.size(); i-- > 0;) {
    const Table& table = tables[i];
    if (table.size() > 0 && !table.superseded() && table.name() == name) return static_cast<std::uint32_t>(i);
  }
  return std::nullopt;
}

}  // namespace takt::cam
