// Movers on tracks, all together: each goes its way as fast as its limits and those before it allow, and none comes
// nearer to another than its gap.
//
// The invariant, held after every cycle for every pair of movers that can meet: if from now on both brake, each with
// its greatest dynamics, they never come nearer than the gap. It holds by construction. A mover that only brakes keeps
// it: so at first each is taken to brake, and then one after the other may go on as it wishes, if the pair it makes
// with everyone in its way keeps the invariant; otherwise it brakes. Nobody has to know what others are up to.
//
// Which pairs can meet: neighbours on a track, a mover and the first one on the rest of its route, and around a place
// where tracks meet (a node) all those that are active there. A mover is active at a node if a place that it passes
// before it rests is nearer to the node than its zone, or than the collision range of the track there. The zone is its
// gap; one that is told to keep a larger gap gets it as its zone once all with whom it gets active by that are far
// enough away. Around a node the distance is that of their ways to it. Two on different tracks there keep more than the
// gap where they could touch else, side by side on tracks of different length (LeadAtStart in network.h). So two that a
// node is between or beside never touch, however they are turned, if their gap is enough for that where one follows the
// other.
//
// Each mover alone has one as well: if from now on it brakes with its greatest dynamics, its speed stays within its
// maximum, in curves its lateral acceleration within its limit, and its acceleration and jerk as vectors within theirs:
// in bends it brakes with a share of its dynamics only (way.h). So all are kept in every cycle, whatever command comes,
// and when: where from the state it is in the commanded dynamics do not keep them, the greatest are used until
// they do. They are used, too, to take away an acceleration that would make it faster than commanded.
//
// A mover may be off its place (Rider::off), as set points from outside have it: every gap to it is as much
// larger, and so are zones and ranges around nodes between it and each other. Whoever gets onto a track, or further off
// its place, has to ask before (TooNear).
//
// What gaps and nodes do not keep apart, the guard does (guard.h): movers on tracks that cross or come near each other
// without a node, movers nearer than their size in a bend, and movers that are on no track. A mover that the guard does
// not let go on for one that is not before or behind it brakes, and goes on once its way is clear again.
//
// How a mover follows another is not part of that: its speed falls with the way left to where the one before it could
// stop, in a way that does not swing (following.h). It keeps a little more than the invariant asks for.
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

  // One cycle of all movers. With a guard: none overlaps any other mover, either.
  void Step(const Cycle& cycle, trajectory::Planner& planner, const Network& network, std::span<Rider> riders,
            Guard* guard = nullptr) noexcept;

  // Who would come nearer to this mover than the larger gap of both if from now on all braked; kNobody: nobody. Asked
  // before a mover is put on a track, or may be further off its place, so that the invariant holds from then on.
  std::uint32_t TooNear(const Cycle& cycle, const Network& network, std::span<const Rider> riders,
                        std::uint32_t mover) noexcept;

  // Returns the mover with the least number that this one, turned and as far off its track as `kind` says, would
  // overlap on `course` if from now on both braked; kNobody: none. Asked between steps, before a mover gets further off
  // its track.
  std::uint32_t FindAcross(const Cycle& cycle, const Network& network, std::span<const Rider> riders, Guard& guard,
                           std::uint32_t mover, const Area& kind, const Course& course) noexcept;

  // The movers on a track, from its start to its end. As the last step, or question, left it.
  std::span<const std::uint32_t> On(std::uint32_t track) const noexcept;
  // Movers that were going and had to brake in the last step, against what they follow with.
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  class Step_;

  Scene scene_;
  std::uint32_t refused_ = 0;
};

// Whether this mover waits for others that wait for it, in a ring.
bool IsDeadlocked(std::span<const Rider> riders, std::uint32_t mover) noexcept;
// Whether it waits, be it over others, for movers that wait for one another: in that ring, or behind it.
bool LeadsToDeadlock(std::span<const Rider> riders, std::uint32_t mover) noexcept;

}  // namespace takt::planar
