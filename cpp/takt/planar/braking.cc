#include "takt/planar/braking.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/trajectory/ramp.h"

namespace takt::planar {
namespace {

constexpr double kRounding = 1e-15;  // relative accuracy of a root

// Returns the piece of a braking at t, and makes t relative to its start; null: at rest.
const trajectory::Piece* PieceAt(const Braking& b, double& t) {
  double begin = 0;
  for (std::size_t i = 0; i < b.pieces.size(); ++i) {
    if (t < b.ends_s[i]) {
      t -= begin;
      return &b.pieces[i];
    }
    begin = b.ends_s[i];
  }
  return nullptr;
}

trajectory::Piece From(const Braking& b, double t) {
  const trajectory::Piece* piece = PieceAt(b, t);
  if (!piece) return {b.rest, 0, 0, 0};
  const KinematicState at = piece->At(t);
  return {at.position, at.velocity, at.acceleration, piece->jerk};
}

// Returns the least position of a piece during `duration`.
double LeastOf(const trajectory::Piece& piece, double duration) {
  double least = std::min(piece.position, piece.At(duration).position);
  for (const double t : piece.VelocityZeros()) {
    if (t > 0 && t < duration) least = std::min(least, piece.At(t).position);
  }
  return least;
}

}  // namespace

KinematicState Braking::At(double t) const noexcept {
  const trajectory::Piece* piece = PieceAt(*this, t);
  return piece ? piece->At(t) : KinematicState{rest, 0, 0};
}

Braking Brake(const KinematicState& from, const Brakes& brakes) noexcept {
  Braking out;
  KinematicState at = from;
  double time = 0;
  out.lowest = out.highest = from.position;
  const trajectory::Ramp ramp = trajectory::QuickestRamp(from.velocity, from.acceleration, 0,
                                                         {brakes.deceleration, brakes.deceleration, brakes.jerk});
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    const trajectory::Stretch& stretch = ramp[i];
    trajectory::Piece& piece = out.pieces[i];
    piece = {at.position, at.velocity, stretch.acceleration, stretch.jerk};
    time += stretch.duration;
    out.ends_s[i] = time;
    if (!(stretch.duration > 0)) continue;
    const KinematicState end = piece.At(stretch.duration);
    // The velocity changes its sign at most once, if there is acceleration from before.
    if (at.velocity * end.velocity < 0) {
      for (const double t : piece.VelocityZeros()) {
        if (!(t > 0 && t < stretch.duration)) continue;
        const double place = piece.At(t).position;
        out.lowest = std::min(out.lowest, place);
        out.highest = std::max(out.highest, place);
      }
    }
    at = end;
  }
  out.rest = at.position;
  out.lowest = std::min(out.lowest, out.rest);
  out.highest = std::max(out.highest, out.rest);
  return out;
}

double LeastDistance(const Braking& behind, const Braking& ahead, double apart) noexcept {
  double t = 0;
  double least = ahead.rest + apart - behind.rest;
  const double end = std::max(behind.ends_s.back(), ahead.ends_s.back());
  std::size_t i = 0, k = 0;
  while (t < end) {
    while (i < 3 && behind.ends_s[i] <= t) ++i;
    while (k < 3 && ahead.ends_s[k] <= t) ++k;
    double until = end;
    if (i < 3) until = std::min(until, behind.ends_s[i]);
    if (k < 3) until = std::min(until, ahead.ends_s[k]);
    const trajectory::Piece b = From(behind, t), a = From(ahead, t);
    const trajectory::Piece distance{a.position + apart - b.position, a.velocity - b.velocity,
                                     a.acceleration - b.acceleration, a.jerk - b.jerk};
    least = std::min(least, LeastOf(distance, until - t));
    t = until;
  }
  return least;
}

double StoppingDistance(double speed, const Brakes& b) noexcept {
  const double full = b.deceleration * b.deceleration / b.jerk;
  if (speed >= full) return 0.5 * speed * (speed / b.deceleration + b.deceleration / b.jerk);
  return speed > 0 ? speed * std::sqrt(speed / b.jerk) : 0;
}

double SpeedForDistance(double way, const Brakes& b) noexcept {
  if (!(way > 0)) return 0;
  const double d = b.deceleration, full = d * d / b.jerk;
  if (way < full * d / b.jerk) return maths::Cbrt(way * way * b.jerk);
  return 0.5 * (-full + std::sqrt(full * full + 8 * d * way));
}

double SpeedBefore(double way, double end, const Brakes& b) noexcept {
  if (!(way > 0)) return end;
  const double d = b.deceleration, ramp = d / b.jerk;
  // way = (v + end) / 2 * ((v - end) / d + ramp)
  const double half = 0.5 * d * ramp;
  const double v = -half + std::sqrt(std::max(0.0, (end - half) * (end - half) + 2 * d * way));
  if (v - end >= d * ramp) return v;
  // way = (2 end + j w²) w, v = end + j w². Convex from the root on: Newton's method from above converges
  // monotonically.
  double w = std::min(maths::Cbrt(way / b.jerk), end > 0 ? way / (2 * end) : INFINITY);
  for (int i = 0; i < 8; ++i) {
    const double f = (2 * end + b.jerk * w * w) * w - way;
    const double step = f / (2 * end + 3 * b.jerk * w * w);
    w -= step;
    if (!(step > kRounding * w)) break;
  }
  return end + b.jerk * w * w;
}

}  // namespace takt::planar
