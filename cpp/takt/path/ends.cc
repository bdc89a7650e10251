#include "takt/path/ends.h"

#include <algorithm>
#include <cmath>

#include "takt/path/turn.h"

namespace takt::path {
namespace {

// Tolerance of a rotation matrix.
constexpr double kRotation = 1e-6;

// [rad] A turn below this is rounding.
constexpr double kNoTurn = 1e-14;

Course CourseOf(const VectorPolynomial& turn) {
  const auto nothing = [](const Triple& c) { return ToVector(c).norm() < kNoTurn; };
  if (std::all_of(turn.begin(), turn.end(), nothing)) return Course::kStill;
  const bool even = nothing(turn[0]) && std::all_of(turn.begin() + 2, turn.end(), nothing);
  return even ? Course::kEven : Course::kCurved;
}

void SetBase(Segment& segment, const KDL::Rotation& base) {
  const Eigen::Quaterniond q = ToQuaternion(base);
  segment.base = {q.x(), q.y(), q.z(), q.w()};
}

// Counts up to the last one that is not 0 everywhere.
void CountAuxiliaries(Segment& segment) {
  segment.auxiliary_count = 0;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    if (segment.auxiliaries[i] != Polynomial{}) segment.auxiliary_count = static_cast<std::uint8_t>(i + 1);
  }
}

}  // namespace

bool Sound(const Point& point) noexcept {
  if (!kinematics::Finite(point.frame)) return false;
  if (!std::all_of(point.auxiliaries.begin(), point.auxiliaries.end(), [](double a) { return std::isfinite(a); })) {
    return false;
  }
  const Eigen::Matrix3d m = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(point.frame.M.data);
  return (m * m.transpose()).isIdentity(kRotation) && m.determinant() > 0;
}

void SetEven(Segment& segment, const Point& from, const Point& to) noexcept {
  SetBase(segment, from.frame.M);
  segment.turn = {};
  segment.turn[1] = ToTriple(ToVector(kinematics::TurnBetween(from.frame.M, to.frame.M)));
  segment.turning = CourseOf(segment.turn);
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    segment.auxiliaries[i] = {from.auxiliaries[i], to.auxiliaries[i] - from.auxiliaries[i]};
  }
  CountAuxiliaries(segment);
}

void SetCurved(Segment& segment, const KDL::Rotation& base, const Along& begin, const Along& end) noexcept {
  const double length = segment.length;
  const auto over_share = [length]<typename T>(const Derivatives<T>& d) -> Derivatives<T> {
    return {d.value, d.first * length, d.second * (length * length)};
  };
  SetBase(segment, base);
  segment.turn = VectorHermite(over_share(begin.turn), over_share(end.turn));
  segment.turning = CourseOf(segment.turn);
  const auto auxiliary = [](const AuxiliaryMotion& m, std::size_t i) {
    return Derivatives<double>{m.position[i], m.velocity[i], m.acceleration[i]};
  };
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    segment.auxiliaries[i] =
        Hermite(over_share(auxiliary(begin.auxiliaries, i)), over_share(auxiliary(end.auxiliaries, i)));
  }
  CountAuxiliaries(segment);
}

}  // namespace takt::path
