// Positions of the movers in a cycle, and the checks of the invariant of traffic.h.
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

inline constexpr double kTolerance = 1e-7;  // [mm] rounding
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Largest number of nodes within its zone beyond either end of the known route of a mover.
inline constexpr std::size_t kBeyond = 24;

// Data of a mover, computed in each cycle. Positions on the track where it is at the beginning of the cycle.
struct Now {
  KinematicState next;     // at the end of the cycle
  Braking braking;         // from `next`, with the dynamics that the bends ahead allow
  Braking hard;            // from `next`, with its maximum dynamics: never at rest before that
  std::uint8_t share = 0;  // index into kShares, of `braking`; 0: `hard` is the same
  double rest_before = 0;  // [mm] rest position if it only braked with its maximum dynamics
  std::uint32_t leader = kNobody;
  double leader_offset = 0;        // [mm] own position minus the leader's of the same point
  bool entered = false;            // visited in the search for an order
  bool settled = false;            // `next` is final
  bool taken = false;              // it takes the step that it asked for, instead of braking
  std::uint32_t across = kNobody;  // the mover that the last step it asked for would have overlapped
};
// The passage of a mover through a node.
struct Passage {
  std::uint32_t node = kNoNode;
  double offset = 0;  // [mm] position of the node: the distance past it is position - offset, < 0 before it
  // The tracks before and after the node; kNoTrack: not known, or none.
  std::uint32_t from = kNoTrack;
  std::uint32_t to = kNoTrack;
  double range_before = 0;  // [mm] collision ranges of `from` and `to` at the node
  double range_behind = 0;

  bool operator==(const Passage&) const = default;
};
// A mover that may be active at a node.
struct Presence {
  std::uint32_t mover = kNobody;
  Passage passage;
  std::uint32_t next = kNobody;
  // Copies of what is read for all presences; only few of them need more.
  double place = 0;  // [mm] from the node, at the beginning of the cycle
  double off = 0;    // Rider::off
};

// Working memory of one cycle; computed anew in each.
struct Scene {
  Scene(std::uint32_t movers, std::uint32_t tracks);

  std::vector<Now> now;
  std::vector<std::uint32_t> order;   // movers by track, ascending along it
  std::vector<std::uint32_t> begins;  // by track: index of its first mover in `order`; one more entry at the end
  std::vector<std::uint32_t> index;   // by mover: its index in `order`
  std::vector<std::uint32_t> heads;   // by node: index of its first presence
  std::vector<Presence> presences;
  std::uint32_t presence_count = 0;
  double off = 0;  // [mm] largest displacement of any mover (Rider::off)
  std::vector<std::uint32_t> stack;
};

// The relation of a mover to another one at a node.
struct Meeting {
  std::uint32_t other = kNobody;
  double apart = 0;              // [mm] own position minus the other's of the same point
  double place = 0;              // [mm] of the other from this one, now
  bool ahead = false;            // the other is farther ahead
  double off = 0;                // [mm] largest displacements of both, added
  const Passage* its = nullptr;  // the other's passage through the node
  double gap = 0;                // [mm] required distance; 0: their order along the route ensures it
  // [mm] required distance once the rear one cannot stop before the node; 0: no more than before
  double split = 0;
};

class RightOfWay {
 public:
  RightOfWay(Scene& scene, const Network& network, std::span<const Rider> riders, double period_s) noexcept
      : s_(scene), network_(network), riders_(riders), period_s_(period_s) {}

  const Network& network() const noexcept { return network_; }
  const Rider& rider(std::uint32_t i) const noexcept { return riders_[i]; }
  const Now& now(std::uint32_t i) const noexcept { return s_.now[i]; }
  double period_s() const noexcept { return period_s_; }

  // Starts a cycle: all movers are assumed to brake; finds their order, their leaders and the nodes where they are
  // active.
  void Begin() noexcept;
  // Returns true if this step keeps the invariant against all movers.
  bool MayTake(std::uint32_t i, const KinematicState& next, const Braking& braking) const noexcept;
  // Returns a mover that would come too near to this one if all braked from now on; kNobody if there is none.
  std::uint32_t TooNear(std::uint32_t i) const noexcept;
  // Returns true if it may be active within `zone` [mm] of nodes: all movers that this newly involves are far enough
  // away.
  bool MayWiden(std::uint32_t i, double zone) const noexcept;
  // Returns true if a mover with this step is active at a node. `off` [mm]: displacements of it and the other one,
  // added.
  static bool IsActive(double zone, double off, const KinematicState& next, const Braking& braking, const Passage& p) {
    const double lowest = std::min(next.position, braking.lowest), highest = std::max(next.position, braking.highest);
    if (highest < p.offset) return p.offset - highest < std::max(zone, p.range_before) + off;
    if (lowest > p.offset) return lowest - p.offset < std::max(zone, p.range_behind) + off;
    return true;
  }
  // Returns true if the other mover is active, with the step assumed for it.
  bool IsActive(const Meeting& m) const noexcept {
    const Now& its = s_.now[m.other];
    return IsActive(riders_[m.other].zone, m.off, its.next, its.braking, *m.its);
  }
  // Makes `next` its step, and `braking`, with this share, its braking from there.
  void Take(std::uint32_t i, const KinematicState& next, const Braking& braking, std::size_t share) noexcept;

  // Returns the next mover in this direction, on the track or the rest of the route; kNobody if there is none near
  // enough to matter. `offset` [mm]: own position minus the leader's of the same point.
  std::uint32_t FindLeader(std::uint32_t i, int direction, double& offset) const noexcept;
  double GapTo(std::uint32_t i, std::uint32_t leader, int direction) const noexcept;

  // Calls look(k, offset) for each mover k with this one next ahead on its route; offset [mm]: k's position minus this
  // one's of the same point.
  template <typename Look>
  void Followers(std::uint32_t i, const Look& look) const {
    for (std::uint32_t k = 0; k < riders_.size(); ++k) {
      const Rider& other = riders_[k];
      if (!other.on || k == i) continue;
      std::uint32_t its_leader = s_.now[k].leader;
      double offset = s_.now[k].leader_offset;
      // A mover that moves back now still has its route ahead; its leader, found in its direction, is not the next
      // there.
      if (other.direction < 0) its_leader = other.route.count > 1 ? FindLeader(k, 1, offset) : kNobody;
      if (its_leader == i) look(k, offset);
    }
  }

  // Calls `look` for the passages through nodes on its route up to the position `reach`, on the tracks behind it, and
  // beyond the known route within its zone: there it may meet movers whose tracks are not on its route.
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

  // Calls `look` for the movers near a node that this mover has to keep apart from if both are active there. `counts`
  // receives a meeting without its distances, which are costly, and returns false if it does not matter.
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
  // Calls `look` for the nodes within `way` [mm] beyond the end of a track at `offset`, or before its start, nearest
  // first.
  template <typename Look>
  void Beyond(std::uint32_t track, double offset, double way, bool forward, const Look& look) const {
    struct Reached {
      std::uint32_t track;
      double way;  // [mm] to its far end
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
  // Return true if the other mover stays at least `required` [mm] ahead of, or behind, a braking if it brakes as well,
  // both with the dynamics that bends allow and with its maximum dynamics.
  bool HoldsAhead(const Braking& of_behind, std::uint32_t ahead, double apart, double required) const noexcept;
  bool HoldsBehind(std::uint32_t behind, const Braking& of_ahead, double apart, double required) const noexcept;
  // Returns true if both movers stay `required` [mm] apart if both brake.
  bool Keeps(const Braking& own, const Meeting& m, double required) const noexcept;
  void EnterNodes(std::uint32_t i, const KinematicState& next, const Braking& braking) noexcept;
  // Returns true if the other's track is on this one's route, where positions of both differ by `apart`.
  bool IsOnRoute(const Rider& r, const Rider& other, double apart) const noexcept;

  Scene& s_;
  const Network& network_;
  std::span<const Rider> riders_;
  double period_s_;
};

}  // namespace takt::planar
