#include "takt/mover/ground.h"

#include <algorithm>

namespace takt::mover {

namespace {

using trajectory::Profile;

constexpr double kBeyond = 1e-9;  // mm, deg: less is rounding

// What X and Y still pass besides the straight way from where they are to where they end.
void Surround(const PlaneMotion& m, double t, planar::Move& move) {
  const auto corner = [&](double along, double across) {
    move.corners[move.corner_count++] = {m.origin_x + m.direction_x * along - m.direction_y * across,
                                         m.origin_y + m.direction_y * along + m.direction_x * across};
  };
  const double alone = std::max(t, m.share > 0 ? m.across.duration() : 0.0);
  const double from = m.along.At(alone).position, to = m.along.end().position;
  const Profile::Range line = m.along.PositionRange(alone);
  const bool above = line.max > std::max(from, to) + kBeyond, below = line.min < std::min(from, to) - kBeyond;
  if (alone > t) {
    Profile beside = m.along;
    if (!above && !below) beside.Cut(alone);
    const Profile::Range along = beside.PositionRange(t), across = m.across.PositionRange(t);
    corner(along.min, across.min);
    corner(along.max, across.min);
    corner(along.max, across.max);
    corner(along.min, across.max);
    return;
  }
  if (above) corner(line.max, 0);
  if (below) corner(line.min, 0);
}

planar::Move MoveOf(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) {
  planar::Move move{.on_track = on_track};
  const PlaneMotion& m = plane.motion;
  if (!on_track) {
    Surround(m, Elapsed(c, plane.begin), move);
    move.target.place = {m.end_x, m.end_y};
    if (plane.waits) {
      move.over = move.target.place;
      move.target.place = {plane.next.x, plane.next.y};
    }
  }
  const double now = Now(c, turn).position, end = turn.profile.end().position;
  const Profile::Range range = turn.profile.PositionRange(Elapsed(c, turn.begin));
  move.target.c = end;
  if (range.max > std::max(now, end) + kBeyond) move.over_c = range.max;
  if (range.min < std::min(now, end) - kBeyond) move.over_c = range.min;
  return move;
}

}  // namespace

ObjectInfo InTheWay(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) noexcept {
  if (c.grounds.Watching(c.grounds.group_of_mover[c.index]) == 0) return {};
  return planar::AskMove(c.index, MoveOf(c, plane, turn, on_track), c.grounds);
}

void Reserve(const Context& c, const State& s, bool on_track) noexcept {
  if (c.grounds.Watching(c.grounds.group_of_mover[c.index]) == 0) return;
  planar::TakeMove(c.index, MoveOf(c, s.plane, s.others.back(), on_track), c.grounds);
}

void Stand(const Context& c, const State& s) noexcept {
  planar::Grounds& g = c.grounds;
  planar::MoverNow& now = g.movers[c.index];
  const auto rests = [&](Coordinate i) { return s.set_point[i].velocity == 0 && s.set_point[i].acceleration == 0; };
  now.mover = {c.params.width, c.params.height};
  now.system = s.system;
  now.pose = {{s.set_point[kX].position, s.set_point[kY].position}, s.set_point[kC].position};
  now.rests = s.external.mode == SetpointMode::kNone && IsPlaneResting(c, s) && IsOver(c, s.others.back()) &&
              rests(kX) && rests(kY) && rests(kC);
  now.on_track = IsOnTrack(s);
  now.track = s.track;
  const std::uint32_t group = g.Watching(g.group_of_mover[c.index]);
  if (group == 0) return;
  // What is not straight is looked at anew.
  const planar::Reservation& own = g.grounds[group - 1].reserved.movers[c.index];
  const bool bends = own.move.corner_count > 0 || own.move.over || own.move.over_c;
  if (own.moving && bends) Reserve(c, s, now.on_track);
  planar::AdvanceMover(c.index, g);
}

}  // namespace takt::mover
