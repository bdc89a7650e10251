#include "takt/kinematics/linear.h"

#include "takt/core/describe.h"
#include "takt/kinematics/angles.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

using Four = std::array<double, 4>;

void Add(Linear& linear, Coordinate coordinate) {
  const auto c = static_cast<std::size_t>(coordinate);
  linear.moves[c] = true;
  linear.to_tool[c][linear.count] = linear.to_joints[linear.count][c] = 1;
  linear.kinds[linear.count++] = coordinate == Coordinate::kC ? JointKind::kRotary : JointKind::kLinear;
}

Four ToTool(const Linear& linear, const Joints& joints) {
  Four out{};
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < linear.count; ++i) out[c] += linear.to_tool[c][i] * joints[i];
  }
  return out;
}

Joints ToJoints(const Linear& linear, const Four& coordinates) {
  Joints out{};
  for (std::size_t i = 0; i < linear.count; ++i) {
    for (std::size_t c = 0; c < 4; ++c) out[i] += linear.to_joints[i][c] * coordinates[c];
  }
  return out;
}

KDL::Vector Place(const Four& c) {
  return {c[0], c[1], c[2]};
}

Four Coordinates(const KDL::Vector& v, double c) {
  return {v.x(), v.y(), v.z(), c};
}

}  // namespace

Linear MakeGantry(const std::vector<Coordinate>& axes) {
  Linear linear;
  for (const Coordinate c : axes) Add(linear, c);
  return linear;
}

Linear MakeCoreXy(bool with_z, bool with_c) {
  Linear linear;
  linear.count = 2;
  linear.moves[0] = linear.moves[1] = true;
  linear.to_tool[0] = {0.5, 0.5, 0, 0};
  linear.to_tool[1] = {0.5, -0.5, 0, 0};
  linear.to_joints[0] = {1, 1, 0, 0};
  linear.to_joints[1] = {1, -1, 0, 0};
  if (with_z) Add(linear, Coordinate::kZ);
  if (with_c) Add(linear, Coordinate::kC);
  return linear;
}

Reason Forward(const Linear& linear, const Joints& joints, Frame& tool) noexcept {
  const Four c = ToTool(linear, joints);
  tool = Frame(AboutZ(c[3]), Place(c));
  return Reason::kNone;
}

Reason Forward(const Linear& linear, const JointMotion& motion, MovingFrame& tool) noexcept {
  const Four p = ToTool(linear, motion.position);
  const Four v = ToTool(linear, motion.velocity);
  const Four a = ToTool(linear, motion.acceleration);
  tool = MovingFrame(KDL::RotationAcc(AboutZ(p[3]), {0, 0, v[3]}, {0, 0, a[3]}),
                     KDL::VectorAcc(Place(p), Place(v), Place(a)));
  return Reason::kNone;
}

Jacobian JacobianAt(const Linear& linear, const Joints&) noexcept {
  Jacobian columns{};
  for (std::size_t i = 0; i < linear.count; ++i) {
    columns[i].vel = {linear.to_tool[0][i], linear.to_tool[1][i], linear.to_tool[2][i]};
    columns[i].rot = {0, 0, linear.to_tool[3][i]};
  }
  return columns;
}

Reason Inverse(const Linear& linear, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept {
  if (!Upright(tool.M)) return Reason::kOrientation;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!linear.moves[c] && std::abs(tool.p.data[c]) > kSlack) return Reason::kOutOfReach;
  }
  const double present = ToTool(linear, near)[3];
  const double c = linear.moves[3] ? NearestTurn(AngleAboutZ(tool.M), present) : 0;
  joints = ToJoints(linear, Coordinates(tool.p, c));
  return Reason::kNone;
}

Reason SolveMotion(const Linear& linear, const MovingFrame& tool, JointMotion& motion) noexcept {
  if (!IsUprightMotion(tool)) return Reason::kOrientation;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!linear.moves[c] && !(tool.p.v.data[c] == 0 && tool.p.dv.data[c] == 0)) return Reason::kOutOfReach;
  }
  motion.velocity = ToJoints(linear, Coordinates(tool.p.v, tool.M.w.z()));
  motion.acceleration = ToJoints(linear, Coordinates(tool.p.dv, tool.M.dw.z()));
  return Reason::kNone;
}

void describe(Enumeration<Coordinate>& e) {
  e.about("A coordinate of the tool.");
  e.value(Coordinate::kX, "x", "Along X.");
  e.value(Coordinate::kY, "y", "Along Y.");
  e.value(Coordinate::kZ, "z", "Along Z.");
  e.value(Coordinate::kC, "c", "About Z.");
}

}  // namespace takt::kinematics
