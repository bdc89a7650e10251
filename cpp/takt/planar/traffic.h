// Traffic of movers on tracks: each moves as fast as its limits and the movers ahead allow, and no two come nearer to
// each other than the gap.
//
// The invariant, after every cycle, for every pair of movers that can meet: if both brake from now on, each with its
// maximum dynamics, they never come nearer than the gap. It holds by construction: braking alone keeps it. So each
// mover is first assumed to brake; then one after the other may take the step that it wishes if every pair of it and a
// mover in its way keeps the invariant; otherwise it brakes. No mover needs to know the intentions of others.
//
// Pairs that can meet: neighbours on a track, a mover and the first one on the rest of its route, and all movers that
// are active at the same node, a point where tracks meet. A mover is active at a node if a position that it passes
// before it rests is nearer to the node than its zone, or than the collision range of the track there. The zone is its
// gap; if a larger gap is commanded, the zone grows to it once all movers that this newly involves are far enough away.
// Around a node the distance of two movers is the difference of their distances along the tracks to it. Two on
// different tracks there keep more than the gap where they could touch otherwise, side by side on tracks of different
// length (LeadAtStart in network.h). So two movers with a node between or beside them never touch, at any angles, if
// their gap suffices where one follows the other.
//
// A second invariant holds for each mover alone: if it brakes with its maximum dynamics from now on, its speed stays
// within its maximum, in curves its lateral acceleration within its limit, and its acceleration and jerk as vectors
// within theirs: in bends it brakes with a share of its dynamics only (way.h). So these limits hold in every cycle,
// whatever command arrives at whatever time: if the commanded dynamics cannot keep them from the current state, the
// maximum dynamics are used until they can. They also serve to remove an acceleration that would make the mover faster
// than commanded.
//
// A mover may be displaced from its position (Rider::off), by set points from outside: every gap to it grows by that,
// and so do zones and ranges around nodes between it and any other mover. TooNear has to be called before a mover is
// put on a track, or is displaced farther.
//
// The guard (guard.h) separates movers that gaps and nodes do not: movers on tracks that cross or come near each other
// without a node, movers nearer than their size in a bend, and movers that are on no track. A mover that the guard
// stops for one that is neither ahead nor behind brakes, and continues once its path is clear.
//
// How a mover follows another one is a separate law: its speed falls with the distance to where the mover ahead could
// stop, without oscillation (following.h). It keeps a little more distance than the invariant requires.
#pragma once

#include <cstdint>
#include <span>

#include "takt/core/cycle.h"
#include "takt/planar/guard.h"
#include "takt/planar/network.h"
#include "takt/planar/rider.h"
#include "takt/planar/right_of_way.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {

struct TrafficSettings {
  std::uint32_t movers = 0;
  std::uint32_t tracks = 0;
};

class Traffic {
 public:
  explicit Traffic(const TrafficSettings& settings);

  // Computes one cycle of all movers. With a guard, none overlaps any other mover, either.
  void Step(const Cycle& cycle, trajectory::Planner& planner, const Network& network, std::span<Rider> riders,
            Guard* guard = nullptr) noexcept;

  // Returns a mover that would come nearer to this one than the larger gap of both if all braked from now on; kNobody
  // if there is none. To be called before a mover is put on a track, or may be displaced farther, so that the invariant
  // holds from then on.
  std::uint32_t TooNear(const Cycle& cycle, const Network& network, std::span<const Rider> riders,
                        std::uint32_t mover) noexcept;

  // Returns the mover with the least number that this one, with the angles and the offsets from its track in `kind`,
  // would overlap on `course` if both braked from now on; kNobody if there is none. To be called between steps, before
  // a mover is displaced farther from its track.
  std::uint32_t FindAcross(const Cycle& cycle, const Network& network, std::span<const Rider> riders, Guard& guard,
                           std::uint32_t mover, const Area& kind, const Course& course) noexcept;

  // Returns the movers on a track, from its start to its end, in the order of the last step or query.
  std::span<const std::uint32_t> On(std::uint32_t track) const noexcept;
  // Returns the number of moving movers whose wished step was refused in the last step, so that they braked.
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  class Step_;

  Scene scene_;
  std::uint32_t refused_ = 0;
};

// Returns true if this mover waits, directly or via others, for itself: a cycle of waiting movers.
bool IsDeadlocked(std::span<const Rider> riders, std::uint32_t mover) noexcept;
// Returns true if this mover waits, directly or via others, for a cycle of waiting movers, whether it is in that or
// behind it.
bool LeadsToDeadlock(std::span<const Rider> riders, std::uint32_t mover) noexcept;

}  // namespace takt::planar
