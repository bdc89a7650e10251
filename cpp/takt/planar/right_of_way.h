// Who is where in a cycle, and who may go on: the invariant of traffic.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "takt/core/kinematic_state.h"
#include "takt/planar/braking.h"
#include "takt/planar/network.h"
#include "takt/planar/rider.h"

namespace takt::planar {

inline constexpr double kTolerance = 1e-7;  // mm: rounding
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Nodes within its zone beyond either end of what a mover knows of its way; there is room for so many.
inline constexpr std::size_t kBeyond = 24;

// What is worked out of a mover in each cycle. Places are those on the track where it is when the cycle begins.
struct Now {
  KinematicState next;     // at the end of the cycle
  Braking braking;         // from there, as it can in the bends on its way
  Braking hard;            // from there, with its greatest dynamics: it never comes to rest before that
  std::uint8_t share = 0;  // of kShares, in `braking`; 0: both are the same
  double rest_before = 0;  // where it would stand if it only braked with its greatest dynamics
  std::uint32_t leader = kNobody;
  double leader_offset = 0;        // from the leader's places to its own
  bool entered = false;            // in the search for an order
  bool settled = false;            // `next` is what it is going to do
  bool taken = false;              // it takes the step it asked for, and does not only brake
  std::uint32_t across = kNobody;  // the mover that its last step asked for would have overlapped
};
// A mover's way through a node.
struct Passage {
  std::uint32_t node = kNoNode;
  double offset = 0;  // place - offset: its way from the node, < 0 before it
  // The tracks before and behind it; kNoTrack: it does not come from there, or not go there.
  std::uint32_t from = kNoTrack;
  std::uint32_t to = kNoTrack;
  double range_before = 0;  // collision ranges of these tracks here, mm
  double range_behind = 0;

  bool operator==(const Passage&) const = default;
};
// A mover that is active at a node.
struct Presence {
  std::uint32_t mover = kNobody;
  Passage passage;
  std::uint32_t next = kNobody;
  // What is looked at of all that are there, for few of which the rest counts.
  double place = 0;  // when the cycle begins, from the node
  double off = 0;    // Rider::off
};

// The memory of one cycle: what is worked out anew in each.
struct Scene {
  Scene(std::uint32_t movers, std::uint32_t tracks);

  std::vector<Now> now;
  std::vector<std::uint32_t> order;   // movers by track, and along it
  std::vector<std::uint32_t> begins;  // by track: its first one in `order`; one more at the end
  std::vector<std::uint32_t> index;   // by mover: where it stands in `order`
  std::vector<std::uint32_t> heads;   // by node: its first presence
  std::vector<Presence> presences;
  std::uint32_t presence_count = 0;
  double off = 0;  // mm, so far off its place may somebody be
  std::vector<std::uint32_t> stack;
};

// What two movers at a node have to do with one another.
struct Meeting {
  std::uint32_t other = kNobody;
  double apart = 0;              // from the other's places to own ones
  double place = 0;              // of the other from here, now
  bool ahead = false;            // it is further on
  double off = 0;                // so far from their places both together may be
  const Passage* its = nullptr;  // the other's way through the node
  double gap = 0;                // what they have to be apart; 0: their order along the way sees to it
  double split = 0;              // and if the one behind cannot stop before the node any more
};

class RightOfWay {
 public:
  RightOfWay(Scene& scene, const Network& network, std::span<const Rider> riders, double period_s) noexcept
      : s_(scene), network_(network), riders_(riders), period_s_(period_s) {}

  const Network& network() const noexcept { return network_; }
  const Rider& rider(std::uint32_t i) const noexcept { return riders_[i]; }
  const Now& now(std::uint32_t i) const noexcept { return s_.now[i]; }
  double period_s() const noexcept { return period_s_; }

  // At first all are taken to brake; nobody is at a node.
  void Begin() noexcept;
  // Whether this step keeps the invariant with everyone.
  bool MayTake(std::uint32_t i, const KinematicState& next, const Braking& braking) const noexcept;
  // Who would come too near to this one if from here on all braked; kNobody: nobody.
  std::uint32_t TooNear(std::uint32_t i) const noexcept;
  // Whether it may be active so far around nodes: whoever it would have to do with there is far enough away.
  bool MayWiden(std::uint32_t i, double zone) const noexcept;
  // Whether one with such a step is active at a node. `off`: how far it and the other may be off their places.
  static bool IsActive(double zone, double off, const KinematicState& next, const Braking& braking, const Passage& p) {
    const double lowest = std::min(next.position, braking.lowest), highest = std::max(next.position, braking.highest);
    if (highest < p.offset) return p.offset - highest < std::max(zone, p.range_before) + off;
    if (lowest > p.offset) return lowest - p.offset < std::max(zone, p.range_behind) + off;
    return true;
  }
  // Whether the other one is, as it is taken to go.
  bool IsActive(const Meeting& m) const noexcept {
    const Now& its = s_.now[m.other];
    return IsActive(riders_[m.other].zone, m.off, its.next, its.braking, *m.its);
  }
  // It takes it, with a braking by this share.
  void Take(std::uint32_t i, const KinematicState& next, const Braking& braking, std::size_t share) noexcept;

  // Who is next in this direction, on the track or the rest of the route.
  std::uint32_t FindLeader(std::uint32_t i, int direction, double& offset) const noexcept;
  double GapTo(std::uint32_t i, std::uint32_t leader, int direction) const noexcept;

  // Calls `look` for those that have this one before them on their way forwards: who, and from its places to theirs.
  template <typename Look>
  void Followers(std::uint32_t i, const Look& look) const {
    for (std::uint32_t k = 0; k < riders_.size(); ++k) {
      const Rider& other = riders_[k];
      if (!other.on || k == i) continue;
      std::uint32_t its_leader = s_.now[k].leader;
      double offset = s_.now[k].leader_offset;
      // One that goes back now still has its way ahead, and who is on it there is nobody's neighbour.
      if (other.direction < 0) its_leader = other.route.count > 1 ? FindLeader(k, 1, offset) : kNobody;
      if (its_leader == i) look(k, offset);
    }
  }

  // Calls `look` for the nodes on the way, and those beyond what is known of it that are no further than its zone:
  // there it meets others that are on no track of it.
  template <typename Look>
  void AlongNodes(const Rider& r, double reach, const Look& look) const {
    const Road& here = network_[r.route.first()];
    if (here.closed) return;
    const std::uint32_t last = r.passed_count > 0 ? r.passed[0] : kNoTrack;
    if (here.start_node != kNoNode) look(Through(here.start_node, 0, last, r.route.first()));
    double offset = 0;
    for (std::uint32_t k = 0; k < r.route.count; ++k) {
      const std::uint32_t track = r.route.tracks[k];
      const std::uint32_t next = k + 1 < r.route.count ? r.route.tracks[k + 1] : kNoTrack;
      offset += network_[track].length;
      if (network_[track].end_node != kNoNode) look(Through(network_[track].end_node, offset, track, next));
      if (offset > reach) break;
    }
    const double near = std::max(r.zone, r.gap) + r.off + s_.off;
    if (offset <= reach) Beyond(r.route.last(), offset, near, true, look);
    offset = 0;
    for (std::uint32_t k = 0; k < r.passed_count; ++k) {
      const std::uint32_t track = r.passed[k];
      const std::uint32_t before = k + 1 < r.passed_count ? r.passed[k + 1] : kNoTrack;
      offset -= network_[track].length;
      if (network_[track].start_node != kNoNode) look(Through(network_[track].start_node, offset, before, track));
    }
    if (offset > -near)
      Beyond(r.passed_count > 0 ? r.passed[r.passed_count - 1] : r.route.first(), offset, near, false, look);
  }

  // Calls `look` for those near a node with whom this mover has to do there if both are active. `counts`: of a meeting
  // without its distances, which cost more, whether it matters.
  template <typename Counts, typename Look>
  void MeetAt(std::uint32_t i, const Passage& own, const Counts& counts, const Look& look) const {
    const Rider& r = riders_[i];
    const double here = r.at.position - own.offset;
    Meeting m;
    for (std::uint32_t k = s_.heads[own.node]; k != kNobody; k = s_.presences[k].next) {
      const Presence& there = s_.presences[k];
      if (there.mover == i) continue;
      const Passage& its = there.passage;
      m.other = there.mover;
      m.its = &its;
      m.off = r.off + there.off;
      m.apart = own.offset - its.offset;
      m.place = there.place - here;
      m.ahead = m.place > 0 || (m.place == 0 && m.other > i);
      if (!counts(m)) continue;
      const Rider& o = riders_[m.other];
      m.gap = m.split = 0;
      const bool in_order = IsOnRoute(r, o, m.apart) || IsOnRoute(o, r, -m.apart);
      const Passage &ahead = m.ahead ? its : own, &behind = m.ahead ? own : its;
      if (!in_order) {
        m.gap = std::max(r.gap, o.gap) + m.off;
        const bool before = (m.ahead ? o : r).at.position < ahead.offset;
        if (before) m.gap = std::max(m.gap, LeadAtEnd(network_, ahead.from, behind.from) + m.off);
      }
      const double kept = in_order ? (m.ahead ? r : o).gap + m.off : m.gap;
      const double lead = LeadAtStart(network_, ahead.to, behind.to);
      const double split = lead > 0 ? lead + m.off : 0;
      if (split > kept) m.split = split;
      if (m.gap > 0 || m.split > 0) look(m);
    }
  }

 private:
  Passage Through(std::uint32_t node, double offset, std::uint32_t from, std::uint32_t to) const {
    const double before = from != kNoTrack ? network_[from].range_at_end : 0;
    const double behind = to != kNoTrack ? network_[to].range_at_start : 0;
    return {node, offset, from, to, before, behind};
  }
  // The nodes behind the end of a track that is at `offset`, or before its start, as near to that as `way`, the nearest
  // first.
  template <typename Look>
  void Beyond(std::uint32_t track, double offset, double way, bool forward, const Look& look) const {
    struct Reached {
      std::uint32_t track;
      double way;  // to its far end
    };
    std::array<Reached, kBeyond> open;
    std::size_t count = 0;
    const auto leave = [&](std::uint32_t from, double gone) {
      const Links& links = forward ? network_[from].behind : network_[from].before;
      for (const std::uint32_t next : links.all()) {
        const double all = gone + network_[next].length;
        const auto end = open.begin() + static_cast<std::ptrdiff_t>(count);
        const auto known = std::find_if(open.begin(), end, [&](const Reached& one) { return one.track == next; });
        if (known != end) {
          known->way = std::min(known->way, all);
        } else if (all <= way && count < kBeyond) {
          open[count++] = {next, all};
        }
      }
    };
    leave(track, 0);
    for (std::size_t k = 0; k < count; ++k) {
      const auto rest = open.begin() + static_cast<std::ptrdiff_t>(k);
      std::iter_swap(rest, std::min_element(rest, open.begin() + static_cast<std::ptrdiff_t>(count),
                                            [](const Reached& a, const Reached& b) { return a.way < b.way; }));
      const Reached here = *rest;
      const Road& road = network_[here.track];
      const std::uint32_t node = forward ? road.end_node : road.start_node;
      const double place = forward ? offset + here.way : offset - here.way;
      if (node != kNoNode) look(Through(node, place, forward ? here.track : kNoTrack, forward ? kNoTrack : here.track));
      leave(here.track, here.way);
    }
  }
  void TakeToBrake(std::uint32_t i) noexcept;
  void Sort() noexcept;
  // Whether another keeps so far ahead of, or behind, a braking if it brakes, as it can in bends or harder.
  bool HoldsAhead(const Braking& of_behind, std::uint32_t ahead, double apart, double required) const noexcept;
  bool HoldsBehind(std::uint32_t behind, const Braking& of_ahead, double apart, double required) const noexcept;
  // Whether two keep so far apart if both brake.
  bool Keeps(const Braking& own, const Meeting& m, double required) const noexcept;
  void EnterNodes(std::uint32_t i, const KinematicState& next, const Braking& braking) noexcept;
  // The other is on this one's way as far as the places of both differ by `apart`.
  bool IsOnRoute(const Rider& r, const Rider& other, double apart) const noexcept;

  Scene& s_;
  const Network& network_;
  std::span<const Rider> riders_;
  double period_s_;
};

}  // namespace takt::planar
