// Reservations in a group of movers: they keep members of the group from colliding.
//
// A mover reserves the area from its pose to the target of its command, at any speed and with any rotation on the way.
// The area that it has left becomes free. A track reserves all that its movers may cover while it is Moving. All of it
// is fit for the cycle; movers and tracks are numbered from 0, in the numbers given to MakeReservations.
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

// A move: straight to the target, while the angle turns to the target's without reversing.
struct Move {
  Pose target{};
  // If the mover is in motion and has to continue on its old path first: its rest position there. It stays within the
  // triangle of its position, `over` and the target until it is on the line from `over` to the target and moves towards
  // the target; from then on it moves straight.
  std::optional<Place> over{};
  // [deg] an angle that it may reach before it turns to that of the target
  std::optional<double> over_c{};
  // More corners of the hull that it stays within, as for a curve onto its new line; valid until they are computed
  // anew.
  std::array<Place, 4> corners{};
  std::uint8_t corner_count = 0;
  bool on_track = false;  // it stays on its track: only the angle of the target counts
  // It rests on a track, or is displaced from its position there. The movers of its network keep clear of it by their
  // gaps; only an overlap with them still counts, as tracks of a network may cross without a node.
  bool kept_by_gaps = false;
};

// A move that waits in its turn for its area (PL-72).
struct Turn {
  std::uint64_t since = 0;    // cycle since which it has waited, from 1; 0: no move waits
  std::uint32_t blocker = 0;  // the mover in the way
  bool asks = false;          // its move is being checked against the turns of other movers
  Move move{};                // the move that waits
};

struct Reservation {
  bool present = false;  // in the group
  bool moving = false;   // moves to the target of `move`
  bool linked = false;   // moves along tracks of `network`
  std::uint32_t network = 0;
  std::uint32_t level = 0;  // its coordinate system: movers in different ones never meet
  std::uint32_t body = 0;   // movers with the same number, from 1, never meet: they move as one body; 0: it moves alone
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
  std::vector<Turn> turns{};  // by mover; apart from them to keep the data of each cycle small
  std::vector<TrackReservation> tracks{};
};
Reservations MakeReservations(std::size_t movers, std::size_t tracks);

// Obstacles that do not change from cycle to cycle. Tracks without an area are null; of the others only those count
// that are Moving in the reservations of the group.
struct StaticObstacles {
  const Environment* environment = nullptr;  // in coordinate system 0; null: no border
  std::span<const TrackArea* const> tracks{};
  std::span<const Spot> spots{};  // origins of the tracks' coordinates; empty: the origin of system 0
};

// Returns the area that a mover has reserved.
Area AreaOf(const Reservation& mover) noexcept;

// Puts a mover at rest into the group, or sets it to another pose; without a check.
void Settle(std::uint32_t mover, const Footprint& footprint, const Pose& pose, Reservations& r,
            std::uint32_t level = 0) noexcept;
void Leave(std::uint32_t mover, Reservations& r) noexcept;

// Returns the object that the mover would collide with: the first of the movers, then of the tracks that are Moving,
// then the environment (number 1); none if there is room. The tracks of its own network do not count for a mover that
// turns on its track. Contact counts as a collision, except with the border of the environment.
ObjectInfo Ask(std::uint32_t mover, const Move& move, const StaticObstacles& around, const Reservations& r) noexcept;
// Returns the mover that has waited longer for a part of the area of this move, and will get it soon, as the mover in
// its way is moving off. Only for a move with room that is being checked in its turn. So no waiting move is overtaken
// forever by others that wait, and none waits for a move that is blocked.
ObjectInfo AskTurn(std::uint32_t mover, const Move& move, const Reservations& r) noexcept;
// Reserves the area of a move, in place of that before.
void Take(std::uint32_t mover, const Move& move, Reservations& r) noexcept;
// Updates its pose: the area that it has left becomes free.
void Advance(std::uint32_t mover, const Pose& pose, Reservations& r) noexcept;
// The mover has come to rest: only its pose stays reserved.
void End(std::uint32_t mover, Reservations& r) noexcept;
// The mover is at rest, and from now on moves along tracks of this network, until a move off the track is reserved.
void Link(std::uint32_t mover, std::uint32_t network, Reservations& r) noexcept;

// Returns the object that the track would collide with if it were Moving; movers and tracks of its network do not
// count.
ObjectInfo AskTrack(std::uint32_t track, const StaticObstacles& around, const Reservations& r) noexcept;
void TakeTrack(std::uint32_t track, Reservations& r) noexcept;
void EndTrack(std::uint32_t track, Reservations& r) noexcept;

void describe(Description<Move>&);
void describe(Description<Turn>&);
void describe(Description<Reservation>&);
void describe(Description<TrackReservation>&);
void describe(Description<Reservations>&);

}  // namespace takt::planar
