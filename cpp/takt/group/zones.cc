#include "takt/group/zones.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "takt/group/group.h"
#include "takt/group/members.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

constexpr double kLeast = 1e-9;  // mm: it begins there and leads out of it at once

std::uint32_t BitOf(std::size_t zone) {
  return 1u << zone;
}

bool Shares(const Zone& zone, std::size_t group) {
  return group < kZoneGroups && (zone.groups >> group & 1) != 0;
}

// The share of the line from `from` to `to` up to which it meets the zone, widened by `margin`; less than 0: it does
// not. On each coordinate it is within for a part of the line, and those parts have one in common (slabs).
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

// Of those that this group shares.
std::uint32_t ZonesMet(const Context& c, const KDL::Vector& from, const KDL::Vector& to, bool with_margin) {
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < c.zones.of.size(); ++i) {
    const Zone& zone = c.zones.of[i];
    if (Shares(zone, c.number - 1) && MeetsUntil(zone, from, to, with_margin ? zone.margin : 0) >= 0) met |= BitOf(i);
  }
  return met;
}

// The group that has one of these zones, from 1, and which; 0: none has.
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

// One that waits for these zones longer, and could have them.
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

// Whether that group waits for this one, or for others that do, which have `zones` or what it wants.
bool WaitsForUs(const Context& c, std::uint32_t group, std::uint32_t zones) {
  for (std::size_t steps = 0; steps <= c.zones.groups.size(); ++steps) {
    const State& other = c.zones.groups[group - 1];
    if (other.waits_for == 0) return false;
    const State& next = c.zones.groups[other.waits_for - 1];
    const std::uint32_t had = other.waits_for == c.number ? zones : next.zones;
    if ((had & other.zones_wanted) == 0) return false;  // it has not looked yet
    if (other.waits_for == c.number) return true;
    group = other.waits_for;
  }
  return false;
}

void EndWait(State& s) {
  s.zones_wanted = s.waits_for = s.waits_zone = 0;
}

// What the rest of the path meets.
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
    if (until >= 0) ahead.next.zones_until[k] = std::max(std::lerp(before, way, until), kLeast);
  }
  ahead.tried_at = there;
  ahead.tried_at_way = way;
}

std::uint32_t ZonesOf(const Stretch& stretch) noexcept {
  std::uint32_t zones = 0;
  for (std::size_t k = 0; k < kZones; ++k) zones |= stretch.zones_until[k] > 0 ? BitOf(k) : 0;
  return zones;
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

ErrorId StepZones(const Context& c, State& s) noexcept {
  if (c.zones.of.empty() || !HasTool(c, s)) return ErrorId::kNone;
  const bool plans = s.queue.count > 0 && s.claimed_for == s.planning.move && !s.ends;
  if (!plans) s.zones_claimed = 0;
  if (!plans || s.interrupted) EndWait(s);
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const KinematicState& set = MemberOf(c, s, k).setpoint;
    motion.position[k] = set.position;
    motion.velocity[k] = set.velocity;
  }
  kinematics::MovingFrame flange;
  if (kinematics::Forward(*c.kinematics, motion, flange) != kinematics::Reason::kNone) return ErrorId::kNone;
  const kinematics::MovingFrame tool = flange * c.mounting.tool;
  const KDL::Vector here = c.mounting.base * tool.p.p;
  s.zones &= ZonesMet(c, here, here, true) | ZonesAhead(c, s) | s.zones_claimed;
  // What is planned was looked at beforehand. Carried along it comes to rest there at the earliest.
  const bool carried = s.begun && s.pace.now.velocity == 0;
  const PathLimits& path = c.params.path;
  const double stop_s = carried ? 0.5 * tool.p.v.Norm() / path.deceleration.value_or(path.acceleration) : 0;
  const KDL::Vector there = c.mounting.base * (tool.p.p + stop_s * tool.p.v);
  std::uint32_t entered = ZonesMet(c, here, there, false) & ~s.zones;
  if (!s.begun) entered |= ZonesMet(c, here, here, true) & ~s.zones;
  for (std::size_t k = 0; k < c.zones.of.size(); ++k) {
    if ((entered & BitOf(k)) == 0) continue;
    const Holder holder = HolderOf(c, BitOf(k));
    if (holder.group == 0) {
      s.zones |= BitOf(k);
    } else if (s.begun && s.state == GroupState::kMoving && !s.ends) {
      return ErrorId::kZoneTaken;
    }
  }
  return ErrorId::kNone;
}

}  // namespace takt::group
