#include "takt/trajectory/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "takt/core/describe.h"

namespace takt::trajectory {

static_assert(std::is_trivially_copyable_v<Profile>);

namespace {

constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();  // share of a time that is ignored

void Include(Profile::Range& range, double value) noexcept {
  range.min = std::min(range.min, value);
  range.max = std::max(range.max, value);
}

// Returns the time at which a piece that does not reverse between `left` and `right` is at `position`; NaN: never.
double MonotoneTime(const Piece& piece, double position, double left, double right) noexcept {
  const double begin = piece.At(left).position - position;
  const double end = piece.At(right).position - position;
  if (begin == 0) return left;
  if (begin * end > 0) return std::numeric_limits<double>::quiet_NaN();
  // Newton's method; where a step leaves the interval, the interval is bisected.
  double t = 0.5 * (left + right);
  for (int i = 0; i < 200 && t > left && t < right; ++i) {
    const KinematicState at = piece.At(t);
    const double off = at.position - position;
    (off * begin > 0 ? left : right) = t;
    const double step = -off / at.velocity;
    if (std::abs(step) <= kRounding * t) return t;
    t += step;
    if (!(t > left && t < right)) t = 0.5 * (left + right);
  }
  return right;
}

}  // namespace

bool Profile::AppendWithAcceleration(double duration_s, double acceleration, double jerk) noexcept {
  if (!(duration_s > 0)) return true;
  if (piece_count == kCapacity) return false;
  const double before = duration();
  if (before + duration_s == before) return true;
  Piece& piece = pieces[Index(piece_count)];
  piece = {end_state.position, end_state.velocity, acceleration, jerk};
  piece_ends_s[Index(piece_count)] = before + duration_s;
  ++piece_count;
  end_state = piece.At(duration_s);
  return true;
}

bool Profile::Append(const Profile& other) noexcept {
  if (piece_count + other.piece_count > kCapacity) return false;
  const double before = duration();
  for (int i = 0; i < other.piece_count; ++i) {
    pieces[Index(piece_count)] = other.pieces[Index(i)];
    piece_ends_s[Index(piece_count)] = before + other.piece_ends_s[Index(i)];
    ++piece_count;
  }
  end_state = other.end_state;
  return true;
}

void Profile::Cut(double t) noexcept {
  if (t >= duration()) return;
  end_state = At(t);
  while (piece_count > 0) {
    const auto last = Index(piece_count - 1);
    const double begin = piece_count > 1 ? piece_ends_s[last - 1] : 0;
    if (begin < t) {
      piece_ends_s[last] = t;
      return;
    }
    pieces[last] = {};
    piece_ends_s[last] = 0;
    --piece_count;
  }
}

void Profile::Skip(double t) noexcept {
  if (!(t > 0)) return;
  const KinematicState at = At(t);
  Profile rest{at, at};
  for (int i = 0; i < piece_count; ++i) {
    const double end = piece_ends_s[Index(i)], begin = end - Length(i);
    if (end <= t) continue;
    const Piece& q = pieces[Index(i)];
    const KinematicState from = q.At(std::max(t - begin, 0.0));
    rest.pieces[Index(rest.piece_count)] = {from.position, from.velocity, from.acceleration, q.jerk};
    rest.piece_ends_s[Index(rest.piece_count++)] = end - t;
  }
  if (rest.piece_count > 0) rest.end_state = end_state;
  *this = rest;
}

double Profile::TimeAt(double position, double begin_s) const noexcept {
  for (int i = 0; i < piece_count; ++i) {
    const Piece& q = pieces[Index(i)];
    const double begin = i == 0 ? 0 : piece_ends_s[Index(i - 1)];
    const double length = piece_ends_s[Index(i)] - begin;
    double left = std::max(0.0, begin_s - begin);
    if (left > length) continue;
    const std::array<double, 2> zeros = q.VelocityZeros();
    for (const double cut : {zeros[0], zeros[1], length}) {
      if (!(cut >= left && cut <= length)) continue;
      const double at = MonotoneTime(q, position, left, cut);
      if (!std::isnan(at)) return begin + at;
      left = cut;
    }
  }
  if (begin_s <= duration() && position == end_state.position) return duration();
  return std::numeric_limits<double>::quiet_NaN();
}

Profile::Range Profile::PositionRange(double begin_s) const noexcept {
  const double first = At(begin_s).position;
  Range range{first, first};
  for (int i = 0; i < piece_count; ++i) {
    const Piece& q = pieces[Index(i)];
    const double length = Length(i);
    const double gone = begin_s - (piece_ends_s[Index(i)] - length);
    if (gone >= length) continue;
    Include(range, q.At(length).position);
    for (const double t : q.VelocityZeros()) {
      if (t > std::max(0.0, gone) && t < length) Include(range, q.At(t).position);
    }
  }
  Include(range, end_state.position);
  return range;
}

Profile::Range Profile::VelocityRange() const noexcept {
  Range range{start_state.velocity, start_state.velocity};
  for (int i = 0; i < piece_count; ++i) {
    const Piece& q = pieces[Index(i)];
    const double length = Length(i);
    Include(range, q.At(length).velocity);
    const double t = -q.acceleration / q.jerk;
    if (t > 0 && t < length) Include(range, q.At(t).velocity);
  }
  Include(range, end_state.velocity);
  return range;
}

Profile::Range Profile::AccelerationRange() const noexcept {
  Range range{start_state.acceleration, start_state.acceleration};
  for (int i = 0; i < piece_count; ++i) {
    const Piece& q = pieces[Index(i)];
    const double length = Length(i);
    Include(range, q.acceleration);
    Include(range, q.acceleration + q.jerk * length);
  }
  Include(range, end_state.acceleration);
  return range;
}

void describe(Description<Piece>& d) {
  d.about("A piece of a motion with constant jerk.");
  d.internal<&Piece::position>(unit::u, "Position at its beginning.");
  d.internal<&Piece::velocity>(unit::u_s, "Velocity at its beginning.");
  d.internal<&Piece::acceleration>(unit::u_s2, "Acceleration at its beginning.");
  d.internal<&Piece::jerk>(unit::u_s3, "Jerk throughout the piece.");
}

void describe(Description<Profile>& d) {
  d.about("A motion known from beginning to end.");
  d.internal<&Profile::start_state>("State at time 0.");
  d.internal<&Profile::end_state>("State at the end.");
  d.internal<&Profile::piece_count>("Number of pieces.");
  d.internal<&Profile::piece_ends_s>(unit::s, "End of each piece, from the start.");
  d.internal<&Profile::pieces>("The pieces in order.");
}

}  // namespace takt::trajectory
