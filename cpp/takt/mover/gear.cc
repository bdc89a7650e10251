#include "takt/mover/gear.h"

#include <algorithm>
#include <cmath>

#include "takt/mover/admission.h"
#include "takt/mover/on_parts.h"
#include "takt/planar/going_along.h"
#include "takt/planar/send.h"

namespace takt::mover {

using planar::kNobody;
using planar::kNoTrack;
using planar::Rider;
using planar::Route;
using trajectory::Limits;

namespace {

// A position on a track on the path of a mover, which is counted over all tracks. On a loop: one of the equivalent
// ones.
struct SyncPlace {
  std::uint32_t track = kNoTrack;
  double position = 0;
  TurnDirection direction = TurnDirection::kNonModulo;
  double modulo_tolerance = 0;
};

// Finds where a track begins on the path of a mover: on its route, or else on the tracks that it remembers to have
// passed.
bool BeginOf(const planar::Network& network, const Rider& r, std::uint32_t track, double& begin) {
  begin = r.origin;
  for (const std::uint32_t on : r.route.all()) {
    if (on == track) return true;
    begin += network[on].length;
  }
  begin = r.origin;
  for (std::uint32_t i = 0; i < r.passed_count; ++i) {
    begin -= network[r.passed[i]].length;
    if (r.passed[i] == track) return true;
  }
  return false;
}

planar::Verdict Find(const planar::Network& network, const Rider& r, const SyncPlace& place, double& begin,
                     double& total) {
  const planar::Road& road = network[place.track];
  const ObjectInfo track = ObjectAt(ObjectKind::kTrack, place.track);
  if (!road.closed && (place.direction != TurnDirection::kNonModulo || place.modulo_tolerance != 0)) {
    return {ErrorId::kParameter, track};
  }
  if (!(place.position >= 0 && place.position <= road.length) && !road.closed) {
    return {ErrorId::kTargetBehindLimit, track, road.length};
  }
  if (!BeginOf(network, r, place.track, begin)) return {ErrorId::kTrail, track};
  const double position = road.closed ? planar::OnLoop(ReachableInterval(place.direction), place.position,
                                                       place.modulo_tolerance, r.at.position, road.length)
                                      : place.position;
  total = begin + position;
  return {};
}

// Computes the route along the trail, from the mover's own track on. kTrail: the track that does not begin at the end
// of the preceding one, occurs twice or has no geometry; the mover's own track, if the trail does not contain it.
planar::Verdict RouteAlong(const TrackNetworkState& streets, const Trail& trail, std::uint32_t own, Route& out) {
  const planar::Network& network = streets.network;
  out = {};
  Route all;
  for (const Name& name : trail.all()) {
    const std::uint32_t track = streets.Find(name.view());
    if (track == kNoTrack) return {ErrorId::kParameter, {}};
    const auto goes_on = [&](std::uint32_t from) {
      const planar::Links& behind = network[from].behind;
      return std::ranges::find(behind.all(), track) != behind.all().end();
    };
    const bool connects = all.count == 0 || goes_on(all.last());
    if (!network[track].track || !connects || all.Contains(track)) {
      return {ErrorId::kTrail, ObjectAt(ObjectKind::kTrack, track)};
    }
    all.tracks[all.count++] = track;
  }
  if (all.count == 0) all.tracks[all.count++] = own;
  for (const std::uint32_t track : all.all()) {
    if (track == own || out.count > 0) out.tracks[out.count++] = track;
  }
  if (out.count == 0) return {ErrorId::kTrail, ObjectAt(ObjectKind::kTrack, own)};
  return {};
}

// Cuts or extends the route to end with the track `to`; missing tracks are those of the shortest path.
bool Lengthen(const Context& c, std::uint32_t to, Route& route) {
  for (std::uint32_t i = 0; i < route.count; ++i) {
    if (route.tracks[i] == to) {
      std::fill(route.tracks.begin() + i + 1, route.tracks.end(), 0U);
      route.count = i + 1;
      return true;
    }
  }
  Route more;
  if (!planar::FindRoute(c.streets.network, route.last(), to, c.streets.search, more)) return false;
  if (route.count + more.count - 1 > planar::kRouteTracks) return false;
  for (std::uint32_t i = 1; i < more.count; ++i) route.tracks[route.count++] = more.tracks[i];
  return true;
}

std::int8_t SenseOf(SyncDirections directions) {
  if (directions == SyncDirections::kBoth) return 0;
  return directions == SyncDirections::kPositive ? 1 : -1;
}

template <typename Gear>
SyncPlace SlavePlace(const State& s, const TrackNetworkState& streets, const Gear& command) {
  return {command.slave_sync_track.empty() ? s.track : streets.Find(command.slave_sync_track.view()),
          command.slave_sync_position, command.direction_slave_sync_position,
          command.modulo_tolerance_slave_sync_position};
}

// Couples the mover to its master, as `next` says.
template <typename Gear>
AdmissionResult Couple(const CommandContext& g, const Gear& command, Rider& next, std::uint32_t axis) {
  State& s = g.s;
  if (const planar::Verdict way = AskRoute(g.c, next.route); way.error != ErrorId::kNone) return Refused(way);
  next.aim = planar::Aim::kFollow;
  const double least = LeastGap(g.c, s, next, command.gap.value_or(g.c.params.gap));
  if (command.gap && *command.gap < least - planar::kSame) return RefusedGap(least);
  if (const ErrorId why = DiagnoseRoute(g.c, s, next, s.others.back()); why != ErrorId::kNone) return Refused(why);
  next.planned = next.there = false;
  next.waits = planar::Waits::kNot;
  next.waits_for = kNobody;
  next.pace = PaceOf(g.c.params, LimitsOf(command, g.c.params.xy, s.limited_by));
  next.gap = command.gap.value_or(std::max(g.c.params.gap, least));
  next.gear.tolerance = command.in_sync_tolerance;
  next.gear.sense = SenseOf(command.allowed_slave_sync_directions);
  for (const Slot slot : {kHalt, kHaltOnTrack}) End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kPlane);
  g.c.rider() = next;
  s.gear = {.axis = axis};
  TakeRoute(g.c, next.route);
  return {};
}

// Ends the gear with an error, and brings the mover to rest.
void Lose(const Context& c, ErrorId error, State& s) {
  c.rider().aim = planar::Aim::kRest;
  c.rider().softly = false;
  c.rider().gear = {};
  s.gear = {};
  End(c, kPlane, FeedbackState::kError, error, s);
  AbortBuffered(c, s);
}

}  // namespace

bool IsFollowedBy(const TrackNetworkState& streets, std::uint32_t master, std::uint32_t mover) noexcept {
  for (std::size_t i = 0; i <= streets.riders.size(); ++i) {
    if (mover == master) return true;
    const Rider& r = streets.riders[mover];
    if (!r.on || r.aim != planar::Aim::kFollow || r.gear.master == kNobody) return false;
    mover = r.gear.master;
  }
  return true;
}

AdmissionResult CarryOut(const CommandContext& g, const GearInPosOnTrack& command) noexcept {
  State& s = g.s;
  TrackNetworkState& streets = g.c.streets;
  if (const ErrorId why = Diagnose(s, Ask::kMoveOnTrack); why != ErrorId::kNone) return Refused(why);
  const auto master = std::ranges::find(streets.masters, command.master.view(), &Master::name);
  if (master == streets.masters.end()) return Refused(ErrorId::kUnknownTarget);
  if (!master->known) return Refused(ErrorId::kMasterOff);
  const SyncPlace place = SlavePlace(s, streets, command);
  if (place.track == kNoTrack) return Refused(ErrorId::kParameter);
  Rider next = g.c.rider();
  next.gear = {};
  const planar::Verdict trail = RouteAlong(streets, command.trail, s.track, next.route);
  if (trail.error != ErrorId::kNone) return Refused(trail);
  if (!planar::MayTake(streets.network, g.c.rider(), next.route)) return Refused(ErrorId::kTrail);
  double begin = 0, slave_sync = 0;
  const planar::Verdict sync = Find(streets.network, next, place, begin, slave_sync);
  if (sync.error != ErrorId::kNone) return Refused(sync);
  // Of a periodic axis, the equivalent position nearest to its present one.
  double master_sync = command.master_sync_position + master->origin;
  if (master->turn > 0) {
    master_sync += master->turn * std::round((master->at.position - master_sync) / master->turn);
  }
  next.gear.offset = slave_sync - master_sync;
  return Couple(g, command, next, static_cast<std::uint32_t>(master - streets.masters.begin()));
}

AdmissionResult CarryOut(const CommandContext& g, const GearInPosOnTrackWithMasterMover& command) noexcept {
  State& s = g.s;
  TrackNetworkState& streets = g.c.streets;
  const planar::Network& network = streets.network;
  if (const ErrorId why = Diagnose(s, Ask::kMoveOnTrack); why != ErrorId::kNone) return Refused(why);
  const auto found = std::ranges::find(streets.movers, command.master.view(), &MasterMover::name);
  if (found == streets.movers.end()) return Refused(ErrorId::kUnknownTarget);
  const auto index = static_cast<std::uint32_t>(found - streets.movers.begin());
  if (IsFollowedBy(streets, g.c.index, index)) return Refused(ErrorId::kCouplingLoop);
  const Rider& master = streets.riders[index];
  if (!found->enabled || !found->on_track) return Refused(ErrorId::kMasterOffTrack);
  const SyncPlace its_place = {
      command.master_sync_track.empty() ? master.route.first() : streets.Find(command.master_sync_track.view()),
      command.master_sync_position, command.direction_master_sync_position,
      command.modulo_tolerance_master_sync_position};
  const SyncPlace place = SlavePlace(s, streets, command);
  if (place.track == kNoTrack || its_place.track == kNoTrack) return Refused(ErrorId::kParameter);
  double its_begin = 0, master_sync = 0;
  if (planar::Verdict why = Find(network, master, its_place, its_begin, master_sync); why.error != ErrorId::kNone) {
    if (why.error == ErrorId::kTrail) why.error = ErrorId::kNoRoute;
    return Refused(why);
  }
  Rider next = g.c.rider();
  next.gear = {};
  next.gear.master = index;
  const planar::Verdict trail = RouteAlong(streets, command.trail, s.track, next.route);
  if (trail.error != ErrorId::kNone) return Refused(trail);
  if (command.follow_mover) {
    if (!Lengthen(g.c, its_place.track, next.route)) {
      return Refused(ErrorId::kNoRoute, ObjectAt(ObjectKind::kTrack, its_place.track));
    }
    double begin = 0;
    BeginOf(network, next, its_place.track, begin);
    next.gear.takes_masters_way = true;
    next.gear.apart = begin - its_begin;
    if (!planar::TakeMastersRoute(network, master, next)) {
      return Refused(ErrorId::kNoRoute, ObjectAt(ObjectKind::kMover, index));
    }
  }
  if (!planar::MayTake(network, g.c.rider(), next.route)) return Refused(ErrorId::kTrail);
  double begin = 0, slave_sync = 0;
  const planar::Verdict sync = Find(network, next, place, begin, slave_sync);
  if (sync.error != ErrorId::kNone) return Refused(sync);
  next.gear.offset = slave_sync - master_sync;
  return Couple(g, command, next, kNoMaster);
}

void Lead(const Context& c, State& s) noexcept {
  if (!IsGeared(c, s)) return;
  Rider& rider = c.rider();
  TrackNetworkState& streets = c.streets;
  if (rider.gear.master == kNobody) {
    const Master& master = streets.masters[s.gear.axis];
    if (!master.known) return Lose(c, ErrorId::kMasterOff, s);
    rider.demand = master.at;
    return;
  }
  const MasterMover& master = streets.movers[rider.gear.master];
  if (!master.enabled || !master.on_track) return Lose(c, ErrorId::kMasterOffTrack, s);
  if (rider.gear.takes_masters_way &&
      !planar::TakeMastersRoute(streets.network, streets.riders[rider.gear.master], rider)) {
    Lose(c, ErrorId::kMasterLost, s);
  }
}

void NoteGear(const Context& c, State& s) noexcept {
  const Rider& rider = c.rider();
  if (rider.gear.end == planar::GearEnd::kWay) {
    c.rider().gear = {};
    s.gear = {};
    End(c, kPlane, FeedbackState::kError, ErrorId::kTrackEnd, s);
    return AbortBuffered(c, s);
  }
  if (!IsGeared(c, s) || rider.gear.in_step == s.gear.in_sync) return;
  s.gear.in_sync = rider.gear.in_step;
  const FeedbackEvent event{s.tickets[kPlane], c.cycle.count,  FeedbackState::kActive,
                            s.gear.in_sync,    ErrorId::kNone, 0};
  c.feedback.Report(event);
}

}  // namespace takt::mover
