#include "takt/mover/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/planar/braking.h"

namespace takt::mover {

namespace {

using trajectory::Limits;
using trajectory::Planner;
using trajectory::Profile;

constexpr double kNothing = 1e-9;  // of a limit: below, no motion across
constexpr int kTriedShares = 8;    // number of shares tried
constexpr int kTries = 4;          // number of distances before a corner tried
constexpr int kWayHalvings = 30;   // bisections of a distance

struct Direction {
  double x = 1, y = 0;
};

// A state seen in a frame with this direction.
struct Framed {
  KinematicState along, across;
};

Framed InFrame(const PlaneState& s, const Direction& d, double origin_x, double origin_y) {
  const auto along = [&](double x, double y) { return d.x * x + d.y * y; };
  const auto across = [&](double x, double y) { return d.x * y - d.y * x; };
  const double x = s.x.position - origin_x, y = s.y.position - origin_y;
  return {{along(x, y), along(s.x.velocity, s.y.velocity), along(s.x.acceleration, s.y.acceleration)},
          {across(x, y), across(s.x.velocity, s.y.velocity), across(s.x.acceleration, s.y.acceleration)}};
}
// With the origin at its position.
Framed InFrame(const PlaneState& s, const Direction& d) {
  return InFrame(s, d, s.x.position, s.y.position);
}

std::optional<Direction> DirectionOf(double x, double y) {
  const double length = maths::Hypot(x, y);
  if (!(length > 0)) return std::nullopt;
  return Direction{x / length, y / length};
}

// Returns the velocity at which a ramp-down of the acceleration, begun at once, ends.
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

// Returns true if a coordinate can begin in this state with this share of the limits, and stay within them.
bool Fits(const KinematicState& s, double share, const Limits& l) {
  constexpr double kRounding = 1 + 1e-9;
  const double velocity = kRounding * share * l.velocity;
  return std::abs(s.velocity) <= velocity && std::abs(s.acceleration) <= kRounding * share * l.acceleration &&
         std::abs(Unavoidable(s, share * l.jerk)) <= velocity;
}

double Least(const KinematicState& s, const Limits& l) {
  return std::max(std::abs(s.velocity) / l.velocity, std::abs(s.acceleration) / l.acceleration);
}

// Plans onto the line to a point at `distance` [mm], with this share across.
bool PlanOntoLine(Planner& planner, const Framed& from, double distance, double share, const Limits& limits,
                  PlaneMotion& motion) {
  const double rest = std::sqrt(std::max(0.0, 1 - share * share));
  if (!Fits(from.across, share, limits) || !Fits(from.along, rest, limits)) return false;
  motion.share = share;
  if (!planner.ToPosition(from.along, distance, 0, ShareOf(rest, limits), motion.along).ok()) return false;
  if (share == 0) return true;
  if (!planner.ToPosition(from.across, 0, 0, ShareOf(share, limits), motion.across).ok()) return false;
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

Limits LimitsOfEach(const Limits& maximum) noexcept {
  Limits even = maximum;
  even.acceleration = even.deceleration = std::min(maximum.acceleration, maximum.deceleration);
  return ShareOf(kEach, even);
}

bool FitsEach(const PlaneState& at, const Limits& each) noexcept {
  return Fits(at.x, 1, each) && Fits(at.y, 1, each);
}

PlaneMotion MotionOfEach(const Profile& x, const Profile& y) noexcept {
  PlaneMotion motion;
  motion.share = kEach;
  motion.along = x;
  motion.across = y;
  motion.end_x = x.end().position;
  motion.end_y = y.end().position;
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

double BesideLine(const PlaneMotion& m) noexcept {
  if (m.across.duration() == 0) return 0;
  const Profile::Range along = m.along.PositionRange(), across = m.across.PositionRange();
  const double end = m.along.end().position;
  return across.max - across.min + std::max(0.0, along.max - std::max(0.0, end)) +
         std::max(0.0, std::min(0.0, end) - along.min);
}

double SpeedBound(const PlaneMotion& m) noexcept {
  const auto largest = [](const Profile& p) {
    const Profile::Range range = p.VelocityRange();
    return std::max(std::abs(range.min), std::abs(range.max));
  };
  if (m.share == 0) return largest(m.along);
  Profile beside = m.along;
  beside.Cut(m.across.duration());
  return std::max(largest(m.along), maths::Hypot(largest(beside), largest(m.across)));
}

bool PlanMove(Planner& planner, const PlaneState& from, double x, double y, const Limits& limits,
              PlaneMotion& out) noexcept {
  const double way_x = x - from.x.position;
  const double way_y = y - from.y.position;
  const double distance = maths::Hypot(way_x, way_y);
  auto direction = DirectionOf(way_x, way_y);
  if (!direction) direction = DirectionOf(from.x.velocity, from.y.velocity);
  if (!direction) direction = DirectionOf(from.x.acceleration, from.y.acceleration);
  const Framed framed = InFrame(from, direction.value_or(Direction{}));
  PlaneMotion best = Begin(from, direction.value_or(Direction{}));
  bool found = false;
  if (Negligible(framed.across, limits)) {
    found = planner.ToPosition(framed.along, distance, 0, limits, best.along).ok();
  } else {
    Limits even = limits;  // one profile brakes while the other accelerates
    even.acceleration = even.deceleration = std::min(limits.acceleration, limits.deceleration);
    const double least = Least(framed.across, even);
    const double most = std::sqrt(std::max(0.0, 1 - maths::Power(Least(framed.along, even), 2)));
    for (int i = 0; i < kTriedShares; ++i) {
      PlaneMotion motion = Begin(from, *direction);
      const double share = least + (std::max(most, least) - least) * i / (kTriedShares - 1);
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

bool PlanRound(Planner& planner, const PlaneState& from, const PlaneState& corner, double x, double y, double share,
               const Limits& limits, PlaneMotion& out) noexcept {
  const double way_x = x - corner.x.position, way_y = y - corner.y.position;
  const auto direction = DirectionOf(way_x, way_y);
  if (!direction) return false;
  const Framed framed = InFrame(from, *direction, corner.x.position, corner.y.position);
  PlaneMotion motion = Begin(corner, *direction);
  if (!PlanOntoLine(planner, framed, maths::Hypot(way_x, way_y), share, limits, motion)) return false;
  motion.end_x = x;
  motion.end_y = y;
  out = motion;
  return true;
}

bool PlanCorner(Planner& planner, double x, double y, double most, const Limits& limits, const Limits& then, double t,
                PlaneMotion& motion, Corner& best) noexcept {
  const PlaneState corner{{motion.end_x, 0, 0}, {motion.end_y, 0, 0}};
  const auto direction = DirectionOf(x - motion.end_x, y - motion.end_y);
  // The rest of the first line once the motion across is over.
  const double on_line = std::max(t, motion.across.duration());
  const double end = motion.along.end().position;
  if (!direction || on_line >= motion.along.duration()) return false;
  Profile head = motion.along;
  head.Cut(on_line);
  const double left = end - head.end().position;
  if (left <= 0) return false;
  const double cosine = motion.direction_x * direction->x + motion.direction_y * direction->y;
  const double sine = std::abs(motion.direction_x * direction->y - motion.direction_y * direction->x);
  Limits even = then;
  even.acceleration = even.deceleration = std::min(then.acceleration, then.deceleration);
  const double angle = maths::Atan2(sine, std::abs(cosine));
  bool found = false;
  double least = 0;
  PlaneMotion passing;
  // If the mover is already too fast to slow down that far before the corner, shorter distances are tried.
  for (int i = 0; i < kTries * (kTriedShares + 1); ++i) {
    const int part = i % (kTriedShares + 1);
    if (part == 0 && found) break;
    if (part == 0 && i > 0) most *= 0.4;
    const maths::SineCosine heading = maths::SinCos(angle * part / kTriedShares);
    const double share = heading.sine, rest = heading.cosine;
    if (sine > kNothing ? part == 0 || rest < 0.05 : part > 0) continue;
    const auto brakes = [](double part, const Limits& l) {
      return planar::Brakes{part * l.deceleration, part * l.jerk};
    };
    double highest = std::min(limits.velocity, then.velocity);
    if (sine > kNothing) highest = std::min(highest, share * then.velocity / sine);
    if (std::abs(cosine) > kNothing) highest = std::min(highest, rest * then.velocity / std::abs(cosine));
    // The speed at a distance before the corner from which the mover can stop at the corner, stop its motion across
    // before the second line, and stop its motion against the direction of that line.
    const auto allowed = [&](double way) {
      double speed = std::min(highest, planar::SpeedForDistance(way, brakes(1, limits)));
      if (sine > kNothing) speed = std::min(speed, planar::SpeedForDistance(way * sine, brakes(share, even)) / sine);
      if (cosine < -kNothing)
        speed = std::min(speed, planar::SpeedForDistance(-way * cosine, brakes(rest, even)) / -cosine);
      return speed;
    };
    const double now = std::max(0.0, head.end().velocity);
    const auto reached = [&](double way) {
      return planar::SpeedBefore(left - way, now, {limits.acceleration, limits.jerk});
    };
    // Further away the allowed speed is higher, but the distance to reach it is shorter.
    double before = std::min(most, left), nearer = 0;
    for (int k = 0; k < kWayHalvings && reached(before) < allowed(before); ++k) {
      const double middle = 0.5 * (nearer + before);
      (reached(middle) < allowed(middle) ? before : nearer) = middle;
    }
    const double speed = std::min(allowed(before), reached(before)) * (1 - 1e-6);
    if (before <= 0 || speed <= 0) continue;
    PlaneMotion first = motion, second;
    Profile tail;
    if (!planner.ToPosition(head.end(), end - before, speed, limits, tail).ok()) continue;
    if (tail.VelocityRange().min < 0 || tail.PositionRange().max > end - before + 1e-6) continue;
    first.along = head;
    if (!first.along.Append(tail)) continue;
    const PlaneState from{{corner.x.position - motion.direction_x * before, motion.direction_x * speed, 0},
                          {corner.y.position - motion.direction_y * before, motion.direction_y * speed, 0}};
    if (!PlanRound(planner, from, corner, x, y, share, even, second)) continue;
    const double takes = first.along.duration() + DurationOf(second);
    if (found && takes >= least) continue;
    found = true;
    least = takes;
    passing = first;
    best = {before, speed, share};
  }
  if (found) motion = passing;
  return found;
}

bool PlanRest(Planner& planner, const PlaneMotion& motion, double t, const Limits& limits, PlaneMotion& out) noexcept {
  const PlaneState from = At(motion, t);
  // A stop from a curved motion, not a change from one line to another.
  if (motion.share == 0 && t < motion.across.duration()) return PlanRest(planner, from, limits, out);
  PlaneMotion rest = Begin(from, {motion.direction_x, motion.direction_y});
  rest.share = t < motion.across.duration() ? motion.share : 0;
  if (t < DurationOf(motion)) {
    const auto begin = [&](const Profile& profile) {
      KinematicState s = profile.At(t);
      s.position = 0;
      return s;
    };
    const double along = std::sqrt(1 - rest.share * rest.share);
    if (!planner.Stop(begin(motion.along), ShareOf(along, limits), rest.along).ok()) return false;
    if (rest.share > 0) {
      if (!planner.Stop(begin(motion.across), ShareOf(rest.share, limits), rest.across).ok()) return false;
      // The motion itself may use the full limits once across is over; without them, the stop would lead beyond its
      // end.
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
  const double a = maths::Hypot(from.x.acceleration, from.y.acceleration);
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
  d.internal<&P::origin_x>(unit::mm, "X of the start.");
  d.internal<&P::origin_y>(unit::mm, "Y of the start.");
  d.internal<&P::direction_x>(unit::one, "X of the unit vector of the motion along.");
  d.internal<&P::direction_y>(unit::one, "Y of the unit vector of the motion along.");
  d.internal<&P::share>(unit::one, "Share of the limits for the motion across.");
  d.internal<&P::end_x>(unit::mm, "X of the end.");
  d.internal<&P::end_y>(unit::mm, "Y of the end.");
  d.internal<&P::along>("Motion along the direction.");
  d.internal<&P::across>("Motion across the direction, to its left.");
}

}  // namespace takt::mover
