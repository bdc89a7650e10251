// GR-30: what kinematics cost in a cycle, beside KDL's own inverse of an arm with six axes in the same run.

#include <benchmark/benchmark.h>

#include <fstream>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr.hpp>
#include <kdl/chainiksolvervel_wdls.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "takt/core/angle.h"
#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {
namespace {

constexpr std::size_t kPoses = 1024;

Kinematics Made(const KinematicsParams& params) {
  return *Make(params, std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics").kinematics;
}

Kinematics Delta() {
  return Made({.delta = DeltaParams{.base_radius = 164, .platform_radius = 44, .upper_arm = 524, .lower_arm = 1244},
               .joints = {}});
}
Kinematics Scara() {
  return Made({.scara = ScaraParams{.first_arm = 325, .second_arm = 275}, .joints = {}});
}
// The Puma 560, once closed, once from URDF.
Kinematics SixAxis() {
  const JointParams plain;
  return Made({.six_axis = SixAxisParams{.a2 = 20.3, .b = -150.05, .c2 = 431.8, .c3 = 431.8},
               .joints = {plain, {90, true}, {-90, true}, plain, {0, true}, plain}});
}
Kinematics Serial() {
  return Made({.serial = SerialParams{.urdf = "puma.urdf", .base = "", .tip = ""}, .joints = {}});
}

// Poses anywhere, each with axes about a degree from its own: what a cycle of fast motion asks for.
struct Problem {
  JointMotion motion;
  Joints near{};
  Frame pose;
  MovingFrame tool;
};

std::vector<Problem> Problems(const Kinematics& k, double lower, double upper) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<> anywhere(lower, upper), beside(-1, 1);
  std::vector<Problem> problems;
  while (problems.size() < kPoses) {
    Problem p;
    for (std::size_t i = 0; i < k.count; ++i) {
      p.motion.position[i] = anywhere(engine);
      p.motion.velocity[i] = 100 * beside(engine);
      p.near[i] = p.motion.position[i] + beside(engine);
    }
    Joints unused{};
    if (Forward(k, p.motion.position, p.pose) != Reason::kNone) continue;
    if (Forward(k, p.motion, p.tool) != Reason::kNone) continue;
    if (Inverse(k, p.pose, {}, p.near, unused) == Reason::kNone) problems.push_back(p);
  }
  return problems;
}

void Poses(benchmark::State& state, Kinematics (*make)(), double lower, double upper) {
  const Kinematics k = make();
  const std::vector<Problem> problems = Problems(k, lower, upper);
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& p = problems[i++ % kPoses];
    Joints joints;
    benchmark::DoNotOptimize(Inverse(k, p.pose, {}, p.near, joints));
    benchmark::DoNotOptimize(joints);
  }
}

// With velocities and accelerations: what a cycle of a moving group needs.
void Motions(benchmark::State& state, Kinematics (*make)(), double lower, double upper) {
  const Kinematics k = make();
  const std::vector<Problem> problems = Problems(k, lower, upper);
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& p = problems[i++ % kPoses];
    JointMotion motion;
    benchmark::DoNotOptimize(Inverse(k, p.tool, {}, p.near, motion));
    benchmark::DoNotOptimize(motion);
  }
}

void Forwards(benchmark::State& state, Kinematics (*make)(), double lower, double upper) {
  const Kinematics k = make();
  const std::vector<Problem> problems = Problems(k, lower, upper);
  std::size_t i = 0;
  for (auto _ : state) {
    Frame tool;
    benchmark::DoNotOptimize(Forward(k, problems[i++ % kPoses].motion.position, tool));
    benchmark::DoNotOptimize(tool);
  }
}

KDL::Chain PumaOfKdl() {
  const KDL::Joint z(KDL::Joint::RotZ);
  const double right = std::numbers::pi / 2;
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(431.8, 0, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(20.3, -right, 150.05, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 431.8, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, -right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, 0, 0, 0)));
  return chain;
}

// KDL's own solvers on the same poses from the same places.
void KdlInverse(benchmark::State& state, KDL::ChainIkSolverPos& solver) {
  const std::vector<Problem> problems = Problems(SixAxis(), 10, 60);
  std::vector<KDL::JntArray> near;
  for (const Problem& p : problems) {
    near.emplace_back(6);
    for (unsigned n = 0; n < 6; ++n) near.back()(n) = p.near[n] * kDegree;
  }
  KDL::JntArray out(6);
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t n = i++ % kPoses;
    benchmark::DoNotOptimize(solver.CartToJnt(near[n], problems[n].pose, out));
  }
}
void KdlNewton(benchmark::State& state) {
  const KDL::Chain chain = PumaOfKdl();
  KDL::ChainFkSolverPos_recursive forward(chain);
  KDL::ChainIkSolverVel_wdls velocity(chain);
  KDL::ChainIkSolverPos_NR solver(chain, forward, velocity, 100, 1e-9);
  KdlInverse(state, solver);
}
void KdlLevenberg(benchmark::State& state) {
  const KDL::Chain chain = PumaOfKdl();
  KDL::ChainIkSolverPos_LMA solver(chain, 1e-9);
  KdlInverse(state, solver);
}

BENCHMARK_CAPTURE(Poses, delta, Delta, -40, 80)->Name("DeltaInverse");
BENCHMARK_CAPTURE(Motions, delta, Delta, -40, 80)->Name("DeltaInverseMotion");
BENCHMARK_CAPTURE(Forwards, delta, Delta, -40, 80)->Name("DeltaForward");
BENCHMARK_CAPTURE(Poses, scara, Scara, 10, 100)->Name("ScaraInverse");
BENCHMARK_CAPTURE(Poses, six, SixAxis, 10, 60)->Name("SixAxisInverse/takt");
BENCHMARK(KdlNewton)->Name("SixAxisInverse/kdl");
BENCHMARK_CAPTURE(Motions, six, SixAxis, 10, 60)->Name("SixAxisInverseMotion");
BENCHMARK_CAPTURE(Forwards, six, SixAxis, 10, 60)->Name("SixAxisForward");
BENCHMARK_CAPTURE(Poses, serial, Serial, 10, 60)->Name("SerialInverse/takt");
BENCHMARK(KdlNewton)->Name("SerialInverse/kdl");
BENCHMARK_CAPTURE(Motions, serial, Serial, 10, 60)->Name("SerialInverseMotion");
BENCHMARK(KdlLevenberg)->Name("KdlInverseLma");

}  // namespace
}  // namespace takt::kinematics
