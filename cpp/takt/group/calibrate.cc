#include "takt/group/calibrate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace takt::group {

namespace {

using Vector = Eigen::Vector3d;

constexpr double kLeastSpread = 0.1;  // [mm]: points closer together, or closer to one line, define no frame

struct Places {
  std::array<Vector, 4> of;
  std::size_t count = 3;

  Vector Middle() const {
    Vector sum = Vector::Zero();
    for (std::size_t i = 0; i < count; ++i) sum += of[i];
    return sum / static_cast<double>(count);
  }
  // Returns true if the points lie on one line: the second largest principal spread is below kLeastSpread.
  bool OnALine() const {
    const Vector middle = Middle();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count; ++i) spread += (of[i] - middle) * (of[i] - middle).transpose();
    const Vector squares = Eigen::JacobiSVD<Eigen::Matrix3d>(spread).singularValues();
    return !(std::sqrt(squares(1)) >= kLeastSpread);
  }
};

Calibrated Made(const Eigen::Matrix3d& turn, const Vector& place, double largest) {
  const KDL::Rotation rotation(turn(0, 0), turn(0, 1), turn(0, 2), turn(1, 0), turn(1, 1), turn(1, 2), turn(2, 0),
                               turn(2, 1), turn(2, 2));
  return {kinematics::ToPose({rotation, KDL::Vector(place(0), place(1), place(2))}), largest};
}

std::optional<Calibrated> ByDirections(const Places& places, const Vector& origin) {
  const Vector on_x = places.of[1] - places.of[0], beside = places.of[2] - places.of[0];
  if (!(on_x.norm() >= kLeastSpread)) return std::nullopt;
  const Vector x = on_x.normalized(), across = beside - beside.dot(x) * x;
  if (!(across.norm() >= kLeastSpread)) return std::nullopt;
  Eigen::Matrix3d turn;
  turn.col(0) = x;
  turn.col(1) = across.normalized();
  turn.col(2) = x.cross(across.normalized());
  return Made(turn, origin, 0);
}

std::optional<Calibrated> Nearest(const Places& seen, const Places& measured) {
  if (seen.OnALine() || measured.OnALine()) return std::nullopt;
  const Vector seen_middle = seen.Middle(), middle = measured.Middle();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < seen.count; ++i)
    sum += (seen.of[i] - seen_middle) * (measured.of[i] - middle).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d v = svd.matrixV();
  if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) = -v.col(2);
  const Eigen::Matrix3d turn = v * svd.matrixU().transpose();
  const Vector place = middle - turn * seen_middle;
  double largest = 0;
  for (std::size_t i = 0; i < seen.count; ++i) {
    largest = std::max(largest, (turn * seen.of[i] + place - measured.of[i]).norm());
  }
  return Made(turn, place, largest);
}

}  // namespace

std::optional<Calibrated> FrameOf(const Calibrate& m) noexcept {
  Places measured{{Vector(m.x1, m.y1, m.z1), Vector(m.x2, m.y2, m.z2), Vector(m.x3, m.y3, m.z3),
                   Vector(m.x4.value_or(0), m.y4.value_or(0), m.z4.value_or(0))}};
  const bool fourth = m.x4.has_value();
  if (!m.seen_x1) return ByDirections(measured, measured.of[fourth ? 3 : 0]);
  Places seen{{Vector(*m.seen_x1, m.seen_y1.value_or(0), m.seen_z1.value_or(0)),
               Vector(m.seen_x2.value_or(0), m.seen_y2.value_or(0), m.seen_z2.value_or(0)),
               Vector(m.seen_x3.value_or(0), m.seen_y3.value_or(0), m.seen_z3.value_or(0)),
               Vector(m.seen_x4.value_or(0), m.seen_y4.value_or(0), m.seen_z4.value_or(0))}};
  seen.count = measured.count = fourth ? 4 : 3;
  return Nearest(seen, measured);
}

}  // namespace takt::group
