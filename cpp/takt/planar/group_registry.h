// Who is in which group of movers, and what each group has reserved: what movers, tracks, environments and the groups
// themselves share. Groups are numbered from 1; 0: none. All of it is fit for the cycle.
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

// A mover as it is at the end of a cycle.
struct MoverView {
  Footprint mover{};
  std::uint32_t system = 0;        // coordinate system that it is in
  Pose pose{};                     // in that
  bool rests = true;               // in X, Y and C
  std::uint32_t body = 0;          // those with the same number, from 1, move as one; 0: it moves alone
  bool on_track = false;           // and else it goes nowhere
  std::uint32_t track = kNoTrack;  // that one
  bool comes = false;              // its part is on its way, and brings it
  Spot goal{};                     // there
};

// What is remembered of a group.
struct GroupReservations {
  bool watches = false;  // it is enabled: only then anything is reserved or refused
  bool waits = false;    // moves of its movers wait for their area instead of being refused; as the machine file says
  Reservations reserved;
};

struct GroupRegistry {
  GroupRegistry(std::size_t movers, std::size_t tracks, std::size_t environments, std::vector<std::string> groups);

  std::uint32_t Find(std::string_view group) const noexcept;
  // 0: none, or it does not watch.
  std::uint32_t Watching(std::uint32_t group) const noexcept {
    return group != 0 && grounds[group - 1].watches ? group : 0;
  }
  // The environment of a group, from 1; 0: none.
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

  // What follows from the states of others.
  std::vector<MoverView> movers;
  std::vector<const TrackArea*> areas;       // by track; null: it has no length
  std::vector<Spot> spots;                   // by track: where the part that it lies on is
  std::vector<std::uint8_t> moving;          // by track: it is Moving
  std::vector<const Environment*> surfaces;  // by environment; null: it has no boundary
  bool on_parts = false;                     // the surface is made of parts: environments are what these say
  Guard guard;                               // of all movers, in a group or not
};

// Whether something of a group that watches is or would be in the way. `error` is none, or why not.
struct Verdict {
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};
  double value = 0;  // what the error says besides, as the value of a feedback
};

// With what a mover would collide in its group; none where that does not watch. And what follows for what is reserved.
ObjectInfo AskMove(std::uint32_t mover, const Move& move, const GroupRegistry& g) noexcept;
// What its group knows of a move that waits in its turn; null: the group does not watch.
Turn* TurnOf(std::uint32_t mover, GroupRegistry& g) noexcept;
void TakeMove(std::uint32_t mover, const Move& move, GroupRegistry& g) noexcept;
// As `movers` says it is now.
void AdvanceMover(std::uint32_t mover, GroupRegistry& g) noexcept;
// Its area where its part brings it.
Area AreaThere(const MoverView& now) noexcept;
// Whom a part brings to where this area is; whether or not they have a group. `but`: not this one.
ObjectInfo WhoComes(std::uint32_t but, std::uint32_t system, const Area& area, const GroupRegistry& g) noexcept;
// It is set to another place in this coordinate system, if there is room: no mover stands there, in a group or not,
// none is brought there, and nothing that its group has reserved is in the way.
Verdict SetDown(std::uint32_t mover, const Pose& pose, std::uint32_t system, GroupRegistry& g) noexcept;

// Whether a mover may move along these tracks, each of which is in the mover's group if that watches; and it does.
Verdict AskTracks(std::uint32_t mover, std::span<const std::uint32_t> tracks, const GroupRegistry& g) noexcept;
void TakeTracks(std::span<const std::uint32_t> tracks, GroupRegistry& g) noexcept;

// Into a group and out of it. What comes into a group that watches must rest, and have room there.
Verdict AddMover(std::uint32_t mover, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict AddTrack(std::uint32_t track, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict AddEnvironment(std::uint32_t environment, std::uint32_t group, GroupRegistry& g) noexcept;
Verdict RemoveMover(std::uint32_t mover, GroupRegistry& g) noexcept;
Verdict RemoveTrack(std::uint32_t track, GroupRegistry& g) noexcept;
Verdict RemoveEnvironment(std::uint32_t environment, GroupRegistry& g) noexcept;

// From now on the group watches, if all that is in it rests and has room; else the object is who does not.
Verdict Watch(std::uint32_t group, GroupRegistry& g) noexcept;
void Unwatch(std::uint32_t group, GroupRegistry& g) noexcept;

// The tracks that are Moving: at the end of a cycle.
void AdvanceTracks(GroupRegistry& g) noexcept;

void describe(Description<GroupReservations>&);

}  // namespace takt::planar
