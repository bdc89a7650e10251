#include "takt/group/clutch.h"

#include <algorithm>
#include <cmath>

#include "takt/group/join.h"
#include "takt/group/make_stretch.h"
#include "takt/group/members.h"
#include "takt/group/run.h"
#include "takt/trajectory/demand_follower.h"
#include "takt/trajectory/quintic.h"

namespace takt::group {

namespace {

// Shares of the axes' limits: for clutches, the rest is a reserve for changes; and for path and carriers braked at
// once.
constexpr double kOfLimits = 0.9;
constexpr double kBothShare = 0.5;
// Share of the latter for carriers: bends of the path need their part, too, and a path that accelerates takes back its
// acceleration at once.
constexpr double kCarrierShare = 0.25;
constexpr double kLeastAcceleration = 0.1;  // of an axis, left beside its bends
constexpr int kLooks = 4;
constexpr double kJump = 2;             // a larger step of the carrier, in cycles of travel of the clutch, is a jump
constexpr double kLeastClosing = 0.05;  // of the velocity limit, towards a carrier that moves as fast itself
constexpr double kCarriersOwn = 0.5;    // of the acceleration limit, at most for the acceleration of the carrier
constexpr double kLeastOverride = 0.01;
constexpr double kBendShare = 0.4;      // of the acceleration, for bends, while a tool at rest catches up
constexpr double kChangeShare = 0.5;    // of the clutch's jerk; the carrier's own is added to it
constexpr double kSlightChange = 0.03;  // of the clutch's acceleration and jerk: within the margins of boarding

trajectory::Planner& PlannerOf(const Context& c, const State& s) {
  std::size_t place = 0;
  while (s.members[place] == 0) ++place;
  return ContextOf(c, s, place).planner;
}

const CarrierBinding& RideAt(const Context& c, std::uint64_t number) {
  return c.ahead.rides[number % kRides];
}

template <typename S>
auto* Find(S& s, std::uint64_t ride) {
  const auto found = std::ranges::find_if(s.clutches, [&](const Clutch& k) { return k.used && k.ride == ride; });
  return found != s.clutches.end() ? &*found : nullptr;
}

bool HasTravel(const kinematics::Carrier& carrier) {
  return carrier.kind == kinematics::CarrierKind::kStraight || carrier.kind == kinematics::CarrierKind::kTurning;
}

// Returns the tool at `way` of a stretch, carried by one binding with this travel.
MovingFrame ToolAtTravel(const Context& c, const Stretch& stretch, double way, const CarrierBinding& ride,
                         const KinematicState& travel) {
  kinematics::Carrier carrier = CarrierOf(c, ride.cargo);
  carrier.travel = travel;
  return kinematics::PoseOn(carrier, ride.cargo.from, kinematics::ToFrame(ride.cargo.lies)) *
         (ride.reference_inverse * path::At(stretch.segment, way).GetFrame());
}

// Computes the travel demanded by the law that gets the tool into sync or out of it. Returns false if the law has
// ended.
bool FollowLaw(const KinematicState& carrier, bool out, Clutch& clutch, KinematicState& demand) {
  if (clutch.law_length == 0) return false;
  const double x = std::clamp((carrier.position - clutch.law_begin) / clutch.law_length, 0.0, 1.0);
  if (x >= 1) {
    clutch.law_length = 0;
    return false;
  }
  const trajectory::Quintic law =
      trajectory::Connect(clutch.law_length, {0, out ? 1.0 : 0.0, 0}, {clutch.law_way, out ? 0.0 : 1.0, 0});
  demand = trajectory::ComposeWithMaster(law.At(x * clutch.law_length), carrier);
  demand.position += clutch.law_from;
  return true;
}

trajectory::Limits Shared(trajectory::Limits limits, double share) {
  const double carriers = share < 1 ? share * kCarrierShare : 1;
  limits.acceleration *= carriers;
  limits.deceleration *= carriers;
  limits.jerk *= carriers;
  return limits;
}

trajectory::Limits LimitsNow(const Clutch& clutch, const State& s) {
  const bool alone = clutch.boards || clutch.reserved || (clutch.coupled && !s.lets_go);
  return alone ? clutch.limits() : Shared(clutch.limits(), BrakeShare(s));
}

KinematicState Less(const KinematicState& a, const KinematicState& b) {
  return {a.position - b.position, a.velocity - b.velocity, a.acceleration - b.acceleration};
}
KinematicState Before(const KinematicState& now, double time_s) {
  return {now.position - time_s * (now.velocity - 0.5 * time_s * now.acceleration),
          now.velocity - time_s * now.acceleration, now.acceleration};
}
KinematicState Sum(const KinematicState& a, const KinematicState& b) {
  return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
}

// Plans how the tool gets into sync, in the frame of the carrier: its own motion, and the resolution of its
// measurement, then have no effect.
Status ComeCloser(trajectory::Planner& planner, const KinematicState& carrier, const trajectory::Limits& limits,
                  const KinematicState& apart, trajectory::Profile& out) {
  const double toward = apart.position > 0 ? -1 : 1;
  const double velocity = std::max(limits.velocity - toward * carrier.velocity, kLeastClosing * limits.velocity);
  const double most = kCarriersOwn * limits.acceleration;
  const double own = std::clamp(carrier.acceleration, -most, most);
  const trajectory::Bounds bounds = {limits.acceleration - own, limits.acceleration + own, limits.jerk};
  return planner.ToPosition(apart, 0, velocity, bounds, out);
}

// Returns `apart` a cycle later; zero when in sync.
KinematicState Closer(const Context& c, const State& s, const Clutch& clutch, const KinematicState& carrier,
                      const trajectory::Limits& limits) {
  trajectory::Planner& planner = PlannerOf(c, s);
  trajectory::Profile profile;
  const Status status = clutch.boards ? ComeAboard(planner, carrier.velocity, limits, clutch.apart, profile)
                                      : ComeCloser(planner, carrier, limits, clutch.apart, profile);
  if (status.failed()) return clutch.apart;
  return profile.duration() > c.cycle.period_s ? profile.At(c.cycle.period_s) : KinematicState{};
}

void EndBoarding(const Context& c, Clutch& clutch) {
  clutch.boards = false;
  c.ahead.rides[clutch.ride % kRides].boarding.on = false;
}

void Drive(const Context& c, State& s, const KinematicState& carrier, Clutch& clutch) {
  trajectory::Planner& planner = PlannerOf(c, s);
  const double period = c.cycle.period_s;
  const TrackingParams& params = c.params.tracking;
  KinematicState demand = carrier;
  // The path leaves boarding its part of the limits: the clutch keeps it until it is in sync or at rest; else it could
  // not take back its acceleration in time.
  if (clutch.boards) clutch.reserved = true;
  // Boarding was planned for a constant velocity of the carrier; from now on the path waits.
  const double change = carrier.acceleration - (clutch.travel.acceleration - clutch.apart.acceleration);
  const bool slight = std::abs(carrier.acceleration) <= kSlightChange * clutch.acceleration &&
                      std::abs(change) <= kSlightChange * clutch.jerk * period;
  if (clutch.boards && !slight) {
    EndBoarding(c, clutch);
    clutch.jerk *= kChangeShare;
  }
  // A move that waits does not wait for a carrier at rest.
  if (carrier.velocity == 0 && s.queue.count > 0 && !s.lets_go) clutch.law_length = 0;
  const bool law = FollowLaw(carrier, s.lets_go, clutch, demand);
  const trajectory::Limits limits_now = LimitsNow(clutch, s);
  if (s.lets_go && !law) {
    trajectory::Limits limits = limits_now;
    if (s.brake.deceleration > 0) limits.deceleration = std::min(limits.deceleration, s.brake.deceleration);
    if (s.brake.jerk > 0) limits.jerk = std::min(limits.jerk, s.brake.jerk);
    trajectory::Profile profile{clutch.travel};
    planner.ToVelocity(clutch.travel, 0, limits, profile);
    clutch.travel = profile.At(period);
    clutch.coupled = clutch.catches_up = false;
    EndBoarding(c, clutch);
    return;
  }
  // A belt whose encoder was lost may reappear elsewhere: the tool does not follow such a jump.
  const KinematicState before = Before(carrier, period);
  const double known = clutch.travel.position - (clutch.catches_up ? clutch.apart.position : 0);
  const double step = before.position - known;
  const bool jumps = std::abs(step) > kJump * clutch.velocity * period;
  if (clutch.coupled && params.after_sync == AfterSync::kStay && !law && !jumps) {
    clutch.travel = carrier;
    clutch.catches_up = false;
    return;
  }
  trajectory::Limits catching_up = limits_now;
  if (params.override_in_sync) catching_up.velocity *= std::max(s.velocity_factor, kLeastOverride);
  if (params.after_sync == AfterSync::kStay && !law) {
    if (!clutch.catches_up || jumps) clutch.apart = Less(clutch.travel, before);
    clutch.catches_up = true;
    clutch.apart = Closer(c, s, clutch, carrier, catching_up);
    clutch.coupled = clutch.apart == KinematicState{};
    if (clutch.coupled || jumps) EndBoarding(c, clutch);
    if (clutch.coupled) clutch.reserved = false;
    clutch.travel = clutch.coupled ? carrier : Sum(carrier, clutch.apart);
    return;
  }
  clutch.catches_up = false;
  trajectory::DemandFollowerState chase;
  const trajectory::DemandFollower chaser = {limits_now, planner, catching_up, period};
  clutch.travel = trajectory::FollowDemand(chaser, trajectory::DemandMode::kPosition, clutch.travel, demand, chase);
  clutch.coupled = chase.in_step && !law;
}

void StepOne(const Context& c, const Stretch& stretch, double way, std::uint64_t number, State& s) {
  const CarrierBinding& ride = RideAt(c, number);
  if (!Moves(ride)) return;
  const kinematics::Carrier carrier = CarrierOf(c, ride.cargo);
  if (!HasTravel(carrier)) return;
  Clutch* clutch = Find(s, number);
  if (clutch) {
    // At rest apart from the carrier: limits for the motion to it. They stay until the tool is in sync, because
    // CanRelease relies on them.
    const bool stands = clutch->travel.velocity == 0 && clutch->travel.acceleration == 0;
    if (!s.lets_go && !clutch->coupled && !clutch->boards && stands) {
      const double way_to_go = carrier.travel.position - clutch->travel.position;
      SetLimits(LimitsAlong(c, s, stretch, way, number, clutch->travel, way_to_go), *clutch);
      clutch->reserved = false;
    }
    return Drive(c, s, carrier.travel, *clutch);
  }
  const auto free = std::ranges::find_if(s.clutches, [](const Clutch& k) { return !k.used; });
  if (free == s.clutches.end()) return;
  free->used = true;
  free->coupled = !s.lets_go;
  free->ride = number;
  free->travel = carrier.travel;
  SetLimits(LimitsAlong(c, s, stretch, way, number, carrier.travel, kAhead_s * carrier.travel.velocity), *free);
}

}  // namespace

void SetLimits(const trajectory::Limits& limits, Clutch& clutch) noexcept {
  clutch.velocity = limits.velocity;
  clutch.acceleration = limits.acceleration;
  clutch.deceleration = limits.deceleration;
  clutch.jerk = limits.jerk;
}

void StepClutches(const Context& c, const Stretch& stretch, State& s) noexcept {
  for (Clutch& clutch : s.clutches) {
    if (clutch.used && clutch.ride != stretch.from_ride && clutch.ride != stretch.to_ride) clutch = {};
  }
  s.ridden = {};
  if (stretch.joints) return;
  s.ridden = {RideAt(c, stretch.from_ride).cargo.carrier, RideAt(c, stretch.to_ride).cargo.carrier};
  const double way = std::clamp(stretch.from + s.pace.now.position - stretch.begin, stretch.from, stretch.to);
  StepOne(c, stretch, way, stretch.from_ride, s);
  if (stretch.to_ride != stretch.from_ride) StepOne(c, stretch, way, stretch.to_ride, s);
}

bool IsOnFreeCarrier(const Context& c, const State& s) noexcept {
  return std::ranges::any_of(s.ridden, [&](std::uint32_t carrier) {
    return carrier != 0 && c.carriers.At(carrier).kind == kinematics::CarrierKind::kFree;
  });
}

bool IsUncoupled(const State& s) noexcept {
  return std::ranges::any_of(s.clutches, [](const Clutch& k) { return k.used && !k.coupled; });
}

bool WaitsForClutch(const State& s) noexcept {
  return std::ranges::any_of(s.clutches, [](const Clutch& k) { return k.used && !k.coupled && !k.boards; });
}

Status ComeAboard(trajectory::Planner& planner, double velocity, const trajectory::Limits& limits,
                  const KinematicState& apart, trajectory::Profile& out) noexcept {
  // Symmetric, so that the rest of the motion is planned alike in each cycle.
  const double closing = std::max(limits.velocity - std::abs(velocity), kLeastClosing * limits.velocity);
  const trajectory::Bounds bounds = {limits.acceleration, limits.acceleration, limits.jerk};
  return planner.ToPosition(apart, 0, closing, bounds, out);
}

bool ClutchesAtRest(const State& s) noexcept {
  return std::ranges::all_of(s.clutches, [](const Clutch& k) {
    return !k.used || (!k.coupled && k.travel.velocity == 0 && k.travel.acceleration == 0);
  });
}

double BrakeShare(const State& s) noexcept {
  const bool carried = std::ranges::any_of(s.clutches, &Clutch::used);
  const bool both = carried && (s.lets_go || IsUncoupled(s)) && !trajectory::Stands(s.pace);
  return both && !s.ends ? kBothShare : 1;
}

MovingFrame ToolBraked(const Context& c, const State& s, const Stretch& stretch, double way) noexcept {
  const auto braked = [&](std::uint64_t number, kinematics::Carrier carrier) {
    const Clutch* clutch = Find(s, number);
    KinematicState& travel = carrier.travel;
    if (!clutch) return carrier;
    travel = clutch->travel;
    const double speed = travel.velocity;
    travel.position = trajectory::StopPosition(travel, clutch->limits()) + 2 * c.cycle.period_s * speed;
    travel.acceleration = 0;
    return carrier;
  };
  return ToolWith(c, stretch, {way, 0, 0}, braked);
}

bool CanRelease(const Context& c, State& s) noexcept {
  const double place = RestAt(c, s);
  const LookAhead& ahead = c.ahead;
  const Stretch& stretch = *ahead.At(place);
  if (!IsCarried(ahead, stretch)) return true;
  const double way = std::clamp(stretch.from + place - stretch.begin, stretch.from, stretch.to);
  // The carriers are braked with it, from the next cycle on.
  const MovingFrame tool = ToolBraked(c, s, stretch, way);
  kinematics::JointMotion motion;
  kinematics::Reason reason = AxesFor(c, s, stretch, tool, {way, 0, 0}, s.joints, motion);
  // The axes must be able to move there as fast as the carriers move now.
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  for (std::size_t k = 0; k < std::min(own.count, kMaxAxes); ++k) {
    if (reason != kinematics::Reason::kNone || s.members[k] == 0) continue;
    if (std::abs(motion.velocity[k]) > own.of[k].velocity) reason = kinematics::Reason::kSingular;
    if (std::abs(motion.acceleration[k]) > own.of[k].acceleration) reason = kinematics::Reason::kSingular;
  }
  if (reason != kinematics::Reason::kNone) s.reason = reason;
  return reason == kinematics::Reason::kNone;
}

trajectory::Limits LimitsAlong(const Context& c, const State& s, const Stretch& stretch, double way,
                               std::uint64_t number, const KinematicState& from, double distance) noexcept {
  const CarrierBinding& ride = RideAt(c, number);
  const PathLimits& path = c.params.path;
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const double speed = std::abs(from.velocity);
  const bool stands = speed == 0;
  trajectory::Limits limits = {path.velocity, path.acceleration, path.deceleration.value_or(path.acceleration),
                               path.jerk};
  double length = 0;  // [mm] of tool motion per unit of travel
  kinematics::Joints near = s.joints;
  double velocity = trajectory::CoordinateLimits::kNone, acceleration = velocity, jerk = velocity;
  for (int i = 0; i < kLooks; ++i) {
    const double travel = from.position + i * distance / (kLooks - 1);
    const KinematicState one = {travel, 1, 0};
    const MovingFrame tool = ToolAtTravel(c, stretch, way, ride, one);
    length = std::max(length, tool.p.v.Norm());
    kinematics::JointMotion motion;
    if (AxesFor(c, s, stretch, tool, {way, 0, 0}, near, motion) != kinematics::Reason::kNone) break;
    near = motion.position;
    for (std::size_t k = 0; k < own.count && k < kMaxAxes; ++k) {
      const double slope = std::abs(motion.velocity[k]);
      if (s.members[k] == 0 || slope == 0) continue;
      velocity = std::min(velocity, kOfLimits * own.of[k].velocity / slope);
      const double bend = std::abs(motion.acceleration[k]), most = kBendShare * own.of[k].acceleration;
      if (stands && bend * velocity * velocity > most) velocity = std::sqrt(most / bend);
      const double at = stands ? velocity : speed;
      const double bends = bend * at * at;
      const double left =
          std::max(kOfLimits * own.of[k].acceleration - bends, kLeastAcceleration * own.of[k].acceleration);
      acceleration = std::min(acceleration, left / slope);
      jerk = std::min(jerk, kOfLimits * own.of[k].jerk / slope);
    }
  }
  const double scale = length > 0 ? 1 / length : 1;
  // Boarding is planned with the limits of the axes: it approaches a carrier that is faster than the path may be.
  const double most = stands && c.params.tracking.board ? velocity : std::min(velocity, scale * limits.velocity);
  return {most, std::min(acceleration, scale * limits.acceleration),
          std::min(acceleration, scale * limits.deceleration), std::min(jerk, scale * limits.jerk)};
}

}  // namespace takt::group
