#include "takt/mover/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "takt/core/describe.h"

namespace takt::mover {

namespace {

using trajectory::Limits;
using trajectory::Planner;
using trajectory::Profile;

constexpr double kNothing = 1e-9;  // of a limit: nothing across
constexpr int kShares = 8;         // that are tried

struct Direction {
  double x = 1, y = 0;
};

// A state seen in a frame with this direction, from where it is.
struct Framed {
  KinematicState along, across;
};

Framed InFrame(const PlaneState& s, const Direction& d) {
  const auto along = [&](double x, double y) { return d.x * x + d.y * y; };
  const auto across = [&](double x, double y) { return d.x * y - d.y * x; };
  return {{0, along(s.x.velocity, s.y.velocity), along(s.x.acceleration, s.y.acceleration)},
          {0, across(s.x.velocity, s.y.velocity), across(s.x.acceleration, s.y.acceleration)}};
}

std::optional<Direction> DirectionOf(double x, double y) {
  const double length = std::hypot(x, y);
  if (!(length > 0)) return std::nullopt;
  return Direction{x / length, y / length};
}

Limits Times(double share, const Limits& l) {
  return {share * l.velocity, share * l.acceleration, share * l.deceleration, share * l.jerk};
}

// Where a velocity ends when the acceleration is taken away at once.
double Unavoidable(const KinematicState& s, double jerk) {
  return s.velocity + s.acceleration * std::abs(s.acceleration) / (2 * jerk);
}

bool Negligible(const KinematicState& s, const Limits& l) {
  return std::abs(s.velocity) <= kNothing * l.velocity && std::abs(s.acceleration) <= kNothing * l.acceleration;
}

PlaneMotion Begin(const PlaneState& from, const Direction& d) {
  PlaneMotion motion = StandingAt(from.x.position, from.y.position);
  motion.direction_x = d.x;
  motion.direction_y = d.y;
  return motion;
}

void PutEnd(PlaneMotion& m) {
  const double along = m.along.end().position;
  const double across = m.across.end().position;
  m.end_x = m.origin_x + m.direction_x * along - m.direction_y * across;
  m.end_y = m.origin_y + m.direction_y * along + m.direction_x * across;
}

// Whether a coordinate can begin so with this share of the limits, and stay within them.
bool Fits(const KinematicState& s, double share, const Limits& l) {
  constexpr double kRounding = 1 + 1e-9;
  const double velocity = kRounding * share * l.velocity;
  return std::abs(s.velocity) <= velocity && std::abs(s.acceleration) <= kRounding * share * l.acceleration &&
         std::abs(Unavoidable(s, share * l.jerk)) <= velocity;
}

double Least(const KinematicState& s, const Limits& l) {
  return std::max(std::abs(s.velocity) / l.velocity, std::abs(s.acceleration) / l.acceleration);
}

// Onto the line to a place `distance` away with this share across.
bool PlanOntoLine(Planner& planner, const Framed& from, double distance, double share, const Limits& limits,
                  PlaneMotion& motion) {
  const double rest = std::sqrt(std::max(0.0, 1 - share * share));
  if (!Fits(from.across, share, limits) || !Fits(from.along, rest, limits)) return false;
  motion.share = share;
  if (!planner.ToPosition(from.along, distance, 0, Times(rest, limits), motion.along).ok() ||
      !planner.ToPosition(from.across, 0, 0, Times(share, limits), motion.across).ok()) {
    return false;
  }
  const double alone = motion.across.duration();
  Profile quicker = motion.along;
  quicker.Cut(alone);
  Profile then;
  if (alone < motion.along.duration() && planner.ToPosition(quicker.end(), distance, 0, limits, then).ok() &&
      quicker.Append(then)) {
    motion.along = quicker;
  }
  return true;
}

}  // namespace

PlaneMotion StandingAt(double x, double y) noexcept {
  PlaneMotion motion;
  motion.origin_x = motion.end_x = x;
  motion.origin_y = motion.end_y = y;
  return motion;
}

double DurationOf(const PlaneMotion& m) noexcept {
  return std::max(m.along.duration(), m.across.duration());
}

PlaneState At(const PlaneMotion& m, double t) noexcept {
  if (t >= DurationOf(m)) return {{m.end_x, 0, 0}, {m.end_y, 0, 0}};
  const KinematicState u = m.along.At(t);
  const KinematicState w = m.across.At(t);
  const double dx = m.direction_x;
  const double dy = m.direction_y;
  return {{m.origin_x + dx * u.position - dy * w.position, dx * u.velocity - dy * w.velocity,
           dx * u.acceleration - dy * w.acceleration},
          {m.origin_y + dy * u.position + dx * w.position, dy * u.velocity + dx * w.velocity,
           dy * u.acceleration + dx * w.acceleration}};
}

double SpeedBound(const PlaneMotion& m) noexcept {
  const auto largest = [](const Profile& p) {
    const Profile::Range range = p.VelocityRange();
    return std::max(std::abs(range.min), std::abs(range.max));
  };
  if (m.share == 0) return largest(m.along);
  Profile beside = m.along;
  beside.Cut(m.across.duration());
  return std::max(largest(m.along), std::hypot(largest(beside), largest(m.across)));
}

bool PlanMove(Planner& planner, const PlaneState& from, double x, double y, const Limits& limits,
              PlaneMotion& out) noexcept {
  const double way_x = x - from.x.position;
  const double way_y = y - from.y.position;
  const double distance = std::hypot(way_x, way_y);
  auto direction = DirectionOf(way_x, way_y);
  if (!direction) direction = DirectionOf(from.x.velocity, from.y.velocity);
  if (!direction) direction = DirectionOf(from.x.acceleration, from.y.acceleration);
  const Framed framed = InFrame(from, direction.value_or(Direction{}));
  PlaneMotion best = Begin(from, direction.value_or(Direction{}));
  bool found = false;
  if (Negligible(framed.across, limits)) {
    found = planner.ToPosition(framed.along, distance, 0, limits, best.along).ok();
  } else {
    Limits even = limits;  // one profile brakes while the other speeds up
    even.acceleration = even.deceleration = std::min(limits.acceleration, limits.deceleration);
    const double least = Least(framed.across, even);
    const double most = std::sqrt(std::max(0.0, 1 - std::pow(Least(framed.along, even), 2)));
    for (int i = 0; i < kShares; ++i) {
      PlaneMotion motion = Begin(from, *direction);
      const double share = least + (std::max(most, least) - least) * i / (kShares - 1);
      if (!(share < 1) || !PlanOntoLine(planner, framed, distance, share, even, motion)) continue;
      if (!found || DurationOf(motion) < DurationOf(best)) best = motion;
      found = true;
    }
  }
  if (!found) return false;
  best.end_x = x;
  best.end_y = y;
  out = best;
  return true;
}

bool PlanRest(Planner& planner, const PlaneMotion& motion, double t, const Limits& limits, PlaneMotion& out) noexcept {
  const PlaneState from = At(motion, t);
  PlaneMotion rest = Begin(from, {motion.direction_x, motion.direction_y});
  rest.share = t < motion.across.duration() ? motion.share : 0;
  if (t < DurationOf(motion)) {
    const auto begin = [&](const Profile& profile) {
      KinematicState s = profile.At(t);
      s.position = 0;
      return s;
    };
    const double along = std::sqrt(1 - rest.share * rest.share);
    if (!planner.Stop(begin(motion.along), Times(along, limits), rest.along).ok()) return false;
    if (rest.share > 0) {
      if (!planner.Stop(begin(motion.across), Times(rest.share, limits), rest.across).ok()) return false;
      // As the motion itself may have reckoned with: else this would lead beyond its end.
      Profile harder = rest.along, then;
      harder.Cut(rest.across.duration());
      if (rest.across.duration() < rest.along.duration() && planner.Stop(harder.end(), limits, then).ok() &&
          harder.Append(then)) {
        rest.along = harder;
      }
    }
    PutEnd(rest);
  }
  out = rest;
  return true;
}

bool PlanRest(Planner& planner, const PlaneState& from, const Limits& limits, PlaneMotion& out) noexcept {
  const double a = std::hypot(from.x.acceleration, from.y.acceleration);
  const auto of_velocity = DirectionOf(from.x.velocity, from.y.velocity);
  Direction direction =
      of_velocity.value_or(DirectionOf(from.x.acceleration, from.y.acceleration).value_or(Direction{}));
  Framed framed = InFrame(from, direction);
  if (Negligible(framed.across, limits)) {
    PlaneMotion rest = Begin(from, direction);
    if (!planner.Stop(framed.along, limits, rest.along).ok()) return false;
    PutEnd(rest);
    out = rest;
    return true;
  }
  const double time = a / limits.jerk;
  const auto then = DirectionOf(from.x.velocity + 0.5 * time * from.x.acceleration,
                                from.y.velocity + 0.5 * time * from.y.acceleration);
  direction = then.value_or(direction);
  framed = InFrame(from, direction);
  PlaneMotion rest = Begin(from, direction);
  rest.along = Profile{framed.along, framed.along};
  rest.across = Profile{framed.across, framed.across};
  rest.along.Append(time, -framed.along.acceleration / time);
  rest.across.Append(time, -framed.across.acceleration / time);
  rest.across.SnapEnd({rest.across.end().position, 0, 0});
  rest.along.SnapEnd({rest.along.end().position, rest.along.end().velocity, 0});
  Profile stop;
  if (!planner.Stop(rest.along.end(), limits, stop).ok() || !rest.along.Append(stop)) return false;
  PutEnd(rest);
  out = rest;
  return true;
}

void describe(Description<PlaneMotion>& d) {
  using P = PlaneMotion;
  d.about("A motion of X and Y.");
  d.internal<&P::origin_x>(unit::mm, "Where it begins.");
  d.internal<&P::origin_y>(unit::mm, "Where it begins.");
  d.internal<&P::direction_x>(unit::one, "Of along.");
  d.internal<&P::direction_y>(unit::one, "Of along.");
  d.internal<&P::share>(unit::one, "Of the limits, across.");
  d.internal<&P::end_x>(unit::mm, "Where it ends.");
  d.internal<&P::end_y>(unit::mm, "Where it ends.");
  d.internal<&P::along>("Along the direction.");
  d.internal<&P::across>("To the left of it.");
}

}  // namespace takt::mover
