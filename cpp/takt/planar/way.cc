#include "takt/planar/way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace takt::planar {
namespace {

constexpr double kSlight = 1e-9;  // share of a speed, or mm

double SpeedIn(const Bend& bend, const Pace& pace) {
  const double most = pace.limits.velocity;
  return bend.curvature > 0 ? std::min(most, std::sqrt(pace.lateral / bend.curvature)) : most;
}

// The number of the bend that s lies in; at a border, that on the far side.
std::size_t BendAt(const Road& road, double s, std::int8_t direction) {
  const std::vector<Bend>& bends = road.track->bends;
  const auto behind = std::ranges::upper_bound(bends, s, {}, &Bend::from);
  auto i = static_cast<std::size_t>(behind - bends.begin());
  if (i > 0) --i;
  if (direction < 0 && i > 0 && s <= bends[i].from) --i;
  return i;
}

// Along one track from s on; `gone`: the way to there. Returns the way to its end.
double AlongTrack(const Road& road, double s, double gone, double until, const Pace& pace, Caps& caps) {
  const std::vector<Bend>& bends = road.track->bends;
  for (std::size_t i = BendAt(road, s, 1); i < bends.size(); ++i) {
    const double way = gone + std::max(0.0, bends[i].from - s);
    if (way > until) return until;
    caps.Add(way, SpeedIn(bends[i], pace));
  }
  return gone + road.length - s;
}

double BackAlongTrack(const Road& road, double s, double gone, double until, const Pace& pace, Caps& caps) {
  double way = gone;
  for (std::size_t i = BendAt(road, s, -1) + 1; i-- > 0;) {
    if (way > until) return until;
    caps.Add(way, SpeedIn(road.track->bends[i], pace));
    way = gone + s - road.track->bends[i].from;
  }
  return gone + s;
}

}  // namespace

void Caps::Add(double way, double speed) noexcept {
  if (cut) return;
  if (count > 0 && std::abs(of[count - 1].speed - speed) <= kSlight * speed) return;
  // What was passed already, or is too short to be seen.
  if (count > 0 && way <= of[count - 1].way + kSlight) {
    of[count - 1].speed = count == 1 && way <= 0 ? speed : std::min(of[count - 1].speed, speed);
    return;
  }
  if (count == kCaps) {
    cut = true;
    return;
  }
  of[count++] = {way, speed};
}

Caps CapsAhead(const Network& network, const Start& start, double until, const Pace& pace) noexcept {
  Caps caps;
  const Road& road = network[start.route->first()];
  const double s = std::clamp(start.s, 0.0, road.length);
  double gone =
      start.direction > 0 ? AlongTrack(road, s, 0, until, pace, caps) : BackAlongTrack(road, s, 0, until, pace, caps);
  for (std::uint32_t i = 1; i < start.route->count && gone < until; ++i) {
    gone = AlongTrack(network[start.route->tracks[i]], 0, gone, until, pace, caps);
  }
  while (road.closed && gone < until && !caps.cut) {
    gone = start.direction > 0 ? AlongTrack(road, 0, gone, until, pace, caps)
                               : BackAlongTrack(road, road.length, gone, until, pace, caps);
  }
  return caps;
}

namespace {

// A place that is to be passed no faster than this, without acceleration.
struct Gate {
  double way = 0;
  double speed = 0;
};

// Whether a motion keeps to the caps up to its end. Speeds are looked at where they are largest: at borders, and where
// the motion turns from faster to slower.
bool Keeps(const trajectory::Profile& plan, const Caps& caps) {
  const double fastest = plan.VelocityRange().max;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < caps.count && caps.of[i].way < plan.end().position; ++i) {
    least = std::min(least, caps.of[i].speed);
  }
  // What it began with too fast it may keep.
  const double allowance = 1e-9 * fastest;
  if (fastest <= least + allowance) return true;
  double begin = 0;
  for (std::size_t i = 0; i < caps.count && caps.of[i].way < plan.end().position; ++i) {
    if (caps.cut && i + 1 == caps.count) return true;  // what comes is not known
    const double border = i + 1 < caps.count ? caps.of[i + 1].way : plan.end().position;
    const double end = border < plan.end().position ? plan.TimeAt(border, begin) : plan.duration();
    if (!(end >= begin)) return false;
    double most = std::max(plan.At(begin).velocity, plan.At(end).velocity);
    for (int k = 0; k < plan.size(); ++k) {
      const double from = k == 0 ? 0 : plan.piece_ends_s[static_cast<std::size_t>(k - 1)];
      const trajectory::Piece& piece = plan.pieces[static_cast<std::size_t>(k)];
      const double to = plan.piece_ends_s[static_cast<std::size_t>(k)];
      for (const double t : {from, piece.jerk != 0 ? from - piece.acceleration / piece.jerk : from}) {
        if (t >= from && t <= to && t > begin && t < end) most = std::max(most, plan.At(t).velocity);
      }
    }
    const double allowed = i == 0 ? std::max(caps.of[0].speed, plan.start().velocity) : caps.of[i].speed;
    if (most > allowed + allowance) return false;
    begin = end;
  }
  return true;
}

// One that is faster than it was told to be must still not take a curve too fast.
bool KeepsMost(const Network& network, const Start& start, const trajectory::Profile& plan, const Pace& pace,
               const Pace& most) {
  if (plan.VelocityRange().max <= pace.limits.velocity * (1 + kSlight)) return true;
  return Keeps(plan, CapsAhead(network, start, plan.PositionRange().max, most));
}

// Braking as it was told to it gets no faster than that, or than it is, and does not go back.
bool StopsWithin(const Network& network, const Start& start, const trajectory::Profile& stop, const Pace& pace,
                 const Pace& most) {
  const trajectory::Profile::Range range = stop.VelocityRange();
  if (range.max > std::max(pace.limits.velocity, start.speed) * (1 + kSlight) || range.min < -1e-6) return false;
  return Keeps(stop, CapsAhead(network, start, stop.PositionRange().max, most));
}

// False: there is no such plan.
bool TryWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
            const Pace& most, trajectory::Profile& out, bool& ends) {
  if (!(way >= 0)) return false;
  const KinematicState from{0, start.speed, start.acceleration};
  const Brakes brakes = pace.brakes();
  ends = true;
  const Caps caps = CapsAhead(network, start, way, pace);

  std::array<Gate, kCaps + 1> gates{};
  const std::size_t count = caps.count;  // gate k is where cap k + 1 begins, the last one the end
  for (std::size_t k = 0; k + 1 < count; ++k) {
    gates[k] = {caps.of[k + 1].way, std::min(caps.of[k].speed, caps.of[k + 1].speed)};
  }
  // What comes behind the last cap that there is room for is not known: it must be able to stop there, but does not.
  gates[count - 1] = {caps.cut ? caps.of[count - 1].way : way, 0};
  for (std::size_t k = count - 1; k-- > 0;) {
    const double room = gates[k + 1].way - gates[k].way;
    gates[k].speed = std::min(gates[k].speed, SpeedBefore(room, gates[k + 1].speed, brakes));
  }

  trajectory::Limits limits = pace.limits;
  const double v = start.speed;
  for (std::size_t k = caps.cut ? count - 1 : count; k-- > 0;) {
    const Gate& gate = gates[k];
    // Not to be reached that fast.
    if (gate.speed * gate.speed > v * v + 2 * limits.acceleration * gate.way + kSlight && k > 0) continue;
    if (gate.way <= 0 && k + 1 < count) break;
    limits.velocity = 0;
    for (std::size_t i = 0; i <= k; ++i) limits.velocity = std::max(limits.velocity, caps.of[i].speed);
    limits.velocity = std::max(limits.velocity, gate.speed);
    trajectory::Profile plan;
    if (planner.ToPosition(from, gate.way, gate.speed, limits, plan).failed()) continue;
    // It would have to run back: too near to stop, or too near to get so fast.
    const trajectory::Profile::Range range = plan.PositionRange();
    const bool straight = range.min >= -1e-6 && range.max <= gate.way + 1e-6 && plan.VelocityRange().min >= -1e-9;
    if (straight && Keeps(plan, caps) && KeepsMost(network, start, plan, pace, most)) {
      out = plan;
      ends = k + 1 == count;
      return true;
    }
  }
  // Up to the first gate as fast as may be, or slower from here on.
  const double cap = caps.of[0].speed;
  const Gate& gate = gates[0];
  double low = 0, high = std::min(cap, gate.speed);
  limits.velocity = std::max(cap, high);
  bool found = false;
  for (int i = 0; i < 12; ++i) {
    const double speed = 0.5 * (low + high);
    trajectory::Profile plan;
    const bool planned = planner.ToPosition(from, gate.way, speed, limits, plan).ok();
    const bool straight = planned && plan.PositionRange().max <= gate.way + 1e-6 && plan.VelocityRange().min >= -1e-9;
    if (straight) {
      out = plan;
      found = true;
    }
    // Too fast to get there slower, or too slow to get there faster.
    const bool faster = straight || (planned && plan.PositionRange().max > gate.way + 1e-6 && v > speed);
    (faster ? low : high) = speed;
  }
  ends = count == 1 && out.end().velocity == 0;
  return found && Keeps(out, caps) && KeepsMost(network, start, out, pace, most);
}

}  // namespace

Planned PlanWay(trajectory::Planner& planner, const Network& network, const Start& start, double way, const Pace& pace,
                const Pace& most, trajectory::Profile& out, bool& ends) noexcept {
  if (TryWay(planner, network, start, way, pace, most, out, ends)) return Planned::kWay;
  ends = false;
  const KinematicState from{0, start.speed, start.acceleration};
  if (planner.Stop(from, pace.limits, out).ok() && StopsWithin(network, start, out, pace, most)) return Planned::kStop;
  // What would make it too fast is taken away; else it goes on, no faster than it is.
  const double peak = start.speed + start.acceleration * start.acceleration / (2 * pace.limits.jerk);
  const bool speeds_up = start.acceleration > 0 && peak > std::max(pace.limits.velocity, start.speed) * (1 + kSlight);
  Pace hard = most;
  hard.limits.velocity = std::min(pace.limits.velocity, start.speed);
  if (!speeds_up && TryWay(planner, network, start, way, hard, most, out, ends)) return Planned::kHard;
  ends = false;
  if (planner.Stop(from, most.limits, out).failed()) out = trajectory::Profile(KinematicState{});
  return Planned::kHard;
}

}  // namespace takt::planar
