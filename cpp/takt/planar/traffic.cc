#include "takt/planar/traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "takt/planar/following.h"
#include "takt/planar/going_along.h"
#include "takt/planar/send.h"

namespace takt::planar {
namespace {

// Cycles in which the acceleration of a mover does not grow after it had to brake against its wish: it would soon have
// to brake again.
constexpr std::uint32_t kCalmCycles = 20;
// Share per cycle with which the smoothed acceleration of following rises and falls towards its target.
constexpr double kEaseUp = 0.15;
constexpr double kEaseDown = 0.7;
// A mover is stationary below this speed [mm/s], and at its limit within this distance [mm].
constexpr double kStands = 0.1;
constexpr double kAtLimit = 0.01;
// A geared mover is in step within this error [mm] and this difference of speeds [mm/s].
constexpr double kInStep = 1e-6;
constexpr double kInStepSpeed = 1e-3;
// [mm] farther than any plan on a loop.
constexpr double kFarAhead = 1e5;

// Returns true if two movers on tracks stay apart while both brake because one is behind the other along the track.
bool KeepInOrder(const Scene& scene, const Network& network, std::uint32_t i, const BrakingMover& own, std::uint32_t k,
                 const BrakingMover& its) {
  const auto in_order = [&](const BrakingMover& behind, const BrakingMover& ahead, double apart) {
    return ApartByOrder(network, behind.rider, behind.braking, behind.kind, ahead.braking, ahead.kind, apart);
  };
  // `ahead` is the next mover in the direction of `of`.
  const auto follows = [&](const Now& now, const BrakingMover& of, const BrakingMover& ahead) {
    const double apart = now.leader_offset;
    return of.rider.direction > 0 ? in_order(of, ahead, apart) : in_order(ahead, of, -apart);
  };
  if (scene.now[i].leader == k) return follows(scene.now[i], own, its);
  return scene.now[k].leader == i && follows(scene.now[k], its, own);
}

}  // namespace

class Traffic::Step_ {
 public:
  Step_(Traffic& traffic, const Cycle& cycle, trajectory::Planner& planner, const Network& network,
        std::span<Rider> riders, Guard* guard)
      : t_(traffic),
        s_(traffic.scene_),
        w_(traffic.scene_, network, riders, cycle.period_s),
        cycle_(cycle),
        planner_(planner),
        network_(network),
        riders_(riders),
        guard_(guard) {}

  void Run() {
    t_.refused_ = 0;
    for (Rider& r : riders_) {
      // With its master a mover may reverse while moving.
      if (r.on && r.aim != Aim::kTarget && r.at.velocity != 0) r.direction = r.at.velocity < 0 ? -1 : 1;
    }
    w_.Begin();
    for (std::uint32_t i = 0; i < riders_.size(); ++i) {
      Rider& r = riders_[i];
      if (r.on && (r.gap < r.zone || (r.gap > r.zone && w_.MayWiden(i, r.gap)))) r.zone = r.gap;
    }
    // Leaders first: a follower uses the step that its leader takes in this cycle.
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

  void SettleInOrder(std::uint32_t i) {
    std::size_t depth = 0;
    const auto enter = [&](std::uint32_t k) {
      if (k == kNobody || !riders_[k].on || s_.now[k].entered) return false;
      s_.now[k].entered = true;
      s_.stack[depth++] = k;
      return true;
    };
    enter(i);
    while (depth > 0) {
      const std::uint32_t k = s_.stack[depth - 1];
      if (enter(s_.now[k].leader) || enter(MasterBefore(k))) continue;
      --depth;
      Settle(k);
      s_.now[k].settled = true;
    }
  }

  // Returns the master that has to be settled before this mover; none if this mover is the master's leader, whose step
  // the master has to know.
  std::uint32_t MasterBefore(std::uint32_t i) const {
    const Rider& r = riders_[i];
    if (r.aim != Aim::kFollow || r.gear.master == kNobody) return kNobody;
    return s_.now[r.gear.master].leader == i ? kNobody : r.gear.master;
  }

  // Returns the predicted state of a master at the end of the cycle, over all tracks.
  KinematicState Foresee(std::uint32_t master) const {
    const Rider& m = riders_[master];
    KinematicState at = s_.now[master].next;
    if (!s_.now[master].settled) {
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

  // Returns its demanded state at the end of the cycle, on its first track.
  KinematicState DemandOn(Rider& r) const {
    if (r.gear.master != kNobody) r.demand = Foresee(r.gear.master);
    KinematicState demand = r.demand;
    demand.position += r.gear.offset - r.origin;
    return demand;
  }

  // Returns the end of its route in its direction, as a position on the last track [mm].
  double EndOf(const Rider& r) const {
    double end = network_[r.route.last()].length;
    for (const std::uint32_t track : r.route.all()) end -= r.direction < 0 ? network_[track].length : 0;
    return end;
  }

  // Returns the wish of a geared mover; if its route ends it moves to that end instead.
  KinematicState WishAlong(Rider& r, const KinematicState& demand, bool& exact) {
    KinematicState wish = FollowDemandAlone(planner_, r, demand, period(), exact);
    const bool ahead = r.direction * wish.velocity > 0 && r.direction * r.at.velocity >= 0;
    if (!exact && ahead && CurvesAhead(network_, r)) {
      // Bounded by the motion to the end of its route.
      r.target = network_[r.route.last()].closed ? r.at.position + r.direction * kFarAhead : EndOf(r);
      const KinematicState alone = Wish(r);
      if (r.direction * (wish.velocity - alone.velocity) > 0) return alone;
    }
    r.planned = false;
    const int out = LeavesRoute(network_, r, wish);
    if (out == 0) return wish;
    exact = false;
    // While its demand is on its route, it waits for it.
    if (demand.position >= -kTolerance && LeavesRoute(network_, r, demand) == 0) {
      return Brake(r.at, LeavesRoute(network_, r, r.at) == 0 ? r.pace.brakes() : r.brakes).At(period());
    }
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

  // Returns true if it is at rest and waits for its master to reach a position that it may take.
  static bool AwaitsMaster(const Rider& r, const KinematicState& demand) {
    const bool may = r.gear.was_in_step || r.gear.sense * (demand.position - r.at.position) >= -kTolerance;
    return Rests(r.at) && !may;
  }

  // Returns true if it approaches the master's position from behind; it may not move back, so it must not pass.
  bool ComesFromBehind(const Rider& r, const KinematicState& demand) const {
    return !r.gear.was_in_step && r.gear.sense == r.direction && RoomTo(r, demand) > 0;
  }
  double RoomTo(const Rider& r, const KinematicState& demand) const {
    return r.direction * (demand.position - period() * demand.velocity - r.at.position);
  }
  // Returns true if it would pass that position if both braked from here with its commanded dynamics.
  static bool Passes(const Rider& r, const KinematicState& next, const KinematicState& demand) {
    const Braking own = Brake(next, r.pace.brakes()), its = Brake(demand, r.pace.brakes());
    return r.direction > 0 ? LeastDistance(own, its, 0) < -kTolerance : LeastDistance(its, own, 0) < -kTolerance;
  }

  // Updates its error at the end of the cycle, and whether it is in step.
  void NoteStep(std::uint32_t i) {
    Rider& r = riders_[i];
    const KinematicState demand = DemandOn(r);
    const KinematicState& next = s_.now[i].next;
    r.gear.error = next.position - demand.position;
    const bool exact = std::abs(r.gear.error) <= kInStep && std::abs(next.velocity - demand.velocity) <= kInStepSpeed;
    r.gear.in_step = exact || std::abs(r.gear.error) <= r.gear.tolerance;
    r.gear.was_in_step |= r.gear.in_step;
  }

  void Plan(Rider& r, double place, double speed, double acceleration) {
    PlanOn(planner_, network_, place, speed, acceleration, r);
  }

  // Returns its state at the end of the cycle by its own plan.
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

  // Returns true if this braking reverses the motion before it rests.
  static bool Reverses(const KinematicState& from, const Braking& braking) {
    return (from.velocity > 0 ? braking.highest - braking.rest : braking.rest - braking.lowest) > kTolerance;
  }

  // Takes a step with the largest share of its dynamics for braking that keeps the vectors within their maxima in the
  // bends ahead. Returns false if the step is not admissible.
  bool TryToTake(std::uint32_t i, const KinematicState& next) {
    held_by_guard_ = false;
    const Rider& r = riders_[i];
    const bool on_plan = r.aim == Aim::kTarget && r.planned && r.plan_ends;  // rests at the target without that braking
    for (std::size_t share = 0; share < kShares.size(); ++share) {
      const Brakes brakes = WithShare(r.brakes, r.pace, share);
      const Braking braking = Brake(next, brakes);
      if (share > 0 && !on_plan && Reverses(next, braking)) return false;
      if (!KeepsToVectors(network_, r, next, braking, period())) continue;
      // A smaller share would only make it rest later.
      if (!KeepsToLimits(network_, r, next, braking, brakes.jerk) || !w_.MayTake(i, next, braking)) return false;
      held_by_guard_ = guard_ != nullptr && !PassesGuard(i, next, braking);
      if (held_by_guard_) return false;
      w_.Take(i, next, braking, share);
      return true;
    }
    return false;
  }
  bool Refuse(std::uint32_t i) {
    if (held_by_guard_) return false;
    riders_[i].calm_cycles = kCalmCycles;
    t_.refused_ += std::abs(riders_[i].at.velocity) > kStands ? 1 : 0;
    return false;
  }
  bool Take(std::uint32_t i, const KinematicState& next) { return TryToTake(i, next) || Refuse(i); }
  // Takes the first admissible step of those for each share of its dynamics; in bends a smaller share may suffice.
  template <typename StepWithShare>
  bool TakeWithShare(std::uint32_t i, const StepWithShare& step) {
    const std::size_t shares = std::isfinite(riders_[i].pace.vector_jerk) ? kShares.size() : 1;
    for (std::size_t share = 0; share < shares; ++share) {
      const std::optional<KinematicState> next = step(share);
      if (next && TryToTake(i, *next)) return true;
    }
    return Refuse(i);
  }

  const Area& KindOf(std::uint32_t i) const { return guard_->figure(i).kind; }
  // Returns the course between two positions on its route.
  Course CourseOf(std::uint32_t i, double from, double to) const {
    return CourseOn(network_, riders_[i], from, to, KindOf(i));
  }
  bool IsInOrder(std::uint32_t i, std::uint32_t k) const { return s_.now[i].leader == k || s_.now[k].leader == i; }

  bool IsOnTrack(std::uint32_t k) const { return riders_[k].on && guard_->figure(k).on_track; }

  // Returns true if the guard admits this step; then it becomes the mover's course.
  bool PassesGuard(std::uint32_t i, const KinematicState& next, const Braking& braking) {
    const Course course = CourseOf(i, std::min({riders_[i].at.position, next.position, braking.lowest}),
                                   std::max({riders_[i].at.position, next.position, braking.highest}));
    const BrakingMover own{riders_[i], braking, KindOf(i)};
    const auto other = [&](std::uint32_t k) { return BrakingMover{riders_[k], s_.now[k].braking, KindOf(k)}; };
    const std::uint32_t across = guard_->Find(
        i, guard_->figure(i).system, course,
        [&](std::uint32_t k, bool there) {
          return !there && IsInOrder(i, k) && IsOnTrack(k) && KeepInOrder(s_, network_, i, own, k, other(k));
        },
        [&](std::uint32_t k, bool there) {
          return !there && IsOnTrack(k) && ApartInTime(network_, own, other(k), period());
        });
    s_.now[i].across = across;
    if (across == kNobody) {
      guard_->Put(i, course);
      return true;
    }
    if (!IsInOrder(i, across)) riders_[i].held_by = across;
    return false;
  }

  // Returns the mover across its path within the distance that it needs to keep its pace; kNobody: the path is clear.
  std::uint32_t Across(std::uint32_t i) {
    const Rider& r = riders_[i];
    double ahead = StoppingDistance(r.pace.limits.velocity, r.pace.brakes());
    if (r.aim == Aim::kTarget) ahead = std::min(ahead, std::abs(TargetPosition(network_, r) - r.at.position));
    const double there = r.at.position + r.direction * ahead;
    return guard_->Find(
        i, guard_->figure(i).system, CourseOf(i, std::min(r.at.position, there), std::max(r.at.position, there)),
        [&](std::uint32_t k, bool brought) { return !brought && IsInOrder(i, k); }, Guard::None);
  }

  // Returns true if it brakes for a mover across its path, or waits for it.
  bool Holds(std::uint32_t i) {
    Rider& r = riders_[i];
    if (guard_ == nullptr || r.held_by == kNobody) return false;
    r.held_by = Across(i);
    if (r.held_by == kNobody) return false;
    r.planned = false;
    if (std::abs(r.at.velocity) < kStands) WaitFor(r, Waits::kMover, r.held_by);
    return true;
  }

  void WaitFor(Rider& r, Waits why, std::uint32_t whom) {
    if (r.aim == Aim::kRest) {  // no motion to continue
      why = Waits::kNot;
      whom = kNobody;
    }
    if (r.waits == why && r.waits_for == whom) return;
    if (r.waits == Waits::kNot || why == Waits::kNot) r.waits_since = cycle_.count;
    r.waits = why;
    r.waits_for = whom;
  }

  // Returns the smoothed acceleration of following, `most`: fluctuations of the movers ahead in single cycles are not
  // passed on, as they would grow along a chain.
  static double Eased(const Rider& r, double most) {
    const double wanted = std::clamp(most, -2 * r.pace.limits.deceleration, 2 * r.pace.limits.acceleration);
    return r.eased + (wanted < r.eased ? kEaseDown : kEaseUp) * (wanted - r.eased);
  }
  // After it had to brake its acceleration does not grow.
  static double Calmed(const Rider& r, double most) {
    return r.calm_cycles > 0 ? std::min(most, std::max(0.0, r.direction * r.at.acceleration)) : most;
  }
  // Returns the range of accelerations possible at the end of the cycle. The current one may be removed faster than the
  // commanded jerk allows.
  trajectory::Profile::Range Reachable(const Rider& r, std::size_t share) const {
    const double before = r.direction * r.at.acceleration;
    const double change = WithShare(r.pace.limits, r.pace, share).jerk * period();
    const double away = WithShare(LimitsNow(r), r.pace, share).jerk * period();
    return {before - (before > 0 ? away : change), before + (before < 0 ? away : change)};
  }
  // Returns the state at the end of the cycle with this acceleration, or the nearest possible one.
  KinematicState StepWith(const Rider& r, double acceleration, std::size_t share = 0) const {
    const double before = r.direction * r.at.acceleration, speed = r.direction * r.at.velocity;
    const trajectory::Limits limits = WithShare(r.pace.limits, r.pace, share);
    const auto [lowest, highest] = Reachable(r, share);
    double next = std::clamp(acceleration, lowest, highest);
    // The deceleration must be removed when the mover comes to rest, or it would reverse: at the end of the cycle, with
    // a reserve of a tenth of the jerk.
    const double jerk_then = 0.9 * limits.jerk, half = 0.5 * jerk_then * period();
    const double left = std::max(0.0, speed + 0.5 * period() * before);
    const double gone = std::sqrt(half * half + 2 * jerk_then * left) - half;
    const double braked = WithShare(r.brakes, r.pace, share).deceleration;
    next = std::clamp(next, -std::min(gone, braked), limits.acceleration);
    next = std::clamp(next, lowest, highest);
    const double jerk = (next - before) / period();
    return trajectory::Piece{r.at.position, r.at.velocity, r.at.acceleration, r.direction * jerk}.At(period());
  }

  // Returns true if the rest of its motion, however short, fits into this distance.
  bool Reaches(const Rider& r, double room) const {
    return std::abs(TargetPosition(network_, r) - r.at.position) <= room + kTolerance;
  }

  // Returns the state at the end of the cycle when braking as commanded.
  KinematicState Halting(const Rider& r, std::size_t share) const {
    return Brake(r.at, WithShare(Brakes{r.pace.limits.deceleration, LimitsNow(r).jerk}, r.pace, share)).At(period());
  }

  // A mover that was held back, and still is, needs no plan of its own while nothing else ahead would slow it down.
  // Returns false if it needs one.
  bool StaysBehind(std::uint32_t i) {
    Rider& r = riders_[i];
    if (r.aim != Aim::kTarget || r.planned || std::abs(r.at.velocity) < kStands) return false;
    Limit limit;
    double most = kInfinite;
    LimitBy(w_, i, r.direction * r.at.velocity, limit, most);
    // A plan might show that it comes to rest before that mover.
    if (limit.by == kNobody || Rests(riders_[limit.by].at)) return false;
    const double eased = Eased(r, most);
    most = Calmed(r, eased);
    const KinematicState step = StepWith(r, most);
    if (most >= Reachable(r, 0).max || r.direction * step.velocity <= 0 || !IsUnconstrained(network_, r, step))
      return false;
    r.eased = eased;
    if (r.calm_cycles > 0) --r.calm_cycles;
    // if none is admissible, it brakes
    TakeWithShare(i, [&](std::size_t share) { return std::optional(StepWith(r, most, share)); });
    WaitFor(r, Waits::kNot, kNobody);
    return true;
  }

  void Settle(std::uint32_t i) {
    Rider& r = riders_[i];
    Now& now = s_.now[i];
    const bool halts = r.aim == Aim::kRest && r.softly && !Rests(r.at);
    if ((r.aim == Aim::kRest && !halts) || (r.aim == Aim::kTarget && r.there)) {
      r.planned = false;
      r.held_by = kNobody;
      return WaitFor(r, Waits::kNot, kNobody);
    }
    if (Holds(i)) return;
    // A stationary mover that waits needs no plan until there is room, or enough room for the rest of its motion.
    if (r.aim == Aim::kTarget && r.waits == Waits::kMover && !r.planned && Rests(r.at)) {
      Limit limit;
      double most = kInfinite;
      LimitBy(w_, i, 0, limit, most);
      if (limit.room < kAtLimit && !Reaches(r, limit.room)) return WaitFor(r, Waits::kMover, limit.by);
    }
    if (StaysBehind(i)) return;
    bool exact = false;  // a geared mover is at its demand
    KinematicState demand;
    if (r.aim == Aim::kFollow) demand = DemandOn(r);
    // A mover that is held back stays so until there is room: otherwise it would oscillate.
    const bool was_free = r.aim == Aim::kFollow || r.planned || Rests(r.at);
    const std::int8_t went = r.direction;
    const KinematicState wish = halts ? Halting(r, 0) : r.aim == Aim::kTarget ? Wish(r) : WishAlong(r, demand, exact);
    const bool follows = r.aim == Aim::kFollow;
    if (follows && Rests(r.at) && wish.velocity * r.direction < 0) r.direction = wish.velocity < 0 ? -1 : 1;
    // After a reversal, and maybe with a new route, its leader is another one.
    const bool anew = r.direction != went || (r.aim == Aim::kTarget && now.leader == kNobody);
    if (anew) now.leader = w_.FindLeader(i, r.direction, now.leader_offset);
    const int direction = r.direction;
    const double speed = direction * r.at.velocity;
    const double before = direction * r.at.acceleration;
    Limit limit;
    double most = kInfinite;
    LimitBy(w_, i, speed, limit, most);
    r.eased = Eased(r, most);
    most = Calmed(r, r.eased);
    if (r.calm_cycles > 0) --r.calm_cycles;
    const bool comes = follows && !exact && ComesFromBehind(r, demand);
    if (follows) {
      most = std::max(most, CloseGapAcceleration(w_, i, limit));
      // Before a stationary demand it comes to rest by itself.
      if (Rests(demand) && direction * (demand.position - r.at.position) <= limit.room + kTolerance) most = kInfinite;
      if (comes) most = std::min(most, ApproachAcceleration(r, RoomTo(r, demand), demand, r.pace.brakes(), period()));
    }
    // With constant jerk neither faster than wished at the end of the cycle, nor with more acceleration.
    const double mean = (direction * wish.velocity - speed) / period();
    const double as_fast = 2 * mean - before;
    // A small wish may begin and end without acceleration; with that bound, a follower of a master would not move at
    // all.
    const double least_end = direction * wish.acceleration;
    const double fastest = r.pace.limits.velocity - direction * wish.velocity;
    const double end =
        follows ? std::max(least_end, std::sqrt(r.pace.limits.jerk * std::max(0.0, fastest))) : least_end;
    const double wished = std::min(end, as_fast);
    const bool limited = mean > most + 1e-9 && !(was_free && IsNoFasterThanLeader(w_, i, wish, limit));
    if (halts && !limited && TakeWithShare(i, [&](std::size_t share) { return std::optional(Halting(r, share)); })) {
      return WaitFor(r, Waits::kNot, kNobody);
    }
    if (!limited && !(comes && Passes(r, wish, demand)) && Take(i, wish)) {
      if (r.aim == Aim::kTarget && r.plan_ends && r.plan_time >= r.plan.duration()) r.there = true;
      if (follows && AwaitsMaster(r, demand)) {
        return WaitFor(r, r.gear.master == kNobody ? Waits::kMaster : Waits::kMover, r.gear.master);
      }
      return WaitFor(r, Waits::kNot, kNobody);
    }
    r.planned = false;
    const bool stands = std::abs(r.at.velocity) < kStands;
    // Slower than wished, as fast as the limit admits.
    const auto slower = [&](std::size_t share) -> std::optional<KinematicState> {
      const KinematicState step = StepWith(r, std::min(most, wished), share);
      const bool goes = direction * step.velocity > 0 && !(stands && limit.room < kAtLimit);
      if (!goes || (comes && Passes(r, step, demand))) return std::nullopt;
      return step;
    };
    if (slower(0) && TakeWithShare(i, slower)) {
      return stands ? WaitFor(r, Waits::kMover, limit.by) : WaitFor(r, Waits::kNot, kNobody);
    }
    if (!stands) return;
    const std::uint32_t by = now.across != kNobody ? now.across : limit.by;
    WaitFor(r, by != kNobody ? Waits::kMover : Waits::kRoute, by);
  }

  // The end of the cycle: positions become those on the track where the mover is now.
  void GoOn(std::uint32_t i) {
    Rider& r = riders_[i];
    const Now& now = s_.now[i];
    if (guard_ != nullptr && !now.taken && !(Rests(r.at) && Rests(now.next))) {
      guard_->Put(i, CourseOf(i, std::min(now.next.position, now.braking.lowest),
                              std::max(now.next.position, now.braking.highest)));
    }
    r.at = now.next;
    r.share = now.share;
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
  Scene& s_;
  RightOfWay w_;
  const Cycle& cycle_;
  trajectory::Planner& planner_;
  const Network& network_;
  std::span<Rider> riders_;
  Guard* guard_;
  bool held_by_guard_ = false;  // the last step was refused by the guard
};

Traffic::Traffic(const TrafficSettings& settings) : scene_(settings.movers, settings.tracks) {}

void Traffic::Step(const Cycle& cycle, trajectory::Planner& planner, const Network& network, std::span<Rider> riders,
                   Guard* guard) noexcept {
  Step_(*this, cycle, planner, network, riders, guard).Run();
}

std::uint32_t Traffic::TooNear(const Cycle& cycle, const Network& network, std::span<const Rider> riders,
                               std::uint32_t mover) noexcept {
  RightOfWay all(scene_, network, riders, cycle.period_s);
  all.Begin();
  return all.TooNear(mover);
}

std::uint32_t Traffic::FindAcross(const Cycle& cycle, const Network& network, std::span<const Rider> riders,
                                  Guard& guard, std::uint32_t mover, const Area& kind, const Course& course) noexcept {
  const Rider& own = riders[mover];
  const Braking braking = Brake(own.at, BrakesOf(own));
  RightOfWay all(scene_, network, riders, cycle.period_s);
  bool begun = false;
  const auto passes = [&](std::uint32_t k, bool there) {
    const Rider& other = riders[k];
    if (there || !other.on || !guard.figure(k).on_track || (Rests(own.at) && Rests(other.at))) return false;
    if (!begun) all.Begin();
    begun = true;
    const Braking braking_k = Brake(other.at, BrakesOf(other));
    const BrakingMover it{own, braking, kind}, its{other, braking_k, guard.figure(k).kind};
    return KeepInOrder(scene_, network, mover, it, k, its) || ApartInTime(network, it, its, cycle.period_s);
  };
  return guard.Find(mover, guard.figure(mover).system, course, Guard::None, passes);
}

std::span<const std::uint32_t> Traffic::On(std::uint32_t track) const noexcept {
  return {scene_.order.data() + scene_.begins[track], scene_.order.data() + scene_.begins[track + 1]};
}

bool LeadsToDeadlock(std::span<const Rider> riders, std::uint32_t mover) noexcept {
  std::uint32_t at = mover;
  for (std::size_t i = 0; i <= riders.size(); ++i) {
    if (riders[at].waits != Waits::kMover || riders[at].waits_for == kNobody) return false;
    at = riders[at].waits_for;
  }
  return true;
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

}  // namespace takt::planar
