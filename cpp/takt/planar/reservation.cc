#include "takt/planar/reservation.h"

#include <algorithm>

#include "takt/core/describe.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// Contact counts as too near.
constexpr double kClearance = kSame;

Area AreaOf(const Reservation& mover, const Move& move) noexcept {
  Area area;
  area.mover = mover.mover;
  const auto place = [&](const Place& p) { area.places[area.count++] = p; };
  const auto angle = [&](double c) {
    area.least_c = std::min(area.least_c, c);
    area.most_c = std::max(area.most_c, c);
  };
  area.places[0] = mover.pose.place;
  area.least_c = area.most_c = mover.pose.c;
  if (move.over) place(*move.over);
  for (std::size_t i = 0; i < move.corner_count; ++i) place(move.corners[i]);
  if (!move.on_track && !SamePoint(mover.pose.place, move.target.place)) place(move.target.place);
  if (move.over_c) angle(*move.over_c);
  angle(move.target.c);
  return area;
}

// Returns true if a mover that moved from `before` to `now` has reached the line from `over` to its target and moves
// towards the target. A mover sent back the way it came is on that line all the time, but moves away from the target at
// first.
bool HasTurned(const Flat& before, const Flat& now, const Place& over, const Place& target) {
  const Flat line = ToFlat(target) - ToFlat(over), off = now - ToFlat(over);
  if ((now - before).dot(line) <= 0) return false;
  const double share = std::clamp(off.dot(line) / line.squaredNorm(), 0.0, 1.0);
  return (off - share * line).norm() < kSame;
}

void Reserve(Reservation& mover) noexcept {
  mover.extent = ExtentOf(planar::AreaOf(mover));
}

bool Meets(const Area& area, const Extent& extent, const Reservation& own, const Reservation& other) noexcept {
  if (!other.present || other.level != own.level || (own.body != 0 && other.body == own.body)) return false;
  return !Apart(extent, other.extent, kClearance) && Near(area, AreaOf(other), kClearance);
}

// Returns true if they overlap whatever their angles are.
bool LieOnEachOther(const Reservation& one, const Reservation& other) noexcept {
  const double inner = std::min(one.mover.width, one.mover.height) + std::min(other.mover.width, other.mover.height);
  return (ToFlat(one.pose.place) - ToFlat(other.pose.place)).norm() < 0.5 * inner;
}

// The stretches are connected: with no border crossed, one of them decides for all.
bool Carries(const Environment& environment, const TrackArea& track, const Place& origin) noexcept {
  for (std::size_t i = 0; i < track.stretches.size(); ++i) {
    if (Crosses(environment, Shifted(track.stretches[i], origin), Shifted(track.extents[i], origin))) return false;
  }
  return planar::Carries(environment, Shifted(track.stretches.front(), origin));
}

Spot SpotOf(std::size_t track, const StaticObstacles& around) noexcept {
  return track < around.spots.size() ? around.spots[track] : Spot{};
}

const TrackArea* Moving(std::size_t track, std::uint32_t level, const StaticObstacles& around,
                        const Reservations& r) noexcept {
  const bool counts = track < around.tracks.size() && r.tracks[track].moving && SpotOf(track, around).system == level;
  return counts ? around.tracks[track] : nullptr;
}

// Transforms an area into the coordinates of a track.
bool Near(const Area& area, const Extent& extent, std::size_t track, const StaticObstacles& around) noexcept {
  const Place by = Place{} - SpotOf(track, around).origin;
  return planar::Near(Shifted(area, by), Shifted(extent, by), *around.tracks[track], kClearance);
}

}  // namespace

Reservations MakeReservations(std::size_t movers, std::size_t tracks) {
  Reservations r;
  r.movers.resize(movers);
  r.turns.resize(movers);
  r.tracks.resize(tracks);
  return r;
}

Area AreaOf(const Reservation& mover) noexcept {
  return AreaOf(mover, mover.moving ? mover.move : Move{.target = mover.pose});
}

void Settle(std::uint32_t mover, const Footprint& footprint, const Pose& pose, Reservations& r,
            std::uint32_t level) noexcept {
  r.movers[mover] = {.present = true, .level = level, .mover = footprint, .pose = pose};
  r.turns[mover] = {};
  Reserve(r.movers[mover]);
}

void Leave(std::uint32_t mover, Reservations& r) noexcept {
  r.movers[mover] = {};
  r.turns[mover] = {};
}

ObjectInfo Ask(std::uint32_t mover, const Move& move, const StaticObstacles& around, const Reservations& r) noexcept {
  const Reservation& own = r.movers[mover];
  const Area area = AreaOf(own, move);
  const Extent extent = ExtentOf(area);
  for (std::size_t i = 0; i < r.movers.size(); ++i) {
    const Reservation& other = r.movers[i];
    const bool by_gaps = move.kept_by_gaps && other.linked && other.network == own.network;
    if (by_gaps && !LieOnEachOther(own, other)) continue;
    if (i != mover && Meets(area, extent, own, other)) return ObjectAt(ObjectKind::kMover, i);
  }
  for (std::size_t i = 0; i < r.tracks.size(); ++i) {
    const TrackArea* track = Moving(i, own.level, around, r);
    if (!track || (move.on_track && own.linked && own.network == track->network)) continue;
    if (Near(area, extent, i, around)) return ObjectAt(ObjectKind::kTrack, i);
  }
  if (around.environment && own.level == 0 && !Carries(*around.environment, area))
    return ObjectAt(ObjectKind::kEnvironment, 0);
  return {};
}

ObjectInfo AskTurn(std::uint32_t mover, const Move& move, const Reservations& r) noexcept {
  const Reservation& own = r.movers[mover];
  if (!r.turns[mover].asks) return {};
  const Area area = AreaOf(own, move);
  const auto before_it = [&](std::size_t i) {
    const std::uint64_t its = r.turns[i].since, since = r.turns[mover].since;
    return its != 0 && (since == 0 || its < since || (its == since && i < mover));
  };
  for (std::size_t i = 0; i < r.movers.size(); ++i) {
    const Reservation& other = r.movers[i];
    if (i == mover || !other.present || other.level != own.level || !before_it(i)) continue;
    const bool soon = r.movers[r.turns[i].blocker].moving && r.turns[i].blocker != mover;
    if (soon && planar::Near(area, AreaOf(other, r.turns[i].move), kClearance)) {
      return ObjectAt(ObjectKind::kMover, i);
    }
  }
  return {};
}

void Take(std::uint32_t mover, const Move& move, Reservations& r) noexcept {
  Reservation& own = r.movers[mover];
  own.moving = true;
  own.linked = own.linked && move.on_track;
  own.move = move;
  Reserve(own);
}

void Advance(std::uint32_t mover, const Pose& pose, Reservations& r) noexcept {
  Reservation& own = r.movers[mover];
  std::optional<Place>& over = own.move.over;
  if (over && HasTurned(ToFlat(own.pose.place), ToFlat(pose.place), *over, own.move.target.place)) over.reset();
  own.pose = pose;
  Reserve(own);
}

void End(std::uint32_t mover, Reservations& r) noexcept {
  Reservation& own = r.movers[mover];
  own.moving = false;
  own.move = {};
  Reserve(own);
}

void Link(std::uint32_t mover, std::uint32_t network, Reservations& r) noexcept {
  End(mover, r);
  r.movers[mover].linked = true;
  r.movers[mover].network = network;
}

ObjectInfo AskTrack(std::uint32_t track, const StaticObstacles& around, const Reservations& r) noexcept {
  if (track >= around.tracks.size() || !around.tracks[track]) return {};
  const TrackArea& own = *around.tracks[track];
  const Spot spot = SpotOf(track, around);
  for (std::size_t i = 0; i < r.movers.size(); ++i) {
    const Reservation& mover = r.movers[i];
    if (!mover.present || mover.level != spot.system || (mover.linked && mover.network == own.network)) continue;
    if (Near(AreaOf(mover), mover.extent, track, around)) return ObjectAt(ObjectKind::kMover, i);
  }
  if (!own.checks_static_objects) return {};
  for (std::size_t i = 0; i < r.tracks.size(); ++i) {
    const TrackArea* other = Moving(i, spot.system, around, r);
    if (!other || other->network == own.network) continue;
    for (std::size_t k = 0; k < own.stretches.size(); ++k) {
      if (Near(Shifted(own.stretches[k], spot.origin), Shifted(own.extents[k], spot.origin), i, around))
        return ObjectAt(ObjectKind::kTrack, i);
    }
  }
  if (around.environment && spot.system == 0 && !Carries(*around.environment, own, spot.origin))
    return ObjectAt(ObjectKind::kEnvironment, 0);
  return {};
}

void TakeTrack(std::uint32_t track, Reservations& r) noexcept {
  r.tracks[track].moving = true;
}

void EndTrack(std::uint32_t track, Reservations& r) noexcept {
  r.tracks[track].moving = false;
}

void describe(Description<Move>& d) {
  d.about("A move of a mover that needs an area.");
  d.internal<&Move::target>("Target pose.");
  d.internal<&Move::over>("Position of rest on the old line, before the line to the target.");
  d.internal<&Move::over_c>(unit::deg, "Angle that it may reach before it turns to that of the target.");
  d.internal<&Move::corners>("Further corners of the hull that the move stays within.");
  d.internal<&Move::corner_count>("Number of these corners.");
  d.internal<&Move::on_track>("True: it stays on its track.");
  d.internal<&Move::kept_by_gaps>("True: movers of its network keep clear of it by their gaps.");
}

void describe(Description<Turn>& d) {
  d.named("MoverTurn");
  d.about("A move of a mover that waits for its area.");
  d.internal<&Turn::since>("Cycle since which it has waited; 0: no move waits.");
  d.internal<&Turn::blocker>("Mover in its way.");
  d.internal<&Turn::asks>("True: the move is being checked.");
  d.internal<&Turn::move>("Move that waits.");
}

void describe(Description<Reservation>& d) {
  d.about("Area that a mover has reserved.");
  d.internal<&Reservation::present>("True: the mover is in the group.");
  d.internal<&Reservation::moving>("True: it moves to the target of its move.");
  d.internal<&Reservation::linked>("True: it moves along tracks.");
  d.internal<&Reservation::network>("Network of those tracks.");
  d.internal<&Reservation::level>("Coordinate system; movers in different ones never meet.");
  d.internal<&Reservation::body>(
      "Number of the formation that it moves with, whose movers never meet; 0: it moves alone.");
  d.internal<&Reservation::mover>("Area that it covers.");
  d.internal<&Reservation::pose>("Present pose.");
  d.internal<&Reservation::move>("Move in progress.");
  d.internal<&Reservation::extent>("Bounding rectangle of its area.");
}

void describe(Description<TrackReservation>& d) {
  d.about("Area that a track has reserved.");
  d.internal<&TrackReservation::moving>("True: the track is Moving, and all that its movers may cover is reserved.");
}

void describe(Description<Reservations>& d) {
  d.about("Reserved areas of a group of movers.");
  d.internal<&Reservations::movers>("Reservations of movers.");
  d.internal<&Reservations::turns>("Moves that wait for their area.");
  d.internal<&Reservations::tracks>("Reservations of tracks.");
}

}  // namespace takt::planar
