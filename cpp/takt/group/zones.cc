#include "takt/group/zones.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/group.h"
#include "takt/group/join.h"
#include "takt/group/make_stretch.h"
#include "takt/group/members.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/stream.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

constexpr double kLeast = 1e-9;  // [mm] for a zone that is met only at the start of a stretch
constexpr int kLooks = 6;        // points while braking, and along a carrier
constexpr int kBlendLooks = 8;

std::uint32_t BitOf(std::size_t zone) {
  return 1u << zone;
}

bool Shares(const Zone& zone, std::size_t group) {
  return group < kZoneGroups && (zone.groups >> group & 1) != 0;
}

// Returns the share of the line from `from` to `to` up to which it meets the zone widened by `margin`; negative if it
// does not. In each coordinate the line is within the zone for an interval, and those intervals intersect (slabs).
double MeetsUntil(const Zone& zone, const KDL::Vector& from, const KDL::Vector& to, double margin) {
  double first = 0, last = 1;
  for (int i = 0; i < 3; ++i) {
    const double lower = zone.lower(i) - margin, upper = zone.upper(i) + margin;
    const double way = to(i) - from(i);
    if (way == 0) {
      if (from(i) < lower || from(i) > upper) return -1;
      continue;
    }
    const double a = (lower - from(i)) / way, b = (upper - from(i)) / way;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last ? last : -1;
}

// Masks of the zones of this group that are met: with their margin, and the box itself.
struct Met {
  std::uint32_t widened = 0;
  std::uint32_t inside = 0;
};
void MeetLine(const Context& c, const KDL::Vector& from, const KDL::Vector& to, Met& met) {
  for (std::size_t i = 0; i < c.zones.of.size(); ++i) {
    const Zone& zone = c.zones.of[i];
    if (!Shares(zone, c.number - 1) || MeetsUntil(zone, from, to, zone.margin) < 0) continue;
    met.widened |= BitOf(i);
    if (MeetsUntil(zone, from, to, 0) >= 0) met.inside |= BitOf(i);
  }
}

// The group, from 1, that has one of these zones, and which; 0: none.
struct Holder {
  std::uint32_t group = 0;
  std::uint32_t zones = 0;
};
Holder HolderOf(const Context& c, std::uint32_t zones) {
  for (std::size_t i = 0; i < c.zones.groups.size(); ++i) {
    if (i + 1 == c.number) continue;
    if (const std::uint32_t taken = c.zones.groups[i].zones & zones; taken != 0) {
      return {static_cast<std::uint32_t>(i + 1), taken};
    }
  }
  return {};
}

// Returns a group that has waited longer for these zones and could have them.
Holder NextInLine(const Context& c, std::uint32_t zones, const State& s) {
  for (std::size_t i = 0; i < c.zones.groups.size(); ++i) {
    const State& other = c.zones.groups[i];
    if (i + 1 == c.number || (other.zones_wanted & zones) == 0 || (other.zones_wanted & s.zones) != 0) continue;
    const bool longer = s.waits_for == 0 || other.waits_since < s.waits_since;
    if (longer && HolderOf(c, other.zones_wanted & ~zones).group == 0) {
      return {static_cast<std::uint32_t>(i + 1), other.zones_wanted & zones};
    }
  }
  return {};
}

// Returns true if that group waits for this one, directly or through other groups. `zones`: those of this group.
bool WaitsForUs(const Context& c, std::uint32_t group, std::uint32_t zones) {
  for (std::size_t steps = 0; steps <= c.zones.groups.size(); ++steps) {
    const State& other = c.zones.groups[group - 1];
    if (other.waits_for == 0) return false;
    const State& next = c.zones.groups[other.waits_for - 1];
    const std::uint32_t had = other.waits_for == c.number ? zones : next.zones;
    if ((had & other.zones_wanted) == 0) return false;  // it has not yet checked again
    if (other.waits_for == c.number) return true;
    group = other.waits_for;
  }
  return false;
}

void EndWait(State& s) {
  s.zones_wanted = s.waits_for = s.waits_zone = 0;
}

// Computes the tool at the set points of the axes.
bool ToolOf(const Context& c, const State& s, kinematics::MovingFrame& tool) {
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const KinematicState& set = MemberOf(c, s, k).setpoint;
    motion.position[k] = set.position;
    motion.velocity[k] = set.velocity;
  }
  kinematics::MovingFrame flange;
  if (kinematics::Forward(*c.kinematics, motion, flange) != kinematics::Reason::kNone) return false;
  tool = flange * c.mounting.tool;
  return true;
}

double WayAt(const Stretch& stretch, double place) {
  return std::clamp(stretch.from + place - stretch.begin, stretch.from, stretch.to);
}

// When a carrier without travel is released each axis brakes individually: roughly along the velocity of the tool.
KDL::Vector FreelyBraked(const Context& c, const kinematics::MovingFrame& tool) {
  const PathLimits& path = c.params.path;
  const double deceleration = path.deceleration.value_or(path.acceleration);
  const double stop_s = 0.5 * (tool.p.v.Norm() / deceleration + deceleration / path.jerk) + c.cycle.period_s;
  return tool.p.p + stop_s * tool.p.v;
}

// Finds the zones that a tool on a carrier can still reach if it is braked from the next cycle on: path and carriers
// slow down at once, so it is between the point to which the path alone and that to which both would have taken it.
void MeetBraking(const Context& c, const State& s, const kinematics::MovingFrame& tool, Met& met) {
  const LookAhead& ahead = c.ahead;
  if (ahead.count == 0) return;
  const double now = s.pace.now.position, rest = std::max(now, RestAt(c, s));
  if (!IsCarried(ahead, *ahead.At(now)) && !IsCarried(ahead, *ahead.At(rest))) return;
  const KDL::Vector here = c.mounting.base * tool.p.p;
  if (IsOnFreeCarrier(c, s)) MeetLine(c, here, c.mounting.base * FreelyBraked(c, tool), met);
  KDL::Vector up = KDL::Vector::Zero();  // remaining rise
  if (s.rise.used) {
    const Stretch& stretch = *ahead.At(now);
    const CarrierBinding& to = ahead.rides[stretch.to_ride % kRides];
    const CarrierBinding& ride = Moves(to) ? to : ahead.rides[stretch.from_ride % kRides];
    up = c.mounting.base.M * (s.rise.target * PlaceOf(c, ride.cargo).M.R.UnitZ());
  }
  KDL::Vector along = here, braked = here;
  const int looks = rest > now ? kLooks : 1;
  for (int i = 0; i < looks; ++i) {
    const double place = looks > 1 ? std::lerp(now, rest, static_cast<double>(i) / (looks - 1)) : rest;
    const Stretch& stretch = *ahead.At(place);
    if (stretch.joints) break;
    const double way = WayAt(stretch, place);
    const KDL::Vector next = c.mounting.base * ToolNow(c, s, stretch, {way, 0, 0}).p.p;
    const KDL::Vector next_braked = c.mounting.base * ToolBraked(c, s, stretch, way).p.p;
    MeetLine(c, along, next, met);
    MeetLine(c, braked, next_braked, met);
    MeetLine(c, next, next_braked, met);
    if (s.rise.used) MeetLine(c, next_braked, next_braked + up, met);
    along = next;
    braked = next_braked;
  }
}

// Finds the zones that the tool meets while all axes move in proportion from one position to another.
void MeetJoints(const Context& c, const kinematics::Joints& from, const kinematics::Joints& to, Met& met) {
  KDL::Vector before;
  bool known = false;
  for (int i = 0; i <= kLooks; ++i) {
    kinematics::Joints joints{};
    for (std::size_t k = 0; k < kMaxAxes; ++k) joints[k] = std::lerp(from[k], to[k], static_cast<double>(i) / kLooks);
    Frame tool;
    if (ToolAt(c, joints, tool) != kinematics::Reason::kNone) continue;
    const KDL::Vector place = c.mounting.base * tool.p;
    if (known) MeetLine(c, before, place, met);
    before = place;
    known = true;
  }
}

// Returns the zones into which set points that are kept lead.
std::uint32_t ZonesOfStream(const Context& c, const State& s) {
  std::uint32_t zones = 0;
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    if ((s.stream.zones & BitOf(k)) != 0 && s.stream.zones_until[k] > s.stream.of[0].clock) zones |= BitOf(k);
  }
  return zones;
}

// Finds the zones into which its carrier takes a point of a stretch within this time.
void MeetRide(const Context& c, const Stretch& stretch, double way, double time_s, Met& met) {
  KDL::Vector before;
  for (int i = 0; i <= kLooks; ++i) {
    const KDL::Vector place = c.mounting.base * ToolIn(c, stretch, {way, 0, 0}, time_s * i / kLooks).p.p;
    if (i > 0) MeetLine(c, before, place, met);
    before = place;
  }
}

// Returns the zones into which the tool is carried within zones_ahead_s if its carriers move on as now, until tracking
// ends.
std::uint32_t ZonesOfRide(const Context& c, const State& s) {
  if (!s.begun || s.ends || s.lets_go || !IsOnCarrier(c, s)) return 0;
  double time_s = c.params.tracking.zones_ahead_s;
  const Track& track = s.track;
  if (track.started) {
    const KinematicState travel = CarrierOf(c, track.cargo).travel;
    const double left = track.end - track.sense * (travel.position - track.cargo.from);
    const double speed = track.sense * travel.velocity;
    if (speed > 0) time_s = std::clamp(left / speed, 0.0, time_s);
  }
  Met met;
  const double place = s.pace.now.position;
  const Stretch& stretch = *c.ahead.At(place);
  MeetRide(c, stretch, WayAt(stretch, place), time_s, met);
  return met.widened;
}

// Returns the zones that the rest of the path meets.
std::uint32_t ZonesAhead(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  std::uint32_t zones = 0;
  for (std::uint64_t i = ahead.first; i < ahead.end(); ++i) {
    const Stretch& stretch = ahead[i];
    const double way = s.begun ? stretch.from + s.pace.now.position - stretch.begin : stretch.from;
    for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
      if (stretch.zones_until[k] > way) zones |= BitOf(k);
    }
  }
  return zones;
}

}  // namespace

Zone MakeZone(const ZoneParams& params, std::span<const GroupParams> groups) {
  Zone zone;
  zone.lower = {params.lower.x, params.lower.y, params.lower.z};
  zone.upper = {params.upper.x, params.upper.y, params.upper.z};
  zone.margin = params.margin;
  for (std::size_t i = 0; i < std::min(groups.size(), kZoneGroups); ++i) {
    const bool shares =
        params.groups.empty() || std::ranges::find(params.groups, groups[i].name) != params.groups.end();
    if (shares) zone.groups |= std::uint64_t{1} << i;
  }
  return zone;
}

void NoteZones(const Context& c, const State& s, const kinematics::Joints& joints, double way, bool first) noexcept {
  if (c.zones.of.empty() || !HasTool(c, s)) return;
  Frame tool;
  if (ToolAt(c, joints, tool) != kinematics::Reason::kNone) return;
  const KDL::Vector there = c.mounting.base * tool.p;
  LookAhead& ahead = c.ahead;
  const KDL::Vector from = first ? there : ahead.tried_at;
  const double before = first ? way : ahead.tried_at_way;
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    const Zone& zone = c.zones.of[k];
    const double until = Shares(zone, c.number - 1) ? MeetsUntil(zone, from, there, zone.margin) : -1;
    if (until >= 0 && ahead.next.zones_until[k] == 0) ahead.next.zones_from[k] = before;
    if (until >= 0) ahead.next.zones_until[k] = std::max(std::lerp(before, way, until), kLeast);
  }
  ahead.tried_at = there;
  ahead.tried_at_way = way;
}

void NoteRide(const Context& c, const State& s) noexcept {
  Stretch& next = c.ahead.next;
  const CarrierBinding& ride = c.ahead.rides[next.to_ride % kRides];
  if (c.zones.of.empty() || !HasTool(c, s) || next.joints || !Moves(ride)) return;
  const Stretch* here = IsOnCarrier(c, s) ? Here(c, s) : nullptr;
  if (here && c.ahead.rides[here->to_ride % kRides].cargo == ride.cargo) return;  // the tool is on it already
  Met met;
  // From now on: a tool stopped during the transition comes to rest closer to the pose of its target at that time.
  const double there_s = std::max(0.0, next.eta_end - Now(c));
  MeetRide(c, next, next.segment.length, there_s + c.params.tracking.zones_ahead_s, met);
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    if ((met.widened & BitOf(k)) != 0) next.zones_until[k] = next.segment.length;
  }
}

void NoteBlend(const Context& c, const State& s) noexcept {
  LookAhead& ahead = c.ahead;
  if (c.zones.of.empty() || !HasTool(c, s) || !ahead.known || ahead.count == 0) return;
  CornerBlend blend;
  int work = 0;
  const Stretch& before = ahead[ahead.end() - 1];
  if (!FindBlend(c, s, MoveAt(s, s.planning.move), s.planning.element, before, ahead.next, work, blend)) return;
  Met met;
  kinematics::Joints near = ahead.end_joints;
  KDL::Vector from;
  for (int i = 0; i <= kBlendLooks; ++i) {
    trajectory::PathPoint point;
    kinematics::JointMotion motion;
    Frame tool;
    const double way = blend.stretch.segment.length * i / kBlendLooks;
    if (SlopesOn(c, s, blend.stretch, way, near, point, motion) != kinematics::Reason::kNone) return;
    if (ToolAt(c, motion.position, tool) != kinematics::Reason::kNone) return;
    near = motion.position;
    const KDL::Vector place = c.mounting.base * tool.p;
    if (i > 0) MeetLine(c, from, place, met);
    from = place;
  }
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    double& until = ahead.next.zones_until[k];
    if ((met.widened & BitOf(k)) != 0) until = std::max(until, blend.second + kLeast);
  }
}

std::uint32_t ZonesOf(const Stretch& stretch) noexcept {
  std::uint32_t zones = 0;
  for (std::size_t k = 0; k < kZones; ++k) zones |= stretch.zones_until[k] > 0 ? BitOf(k) : 0;
  return zones;
}

double ZonesBeginAt(const Stretch& stretch, std::uint32_t zones) noexcept {
  double from = stretch.segment.length;
  for (std::size_t k = 0; k < kZones; ++k) {
    if ((zones & BitOf(k)) != 0) from = std::min(from, stretch.zones_from[k]);
  }
  return from;
}

Entry EnterZones(const Context& c, State& s) noexcept {
  const std::uint32_t wanted = ZonesOf(c.ahead.next) | c.ahead.tried_zones;
  s.zones_claimed = wanted;
  s.claimed_for = s.planning.move;
  if ((wanted & ~s.zones) == 0) {
    EndWait(s);
    return Entry::kFree;
  }
  const std::uint32_t missing = wanted & ~s.zones;
  Holder before = HolderOf(c, missing);
  if (before.group != 0 && WaitsForUs(c, before.group, s.zones)) {
    EndWait(s);
    s.zones_claimed = 0;
    return Entry::kCircle;
  }
  if (before.group == 0) before = NextInLine(c, missing, s);
  if (before.group == 0) {
    s.zones |= missing;
    EndWait(s);
    return Entry::kFree;
  }
  if (s.waits_for == 0) s.waits_since = c.cycle.count;
  s.zones_wanted = missing;
  s.zones_claimed &= s.zones;
  s.waits_for = before.group;
  s.waits_zone = static_cast<std::uint32_t>(std::countr_zero(before.zones)) + 1;
  return Entry::kWaits;
}

bool EnterZonesOf(const Context& c, const kinematics::Joints& before, const kinematics::Joints& there,
                  const kinematics::Joints& after, double until, State& s) noexcept {
  if (c.zones.of.empty() || !HasTool(c, s)) return true;
  Met met;
  MeetJoints(c, before, there, met);
  if (after != there) MeetJoints(c, there, after, met);
  const std::uint32_t missing = met.widened & ~s.zones;
  if (HolderOf(c, missing).group != 0 || NextInLine(c, missing, s).group != 0) return false;
  s.zones |= missing;
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    if ((met.widened & BitOf(k)) == 0) continue;
    const bool has = (s.stream.zones & BitOf(k)) != 0;
    s.stream.zones_until[k] = has ? std::max(s.stream.zones_until[k], until) : until;
    s.stream.zones |= BitOf(k);
  }
  return true;
}

ErrorId StepZones(const Context& c, State& s) noexcept {
  if (c.zones.of.empty() || !HasTool(c, s)) return ErrorId::kNone;
  // The tool is at rest before the next move, and nothing but that move is left to do.
  const bool only_waits = s.waits_for != 0 && s.done == s.planning.move && !s.interrupted;
  const bool plans = s.queue.count > 0 && s.claimed_for == s.planning.move && !s.ends;
  if (!plans) s.zones_claimed = 0;
  if (!plans || s.interrupted) EndWait(s);
  s.gets_off = s.gets_off && s.ends;
  s.zone_near = false;
  kinematics::MovingFrame tool;
  if (!ToolOf(c, s, tool)) return ErrorId::kNone;
  const KDL::Vector here = c.mounting.base * tool.p.p;
  Met now, comes;
  MeetLine(c, here, here, now);
  // Without a path to brake along, each axis brakes individually.
  const bool by_itself = Streams(s) || (s.ends && !s.begun);
  if (s.begun) MeetBraking(c, s, tool, comes);
  if (by_itself) MeetJoints(c, PresentJoints(c, s), JointsBraked(c, s), comes);
  const std::uint32_t ride = ZonesOfRide(c, s);
  const std::uint32_t stays = s.pace.now.velocity == 0 ? ride : 0;  // else its path may lead out of there
  s.zones &= now.widened | comes.widened | ride | ZonesAhead(c, s) | ZonesOfStream(c, s) | s.zones_claimed;
  // A tool that is within the margin already may leave it.
  const std::uint32_t must_not = now.inside | comes.inside | (comes.widened & ~now.widened);
  const std::uint32_t wanted = must_not | comes.widened | stays | (s.begun || Streams(s) ? 0 : now.widened);
  std::uint32_t of_others = 0;
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    if (((wanted | ride) & ~s.zones & BitOf(k)) == 0) continue;
    if (HolderOf(c, BitOf(k)).group != 0) {
      of_others |= BitOf(k);
    } else if ((wanted & BitOf(k)) != 0) {
      s.zones |= BitOf(k);
    }
  }
  s.zone_near = (ride & of_others) != 0;
  if ((must_not & of_others) == 0) return ErrorId::kNone;
  EndStream(c, FeedbackState::kError, ErrorId::kZoneTaken, s);
  if (!s.begun) return ErrorId::kNone;
  if (s.ends && s.lets_go) {  // as hard as it can
    EndMotion(c, {}, true, s);
    return ErrorId::kNone;
  }
  if (s.state == GroupState::kErrorStop) return ErrorId::kNone;
  if (!only_waits || s.task != Task::kNone) return ErrorId::kZoneTaken;
  EndMotion(c, {}, true, s);
  s.gets_off = true;
  return ErrorId::kNone;
}

}  // namespace takt::group
