#include "takt/cam/segments.h"

namespace takt::cam {

namespace {

// Velocity and acceleration that a segment has at an end; empty: free.
struct End {
  std::optional<double> v, a;
};

End EndOf(const CamSegment& segment, bool at_end) {
  if (segment.law == Law::kQuintic) {
    return at_end ? End{segment.end_v, segment.end_a} : End{segment.begin_v, segment.begin_a};
  }
  const std::vector<SegmentPiece> pieces = PiecesOf(segment);
  const SegmentPiece& piece = at_end ? pieces.back() : pieces.front();
  const Value value = ValueOf(piece.curve, at_end ? segment.to.x - piece.begin : 0);
  return {value.dy, value.ddy};
}

}  // namespace

std::vector<CamSegment> Completed(std::span<const CamSegment> segments, bool cyclic) {
  std::vector<CamSegment> all(segments.begin(), segments.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].from) all[i].from = i > 0 ? all[i - 1].to : CamPlace{};
  }
  const std::size_t n = all.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (all[i].law != Law::kQuintic) continue;
    const End before = i > 0 || cyclic ? EndOf(all[(i + n - 1) % n], true) : End{};
    const End behind = i + 1 < n || cyclic ? EndOf(all[(i + 1) % n], false) : End{};
    CamSegment& s = all[i];
    if (!s.begin_v) s.begin_v = before.v.value_or(0);
    if (!s.begin_a) s.begin_a = before.a.value_or(0);
    if (!s.end_v) s.end_v = behind.v.value_or(0);
    if (!s.end_a) s.end_a = behind.a.value_or(0);
  }
  return all;
}

std::vector<SegmentPiece> PiecesOf(const CamSegment& s) {
  const double h = s.to.x - s.from->x;
  const double rise = s.to.y - s.from->y;
  if (s.law == Law::kDwell || rise == 0) {
    if (s.law != Law::kQuintic) return {{s.from->x, {.c = {s.from->y}}}};
  }
  if (s.law == Law::kQuintic) {
    return {{s.from->x, Quintic(h, {s.from->y, *s.begin_v, *s.begin_a, 0}, {s.to.y, *s.end_v, *s.end_a, 0})}};
  }
  std::vector<SegmentPiece> pieces;
  for (const LawPiece& piece : PiecesOf(s.law, s.sine_share, s.cosine_share)) {
    pieces.push_back({s.from->x + h * piece.begin, Scaled(piece.curve, h, rise)});
    pieces.back().curve.c[0] += s.from->y;
  }
  return pieces;
}

}  // namespace takt::cam
