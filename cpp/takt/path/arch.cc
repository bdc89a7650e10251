#include "takt/path/arch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/kinematics/rotations.h"
#include "takt/path/ends.h"
#include "takt/path/make.h"
#include "takt/path/place.h"
#include "takt/path/vectors.h"

namespace takt::path {
namespace {

// Angle of the ellipse per piece [rad].
constexpr double kAngle = std::numbers::pi / kArchQuintics;

struct Feet {
  Vector begin, end;   // of the arch
  Vector left, right;  // feet of the ellipse
  Vector centre;
  Vector across = Vector::Zero();  // from the centre to the right foot
  Vector crest = Vector::Zero();   // from the centre up
  bool rises = false;              // a straight piece before ...
  bool falls = false;              // ... or behind the ellipse
  bool straight = false;           // no ellipse, but a line between the feet ...
  bool upright = false;            // ... or only the vertical piece

  int pieces() const { return upright ? 1 : (straight ? 1 : kArchQuintics) + (rises || falls ? 1 : 0); }
};

Feet FeetOf(const Point& begin, const Point& end, double height, const Triple& up) {
  const Vector upwards = ToVector(up);
  Feet s;
  s.begin = s.left = ToVector(begin.frame.p);
  s.end = s.right = ToVector(end.frame.p);
  const double rise = upwards.dot(s.end - s.begin);
  s.rises = rise > kSame;
  s.falls = rise < -kSame;
  if (s.rises) s.left += rise * upwards;
  if (s.falls) s.right -= rise * upwards;
  s.centre = (s.left + s.right) / 2;
  s.across = s.right - s.centre;
  s.crest = height * upwards;
  s.straight = height < kSame;
  s.upright = 2 * s.across.norm() < kSame;
  return s;
}

VectorPolynomial Quarter(const Feet& s, int piece) {
  const auto at = [&](double angle) -> Derivatives<Vector> {
    const maths::SineCosine of = maths::SinCos(angle);
    const Vector flat = of.cosine * s.across;
    const Vector high = of.sine * s.crest;
    return {s.centre - flat + high, kAngle * (of.sine * s.across + of.cosine * s.crest),
            kAngle * kAngle * (flat - high)};
  };
  return VectorHermite(at(piece * kAngle), at((piece + 1) * kAngle));
}

// Sets the position of a piece; not its orientation.
void SetPiece(const Feet& s, int piece, Segment& out) {
  const bool line = s.upright || s.straight || (s.rises && piece == 0) || (s.falls && piece + 1 == s.pieces());
  if (!line) return SetQuintic(out, Quarter(s, piece - (s.rises ? 1 : 0)));
  Vector from = s.begin;
  Vector to = s.end;
  if (!s.upright && s.rises) (piece == 0 ? to : from) = s.left;
  if (!s.upright && s.falls) (piece + 1 == s.pieces() ? from : to) = s.right;
  out.length = (to - from).norm();
  out.place[0] = ToTriple(from);
  out.place[1] = ToTriple((to - from) / out.length);
}

}  // namespace

int ArchPieces(const Point& begin, const Point& end, double height, const Triple& up) noexcept {
  return FeetOf(begin, end, height, up).pieces();
}

Problem MakeArchPiece(const Point& begin, const Point& end, double height, const Triple& up, int piece,
                      Segment& out) noexcept {
  if (!Sound(begin) || !Sound(end) || !std::isfinite(height)) return Problem::kNotFinite;
  if (!(std::abs(ToVector(up).norm() - 1) < 1e-6)) return Problem::kNoPlane;
  const Feet shape = FeetOf(begin, end, height, up);
  const int pieces = shape.pieces();
  if (height < 0 || piece < 0 || piece >= pieces) return Problem::kOutside;
  if (shape.upright && !shape.rises && !shape.falls) return Problem::kLengthZero;
  Segment segment;
  double whole = 0;
  double before = 0;
  for (int i = 0; i < pieces; ++i) {
    Segment one;
    SetPiece(shape, i, one);
    if (i < piece) before += one.length;
    whole += one.length;
    if (i == piece) segment = one;
  }
  if (!std::isfinite(whole)) return Problem::kNotFinite;
  const auto part_way = [&](double way) {
    const double share = way / whole;
    const kinematics::GreatArc turn = kinematics::ArcBetween(begin.frame.M, end.frame.M);
    Point point{{kinematics::About(turn.axis, share * turn.angle) * begin.frame.M, {}}, {}};
    for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
      point.auxiliaries[i] = std::lerp(begin.auxiliaries[i], end.auxiliaries[i], share);
    }
    return point;
  };
  const Point first = piece == 0 ? begin : part_way(before);
  const Point last = piece + 1 == pieces ? end : part_way(before + segment.length);
  SetEven(segment, first, last);
  out = segment;
  return Problem::kNone;
}

}  // namespace takt::path
