// Moves onto tracks, along them, and off them.
#include <algorithm>
#include <array>
#include <cmath>

#include "takt/core/angle.h"
#include "takt/mover/admission.h"
#include "takt/mover/coordinate.h"
#include "takt/mover/follow.h"
#include "takt/mover/on_parts.h"
#include "takt/planar/clearance.h"
#include "takt/planar/course.h"
#include "takt/planar/nearest.h"
#include "takt/planar/problem.h"

namespace takt::mover {

using trajectory::Limits;

namespace {

ObjectInfo MoverOf(std::uint32_t index) {
  return {ObjectKind::kMover, index + 1};
}
ObjectInfo TrackOf(std::uint32_t index) {
  return {ObjectKind::kTrack, index + 1};
}

// Returns true if the mover is no larger than those for which geometry and ranges of the track have been made.
bool IsSmallEnough(const MoverParams& mover, const TrackView& track) {
  return std::max(mover.width, mover.height) <= std::max(track.width, track.height) &&
         std::min(mover.width, mover.height) <= std::min(track.width, track.height);
}

planar::Verdict WithoutGeometry(std::uint32_t track) {
  return {ErrorId::kTrackGeometry, TrackOf(track), static_cast<double>(planar::Problem::kEmpty)};
}

// Returns why a track is not enabled: its part may be moving.
planar::Verdict WhyNotEnabled(const Context& c, std::uint32_t track) {
  const std::uint32_t part = c.streets.tracks[track].part;
  if (part != planar::kNoPart && IsPartMoving(c, part)) {
    return {ErrorId::kPartDisabled, ObjectAt(ObjectKind::kPart, part)};
  }
  return {ErrorId::kTrackDisabled, TrackOf(track)};
}

// Returns the part that has to move so that two tracks meet, which are linked only at certain positions of their parts;
// a part that is moving rather than one that only can move. kNoPart: none can.
std::uint32_t PartBetween(const Context& c, std::uint32_t from, std::uint32_t to) {
  const planar::Parts& parts = *c.streets.parts;
  const std::array both = {c.streets.tracks[to].part, c.streets.tracks[from].part};
  const auto goes = [&](std::uint32_t part) { return part != planar::kNoPart && parts.all[part].positions.size() > 1; };
  for (const std::uint32_t part : both) {
    if (goes(part) && IsPartMoving(c, part)) return part;
  }
  const auto found = std::ranges::find_if(both, goes);
  return found == both.end() ? planar::kNoPart : *found;
}

// Returns the first part that is not where the path from one track to another needs it, of the path over the fewest
// tracks. kNoPart: there is no such path at any positions of the parts.
std::uint32_t PartOnTheWay(const Context& c, std::uint32_t from, std::uint32_t to) {
  TrackNetworkState& streets = c.streets;
  planar::RouteSearch& search = streets.search;
  std::ranges::fill(search.settled, std::uint8_t{0});
  // Breadth first; the queue is in search.queue.
  std::uint32_t count = 0;
  const auto reach = [&](std::uint32_t track, std::uint32_t before) {
    if (search.settled[track] != 0) return;
    search.settled[track] = 1;
    search.came_from[track] = before;
    search.queue[count++] = track;
  };
  for (const std::uint32_t next : streets.declared[from].all()) reach(next, from);
  for (std::uint32_t k = 0; k < count; ++k) {
    for (const std::uint32_t next : streets.declared[search.queue[k]].all()) reach(next, search.queue[k]);
  }
  if (search.settled[to] == 0) return planar::kNoPart;
  std::uint32_t part = planar::kNoPart;
  std::uint32_t at = to;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t before = search.came_from[at];
    const auto behind = streets.network[before].behind.all();
    if (std::ranges::find(behind, at) == behind.end()) part = PartBetween(c, before, at);
    if (before == from) break;
    at = before;
  }
  return part;
}

planar::Verdict NoWayTo(const Context& c, const planar::Destination& to, const planar::Rider& rider) {
  const planar::UnreachableReason why = planar::DiagnoseUnreachable(c.streets.network, c.streets.search, to, rider);
  if (why == planar::UnreachableReason::kNotLinked) {
    const std::uint32_t part = PartOnTheWay(c, rider.route.first(), to.track);
    if (part != planar::kNoPart) {
      return {ErrorId::kNoRoute, ObjectAt(ObjectKind::kPart, part),
              static_cast<double>(planar::UnreachableReason::kPartAway)};
    }
  }
  return {ErrorId::kNoRoute, TrackOf(to.track), static_cast<double>(why)};
}

// Moves to a position with the dynamics of a command onto or from a track.
AdmissionResult MoveAs(const auto& command, const CommandContext& g, double x, double y, double c) {
  return MoveTo(g, {.x = x,
                    .y = y,
                    .c = c,
                    .use_orientation = command.use_orientation,
                    .velocity = command.velocity,
                    .acceleration = command.acceleration,
                    .deceleration = command.deceleration,
                    .jerk = command.jerk});
}

}  // namespace

planar::Way ReachableInterval(TurnDirection direction) noexcept {
  switch (direction) {
    case TurnDirection::kPositive:
      return planar::Way::kPositive;
    case TurnDirection::kShortestWay:
      return planar::Way::kShortestWay;
    case TurnDirection::kNegative:
      return planar::Way::kNegative;
    default:
      return planar::Way::kNonModulo;
  }
}

AdmissionResult CarryOut(const CommandContext& g, const JoinTrack& command) noexcept {
  State& s = g.s;
  TrackNetworkState& streets = g.c.streets;
  if (const ErrorId why = Diagnose(s, Ask::kJoinTrack); why != ErrorId::kNone) return Refused(why);
  if (!IsPlaneResting(g.c, s)) return Refused(ErrorId::kCommandMode);
  const std::uint32_t track = streets.Find(command.track.view());
  if (track == planar::kNoTrack) return Refused(ErrorId::kParameter);
  const planar::Spot& spot = streets.tracks[track].spot;
  if (spot.system != s.system) return Refused(ErrorId::kReference, TrackOf(track));
  if (!streets.network[track].track) return Refused(WithoutGeometry(track));
  if (!streets.tracks[track].enabled) return Refused(WhyNotEnabled(g.c, track));
  if (!IsSmallEnough(g.c.params, streets.tracks[track])) return Refused(ErrorId::kMoverTooLarge, TrackOf(track));
  if (streets.uses[track].moving > 0) return Refused(ErrorId::kTrackMode, TrackOf(track));
  const planar::Place from{s.set_point[kX].position, s.set_point[kY].position};
  planar::Nearest nearest = planar::NearestTo(*streets.network[track].track, from - spot.origin);
  nearest.place = nearest.place + spot.origin;
  // The mover occupies its position on the track from now on.
  planar::Rider& rider = g.c.rider();
  rider = {};
  rider.on = true;
  rider.at.position = nearest.s;
  rider.off = ReachOf(g.c, s);
  rider.route.tracks[0] = track;
  rider.route.count = 1;
  rider.gap = rider.zone = std::max(g.c.params.gap, LeastGap(g.c, s, rider, g.c.params.gap));
  rider.pace = PaceOf(g.c.params, StandardOf(g.c.params.xy));
  const Limits most = g.c.params.xy.maximum.limits();
  rider.brakes = {most.deceleration, most.jerk};
  rider.top_speed = most.velocity;
  const std::uint32_t other = streets.traffic.TooNear(g.c.cycle, streets.network, streets.riders, g.c.index);
  if (other != planar::kNobody) {
    rider = {};
    return Refused(ErrorId::kCollision, MoverOf(other));
  }
  const KinematicState turned = Now(g.c, s.others.back());
  const double c = TargetOf(g.c.params, turned, turned.position, {.direction = TurnDirection::kShortestWay});
  const AdmissionResult answer = MoveAs(command, g, nearest.place.x, nearest.place.y, c);
  if (answer.status.failed()) {
    rider = {};
    return answer;
  }
  s.track = track;
  s.mode = CommandMode::kJoiningTrack;
  ++streets.uses[track].configuring;
  return answer;
}

AdmissionResult CarryOut(const CommandContext& g, const LeaveTrack& command) noexcept {
  State& s = g.s;
  TrackNetworkState& streets = g.c.streets;
  if (const ErrorId why = Diagnose(s, Ask::kLeaveTrack); why != ErrorId::kNone) return Refused(why);
  if (!IsPlaneResting(g.c, s)) return Refused(ErrorId::kCommandMode);
  if (streets.uses[s.track].moving > 0) return Refused(ErrorId::kTrackMode, TrackOf(s.track));
  double x = command.x, y = command.y;
  if (const ErrorId why = ToMoverSystem(g.c, s, command.reference, x, y); why != ErrorId::kNone) return Refused(why);
  s.plane = {};
  // Without the displacement by external set points.
  const planar::Place at = streets.At(s.track, g.c.rider().at.position).place;
  s.plane.motion = StandingAt(at.x, at.y);
  s.plane.begin = g.c.cycle.count;
  const AdmissionResult answer = MoveAs(command, g, x, y, command.c);
  if (answer.status.failed()) {
    s.plane = {};  // it stays at its position on the track
    return answer;
  }
  s.mode = CommandMode::kLeavingTrack;
  ++streets.uses[s.track].configuring;
  return answer;
}

double LeastGap(const Context& c, const State& s, const planar::Rider& rider, double wanted) noexcept {
  planar::Footprint largest{c.params.width, c.params.height};
  for (std::size_t k = 0; k < c.streets.riders.size(); ++k) {
    const planar::Rider& other = c.streets.riders[k];
    if (!other.on || !rider.route.Contains(other.route.first())) continue;
    const planar::Footprint& its = c.grounds.movers[k].mover;
    largest = {std::max(largest.width, its.width), std::max(largest.height, its.height)};
  }
  const double turned = s.others.back().profile.end().position * kDegree;
  double least = 0;
  const auto look = [&](std::uint32_t track, double at) {
    const planar::TrackPoint point = planar::At(*c.streets.network[track].track, at);
    least = std::max(least, planar::ClearGap(largest, turned - point.direction));
  };
  look(rider.route.first(), rider.at.position);
  for (const std::uint32_t track : rider.route.all()) {
    look(track, 0);
    look(track, c.streets.network[track].length);
  }
  double in_bends = std::max(least, wanted);
  const planar::Interval way = planar::ReachableInterval(c.streets.network, rider);
  planar::EachStretch(
      c.streets.network, rider.route, way.from, way.to, [&](std::uint32_t track, double from, double to) {
        in_bends = planar::ClearGapAlong(*c.streets.network[track].track, largest, turned, from, to, in_bends);
      });
  return in_bends > std::max(least, wanted) ? in_bends : least;
}

planar::Verdict AskRoute(const Context& c, const planar::Route& route) noexcept {
  for (const std::uint32_t on : route.all()) {
    if (!c.streets.tracks[on].enabled) return WhyNotEnabled(c, on);
    if (c.streets.uses[on].configuring > 0) return {ErrorId::kTrackMode, TrackOf(on)};
    if (!IsSmallEnough(c.params, c.streets.tracks[on])) return {ErrorId::kMoverTooLarge, TrackOf(on)};
  }
  return planar::AskTracks(c.index, route.all(), c.grounds);
}

void TakeRoute(const Context& c, const planar::Route& route) noexcept {
  for (const std::uint32_t on : route.all()) ++c.streets.uses[on].moving;
  planar::TakeTracks(route.all(), c.grounds);
}

planar::Verdict ComputeRoute(const Context& c, const MoveOnTrack& command, const State& s,
                             planar::Rider& rider) noexcept {
  TrackNetworkState& streets = c.streets;
  const std::uint32_t track = command.track.empty() ? s.track : streets.Find(command.track.view());
  if (track == planar::kNoTrack) return {ErrorId::kParameter, {}};
  const planar::Road& road = streets.network[track];
  if (!road.track) return WithoutGeometry(track);
  if (!road.closed && (command.additional_turns != 0 || command.modulo_tolerance != 0)) {
    return {ErrorId::kParameter, TrackOf(track)};
  }
  const bool turns_count = road.closed && command.direction == TurnDirection::kNonModulo;
  const bool outside = !(command.position >= 0 && command.position <= road.length);
  if (outside && !turns_count) return {ErrorId::kTargetBehindLimit, TrackOf(track), road.length};
  const planar::Destination to{track, command.position, ReachableInterval(command.direction), command.additional_turns,
                               command.modulo_tolerance};
  if (!planar::Send(streets.network, streets.search, to, rider)) return NoWayTo(c, to, rider);
  const planar::Verdict route = AskRoute(c, rider.route);
  return route.error == ErrorId::kNone ? planar::Verdict{DiagnoseRoute(c, s, rider, s.others.back()), {}} : route;
}

std::uint32_t PartAwaited(const Context& c, const Command& command, const State& s) noexcept {
  const auto* move = std::get_if<MoveOnTrack>(&command);
  if (!move || !IsOnTrack(s) || c.streets.parts->none()) return planar::kNoPart;
  planar::Rider then = c.rider();
  const planar::Verdict way = ComputeRoute(c, *move, s, then);
  if (way.object.kind != ObjectKind::kPart) return planar::kNoPart;
  const std::uint32_t part = way.object.number - 1;
  return IsPartMoving(c, part) ? part : planar::kNoPart;
}

AdmissionResult CarryOut(const CommandContext& g, const MoveOnTrack& command) noexcept {
  State& s = g.s;
  if (const ErrorId why = Diagnose(s, Ask::kMoveOnTrack); why != ErrorId::kNone) return Refused(why);
  planar::Rider next = g.c.rider();
  next.pace = PaceOf(g.c.params, LimitsOf(command, g.c.params.xy, s.limited_by), command.dynamics_reduction);
  if (const planar::Verdict way = ComputeRoute(g.c, command, s, next); way.error != ErrorId::kNone) {
    return Refused(way);
  }
  const double least = LeastGap(g.c, s, next, command.gap.value_or(g.c.params.gap));
  if (command.gap && *command.gap < least - planar::kSame) return RefusedGap(least);
  next.gap = command.gap.value_or(std::max(g.c.params.gap, least));
  for (const Slot slot : {kHalt, kHaltOnTrack}) End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, s);
  Take(g, kPlane);
  g.c.rider() = next;
  TakeRoute(g.c, next.route);
  return {Status::Ok(), planar::TimeAlone(g.c.planner, g.c.streets.network, next)};
}

AdmissionResult CarryOut(const CommandContext& g, const AdoptTrackOrientation& command) noexcept {
  return Turn(g,
              {.position = 0,
               .direction = command.direction,
               .additional_turns = command.additional_turns,
               .velocity = command.velocity,
               .acceleration = command.acceleration,
               .deceleration = command.deceleration,
               .jerk = command.jerk},
              Ask::kAdoptTrackOrientation);
}

}  // namespace takt::mover
