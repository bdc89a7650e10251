// Zones that several groups share (GR-47): the tool of one group is inside at a time.
//
// Invariant: no two groups have the same zone, and a tool is in no zone that its group does not have. So at every
// instant no two tools are inside the same zone.
//
// - What is planned: a group takes the zones that a move meets before that move is joined to the path, and has them
//   until its tool is outside and nothing that is planned leads there. A move whose path meets a zone that another
//   group has is not planned on: the tool rests at the end of the move before it, and State::waits_for says for whom.
//   Of those that wait the one that waited longest is next. Where groups would wait for one another in a circle the
//   move that would close it is refused.
// - What is carried goes where its belt goes, planned or not. In each cycle the places are known that the tool can
// still
//   come to if path and carriers are braked from the next cycle on, as they can be in every cycle (CanLetGo). The group
//   has all zones that those places meet: it takes the free ones, and it is braked in the very cycle in which they
//   begin to meet one of another group. By induction the tool rests outside. What a belt may do beyond that from one
//   cycle to the next is less than the margin.
// - A tool that stands on a carrier, and a move that boards one, has besides what the carrier takes it into within
//   TrackingParams::zones_ahead_s, if that is free: nobody else begins to go there then.
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

// As the cycle needs it.
struct Zone {
  KDL::Vector lower, upper;  // mm, in the world
  double margin = 0;         // mm
  std::uint64_t groups = 0;  // those that share it: bit 0 is the first group of the machine
};
// `names`: of all groups.
Zone MakeZone(const ZoneParams& params, std::span<const GroupParams> groups);

// All zones and groups of the machine.
struct Zones {
  std::span<const Zone> of{};
  std::span<const State> groups{};
};

// Notes which zones the straight line to the place of these axes meets, from the place noted before (`first`: there is
// none), as part of `ahead.next`.
void NoteZones(const Context& c, const State& s, const kinematics::Joints& joints, double way, bool first) noexcept;

// The end of `ahead.next`, of a move that boards a carrier: notes what that takes its target into until then, and the
// tool afterwards.
void NoteRide(const Context& c, const State& s) noexcept;

// Before `ahead.next` is joined to the path: notes what the blend into it meets, which cuts the corner.
void NoteBlend(const Context& c, const State& s) noexcept;

// A mask: those that a piece of path meets.
std::uint32_t ZonesOf(const Stretch& stretch) noexcept;

// Where, along its segment, it meets the first of these.
double ZonesBeginAt(const Stretch& stretch, std::uint32_t zones) noexcept;

enum class Entry : std::uint8_t { kFree, kWaits, kCircle };
// Takes the zones that `ahead.next` meets, all or none.
Entry EnterZones(const Context& c, State& s) noexcept;

// A streamed set point leads the axes from `before` to `there`, and on to `after`, until `until` of the sender's clock:
// takes the zones that the tool meets on the way. False: they are not free, or another group is next in line.
bool EnterZonesOf(const Context& c, const kinematics::Joints& before, const kinematics::Joints& there,
                  const kinematics::Joints& after, double until, State& s) noexcept;

// move, behind the set points: lets go of zones that the tool has left, and takes those that it is in or is bound to be
// carried into. A tool that would be carried into one of another group is braked: one that only waits for a zone gets
// off its carrier and waits there (State::gets_off), else the group has to fail (kZoneTaken).
ErrorId StepZones(const Context& c, State& s) noexcept;

}  // namespace takt::group
