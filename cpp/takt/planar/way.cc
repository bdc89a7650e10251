#include "takt/planar/way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace takt::planar {
namespace {

constexpr double kSlight = 1e-9;  // share of a speed, or [mm]

// Tolerance of squares: rounding.
constexpr double kWithin = 1 + 1e-9;

// Upper bound of the squared length of the jerk in a bend, and its derivative with respect to the speed.
struct JerkSquare {
  double value = 0;
  double slope = 0;
};
JerkSquare JerkSquareAt(const Bend& bend, const Stress& s) {
  const double k = bend.curvature, v = s.speed;
  const double along = s.jerk + k * k * v * v * v;
  const double across = 3 * k * v * s.acceleration + bend.rate * v * v * v;
  return {along * along + across * across,
          2 * along * 3 * k * k * v * v + 2 * across * (3 * k * s.acceleration + 3 * bend.rate * v * v)};
}

}  // namespace

trajectory::Limits WithShare(trajectory::Limits limits, const Pace& pace, std::size_t share) noexcept {
  const double acceleration = kShares[share].acceleration * pace.vector_acceleration;
  limits.acceleration = std::min(limits.acceleration, acceleration);
  limits.deceleration = std::min(limits.deceleration, acceleration);
  limits.jerk = std::min(limits.jerk, kShares[share].jerk * pace.vector_jerk);
  return limits;
}

Brakes WithShare(Brakes brakes, const Pace& pace, std::size_t share) noexcept {
  return {std::min(brakes.deceleration, kShares[share].acceleration * pace.vector_acceleration),
          std::min(brakes.jerk, kShares[share].jerk * pace.vector_jerk)};
}

bool KeepsVectors(const Bend& bend, const Stress& stress, const Pace& pace) noexcept {
  if (!(bend.curvature > 0)) return true;  // the limits along the route suffice
  const double across = bend.curvature * stress.speed * stress.speed;
  const double most = pace.vector_acceleration * pace.vector_acceleration;
  if (stress.acceleration * stress.acceleration + across * across > most * kWithin) return false;
  return JerkSquareAt(bend, stress).value <= pace.vector_jerk * pace.vector_jerk * kWithin;
}

double SpeedIn(const Bend& bend, const Pace& pace) noexcept {
  double most = pace.limits.velocity;
  if (!(bend.curvature > 0)) return most;
  const Share& least = kShares.back();
  const double room = std::sqrt(1 - least.acceleration * least.acceleration) * pace.vector_acceleration;
  most = std::min(most, std::sqrt(std::min(pace.lateral, room) / bend.curvature));
  if (!std::isfinite(pace.vector_jerk)) return most;
  // The square grows convexly with the speed: Newton's method from above converges monotonically.
  constexpr int kMostSteps = 12;
  const double allowed = pace.vector_jerk * pace.vector_jerk;
  const Stress stress{most, least.acceleration * pace.vector_acceleration, least.jerk * pace.vector_jerk};
  for (int i = 0; i < kMostSteps; ++i) {
    const JerkSquare square = JerkSquareAt(bend, {most, stress.acceleration, stress.jerk});
    if (square.value <= allowed * (1 + 1e-10)) break;
    most -= (square.value - allowed) / square.slope;
  }
  return most;
}

namespace {

// Returns the index of the bend that contains s; at a border, the one ahead in this direction.
std::size_t BendAt(const Road& road, double s, std::int8_t direction) {
  const std::vector<Bend>& bends = road.track->bends;
  const auto behind = std::ranges::upper_bound(bends, s, {}, &Bend::from);
  auto i = static_cast<std::size_t>(behind - bends.begin());
  if (i > 0) --i;
  if (direction < 0 && i > 0 && s <= bends[i].from) --i;
  return i;
}

// Calls look(way, bend) for the bends along one track from s on; `gone`: the distance to s. Returns the distance to the
// end of the track.
template <typename Look>
double AlongTrack(const Road& road, double s, double gone, double until, const Look& look) {
  const std::vector<Bend>& bends = road.track->bends;
  for (std::size_t i = BendAt(road, s, 1); i < bends.size(); ++i) {
    const double way = gone + std::max(0.0, bends[i].from - s);
    if (way > until) return until;
    look(way, bends[i]);
  }
  return gone + road.length - s;
}

template <typename Look>
double BackAlongTrack(const Road& road, double s, double gone, double until, const Look& look) {
  double way = gone;
  for (std::size_t i = BendAt(road, s, -1) + 1; i-- > 0;) {
    if (way > until) return until;
    look(way, road.track->bends[i]);
    way = gone + s - road.track->bends[i].from;
  }
  return gone + s;
}

// The same from a start to the end of its route; on a closed track to its end. Returns the distance covered.
template <typename Look>
double Along(const Network& network, const Start& start, double until, const Look& look) {
  const Road& road = network[start.route->first()];
  const double s = std::clamp(start.s, 0.0, road.length);
  double gone = start.direction > 0 ? AlongTrack(road, s, 0, until, look) : BackAlongTrack(road, s, 0, until, look);
  for (std::uint32_t i = 1; i < start.route->count && gone < until; ++i) {
    gone = AlongTrack(network[start.route->tracks[i]], 0, gone, until, look);
  }
  return gone;
}

}  // namespace

void Caps::Add(double way, double speed, const Bend& bend) noexcept {
  if (cut) return;
  if (count > 0) {
    Cap& last = of[count - 1];
    const bool passed = way <= last.way + kSlight;  // or too short to matter
    if (passed && count == 1 && way <= 0) {
      last = {last.way, speed, bend.curvature, bend.rate};
      return;
    }
    const bool alike = last.bends() == (bend.curvature > 0) && std::abs(last.speed - speed) <= kSlight * speed;
    if (passed || alike) {
      last = {last.way, std::min(last.speed, speed), std::max(last.curvature, bend.curvature),
              std::max(last.rate, bend.rate)};
      return;
    }
  }
  if (count == kCaps) {
    cut = true;
    return;
  }
  of[count++] = {way, speed, bend.curvature, bend.rate};
}

Caps CapsAhead(const Network& network, const Start& start, double until, const Pace& pace) noexcept {
  Caps caps;
  const auto add = [&](double way, const Bend& bend) { caps.Add(way, SpeedIn(bend, pace), bend); };
  double gone = Along(network, start, until, add);
  // A whole turn that adds no cap is like all turns after it: long motions round a circle have few caps.
  const Road& road = network[start.route->first()];
  std::size_t before = 0;
  while (road.closed && gone < until && !caps.cut && caps.count != before) {
    before = caps.count;
    gone = start.direction > 0 ? AlongTrack(road, 0, gone, until, add)
                               : BackAlongTrack(road, road.length, gone, until, add);
  }
  return caps;
}

bool IsStraight(const Network& network, const Start& start, double until) noexcept {
  if (network[start.route->first()].closed) return false;
  bool straight = true;
  Along(network, start, until, [&](double, const Bend& bend) { straight = straight && !(bend.curvature > 0); });
  return straight;
}

namespace {

// A position to be passed no faster than this, without acceleration.
struct Gate {
  double way = 0;
  double speed = 0;
};

// Returns the largest values between two times of a motion. The speed is largest at the ends, or where the acceleration
// changes from positive to negative.
Stress StressOf(const trajectory::Profile& plan, double begin, double end) {
  Stress most;
  most.speed = std::max({0.0, plan.At(begin).velocity, plan.At(end).velocity});
  double from = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(plan.size()); ++k) {
    const trajectory::Piece& piece = plan.pieces[k];
    const double to = plan.piece_ends_s[k], first = std::max(from, begin), last = std::min(to, end);
    if (first < last) {
      const double top = piece.jerk != 0 ? from - piece.acceleration / piece.jerk : first;
      for (const double t : {first, std::clamp(top, first, last), last}) {
        const KinematicState at = piece.At(t - from);
        most.speed = std::max(most.speed, at.velocity);
        most.acceleration = std::max(most.acceleration, std::abs(at.acceleration));
      }
      most.jerk = std::max(most.jerk, std::abs(piece.jerk));
    }
    from = to;
  }
  return most;
}

// Returns true if a motion keeps the caps up to its end, and its vectors within their maxima.
bool Keeps(const trajectory::Profile& plan, const Caps& caps, const Pace& pace) {
  const Stress all = StressOf(plan, 0, plan.duration());
  double least = std::numeric_limits<double>::infinity();
  Bend tightest;
  for (const Cap& cap : caps.all()) {
    if (!(cap.way < plan.end().position)) break;
    least = std::min(least, cap.speed);
    tightest = {0, std::max(tightest.curvature, cap.curvature), std::max(tightest.rate, cap.rate)};
  }
  // Rounding. Besides, the motion may keep a speed above the first cap that it starts with.
  const double allowance = 1e-9 * all.speed;
  if (all.speed <= least + allowance && KeepsVectors(tightest, all, pace)) return true;
  double begin = 0;
  for (std::size_t i = 0; i < caps.count && caps.of[i].way < plan.end().position; ++i) {
    if (caps.cut && i + 1 == caps.count) return true;  // the caps beyond are not known
    const double border = i + 1 < caps.count ? caps.of[i + 1].way : plan.end().position;
    const double end = border < plan.end().position ? plan.TimeAt(border, begin) : plan.duration();
    if (!(end >= begin)) return false;
    const Stress most = StressOf(plan, begin, end);
    const double allowed = i == 0 ? std::max(caps.of[0].speed, plan.start().velocity) : caps.of[i].speed;
    if (most.speed > allowed + allowance || !KeepsVectors(caps.of[i].bend(), most, pace)) return false;
    begin = end;
  }
  return true;
}

// Returns true if a mover that is faster than commanded still keeps its maxima in curves.
bool KeepsMost(const Network& network, const Start& start, const trajectory::Profile& plan, const Pace& pace,
               const Pace& most) {
  if (plan.VelocityRange().max <= pace.limits.velocity * (1 + kSlight)) return true;
  return Keeps(plan, CapsAhead(network, start, plan.PositionRange().max, most), most);
}

// Returns true if braking as commanded gets no faster than commanded, or than the current speed, and does not reverse.
bool StopsWithin(const Network& network, const Start& start, const trajectory::Profile& stop, const Pace& pace,
                 const Pace& most) {
  const trajectory::Profile::Range range = stop.VelocityRange();
  if (range.max > std::max(pace.limits.velocity, start.speed) * (1 + kSlight) || range.min < -1e-6) return false;
  return Keeps(stop, CapsAhead(network, start, stop.PositionRange().max, most), most);
}

// Returns the largest share that a mover may use throughout a stretch.
std::size_t ShareIn(const Cap& cap, const Pace& pace) {
  for (std::size_t share = 0; share + 1 < kShares.size(); ++share) {
    const trajectory::Limits limits = WithShare(pace.limits, pace, share);
    const Stress stress{cap.speed, std::max(limits.acceleration, limits.deceleration), limits.jerk};
    if (KeepsVectors(cap.bend(), stress, pace)) return share;
  }
  return kShares.size() - 1;
}

// Returns false if there is no such plan.
bool TryWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
            const Pace& most, trajectory::Profile& out, bool& ends) {
  if (!(way >= 0)) return false;
  const KinematicState from{0, start.speed, start.acceleration};
  ends = true;
  const Caps caps = CapsAhead(network, start, way, pace);

  std::array<Gate, kCaps + 1> gates{};
  const std::size_t count = caps.count;  // gate k is at the start of cap k + 1, the last one at the end
  for (std::size_t k = 0; k + 1 < count; ++k) {
    gates[k] = {caps.of[k + 1].way, std::min(caps.of[k].speed, caps.of[k + 1].speed)};
  }
  // Beyond the last cap that fits in nothing is known: the mover must be able to stop there, but does not.
  gates[count - 1] = {caps.cut ? caps.of[count - 1].way : way, 0};
  for (std::size_t k = count - 1; k-- > 0;) {
    const double room = gates[k + 1].way - gates[k].way;
    const Brakes brakes = WithShare(pace.brakes(), pace, ShareIn(caps.of[k + 1], pace));
    gates[k].speed = std::min(gates[k].speed, SpeedBefore(room, gates[k + 1].speed, brakes));
  }

  const double v = start.speed;
  // Less than its full dynamics only up to the end of the bend that it is in.
  const auto straight = std::ranges::find_if(caps.all(), [](const Cap& cap) { return !cap.bends(); });
  const auto bends = static_cast<std::size_t>(straight - caps.all().begin());
  const bool bounded = std::isfinite(pace.vector_jerk);
  for (std::size_t k = caps.cut ? count - 1 : count; k-- > 0;) {
    const Gate& gate = gates[k];
    // That speed cannot be reached by then.
    if (gate.speed * gate.speed > v * v + 2 * pace.limits.acceleration * gate.way + kSlight && k > 0) continue;
    if (gate.way <= 0 && k + 1 < count) break;
    for (std::size_t share = 0; share < (bounded && k < bends ? kShares.size() : 1); ++share) {
      trajectory::Limits limits = WithShare(pace.limits, pace, share);
      limits.velocity = 0;
      for (std::size_t i = 0; i <= k; ++i) limits.velocity = std::max(limits.velocity, caps.of[i].speed);
      limits.velocity = std::max(limits.velocity, gate.speed);
      trajectory::Profile plan;
      if (planner.ToPosition(from, gate.way, gate.speed, limits, plan).failed()) continue;
      // It would have to reverse: too near to stop, or too near to get so fast.
      const trajectory::Profile::Range range = plan.PositionRange();
      const bool on = range.min >= -1e-6 && range.max <= gate.way + 1e-6 && plan.VelocityRange().min >= -1e-9;
      if (on && Keeps(plan, caps, pace) && KeepsMost(network, start, plan, pace, most)) {
        out = plan;
        ends = k + 1 == count;
        return true;
      }
    }
  }
  // To the first gate at the highest possible speed, or slower from here on.
  for (std::size_t share = 0; share < (bounded && caps.of[0].bends() ? kShares.size() : 1); ++share) {
    const double cap = caps.of[0].speed;
    const Gate& gate = gates[0];
    trajectory::Limits limits = WithShare(pace.limits, pace, share);
    double low = 0, high = std::min(cap, gate.speed);
    limits.velocity = std::max(cap, high);
    bool found = false;
    for (int i = 0; i < 12; ++i) {
      const double speed = 0.5 * (low + high);
      trajectory::Profile plan;
      const bool planned = planner.ToPosition(from, gate.way, speed, limits, plan).ok();
      const bool on = planned && plan.PositionRange().max <= gate.way + 1e-6 && plan.VelocityRange().min >= -1e-9;
      if (on) {
        out = plan;
        found = true;
      }
      // Too fast to arrive slower, or too slow to arrive faster.
      const bool faster = on || (planned && plan.PositionRange().max > gate.way + 1e-6 && v > speed);
      (faster ? low : high) = speed;
    }
    ends = count == 1 && out.end().velocity == 0;
    if (found && Keeps(out, caps, pace) && KeepsMost(network, start, out, pace, most)) return true;
  }
  return false;
}

}  // namespace

Planned PlanWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
                const Pace& most, trajectory::Profile& out, bool& ends) noexcept {
  if (TryWay(planner, network, start, way, pace, most, out, ends)) return Planned::kWay;
  ends = false;
  const KinematicState from{0, start.speed, start.acceleration};
  if (planner.Stop(from, pace.limits, out).ok() && StopsWithin(network, start, out, pace, most)) return Planned::kStop;
  // An acceleration that would make it too fast is removed; otherwise it continues, no faster than it is.
  const double peak = start.speed + start.acceleration * start.acceleration / (2 * pace.limits.jerk);
  const bool speeds_up = start.acceleration > 0 && peak > std::max(pace.limits.velocity, start.speed) * (1 + kSlight);
  Pace hard = most;
  hard.limits.velocity = std::min(pace.limits.velocity, start.speed);
  if (!speeds_up && TryWay(planner, network, start, way, hard, most, out, ends)) return Planned::kHard;
  ends = false;
  if (planner.Stop(from, most.limits, out).failed()) out = trajectory::Profile(KinematicState{});
  return Planned::kHard;
}

namespace {

// Returns the delay [s] of a change of speed by the jerk limit.
double AddedByJerk(double change, double acceleration, double jerk) {
  const double ramp = acceleration / jerk;
  return change > acceleration * ramp ? ramp : 2 * std::sqrt(change / jerk) - change / acceleration;
}

// The time of a sequence of speeds, with the delay by the jerk limit for each stretch that only rises or only falls.
class SpeedTimes {
 public:
  SpeedTimes(const trajectory::Limits& limits, double speed) : limits_(limits), turned_at_(speed), speed_(speed) {}

  void To(double speed) {
    if ((speed - speed_) * (speed_ - turned_at_) < 0) Turn();
    time_ += std::abs(speed - speed_) / (speed > speed_ ? limits_.acceleration : limits_.deceleration);
    speed_ = speed;
  }
  double End() {
    Turn();
    return time_;
  }

 private:
  void Turn() {
    const double change = std::abs(speed_ - turned_at_);
    const double acceleration = speed_ > turned_at_ ? limits_.acceleration : limits_.deceleration;
    // The slower ramp covers distance as well, which is saved at the higher speed.
    const double share = change / (2 * std::max({speed_, turned_at_, 1e-9}));
    time_ += AddedByJerk(change, acceleration, limits_.jerk) * share;
    turned_at_ = speed_;
  }

  const trajectory::Limits& limits_;
  double turned_at_, speed_, time_ = 0;
};

}  // namespace

double EstimateTravelTime(const Network& network, const Start& start, double way, const Pace& pace) noexcept {
  const double up = 2 * pace.limits.acceleration, down = 2 * pace.limits.deceleration;
  SpeedTimes ramps(pace.limits, start.speed);
  Route route = *start.route;
  Start from = start;
  from.route = &route;
  constexpr int kMostParts = 16;
  double cruise = 0, square = start.speed * start.speed, remaining = way;
  for (int part = 0; part < kMostParts && remaining > 0; ++part) {
    from.s -= LeaveBehind(network, from.s, route);
    const Caps caps = CapsAhead(network, from, remaining, pace);
    const bool ends = !caps.cut;
    // More caps than fit into Caps: up to the last one, and on from there.
    const std::size_t count = ends ? caps.count : caps.count - 1;
    const double known = ends ? remaining : caps.of[count].way;
    const auto length = [&](std::size_t k) { return (k + 1 < count ? caps.of[k + 1].way : known) - caps.of[k].way; };
    const auto cap = [&](std::size_t k) { return caps.of[k].speed * caps.of[k].speed; };
    std::array<double, kCaps + 1> squares;  // of the speeds at the borders
    squares[count] = ends ? 0 : std::min(cap(count - 1), cap(count));
    for (std::size_t k = count; k-- > 1;) {
      squares[k] = std::min({cap(k - 1), cap(k), squares[k + 1] + down * length(k)});
    }
    squares[0] = square;
    for (std::size_t k = 0; k < count; ++k) {
      const double before = squares[k];
      const double behind = squares[k + 1] = std::min(squares[k + 1], before + up * length(k));
      const double peak = std::clamp((up * (behind + down * length(k)) + down * before) / (up + down),
                                     std::max(before, behind), std::max({cap(k), before, behind}));
      const double level = length(k) - (peak - before) / up - (peak - behind) / down;
      if (level > 0 && peak > 0) cruise += level / std::sqrt(peak);
      ramps.To(std::sqrt(peak));
      ramps.To(std::sqrt(behind));
    }
    square = squares[count];
    if (!(known > 0)) break;
    remaining -= known;
    from.s += from.direction * known;
  }
  const double time = cruise + ramps.End();
  return way > remaining ? time * way / (way - remaining) : time;
}

}  // namespace takt::planar
