#include "takt/planar/group_registry.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::planar {

namespace {

Reservations& ReservedBy(std::uint32_t group, GroupRegistry& g) noexcept {
  return g.grounds[group - 1].reserved;
}

Verdict Collision(const ObjectInfo& object) noexcept {
  return object ? Verdict{ErrorId::kCollision, object} : Verdict{};
}

// Reserves the area of a mover at rest, free or on a track.
void PutIn(std::uint32_t mover, std::uint32_t group, GroupRegistry& g) noexcept {
  const MoverView& now = g.movers[mover];
  Reservations& r = ReservedBy(group, g);
  Settle(mover, now.mover, now.pose, r, now.system);
  r.movers[mover].body = now.body;
  if (now.on_track) Link(mover, g.NetworkOf(now.track), r);
}

// Replaces the number of an environment by its number in the machine.
ObjectInfo Numbered(const ObjectInfo& object, std::uint32_t group, const GroupRegistry& g) noexcept {
  if (object.kind != ObjectKind::kEnvironment) return object;
  return {ObjectKind::kEnvironment, g.EnvironmentOf(group)};
}

// Returns the object that a settled mover collides with.
ObjectInfo AskStanding(std::uint32_t mover, std::uint32_t group, const GroupRegistry& g) noexcept {
  const Reservations& r = g.grounds[group - 1].reserved;
  const Reservation& own = r.movers[mover];
  return Numbered(
      Ask(mover, {.target = own.pose, .on_track = own.linked, .kept_by_gaps = own.linked}, g.Around(group), r), group,
      g);
}

// Returns the mover of a group that its part brings to this track, without a link to it.
ObjectInfo MoverArrivingOnTrack(std::uint32_t track, std::uint32_t group, const GroupRegistry& g) noexcept {
  if (!g.areas[track]) return {};
  for (std::uint32_t i = 0; i < g.movers.size(); ++i) {
    const MoverView& now = g.movers[i];
    if (!now.comes || g.group_of_mover[i] != group || now.goal.system != g.spots[track].system) continue;
    if (now.on_track && g.NetworkOf(now.track) == g.NetworkOf(track)) continue;
    const Area area = Shifted(AreaThere(now), Place{} - g.spots[track].origin);
    if (Near(area, ExtentOf(area), *g.areas[track], kSame)) return ObjectAt(ObjectKind::kMover, i);
  }
  return {};
}

// Returns the mover that this area would overlap, in a group or not; none: there is room. `but`: a mover that is
// ignored.
ObjectInfo MoverBelow(std::uint32_t but, std::uint32_t system, const Area& area, const GroupRegistry& g) noexcept {
  for (std::uint32_t i = 0; i < g.movers.size(); ++i) {
    const MoverView& now = g.movers[i];
    const Area its{.places = {now.pose.place},
                   .count = 1,
                   .least_c = now.pose.c,
                   .most_c = now.pose.c,
                   .mover = now.mover,
                   .margin = 0};
    if (i != but && now.system == system && Near(area, its, -kSame)) return ObjectAt(ObjectKind::kMover, i);
  }
  return {};
}

Verdict Leaves(std::uint32_t& group) noexcept {
  if (group == 0) return {ErrorId::kNoPlanarGroup, {}};
  group = 0;
  return {};
}

}  // namespace

GroupRegistry::GroupRegistry(std::size_t of_movers, std::size_t of_tracks, std::size_t of_environments,
                             std::vector<std::string> groups)
    : names(std::move(groups)),
      group_of_mover(of_movers),
      group_of_track(of_tracks),
      group_of_environment(of_environments),
      grounds(names.size()),
      movers(of_movers),
      areas(of_tracks),
      spots(of_tracks),
      moving(of_tracks),
      surfaces(of_environments),
      guard(of_movers) {
  for (GroupReservations& ground : grounds) ground.reserved = MakeReservations(of_movers, of_tracks);
}

std::uint32_t GroupRegistry::Find(std::string_view group) const noexcept {
  const auto found = std::ranges::find(names, group);
  return found == names.end() ? 0 : static_cast<std::uint32_t>(found - names.begin() + 1);
}

std::uint32_t GroupRegistry::EnvironmentOf(std::uint32_t group) const noexcept {
  const auto found = std::ranges::find(group_of_environment, group);
  return found == group_of_environment.end() ? 0 : static_cast<std::uint32_t>(found - group_of_environment.begin() + 1);
}

StaticObstacles GroupRegistry::Around(std::uint32_t group) const noexcept {
  const std::uint32_t environment = EnvironmentOf(group);
  const bool has_border = environment != 0 && !on_parts;
  return {.environment = has_border ? surfaces[environment - 1] : nullptr, .tracks = areas, .spots = spots};
}

ObjectInfo AskMove(std::uint32_t mover, const Move& move, const GroupRegistry& g) noexcept {
  const std::uint32_t group = g.Watching(g.group_of_mover[mover]);
  if (group == 0) return {};
  const Reservations& r = g.grounds[group - 1].reserved;
  const ObjectInfo object = Ask(mover, move, g.Around(group), r);
  return object ? Numbered(object, group, g) : AskTurn(mover, move, r);
}

Turn* TurnOf(std::uint32_t mover, GroupRegistry& g) noexcept {
  const std::uint32_t group = g.Watching(g.group_of_mover[mover]);
  return group == 0 ? nullptr : &ReservedBy(group, g).turns[mover];
}

void TakeMove(std::uint32_t mover, const Move& move, GroupRegistry& g) noexcept {
  if (const std::uint32_t group = g.Watching(g.group_of_mover[mover])) Take(mover, move, ReservedBy(group, g));
}

void AdvanceMover(std::uint32_t mover, GroupRegistry& g) noexcept {
  const std::uint32_t group = g.Watching(g.group_of_mover[mover]);
  if (group == 0) return;
  const MoverView& now = g.movers[mover];
  Reservations& r = ReservedBy(group, g);
  Reservation& own = r.movers[mover];
  const std::uint32_t network = now.on_track ? g.NetworkOf(now.track) : kNoTrack;
  if (now.on_track && !own.linked) Link(mover, network, r);
  own.network = network;
  own.level = now.system;
  own.body = now.body;
  const Pose& was = own.pose;
  const bool stays = was.place.x == now.pose.place.x && was.place.y == now.pose.place.y && was.c == now.pose.c;
  if (!stays) Advance(mover, now.pose, r);
  if (now.rests && own.moving) End(mover, r);
}

Area AreaThere(const MoverView& now) noexcept {
  return {.places = {now.goal.origin}, .count = 1, .least_c = now.pose.c, .most_c = now.pose.c, .mover = now.mover};
}

ObjectInfo MoverArrivingAt(std::uint32_t but, std::uint32_t system, const Area& area, const GroupRegistry& g) noexcept {
  for (std::uint32_t i = 0; i < g.movers.size(); ++i) {
    const MoverView& now = g.movers[i];
    if (i != but && now.comes && now.goal.system == system && Near(area, AreaThere(now), kSame)) {
      return ObjectAt(ObjectKind::kMover, i);
    }
  }
  return {};
}

Verdict SetDown(std::uint32_t mover, const Pose& pose, std::uint32_t system, GroupRegistry& g) noexcept {
  const Area area{
      .places = {pose.place}, .count = 1, .least_c = pose.c, .most_c = pose.c, .mover = g.movers[mover].mover};
  if (const ObjectInfo who = MoverArrivingAt(mover, system, area, g)) return Collision(who);
  if (const ObjectInfo who = MoverBelow(mover, system, area, g)) return Collision(who);
  const std::uint32_t group = g.Watching(g.group_of_mover[mover]);
  if (group == 0) return {};
  Reservations& r = ReservedBy(group, g);
  const Reservation before = r.movers[mover];
  Settle(mover, before.mover, pose, r, system);
  const ObjectInfo object = AskStanding(mover, group, g);
  if (object) r.movers[mover] = before;
  return Collision(object);
}

Verdict AskTracks(std::uint32_t mover, std::span<const std::uint32_t> tracks, const GroupRegistry& g) noexcept {
  const std::uint32_t own = g.Watching(g.group_of_mover[mover]);
  for (const std::uint32_t track : tracks) {
    const std::uint32_t group = g.Watching(g.group_of_track[track]);
    if (own != 0 && group != own) return {ErrorId::kTrackOutside, ObjectAt(ObjectKind::kTrack, track)};
    if (group == 0) continue;
    const Reservations& r = g.grounds[group - 1].reserved;
    if (r.tracks[track].moving) continue;
    if (const ObjectInfo who = MoverArrivingOnTrack(track, group, g)) return Collision(who);
    if (const ObjectInfo object = AskTrack(track, g.Around(group), r)) return Collision(Numbered(object, group, g));
  }
  return {};
}

void TakeTracks(std::span<const std::uint32_t> tracks, GroupRegistry& g) noexcept {
  for (const std::uint32_t track : tracks) {
    g.moving[track] = 1;
    if (const std::uint32_t group = g.Watching(g.group_of_track[track])) TakeTrack(track, ReservedBy(group, g));
  }
}

Verdict AddMover(std::uint32_t mover, std::uint32_t group, GroupRegistry& g) noexcept {
  if (g.group_of_mover[mover] == group) return {};
  if (g.group_of_mover[mover] != 0) return {ErrorId::kOtherPlanarGroup, {}};
  if (g.Watching(group) != 0) {
    if (!g.movers[mover].rests) return {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kMover, mover)};
    PutIn(mover, group, g);
    if (const ObjectInfo object = AskStanding(mover, group, g)) {
      Leave(mover, ReservedBy(group, g));
      return Collision(object);
    }
  }
  g.group_of_mover[mover] = group;
  return {};
}

Verdict AddTrack(std::uint32_t track, std::uint32_t group, GroupRegistry& g) noexcept {
  if (g.group_of_track[track] == group) return {};
  if (g.group_of_track[track] != 0) return {ErrorId::kOtherPlanarGroup, {}};
  // A track that is not Moving covers nothing.
  if (g.Watching(group) != 0 && g.moving[track]) return {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kTrack, track)};
  g.group_of_track[track] = group;
  return {};
}

Verdict AddEnvironment(std::uint32_t environment, std::uint32_t group, GroupRegistry& g) noexcept {
  std::uint32_t& own = g.group_of_environment[environment];
  if (own == group) return {};
  if (own != 0 || g.EnvironmentOf(group) != 0) return {ErrorId::kOtherPlanarGroup, {}};
  own = group;
  if (g.Watching(group) == 0) return {};
  Verdict verdict;
  if (!g.surfaces[environment] && !g.on_parts)
    verdict = {ErrorId::kNoBoundary, ObjectAt(ObjectKind::kEnvironment, environment)};
  for (std::uint32_t i = 0; i < g.moving.size() && verdict.error == ErrorId::kNone; ++i) {
    const bool moves = g.grounds[group - 1].reserved.tracks[i].moving;
    if (moves) verdict = {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kTrack, i)};
  }
  for (std::uint32_t i = 0; i < g.movers.size() && verdict.error == ErrorId::kNone; ++i) {
    if (g.group_of_mover[i] != group) continue;
    if (!g.movers[i].rests || g.grounds[group - 1].reserved.movers[i].moving) {
      verdict = {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kMover, i)};
    } else if (AskStanding(i, group, g)) {
      verdict = Collision(ObjectAt(ObjectKind::kMover, i));
    }
  }
  if (verdict.error != ErrorId::kNone) own = 0;
  return verdict;
}

Verdict RemoveMover(std::uint32_t mover, GroupRegistry& g) noexcept {
  if (const std::uint32_t group = g.group_of_mover[mover]) Leave(mover, ReservedBy(group, g));
  return Leaves(g.group_of_mover[mover]);
}

Verdict RemoveTrack(std::uint32_t track, GroupRegistry& g) noexcept {
  if (const std::uint32_t group = g.group_of_track[track]) EndTrack(track, ReservedBy(group, g));
  return Leaves(g.group_of_track[track]);
}

Verdict RemoveEnvironment(std::uint32_t environment, GroupRegistry& g) noexcept {
  return Leaves(g.group_of_environment[environment]);
}

Verdict Watch(std::uint32_t group, GroupRegistry& g) noexcept {
  const std::uint32_t environment = g.EnvironmentOf(group);
  if (environment != 0 && !g.surfaces[environment - 1] && !g.on_parts) {
    return {ErrorId::kNoBoundary, {ObjectKind::kEnvironment, environment}};
  }
  for (std::uint32_t i = 0; i < g.moving.size(); ++i) {
    const bool moves = g.group_of_track[i] == group && g.moving[i];
    if (moves) return {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kTrack, i)};
  }
  Verdict verdict;
  for (std::uint32_t i = 0; i < g.movers.size() && verdict.error == ErrorId::kNone; ++i) {
    if (g.group_of_mover[i] != group) continue;
    if (!g.movers[i].rests) {
      verdict = {ErrorId::kObjectMoves, ObjectAt(ObjectKind::kMover, i)};
    } else {
      PutIn(i, group, g);
      if (AskStanding(i, group, g)) verdict = Collision(ObjectAt(ObjectKind::kMover, i));
    }
  }
  if (verdict.error != ErrorId::kNone) {
    Unwatch(group, g);
  } else {
    g.grounds[group - 1].watches = true;
  }
  return verdict;
}

void Unwatch(std::uint32_t group, GroupRegistry& g) noexcept {
  g.grounds[group - 1].watches = false;
  Reservations& r = ReservedBy(group, g);
  for (std::uint32_t i = 0; i < r.movers.size(); ++i) Leave(i, r);
  for (std::uint32_t i = 0; i < r.tracks.size(); ++i) EndTrack(i, r);
}

void AdvanceTracks(GroupRegistry& g) noexcept {
  for (std::uint32_t i = 0; i < g.moving.size(); ++i) {
    const std::uint32_t group = g.Watching(g.group_of_track[i]);
    if (group == 0) continue;
    g.moving[i] ? TakeTrack(i, ReservedBy(group, g)) : EndTrack(i, ReservedBy(group, g));
  }
}

void describe(Description<GroupReservations>& d) {
  d.about("Reservations of a group of movers.");
  d.internal<&GroupReservations::watches>("True: the group is enabled, and areas are reserved.");
  d.internal<&GroupReservations::waits>("True: moves wait for their area instead of being refused.");
  d.internal<&GroupReservations::reserved>("Reserved areas.");
}

}  // namespace takt::planar
