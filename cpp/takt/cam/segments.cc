#include "takt/cam/segments.h"

#include "takt/cam/tasks.h"

namespace takt::cam {

namespace {

// Velocity and acceleration of a segment at one end; unset: free.
struct End {
  std::optional<double> v, a;
};

Task TaskOf(const CamSegment& s) {
  return {.length = s.to.x - s.from->x,
          .begin = {s.from->y, s.begin_v.value_or(0), s.begin_a.value_or(0), 0},
          .end = {s.to.y, s.end_v.value_or(0), s.end_a.value_or(0), 0},
          .inflection = s.inflection,
          .sine_share = s.sine_share,
          .cosine_share = s.cosine_share};
}

// From rest to rest, with the inflection in the middle, laws are those of the textbooks, and not tasks.
bool IsTask(const CamSegment& s) {
  if (s.law == Law::kQuintic || s.law == Law::kPolynomial8) return true;
  const Task task = TaskOf(s);
  const bool rests = task.begin.dy == 0 && task.begin.ddy == 0 && task.end.dy == 0 && task.end.ddy == 0;
  return ConnectsAny(s.law) && (!rests || s.inflection != 0.5);
}

End EndOf(const CamSegment& segment, bool at_end) {
  const End given = at_end ? End{segment.end_v, segment.end_a} : End{segment.begin_v, segment.begin_a};
  if (HasFreeEnds(segment.law)) return given;
  if (IsTask(segment)) return {given.v.value_or(0), given.a.value_or(0)};
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
    if (!ConnectsAny(all[i].law)) continue;
    const bool free = HasFreeEnds(all[i].law);
    const End before = free && (i > 0 || cyclic) ? EndOf(all[(i + n - 1) % n], true) : End{};
    const End behind = free && (i + 1 < n || cyclic) ? EndOf(all[(i + 1) % n], false) : End{};
    CamSegment& s = all[i];
    if (!s.begin_v) s.begin_v = before.v.value_or(0);
    if (!s.begin_a) s.begin_a = before.a.value_or(0);
    if (!s.end_v) s.end_v = behind.v.value_or(0);
    if (!s.end_a) s.end_a = behind.a.value_or(0);
    s.law = Resolved(s.law, TaskOf(s));
  }
  return all;
}

std::vector<SegmentPiece> PiecesOf(const CamSegment& s) {
  const double h = s.to.x - s.from->x;
  const double rise = s.to.y - s.from->y;
  std::vector<SegmentPiece> pieces;
  if (IsTask(s)) {
    for (const LawPiece& piece : PiecesOf(s.law, TaskOf(s))) pieces.push_back({s.from->x + piece.begin, piece.curve});
    return pieces;
  }
  if (s.law == Law::kDwell || rise == 0) return {{s.from->x, {.c = {s.from->y}}}};
  for (const LawPiece& piece : PiecesOf(s.law, s.sine_share, s.cosine_share)) {
    pieces.push_back({s.from->x + h * piece.begin, Scaled(piece.curve, h, rise)});
    pieces.back().curve.c[0] += s.from->y;
  }
  return pieces;
}

}  // namespace takt::cam
