// Zones that several groups share (GR-47): the tool of only one group is inside at a time.
//
// Invariant: no two groups hold the same zone, and a tool is in no zone that its group does not hold. So at every
// instant no two tools are inside the same zone.
//
// - Planned motion: a group takes the zones that a move meets before that move is joined to the path, and holds them
//   until its tool is outside and nothing planned leads there. A move whose path meets a zone held by another group is
//   not planned further: the tool rests at the end of the previous move, and State::waits_for names that group. Of the
//   groups that wait, the one that has waited longest is next. A move is refused if groups would wait for one another
//   in a circle.
// - Carried motion: the tool moves with its carrier, planned or not. In each cycle the points are computed that the
//   tool can still reach if path and carriers are braked from the next cycle on, as they can be in every cycle
//   (CanRelease). The group holds all zones that those points meet: it takes the free ones, and it is braked in the
//   cycle in which they begin to meet a zone of another group. By induction the tool comes to rest outside. What a belt
//   may do beyond that from one cycle to the next is less than the margin.
// - A tool at rest on a carrier, and a move that boards one, also hold the zones into which the carrier takes them
//   within TrackingParams::zones_ahead_s, if they are free: no other group starts to enter them then.
#pragma once

#include <cstdint>
#include <span>

#include "takt/group/params.h"
#include "takt/group/state.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

struct Context;
struct Stretch;

inline constexpr std::size_t kZoneGroups = 64;  // that may share zones

// A zone as the cycle uses it.
struct Zone {
  KDL::Vector lower, upper;  // [mm] in the world
  double margin = 0;         // [mm]
  std::uint64_t groups = 0;  // that share it, a mask: bit 0 is the first group of the machine
};
// `groups`: all groups of the machine.
Zone MakeZone(const ZoneParams& params, std::span<const GroupParams> groups);

// All zones and groups of the machine.
struct Zones {
  std::span<const Zone> of{};
  std::span<const State> groups{};
};

// Notes in `ahead.next` the zones that the straight line from the point noted before to the tool at these axes meets
// (`first`: only the latter point).
void NoteZones(const Context& c, const State& s, const kinematics::Joints& joints, double way, bool first) noexcept;

// At the end of `ahead.next`, of a move that boards a carrier: notes the zones into which the carrier takes its target
// until then, and the tool afterwards.
void NoteRide(const Context& c, const State& s) noexcept;

// Before `ahead.next` is joined to the path: notes the zones that the blend into it meets, since it cuts the corner.
void NoteBlend(const Context& c, const State& s) noexcept;

// Returns a mask of the zones that a stretch meets.
std::uint32_t ZonesOf(const Stretch& stretch) noexcept;

// Returns the arc length of its segment at which a stretch meets the first of these zones [mm].
double ZonesBeginAt(const Stretch& stretch, std::uint32_t zones) noexcept;

enum class Entry : std::uint8_t { kFree, kWaits, kCircle };
// Takes the zones that `ahead.next` meets, all or none. kCircle: groups would wait for one another.
Entry EnterZones(const Context& c, State& s) noexcept;

// Takes the zones that the tool meets when a streamed set point leads the axes from `before` to `there`, and on to
// `after`, until `until` of the sender's clock. Returns false if they are not free, or another group is next.
bool EnterZonesOf(const Context& c, const kinematics::Joints& before, const kinematics::Joints& there,
                  const kinematics::Joints& after, double until, State& s) noexcept;

// Stage move, after the set points: releases zones that the tool has left, and takes those that it is in or will
// inevitably be carried into. A tool that would be carried into a zone of another group is braked: if it only waits for
// a zone it gets off its carrier and waits there (State::gets_off), else the group has to fail (kZoneTaken).
ErrorId StepZones(const Context& c, State& s) noexcept;

}  // namespace takt::group
