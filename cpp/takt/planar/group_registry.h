// Members and reservations of the groups of movers: shared by movers, tracks, environments and the groups themselves.
// Groups are numbered from 1; 0: none. All of it is fit for the cycle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/planar/environment.h"
#include "takt/planar/guard.h"
#include "takt/planar/network.h"
#include "takt/planar/reservation.h"
#include "takt/planar/track_area.h"

namespace takt::planar {

// A mover at the end of a cycle.
struct MoverView {
  Footprint mover{};
  std::uint32_t system = 0;        // its coordinate system, from 0
  Pose pose{};                     // in `system`
  bool rests = true;               // in X, Y and C
  std::uint32_t body = 0;          // movers with the same number, from 1, move as one body; 0: it moves alone
  bool on_track = false;           // on a track, neither joining nor leaving it
  std::uint32_t track = kNoTrack;  // the track, if on one
  bool comes = false;              // its part is on the way to another position, with the mover on it
  Spot goal{};                     // its coordinate system and position there, if it `comes`
};

// State of a group.
struct GroupReservations {
  bool watches = false;  // enabled: only then areas are reserved and moves refused
  bool waits = false;    // moves of its movers wait for their area instead of being refused; from the machine file
  Reservations reserved;
};

struct GroupRegistry {
  GroupRegistry(std::size_t movers, std::size_t tracks, std::size_t environments, std::vector<std::string> groups);

  std::uint32_t Find(std::string_view group) const noexcept;
  // Returns the group if it is enabled, else 0.
  std::uint32_t Watching(std::uint32_t group) const noexcept {
    return group != 0 && grounds[group - 1].watches ? group : 0;
  }
  // Returns the environment of a group, from 1; 0: none.
  std::uint32_t EnvironmentOf(std::uint32_t group) const noexcept;
  StaticObstacles Around(std::uint32_t group) const noexcept;
  std::uint32_t NetworkOf(std::uint32_t track) const noexcept {
    return areas[track] ? areas[track]->network : kNoTrack;
  }

  std::vector<std::string> names;  // of the groups
  std::vector<std::uint32_t> group_of_mover;
  std::vector<std::uint32_t> group_of_track;
  std::vector<std::uint32_t> group_of_environment;
  std::vector<GroupReservations> grounds;  // by group, from 0

  // Derived from the states of other objects.
  std::vector<MoverView> movers;
  std::vector<const TrackArea*> areas;       // by track; null: it has no length
  std::vector<Spot> spots;                   // by track: origin of the part that it lies on
  std::vector<std::uint8_t> moving;          // by track: 1 if it is Moving
  std::vector<const Environment*> surfaces;  // by environment; null: no boundary
  bool on_parts = false;                     // the surface is made of parts, which then define its border
  Guard guard;                               // of all movers, in a group or not
};

// The result of a check against enabled groups: an error and the object in the way; kNone if there is room.
struct Verdict {
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};
  double value = 0;  // value of the feedback that reports the error
};

// Returns the object that the mover would collide with in its group; none if there is room, or the group is not
// enabled.
ObjectInfo AskMove(std::uint32_t mover, const Move& move, const GroupRegistry& g) noexcept;
// Returns the group's entry for a move of this mover that waits in its turn; null if the group is not enabled.
Turn* TurnOf(std::uint32_t mover, GroupRegistry& g) noexcept;
void TakeMove(std::uint32_t mover, const Move& move, GroupRegistry& g) noexcept;
// Updates the mover's reservation from `movers`.
void AdvanceMover(std::uint32_t mover, GroupRegistry& g) noexcept;
// Returns the area of a mover at the position to which its part brings it.
Area AreaThere(const MoverView& now) noexcept;
// Returns the mover that a part brings to this area, in a group or not; none if there is no such mover. `but`: a mover
// that is ignored.
ObjectInfo MoverArrivingAt(std::uint32_t but, std::uint32_t system, const Area& area, const GroupRegistry& g) noexcept;
// Sets a mover to another pose in this coordinate system, if there is room: no mover is there or being brought there,
// in a group or not, and nothing reserved in its group is in the way.
Verdict SetDown(std::uint32_t mover, const Pose& pose, std::uint32_t system, GroupRegistry& g) noexcept;

// Checks that a mover may move along these tracks: each is in the mover's group, if that is enabled, and has room for
// its movers in its own group, if that is enabled.
Verdict AskTracks(std::uint32_t mover, std::span<const std::uint32_t> tracks, const GroupRegistry& g) noexcept;
void TakeTracks(std::span<const std::uint32_t> tracks, GroupRegistry& g) noexcept;

// Add an object to a group and remove it. An object that enters an enabled group must be at rest and have room there.
Verdict AddMover(std::uint32_t mover, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict AddTrack(std::uint32_t track, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict AddEnvironment(std::uint32_t environment, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict RemoveMover(std::uint32_t mover, GroupRegistry& g) noexcept;
Verdict RemoveTrack(std::uint32_t track, GroupRegistry& g) noexcept;
Verdict RemoveEnvironment(std::uint32_t environment, GroupRegistry& g) noexcept;

// Enables the group, if all its members are at rest and have room; else the verdict names the object that is not.
Verdict Watch(std::uint32_t group, GroupRegistry& g) noexcept;
void Unwatch(std::uint32_t group, GroupRegistry& g) noexcept;

// Updates the reservations of tracks from `moving`, at the end of a cycle.
void AdvanceTracks(GroupRegistry& g) noexcept;

void describe(Description<GroupReservations>&);

}  // namespace takt::planar
