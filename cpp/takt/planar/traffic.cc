#include "takt/planar/traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/describe.h"
#include "takt/planar/going_along.h"

namespace takt::planar {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// mm: rounding. What is nearer than the gap by less than this is not.
constexpr double kTolerance = 1e-7;
// mm: so far before the place where it would get active at a node a mover stops.
constexpr double kBeforeNode = 1e-3;
// Of the dynamics that follower and leader both have, what following plans with: the rest is for the delay of a cycle.
constexpr double kReserve = 0.95;
// s, in which a mover takes back what it is too fast, and cycles in which it can at the least.
constexpr double kCalm = 0.1;
constexpr double kQuick = 5;
// Cycles in which a mover that had to brake against its wish speeds up no more than it did: it would soon have to
// again.
constexpr std::uint32_t kCalmCycles = 20;
// Shares of a change in what following asks for that count in one cycle.
constexpr double kEaseUp = 0.15;
constexpr double kEaseDown = 0.4;
// Standing is slower than this, mm/s, and nearer than this to where it has to stop, mm.
constexpr double kStands = 0.1;
constexpr double kAtLimit = 0.01;
// A geared mover is in step where it is so near to where it should be, mm, and as fast, mm/s.
constexpr double kInStep = 1e-6;
constexpr double kInStepSpeed = 1e-3;
// mm: further than anything is planned on a loop.
constexpr double kFarAhead = 1e5;
// Share of the speed with which two movers get nearer that could still be stopped.
constexpr double kClosing = 0.5;
// Nodes at which a mover can be active at once: those of its route, where it begins, and those it has passed.
constexpr std::size_t kPresences = kRouteTracks + 1 + kPassed;

bool Rests(const KinematicState& x) {
  return x.velocity == 0 && x.acceleration == 0;
}

// It goes back before it rests.
bool TurnsRound(const Braking& b) {
  const double start = b.pieces[0].position;
  const bool up = b.lowest == start && b.highest == b.rest, down = b.highest == start && b.lowest == b.rest;
  return b.lowest < b.highest && !up && !down;
}

// Where it has to be able to stop: so far from here, and how fast that place goes away.
struct Limit {
  double room = kInfinite;
  double rate = 0;
  Brakes brakes;
  std::uint32_t by = kNobody;
};

// What following plans with: what both can do, less a reserve.
Brakes Common(const Brakes& a, const Brakes& b) {
  return {kReserve * std::min(a.deceleration, b.deceleration), kReserve * std::min(a.jerk, b.jerk)};
}

// How the way to rest grows with the speed, s.
double SlopeOfWayToRest(double speed, const Brakes& b) {
  const double ramp = b.deceleration / b.jerk;
  return speed >= b.deceleration * ramp ? speed / b.deceleration + 0.5 * ramp : 1.5 * std::sqrt(speed / b.jerk);
}

// The acceleration with which a mover follows a limit. With so much room R left it may have the speed v(R) from which
// it just gets to rest in it. Held at that speed its stop keeps its distance to the limit; so a chain of movers hands
// on the stop of the first, and each settles on the speed of the one before it without swinging.
double Follow(const Limit& limit, double speed, double period_s) {
  const Brakes& brakes = limit.brakes;
  const double allowed = SpeedForWay(limit.room, brakes);
  const double slope = SlopeOfWayToRest(allowed, brakes);
  const double quick = kQuick * period_s;
  const double calm = std::clamp(slope, quick, kCalm);
  const double acceleration = (limit.rate - speed) / std::max(slope, quick) + (allowed - speed) / calm;
  // What it speeds up with has to be taken back first, for which it needs more way: speed / jerk of it.
  return acceleration > 0 ? acceleration / (1 + speed / (brakes.jerk * std::max(slope, quick) * calm)) : acceleration;
}

}  // namespace

class Traffic::Step_ {
 public:
  Step_(Traffic& traffic, const Cycle& cycle, trajectory::Planner& planner, const Network& network,
        std::span<Rider> riders)
      : t_(traffic), cycle_(cycle), planner_(planner), network_(network), riders_(riders) {}

  void Run() {
    t_.refused_ = 0;
    t_.presence_count_ = 0;
    std::ranges::fill(t_.heads_, kNobody);
    for (std::uint32_t i = 0; i < riders_.size(); ++i) TakeToBrake(i);
    Sort();
    for (std::uint32_t i = 0; i < riders_.size(); ++i) {
      Rider& r = riders_[i];
      if (!r.on) continue;
      // A master may turn round on the way.
      if (r.aim == Aim::kFollow && r.at.velocity != 0) r.direction = r.at.velocity < 0 ? -1 : 1;
      t_.now_[i].leader = FindLeader(i, riders_[i].direction, t_.now_[i].leader_offset);
      EnterNodes(i, t_.now_[i].next, t_.now_[i].braking);
    }
    // Those in front first: who follows sees what the one before it does in this cycle.
    for (std::uint32_t i = 0; i < riders_.size(); ++i) SettleInOrder(i);
    for (std::uint32_t i = 0; i < riders_.size(); ++i) {
      if (riders_[i].on && riders_[i].aim == Aim::kFollow) NoteStep(i);
    }
    for (std::uint32_t i = 0; i < riders_.size(); ++i) {
      if (riders_[i].on) GoOn(i);
    }
  }

 private:
  double period() const { return cycle_.period_s; }

  void TakeToBrake(std::uint32_t i) {
    Rider& r = riders_[i];
    Now& now = t_.now_[i];
    now = {};
    if (!r.on) return;
    if (Rests(r.at)) {
      now.next = r.at;
      now.braking.rest = now.braking.lowest = now.braking.highest = now.rest_before = r.at.position;
      return;
    }
    const Braking braking = Brake(r.at, r.brakes);
    now.next = braking.At(period());
    now.braking = Brake(now.next, r.brakes);
    now.rest_before = braking.rest;
  }

  void Sort() {
    std::ranges::fill(t_.begins_, 0U);
    for (const Rider& r : riders_) {
      if (r.on) ++t_.begins_[r.route.first() + 1];
    }
    for (std::size_t i = 1; i < t_.begins_.size(); ++i) t_.begins_[i] += t_.begins_[i - 1];
    // Filled from their begins on, which are put back behind that.
    for (std::uint32_t i = 0; i < riders_.size(); ++i) {
      if (riders_[i].on) t_.order_[t_.begins_[riders_[i].route.first()]++] = i;
    }
    for (std::size_t i = t_.begins_.size() - 1; i > 0; --i) t_.begins_[i] = t_.begins_[i - 1];
    t_.begins_[0] = 0;
    for (std::size_t track = 0; track + 1 < t_.begins_.size(); ++track) {
      const auto first = t_.order_.begin() + t_.begins_[track], last = t_.order_.begin() + t_.begins_[track + 1];
      std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = riders_[a].at.position, at_b = riders_[b].at.position;
        return at_a < at_b || (at_a == at_b && a < b);
      });
      for (auto k = first; k != last; ++k) t_.index_[*k] = static_cast<std::uint32_t>(k - t_.order_.begin());
    }
  }

  // Who is next in this direction, on the track or the rest of the route.
  std::uint32_t FindLeader(std::uint32_t i, int direction, double& offset) const {
    const Rider& r = riders_[i];
    const std::uint32_t track = r.route.first();
    const std::uint32_t first = t_.begins_[track], last = t_.begins_[track + 1], index = t_.index_[i];
    offset = 0;
    if (direction > 0 && index + 1 < last) return t_.order_[index + 1];
    if (direction < 0 && index > first) return t_.order_[index - 1];
    if (network_[track].closed) {
      const std::uint32_t round = t_.order_[direction > 0 ? first : last - 1];
      offset = direction > 0 ? network_[track].length : -network_[track].length;
      return round == i ? kNobody : round;
    }
    if (direction < 0) return kNobody;
    const double reach = t_.now_[i].braking.highest + r.gap + 2 * WayToRest(r.pace.limits.velocity, r.pace.brakes());
    for (std::uint32_t k = 1; k < r.route.count; ++k) {
      offset += network_[r.route.tracks[k - 1]].length;
      if (offset > reach) break;
      const std::uint32_t next = r.route.tracks[k];
      if (t_.begins_[next] == t_.begins_[next + 1]) continue;
      const std::uint32_t found = t_.order_[t_.begins_[next]];
      return found == i ? kNobody : found;
    }
    return kNobody;
  }

  // Calls `look` for the nodes on the way: number, where it is on the mover's first track, and the ranges before and
  // behind it.
  template <typename Look>
  void AlongNodes(const Rider& r, double reach, const Look& look) const {
    const Road& here = network_[r.route.first()];
    if (here.closed) return;
    double offset = 0;
    const double range_before = r.passed_count > 0 ? network_[r.passed[0]].range_at_end : 0;
    if (here.start_node != kNoNode) look(here.start_node, 0.0, range_before, here.range_at_start);
    for (std::uint32_t k = 0; k < r.route.count; ++k) {
      const Road& road = network_[r.route.tracks[k]];
      offset += road.length;
      const double behind = k + 1 < r.route.count ? network_[r.route.tracks[k + 1]].range_at_start : 0;
      if (road.end_node != kNoNode) look(road.end_node, offset, road.range_at_end, behind);
      if (offset > reach) break;
    }
    offset = 0;
    for (std::uint32_t k = 0; k < r.passed_count; ++k) {
      const Road& road = network_[r.passed[k]];
      offset -= road.length;
      const double before = k + 1 < r.passed_count ? network_[r.passed[k + 1]].range_at_end : 0;
      if (road.start_node != kNoNode) look(road.start_node, offset, before, road.range_at_start);
    }
  }

  static bool IsActive(const Rider& r, const KinematicState& next, const Braking& braking, double offset,
                       double range_before, double range_behind) {
    const double lowest = std::min(next.position, braking.lowest), highest = std::max(next.position, braking.highest);
    if (highest < offset) return offset - highest < std::max(r.gap, range_before);
    if (lowest > offset) return lowest - offset < std::max(r.gap, range_behind);
    return true;
  }

  const Presence* PresenceOf(std::uint32_t mover, std::uint32_t node) const {
    for (std::uint32_t k = t_.heads_[node]; k != kNobody; k = t_.presences_[k].next) {
      if (t_.presences_[k].mover == mover) return &t_.presences_[k];
    }
    return nullptr;
  }

  void EnterNodes(std::uint32_t i, const KinematicState& next, const Braking& braking) {
    const Rider& r = riders_[i];
    AlongNodes(r, braking.highest + r.gap, [&](std::uint32_t node, double offset, double before, double behind) {
      if (!IsActive(r, next, braking, offset, before, behind) || PresenceOf(i, node)) return;
      t_.presences_[t_.presence_count_] = {i, offset, t_.heads_[node]};
      t_.heads_[node] = t_.presence_count_++;
    });
  }

  // The other is on this one's way as far as the places of both differ by `apart`.
  bool IsOnRoute(const Rider& r, const Rider& other, double apart) const {
    double begin = 0;
    for (const std::uint32_t track : r.route.all()) {
      if (begin > apart + kSame) return false;
      if (track == other.route.first() && begin >= apart - kSame) return true;
      begin += network_[track].length;
    }
    return false;
  }

  // Calls `look` for those at a node with whom this mover has to do there: the presence, and the offset from their
  // places to own ones.
  template <typename Look>
  void OthersAt(std::uint32_t i, std::uint32_t node, double offset, const Look& look) const {
    for (std::uint32_t k = t_.heads_[node]; k != kNobody; k = t_.presences_[k].next) {
      const Presence& other = t_.presences_[k];
      if (other.mover == i) continue;
      const double apart = offset - other.offset;
      // Their order along the way sees to it.
      const Rider &r = riders_[i], &o = riders_[other.mover];
      if (!IsOnRoute(r, o, apart) && !IsOnRoute(o, r, -apart)) look(other.mover, apart);
    }
  }

  // How far apart two have to stay: what is less already must not get less.
  static double Required(double gap, double apart_now) { return std::min(gap - kTolerance, apart_now); }

  double GapTo(std::uint32_t i, std::uint32_t leader, int direction) const {
    const Rider& other = riders_[leader];
    const bool faces = other.at.velocity * direction < 0;
    return faces ? std::max(riders_[i].gap, other.gap) : riders_[i].gap;
  }

  static bool Holds(const Braking& of_behind, const Braking& of_ahead, double apart, double required) {
    // Mostly there is room enough.
    if (of_ahead.lowest + apart - of_behind.highest >= required) return true;
    return LeastDistance(of_behind, of_ahead, apart) >= required;
  }

  // Whether this step keeps the invariant with everyone.
  bool MayTake(std::uint32_t i, const KinematicState& next, const Braking& braking) const {
    const Rider& r = riders_[i];
    const Now& now = t_.now_[i];
    // Who turns round goes both ways.
    const bool turns = TurnsRound(braking) || TurnsRound(now.braking);
    const bool forward = turns || braking.highest > now.braking.highest || next.position > now.next.position;
    const bool back = turns || braking.lowest < now.braking.lowest || next.position < now.next.position;
    const bool closed = network_[r.route.first()].closed;
    if (back && !closed && std::min(braking.lowest, next.position) < std::min(0.0, now.braking.lowest) - kTolerance) {
      return false;
    }
    if (forward && !closed) {
      double end = 0;
      for (const std::uint32_t track : r.route.all()) end += network_[track].length;
      if (braking.highest > std::max(end, now.braking.highest) + kTolerance) return false;
    }
    if (forward) {
      double apart = now.leader_offset;
      const std::uint32_t leader = r.direction > 0 ? now.leader : FindLeader(i, 1, apart);
      if (leader != kNobody) {
        const double required = Required(GapTo(i, leader, 1), riders_[leader].at.position + apart - r.at.position);
        if (!Holds(braking, t_.now_[leader].braking, apart, required)) return false;
      }
    }
    if (back) {
      double apart = now.leader_offset;
      const std::uint32_t leader = r.direction < 0 ? now.leader : FindLeader(i, -1, apart);
      if (leader != kNobody) {
        const double required = Required(GapTo(i, leader, -1), r.at.position - riders_[leader].at.position - apart);
        if (!Holds(t_.now_[leader].braking, braking, -apart, required)) return false;
      }
      for (std::uint32_t k = 0; k < riders_.size(); ++k) {
        const Rider& other = riders_[k];
        if (!other.on || k == i) continue;
        std::uint32_t its_leader = t_.now_[k].leader;
        double offset = t_.now_[k].leader_offset;
        // One that goes back now still has its way ahead, and who is on it there is nobody's neighbour.
        if (other.direction < 0) its_leader = other.route.count > 1 ? FindLeader(k, 1, offset) : kNobody;
        if (its_leader != i) continue;
        const double required = Required(std::max(other.gap, r.gap), r.at.position + offset - other.at.position);
        if (!Holds(t_.now_[k].braking, braking, offset, required)) return false;
      }
    }
    bool may = true;
    AlongNodes(r, braking.highest + r.gap, [&](std::uint32_t node, double offset, double before, double behind) {
      if (!may || !IsActive(r, next, braking, offset, before, behind)) return;
      const bool anew = !PresenceOf(i, node);
      OthersAt(i, node, offset, [&](std::uint32_t other, double apart) {
        const double distance = riders_[other].at.position + apart - r.at.position;
        const bool ahead = distance > 0 || (distance == 0 && other > i);
        if (!may || !(anew || (ahead ? forward : back))) return;
        const double gap = std::max(r.gap, riders_[other].gap);
        // Who was not active has kept away by other means, and has to have all of it now.
        const double required = anew ? gap - kTolerance : Required(gap, std::abs(distance));
        const Braking& theirs = t_.now_[other].braking;
        may = ahead ? Holds(braking, theirs, apart, required) : Holds(theirs, braking, -apart, required);
      });
    });
    return may;
  }

  void SettleInOrder(std::uint32_t i) {
    std::size_t depth = 0;
    const auto enter = [&](std::uint32_t k) {
      if (k == kNobody || !riders_[k].on || t_.now_[k].entered) return false;
      t_.now_[k].entered = true;
      t_.stack_[depth++] = k;
      return true;
    };
    enter(i);
    while (depth > 0) {
      const std::uint32_t k = t_.stack_[depth - 1];
      if (enter(t_.now_[k].leader) || enter(MasterBefore(k))) continue;
      --depth;
      Settle(k);
      t_.now_[k].settled = true;
    }
  }

  // The master that has to be settled before this one. One that has this one before it has to see what that does.
  std::uint32_t MasterBefore(std::uint32_t i) const {
    const Rider& r = riders_[i];
    if (r.aim != Aim::kFollow || r.gear.master == kNobody) return kNobody;
    return t_.now_[r.gear.master].leader == i ? kNobody : r.gear.master;
  }

  // Where a master will be at the end of the cycle, as far as is known, over all tracks.
  KinematicState Foresee(std::uint32_t master) const {
    const Rider& m = riders_[master];
    KinematicState at = t_.now_[master].next;
    if (!t_.now_[master].settled) {
      const double t = period();
      at = {m.at.position + t * (m.at.velocity + 0.5 * t * m.at.acceleration), m.at.velocity + t * m.at.acceleration,
            m.at.acceleration};
      if (m.aim == Aim::kTarget && m.planned) {
        const KinematicState way = m.plan.At(m.plan_time + t);
        at = {m.plan_from + m.direction * way.position, m.direction * way.velocity, m.direction * way.acceleration};
      }
    }
    at.position += m.origin;
    return at;
  }

  // Where it is to be at the end of the cycle, on its first track.
  KinematicState DemandOn(Rider& r) const {
    if (r.gear.master != kNobody) r.demand = Foresee(r.gear.master);
    KinematicState demand = r.demand;
    demand.position += r.gear.offset - r.origin;
    return demand;
  }

  // Of its route in its direction, on the last track.
  double EndOf(const Rider& r) const {
    double end = network_[r.route.last()].length;
    for (const std::uint32_t track : r.route.all()) end -= r.direction < 0 ? network_[track].length : 0;
    return end;
  }

  // What a geared mover wishes to do; where its way ends it goes to that end instead.
  KinematicState WishAlong(Rider& r, const KinematicState& demand, bool& exact) {
    KinematicState wish = GoAlong(planner_, r, demand, period(), exact);
    const bool ahead = r.direction * wish.velocity > 0 && r.direction * r.at.velocity >= 0;
    if (!exact && ahead && CurvesAhead(network_, r)) {
      // No faster than to the end of its way.
      r.target = network_[r.route.last()].closed ? r.at.position + r.direction * kFarAhead : EndOf(r);
      const KinematicState alone = Wish(r);
      if (r.direction * (wish.velocity - alone.velocity) > 0) return alone;
    }
    r.planned = false;
    const int out = RunsOut(network_, r, wish);
    if (out == 0) return wish;
    exact = false;
    r.aim = Aim::kTarget;
    r.gear.end = GearEnd::kWay;
    r.gear.in_step = false;
    r.direction = out < 0 ? -1 : 1;
    if (out < 0) r.route.count = 1;
    std::fill(r.route.tracks.begin() + r.route.count, r.route.tracks.end(), 0U);
    r.target = out < 0 ? 0 : network_[r.route.last()].length;
    r.planned = r.there = false;
    return Wish(r);
  }

  // The acceleration with which a mover comes up behind something that goes on by itself: so much room is left to where
  // it is to be, which goes at this speed and acceleration. Both could still stop, and it would not have passed.
  double ComeUp(const Rider& r, double room, const KinematicState& there, const Brakes& brakes, double share) const {
    const double speed = r.direction * r.at.velocity, its_speed = r.direction * there.velocity;
    const double slope = std::max(SlopeOfWayToRest(std::max({0.0, speed, its_speed}), brakes), kQuick * period());
    const double closing = share / slope, faster = speed - its_speed;
    return r.direction * there.acceleration - closing * faster + (closing * room - faster) / std::min(slope, kCalm);
  }

  // Behind the mover ahead: down to the gap, without a reserve for swinging, so that in the end both go as one.
  double CloseUp(std::uint32_t i, const Limit& limit) const {
    const Rider& r = riders_[i];
    if (limit.by == kNobody || limit.by != t_.now_[i].leader) return -kInfinite;
    const Rider& before = riders_[limit.by];
    if (r.brakes.deceleration < before.brakes.deceleration || r.brakes.jerk < before.brakes.jerk) return -kInfinite;
    const double room = r.direction * (before.at.position + t_.now_[i].leader_offset - r.at.position) - r.gap;
    if (room < 0 || r.direction * before.at.velocity < 0) return -kInfinite;
    return ComeUp(r, room, {0, before.at.velocity, t_.now_[limit.by].next.acceleration}, r.brakes, kClosing);
  }

  // It gets into step from behind and may not come back, so it must not pass its master's place.
  bool ComesFromBehind(const Rider& r, const KinematicState& demand) const {
    return !r.gear.was_in_step && r.gear.sense == r.direction && RoomTo(r, demand) > 0;
  }
  double RoomTo(const Rider& r, const KinematicState& demand) const {
    return r.direction * (demand.position - period() * demand.velocity - r.at.position);
  }
  // It would pass it if both braked from here on as this one can.
  static bool Passes(const Rider& r, const KinematicState& next, const KinematicState& demand) {
    const Braking own = Brake(next, r.pace.brakes()), its = Brake(demand, r.pace.brakes());
    return r.direction > 0 ? LeastDistance(own, its, 0) < -kTolerance : LeastDistance(its, own, 0) < -kTolerance;
  }

  // How far from its master's place it is at the end of the cycle.
  void NoteStep(std::uint32_t i) {
    Rider& r = riders_[i];
    const KinematicState demand = DemandOn(r);
    const KinematicState& next = t_.now_[i].next;
    r.gear.error = next.position - demand.position;
    const bool exact = std::abs(r.gear.error) <= kInStep && std::abs(next.velocity - demand.velocity) <= kInStepSpeed;
    r.gear.in_step = exact || std::abs(r.gear.error) <= r.gear.tolerance;
    r.gear.was_in_step |= r.gear.in_step;
  }

  // A plan from this state on, on the first track. At rest the direction is that of the target.
  void Plan(Rider& r, double place, double speed, double acceleration) {
    double end = r.target;
    for (std::uint32_t k = 0; k + 1 < r.route.count; ++k) end += network_[r.route.tracks[k]].length;
    if (speed == 0 && acceleration == 0) r.direction = end < place ? -1 : 1;
    const double way = r.direction * (end - place);
    const Start start{&r.route, place, r.direction, speed, acceleration};
    const bool found = PlanWay(planner_, network_, start, way, r.pace, r.plan, r.plan_ends);
    r.plan_from = place;
    r.plan_time = 0;
    // A geared mover that only brakes for a curve looks again in each cycle.
    r.planned = found || r.aim != Aim::kFollow;
  }

  // Where its own plan has it at the end of the cycle.
  KinematicState Wish(Rider& r) {
    if (!r.planned) Plan(r, r.at.position, r.direction * r.at.velocity, r.direction * r.at.acceleration);
    double time = r.plan_time + period();
    for (int i = 0; i < 3 && time >= r.plan.duration() && !r.plan_ends; ++i) {
      const KinematicState end = r.plan.end();
      time -= r.plan.duration();
      Plan(r, r.plan_from + r.direction * end.position, end.velocity, end.acceleration);
    }
    r.plan_time = time;
    const KinematicState way = r.plan.At(time);
    return {r.plan_from + r.direction * way.position, r.direction * way.velocity, r.direction * way.acceleration};
  }

  // What holds this mover back, in its direction: the one before it, and those at nodes.
  void LimitBy(std::uint32_t i, double speed, Limit& limit, double& least) const {
    const Rider& r = riders_[i];
    const Now& now = t_.now_[i];
    const int direction = r.direction;
    // Where its own plan ends.
    const bool plans = r.aim == Aim::kTarget && r.planned && r.plan_ends;
    const double end = r.plan_from + direction * r.plan.end().position;
    const auto take = [&](const Limit& one) {
      // Before one that stands it comes to rest anyhow.
      const bool stands = one.by != kNobody && Rests(riders_[one.by].at) && Rests(t_.now_[one.by].next);
      if (plans && stands && direction * (end - r.at.position) <= one.room + kTolerance) return;
      const double acceleration = Follow(one, speed, period());
      if (acceleration < least) {
        least = acceleration;
        limit = one;
      }
    };
    // One that speeds up could stop further on than one of its speed; until it is there the way is not free. Behind one
    // that is as fast the gap is enough, and no mover gets nearer that is faster.
    const auto as_fast = [&](Limit one) {
      const Rider& before = riders_[one.by];
      const double its_speed = direction * before.at.velocity;
      if (its_speed <= 0 || direction * before.at.acceleration <= 0) return;
      one.room += direction * (before.at.position - t_.now_[one.by].rest_before) + WayToRest(its_speed, one.brakes);
      one.rate = its_speed + SlopeOfWayToRest(its_speed, one.brakes) * direction * before.at.acceleration;
      take(one);
    };
    const auto behind = [&](std::uint32_t other, double apart, double gap) {
      const Rider& before = riders_[other];
      const Now& its = t_.now_[other];
      const double stop = its.rest_before + apart;
      Limit one;
      one.room = direction * (stop - r.at.position) - gap;
      // By its speed and acceleration; its jerk moves the place to and fro, and with it all that follow.
      const double its_speed = direction * before.at.velocity;
      one.rate = its_speed >= 0 ? std::max(0.0, its_speed + SlopeOfWayToRest(its_speed, before.brakes) * direction *
                                                                before.at.acceleration)
                                : direction * (its.braking.rest - its.rest_before) / period();
      one.brakes = Common(r.pace.brakes(), before.brakes);
      one.by = other;
      return one;
    };
    if (now.leader != kNobody) {
      const Limit one = behind(now.leader, now.leader_offset, GapTo(i, now.leader, direction));
      take(one);
      as_fast(one);
    }
    const double reach = 2 * WayToRest(r.pace.limits.velocity, r.pace.brakes()) + r.gap;
    AlongNodes(r, r.at.position + reach,
               [&](std::uint32_t node, double offset, double range_before, double range_behind) {
                 const double way = direction * (offset - r.at.position);
                 if (way > reach + std::max(range_before, range_behind)) return;
                 const bool active = PresenceOf(i, node) != nullptr;
                 const double zone = std::max(r.gap, direction > 0 ? range_before : range_behind);
                 if (!active && way < 0) return;  // it goes away from it
                 OthersAt(i, node, offset, [&](std::uint32_t other, double apart) {
                   const double gap = std::max(r.gap, riders_[other].gap);
                   const double distance = direction * (riders_[other].at.position + apart - r.at.position);
                   Limit one = behind(other, apart, gap);
                   if (distance < 0) {
                     // It comes behind; it must have room to stop there.
                     const double rest = direction * (r.at.position - t_.now_[other].rest_before - apart);
                     if (active || rest >= gap) return;
                     one.room = -kInfinite;
                   }
                   if (!active && way - zone - kBeforeNode > one.room) {
                     one.room = way - zone - kBeforeNode;
                     one.rate = 0;
                     one.brakes = Common(r.pace.brakes(), r.brakes);
                   }
                   take(one);
                   if (active && distance > 0) as_fast(one);
                 });
               });
  }

  // It goes just as the one before it, or falls behind: the gap needs no more than the invariant.
  bool GoesAlong(std::uint32_t i, const KinematicState& wish, const Limit& limit) const {
    const Rider& r = riders_[i];
    if (limit.by == kNobody || limit.by != t_.now_[i].leader) return false;
    const Rider& before = riders_[limit.by];
    const KinematicState& other = t_.now_[limit.by].next;
    return r.brakes.deceleration >= before.brakes.deceleration && r.brakes.jerk >= before.brakes.jerk &&
           r.direction * (wish.velocity - other.velocity) <= 1e-9 &&
           r.direction * (wish.acceleration - other.acceleration) <= 1e-6;
  }

  bool Take(std::uint32_t i, const KinematicState& next) {
    Now& now = t_.now_[i];
    const Braking braking = Brake(next, riders_[i].brakes);
    const bool curves = riders_[i].aim != Aim::kFollow || KeepsToCurves(network_, riders_[i], next, braking);
    if (!curves || !MayTake(i, next, braking)) {
      riders_[i].calm_cycles = kCalmCycles;
      t_.refused_ += std::abs(riders_[i].at.velocity) > kStands ? 1 : 0;
      return false;
    }
    now.next = next;
    now.braking = braking;
    EnterNodes(i, next, braking);
    return true;
  }

  void WaitFor(Rider& r, Waits why, std::uint32_t whom) {
    if (r.waits == why && r.waits_for == whom) return;
    if (r.waits == Waits::kNot || why == Waits::kNot) r.waits_since = cycle_.count;
    r.waits = why;
    r.waits_for = whom;
  }

  void Settle(std::uint32_t i) {
    Rider& r = riders_[i];
    Now& now = t_.now_[i];
    if (r.aim == Aim::kRest || (r.aim == Aim::kTarget && r.there)) {
      r.planned = false;
      return WaitFor(r, Waits::kNot, kNobody);
    }
    // Who stands and waits has nothing to plan until there is room.
    if (r.aim == Aim::kTarget && r.waits == Waits::kMover && !r.planned && Rests(r.at)) {
      Limit limit;
      double most = kInfinite;
      LimitBy(i, 0, limit, most);
      if (limit.room < kAtLimit) return WaitFor(r, Waits::kMover, limit.by);
    }
    bool exact = false;  // a geared mover is where it should be
    KinematicState demand;
    if (r.aim == Aim::kFollow) demand = DemandOn(r);
    // Who is held back stays so until there is room: else it would swing between both.
    const bool was_free = r.aim == Aim::kFollow || r.planned || Rests(r.at);
    const std::int8_t went = r.direction;
    const KinematicState wish = r.aim == Aim::kTarget ? Wish(r) : WishAlong(r, demand, exact);
    const bool follows = r.aim == Aim::kFollow;
    if (follows && Rests(r.at) && wish.velocity * r.direction < 0) r.direction = wish.velocity < 0 ? -1 : 1;
    // Who turns has somebody else before it now; a new way may have, too.
    const bool anew = r.direction != went || (r.aim == Aim::kTarget && now.leader == kNobody);
    if (anew) now.leader = FindLeader(i, r.direction, now.leader_offset);
    const int direction = r.direction;
    const double speed = direction * r.at.velocity;
    const double before = direction * r.at.acceleration;
    Limit limit;
    double most = kInfinite;
    LimitBy(i, speed, limit, most);
    // What those before it do in single cycles is not handed on, or it would grow along a chain of movers.
    const double wanted = std::clamp(most, -2 * r.pace.limits.deceleration, 2 * r.pace.limits.acceleration);
    r.eased += (wanted < r.eased ? kEaseDown : kEaseUp) * (wanted - r.eased);
    most = r.eased;
    if (r.calm_cycles > 0) {
      --r.calm_cycles;
      most = std::min(most, std::max(0.0, before));
    }
    const bool comes = follows && !exact && ComesFromBehind(r, demand);
    if (follows) {
      most = std::max(most, CloseUp(i, limit));
      // To a master that stands it comes to rest anyhow.
      if (Rests(demand) && direction * (demand.position - r.at.position) <= limit.room + kTolerance) most = kInfinite;
      if (comes) most = std::min(most, ComeUp(r, RoomTo(r, demand), demand, r.pace.brakes(), kClosing));
    }
    // With constant jerk neither faster than wished at the end of the cycle, nor with more acceleration.
    const double mean = (direction * wish.velocity - speed) / period();
    const double as_fast = 2 * mean - before;
    // A wish that is small may begin and end without acceleration; on the way to the master that would be no way at
    // all.
    const double least_end = direction * wish.acceleration;
    const double fastest = r.pace.limits.velocity - direction * wish.velocity;
    const double end =
        follows ? std::max(least_end, std::sqrt(r.pace.limits.jerk * std::max(0.0, fastest))) : least_end;
    const double wished = std::min(end, as_fast);
    const bool limited = mean > most + 1e-9 && !(was_free && GoesAlong(i, wish, limit));
    if (!limited && !(comes && Passes(r, wish, demand)) && Take(i, wish)) {
      if (r.aim == Aim::kTarget && r.plan_ends && r.plan_time >= r.plan.duration()) r.there = true;
      return WaitFor(r, Waits::kNot, kNobody);
    }
    r.planned = false;
    const bool stands = std::abs(r.at.velocity) < kStands;
    // Slower than it wishes, as fast as it may behind the other.
    const double change = r.pace.limits.jerk * period();
    double next = std::clamp(std::min(most, wished), before - change, before + change);
    // What is braked with must be gone when it stands, or it would run back.
    const double gone = std::sqrt(1.8 * r.pace.limits.jerk * std::max(0.0, speed));
    next = std::clamp(next, -std::min(gone, r.brakes.deceleration), r.pace.limits.acceleration);
    next = std::clamp(next, before - change, before + change);
    const double jerk = (next - before) / period();
    const trajectory::Piece piece{r.at.position, r.at.velocity, r.at.acceleration, direction * jerk};
    const KinematicState step = piece.At(period());
    const bool goes = direction * step.velocity > 0 && !(stands && limit.room < kAtLimit);
    if (goes && !(comes && Passes(r, step, demand)) && Take(i, step)) {
      return stands ? WaitFor(r, Waits::kMover, limit.by) : WaitFor(r, Waits::kNot, kNobody);
    }
    if (stands) WaitFor(r, limit.by != kNobody ? Waits::kMover : Waits::kRoute, limit.by);
  }

  // The end of the cycle: places are those on the track where the mover is now.
  void GoOn(std::uint32_t i) {
    Rider& r = riders_[i];
    r.at = t_.now_[i].next;
    if (std::abs(r.at.velocity) < 1e-9 && std::abs(r.at.acceleration) < 1e-6) r.at.velocity = r.at.acceleration = 0;
    const auto shift = [&r](double by) {
      r.at.position -= by;
      r.plan_from -= by;
      r.origin += by;
    };
    const Road& here = network_[r.route.first()];
    if (here.closed) {
      while (r.at.position >= here.length || r.at.position < 0) {
        const double by = r.at.position < 0 ? -here.length : here.length;
        shift(by);
        r.target -= by;
      }
      return;
    }
    while (r.route.count > 1 && r.at.position >= network_[r.route.first()].length) {
      shift(network_[r.route.first()].length);
      std::copy_backward(r.passed.begin(), r.passed.end() - 1, r.passed.end());
      r.passed[0] = r.route.first();
      r.passed_count = std::min<std::uint32_t>(r.passed_count + 1, kPassed);
      std::copy(r.route.tracks.begin() + 1, r.route.tracks.begin() + r.route.count, r.route.tracks.begin());
      r.route.tracks[--r.route.count] = 0;
    }
  }

  Traffic& t_;
  const Cycle& cycle_;
  trajectory::Planner& planner_;
  const Network& network_;
  std::span<Rider> riders_;
};

Traffic::Traffic(const TrafficSettings& settings)
    : now_(settings.movers),
      order_(settings.movers),
      begins_(settings.tracks + 1),
      index_(settings.movers),
      heads_(2 * settings.tracks),
      presences_(settings.movers * kPresences),
      stack_(settings.movers) {}

void Traffic::Step(const Cycle& cycle, trajectory::Planner& planner, const Network& network,
                   std::span<Rider> riders) noexcept {
  Step_(*this, cycle, planner, network, riders).Run();
}

std::span<const std::uint32_t> Traffic::On(std::uint32_t track) const noexcept {
  return {order_.data() + begins_[track], order_.data() + begins_[track + 1]};
}

bool IsDeadlocked(std::span<const Rider> riders, std::uint32_t mover) noexcept {
  std::uint32_t at = mover;
  for (std::size_t i = 0; i < riders.size(); ++i) {
    if (riders[at].waits != Waits::kMover || riders[at].waits_for == kNobody) return false;
    at = riders[at].waits_for;
    if (at == mover) return true;
  }
  return false;
}

void describe(Enumeration<Aim>& e) {
  e.about("What a mover on a track is about.");
  e.value(Aim::kRest, "rest", "Come to rest and stay.");
  e.value(Aim::kTarget, "target", "Go to a place on its route.");
  e.value(Aim::kFollow, "follow", "Go along with a master.");
}

void describe(Enumeration<Waits>& e) {
  e.about("Why a mover does not go on.");
  e.value(Waits::kNot, "not", "It does, or has nothing to do.");
  e.value(Waits::kMover, "mover", "Another mover is in its way.");
  e.value(Waits::kRoute, "route", "Its route ends here.");
}

void describe(Description<Brakes>& d) {
  d.about("How hard a mover brakes.");
  d.internal<&Brakes::deceleration>(unit::mm_s2, "Deceleration.");
  d.internal<&Brakes::jerk>(unit::mm_s3, "Jerk.");
}

void describe(Description<Pace>& d) {
  d.about("How fast a mover may go.");
  d.internal<&Pace::limits>("Along the way.");
  d.internal<&Pace::lateral>(unit::mm_s2, "Across it, in curves.");
}

void describe(Description<Rider>& d) {
  using R = Rider;
  d.about("A mover on a track.");
  d.internal<&R::on>("It is on a track.");
  d.internal<&R::at>("On the first track of the route.");
  d.internal<&R::route>("The tracks it goes along.");
  d.internal<&R::passed>("Those it has come from, the last one first.");
  d.internal<&R::passed_count>("So many.");
  d.internal<&R::direction>("Of its way.");
  d.internal<&R::aim>("What it is about.");
  d.internal<&R::target>(unit::mm, "On the last track of the route.");
  d.internal<&R::gear>("Whom it goes along with, and how.");
  d.internal<&R::demand>("Where that one is, over all tracks.");
  d.internal<&R::pace>("As commanded.");
  d.internal<&R::brakes>("Its greatest.");
  d.internal<&R::gap>(unit::mm, "To the mover before it.");
  d.internal<&R::planned>("It has a plan.");
  d.internal<&R::plan>("Along the way.");
  d.internal<&R::plan_from>(unit::mm, "Where that began.");
  d.internal<&R::plan_time>(unit::s, "Since that began.");
  d.internal<&R::plan_ends>("It goes all the way to the target.");
  d.internal<&R::there>("It rests at its target.");
  d.internal<&R::calm_cycles>("So long it does not speed up more, having had to brake.");
  d.internal<&R::eased>(unit::mm_s2, "What following asks for, without the shaking of those before it.");
  d.internal<&R::origin>(unit::mm, "Of all tracks it has left behind.");
  d.internal<&R::waits>("Why it does not go on.");
  d.internal<&R::waits_for>("The mover that is in its way.");
  d.internal<&R::waits_since>("Cycle since when.");
}

}  // namespace takt::planar
