#include "takt/path/ends.h"

#include <algorithm>
#include <cmath>

#include "takt/path/turn.h"

namespace takt::path {
namespace {

// How far a matrix may be from a rotation.
constexpr double kRotation = 1e-6;

}  // namespace

bool Sound(const Point& point) noexcept {
  if (!kinematics::Finite(point.frame)) return false;
  if (!std::all_of(point.auxiliaries.begin(), point.auxiliaries.end(), [](double a) { return std::isfinite(a); })) {
    return false;
  }
  const Eigen::Matrix3d m = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(point.frame.M.data);
  return (m * m.transpose()).isIdentity(kRotation) && m.determinant() > 0;
}

void CountAuxiliaries(Segment& segment) noexcept {
  segment.auxiliary_count = 0;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    if (segment.auxiliaries[i] != Polynomial{}) segment.auxiliary_count = static_cast<std::uint8_t>(i + 1);
  }
}

void SetEven(Segment& segment, const Point& from, const Point& to) noexcept {
  const Eigen::Quaterniond base = ToQuaternion(from.frame.M);
  segment.base = {base.x(), base.y(), base.z(), base.w()};
  const Vector turn = ToVector(kinematics::TurnBetween(from.frame.M, to.frame.M));
  segment.turning = turn.isZero(0) ? Course::kStill : Course::kEven;
  segment.turn = {};
  segment.turn[1] = ToTriple(turn);
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    segment.auxiliaries[i] = {from.auxiliaries[i], to.auxiliaries[i] - from.auxiliaries[i]};
  }
  CountAuxiliaries(segment);
}

}  // namespace takt::path
