// The areas of a group of movers: who may go where, so that nothing of the group meets.
//
// A mover reserves what it covers on its way: from where it is to where its command leads it, however fast it goes and
// however it turns meanwhile. What it has left is free again. A track reserves all that its movers may cover while it
// is Moving. All of it is fit for the cycle; movers and tracks are numbered from 0, and there are as many as there were
// made for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/object.h"
#include "takt/planar/area.h"
#include "takt/planar/environment.h"
#include "takt/planar/parts.h"
#include "takt/planar/track_area.h"

namespace takt::planar {

// Straight to the target; the angle goes there without turning back.
struct Move {
  Pose target{};
  // Of a mover in motion, that has to go on along its old way for a while: where it would come to rest there. It stays
  // within the triangle of where it is, this and the target until it is on the line from this to the target; once it is
  // and goes towards the target, it goes straight.
  std::optional<Place> over{};
  // The angle may come to here before it goes to that of the target; deg.
  std::optional<double> over_c{};
  // Of one that goes over to its new line in a curve: within the hull of these and all of the above, until it is taken
  // anew.
  std::array<Place, 4> corners{};
  std::uint8_t corner_count = 0;
  bool on_track = false;  // the mover is where its track has it, and stays linked: the target's angle counts alone
  // It stands on a track, or is off its place there. Those of its network keep away from it by their gaps; only where
  // tracks of a network cross without a node they may still lie on one another.
  bool kept_by_gaps = false;
};

// A move that waits for its area in its turn (PL-72).
struct Turn {
  std::uint64_t since = 0;    // cycle from which on it has waited, from 1; 0: none waits
  std::uint32_t blocker = 0;  // the mover in its way
  bool asks = false;          // just now: it is held against the turns of others
  Move move{};                // what it was refused
};

struct Reservation {
  bool present = false;  // in the group
  bool moving = false;   // to the target of `move`
  bool linked = false;   // goes along tracks of `network`
  std::uint32_t network = 0;
  std::uint32_t level = 0;  // coordinate system that it is in: those of different ones never meet
  std::uint32_t body = 0;   // of movers that move as one: those of the same never meet; 0: it moves alone
  Footprint mover{};
  Pose pose{};
  Move move{};
  Extent extent{};  // of its area
};

struct TrackReservation {
  bool moving = false;
};

struct Reservations {
  std::vector<Reservation> movers{};
  std::vector<Turn> turns{};  // by mover; apart, as what is asked in each cycle is small so
  std::vector<TrackReservation> tracks{};
};
Reservations MakeReservations(std::size_t movers, std::size_t tracks);

// What does not change from cycle to cycle. Tracks that are not in the group have no area.
struct StaticObstacles {
  const Environment* environment = nullptr;  // of coordinate system 0; none: no border
  std::span<const TrackArea* const> tracks{};
  std::span<const Spot> spots{};  // where the coordinates of each track count from; none: all from the origin of 0
};

// What a mover has reserved.
Area AreaOf(const Reservation& mover) noexcept;

// A mover comes into the group, or is set to another place; it stands. It is not asked whether it may.
void Settle(std::uint32_t mover, const Footprint& footprint, const Pose& pose, Reservations& r,
            std::uint32_t level = 0) noexcept;
void Leave(std::uint32_t mover, Reservations& r) noexcept;

// With what the mover would collide: the first of movers, then of tracks that are Moving, then the environment (number
// 1). None: the way is free. A track of its own network does not count for a mover that turns on it. What only touches
// counts, except the border of the environment.
ObjectInfo Ask(std::uint32_t mover, const Move& move, const StaticObstacles& around, const Reservations& r) noexcept;
// Of a move whose way is free, and that asks in its turn: the mover that has waited longer for some of that area, and
// will get it soon, as the mover in its way is leaving. So none that waits is overtaken for ever by others that do; and
// none waits for one that cannot go.
ObjectInfo AskTurn(std::uint32_t mover, const Move& move, const Reservations& r) noexcept;
// From now on it has that reserved, in place of what it had.
void Take(std::uint32_t mover, const Move& move, Reservations& r) noexcept;
// Where it is now.
void Advance(std::uint32_t mover, const Pose& pose, Reservations& r) noexcept;
// It stands where it is.
void End(std::uint32_t mover, Reservations& r) noexcept;
// It stands, and from now on goes along tracks of this network, until it is given a move.
void Link(std::uint32_t mover, std::uint32_t network, Reservations& r) noexcept;

// With what the track would collide if it were Moving; movers and tracks of its own network do not count.
ObjectInfo AskTrack(std::uint32_t track, const StaticObstacles& around, const Reservations& r) noexcept;
void TakeTrack(std::uint32_t track, Reservations& r) noexcept;
void EndTrack(std::uint32_t track, Reservations& r) noexcept;

void describe(Description<Move>&);
void describe(Description<Turn>&);
void describe(Description<Reservation>&);
void describe(Description<TrackReservation>&);
void describe(Description<Reservations>&);

}  // namespace takt::planar
