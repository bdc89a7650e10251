// Zones that several groups share (GR-47): the tool of one group is inside at a time.
//
// Invariant: a group has a zone from before its path is known to lead there until its tool is outside and nothing that
// is planned leads there, and no two groups have the same one. A move whose path meets a zone that another group has is
// not planned on: the tool rests at the end of the move before it, and State::waits_for says for whom. Of those that
// wait the one that waited longest is next. Where groups would wait for one another in a circle the move that would
// close it is refused.
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

// A mask: those that a piece of path meets.
std::uint32_t ZonesOf(const Stretch& stretch) noexcept;

enum class Entry : std::uint8_t { kFree, kWaits, kCircle };
// Takes the zones that `ahead.next` meets, all or none.
Entry EnterZones(const Context& c, State& s) noexcept;

// move: lets go of zones that the tool has left, and takes those that it is in. The tool of a moving group that comes
// into one of another group all the same, as on a belt, has to be stopped (kZoneTaken).
ErrorId StepZones(const Context& c, State& s) noexcept;

}  // namespace takt::group
