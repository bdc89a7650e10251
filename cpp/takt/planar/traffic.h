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
// before it rests is nearer to the node than its gap, or than the collision range of the track there. Around a node the
// distance is that of their ways to it.
//
// How a mover follows another is not part of that: its speed falls with the way left to where the one before it could
// stop, in a way that does not swing (Follow in traffic.cc). It keeps a little more than the invariant asks for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/planar/braking.h"
#include "takt/planar/gear.h"
#include "takt/planar/network.h"
#include "takt/planar/way.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/profile.h"

namespace takt::planar {

inline constexpr std::uint32_t kNobody = 0xffffffff;
inline constexpr std::size_t kPassed = 4;  // tracks that a mover remembers having come from

// What a mover on a track is about.
enum class Aim : std::uint8_t {
  kRest,    // come to rest and stay
  kTarget,  // go to a place on the last track of the route
  kFollow,  // go along with a demand that comes anew in each cycle
};

// Why a mover does not go on.
enum class Waits : std::uint8_t {
  kNot,
  kMover,  // for a mover before it, or at a node
  kRoute,  // its route ends here
};

// Everything that is remembered of a mover on a track.
struct Rider {
  bool on = false;                              // on a track; else nothing else counts
  KinematicState at;                            // mm on the first track of the route, and its derivatives
  Route route;                                  // from where it is
  std::array<std::uint32_t, kPassed> passed{};  // the tracks before, the last one first
  std::uint32_t passed_count = 0;
  std::int8_t direction = 1;  // of its way; changes at rest only

  Aim aim = Aim::kRest;
  double target = 0;      // mm on the last track of the route; of a closed loop turns are counted in
  Gear gear;              // kFollow: whom, and how
  KinematicState demand;  // kFollow: mm, where its master is at the end of this cycle, over all tracks
  Pace pace;              // as commanded
  Brakes brakes;          // its greatest
  double gap = 0;         // mm to the mover before it, from centre to centre

  bool planned = false;           // `plan` is good
  trajectory::Profile plan;       // along the way, 0 at `plan_from`
  double plan_from = 0;           // mm on the first track
  double plan_time = 0;           // s since it began
  bool plan_ends = false;         // it goes all the way to the target
  bool there = false;             // it rests at its target
  std::uint32_t calm_cycles = 0;  // so long it does not speed up more, having had to brake
  double eased = 0;               // mm/s², what following asks for, without the shaking of those before it
  double origin = 0;              // mm, of all tracks that it has left behind: at + origin goes on over borders

  Waits waits = Waits::kNot;
  std::uint32_t waits_for = kNobody;
  std::uint64_t waits_since = 0;  // cycle
};

struct TrafficSettings {
  std::uint32_t movers = 0;
  std::uint32_t tracks = 0;
};

// The memory of one cycle: what is worked out anew in each.
class Traffic {
 public:
  explicit Traffic(const TrafficSettings& settings);

  // One cycle of all movers.
  void Step(const Cycle& cycle, trajectory::Planner& planner, const Network& network, std::span<Rider> riders) noexcept;

  // The movers on a track, from its start to its end. As the last step left it.
  std::span<const std::uint32_t> On(std::uint32_t track) const noexcept;
  // Movers that were going and had to brake in the last step, against what they follow with.
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  class Step_;

  // What is worked out of a mover in each cycle. Places are those on the track where it is when the cycle begins.
  struct Now {
    KinematicState next;     // at the end of the cycle
    Braking braking;         // from there
    double rest_before = 0;  // where it would stand if it only braked
    std::uint32_t leader = kNobody;
    double leader_offset = 0;  // from the leader's places to its own
    bool entered = false;      // in the search for an order
    bool settled = false;      // `next` is what it is going to do
  };
  // A mover that is active at a node.
  struct Presence {
    std::uint32_t mover = kNobody;
    double offset = 0;  // place - offset: its way from the node, < 0 before it
    std::uint32_t next = kNobody;
  };

  std::vector<Now> now_;
  std::vector<std::uint32_t> order_;   // movers by track, and along it
  std::vector<std::uint32_t> begins_;  // by track: its first one in order_; one more at the end
  std::vector<std::uint32_t> index_;   // by mover: where it stands in order_
  std::vector<std::uint32_t> heads_;   // by node: its first presence
  std::vector<Presence> presences_;
  std::vector<std::uint32_t> stack_;
  std::uint32_t presence_count_ = 0;
  std::uint32_t refused_ = 0;
};

// Whether this mover waits for others that wait for it, in a ring.
bool IsDeadlocked(std::span<const Rider> riders, std::uint32_t mover) noexcept;

void describe(Enumeration<Aim>&);
void describe(Enumeration<Waits>&);
void describe(Description<Pace>&);
void describe(Description<Brakes>&);
void describe(Description<Rider>&);

}  // namespace takt::planar
