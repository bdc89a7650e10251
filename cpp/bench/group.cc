// GR-30: what a cycle of a moving Delta costs, and the planning of a pick path; beside KDL's own inverse of an arm with
// six axes in the same run.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr.hpp>
#include <kdl/chainiksolvervel_wdls.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "cpp/group/machines.h"

namespace takt::group {
namespace {

using Clock = std::chrono::steady_clock;

double Nanoseconds(Clock::time_point from) {
  return std::chrono::duration<double, std::nano>(Clock::now() - from).count();
}

double Share(std::vector<double>& times, double share) {
  const auto at = times.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), at, times.end());
  return *at;
}

// Up, across, down: with blends, over and over.
void GivePick(Rig& rig, double side) {
  const auto give = [&](std::optional<double> x, double z, BufferMode mode) {
    return rig.Give(MoveLinearAbsolute{.x = x,
                                       .z = z,
                                       .buffer_mode = mode,
                                       .transition_mode = TransitionMode::kCornerDistance,
                                       .transition_parameter = 20});
  };
  give({}, -870, BufferMode::kAborting);
  give(0, -860, BufferMode::kBlendingNext);
  give(side, -870, BufferMode::kBlendingNext);
  give({}, -900, BufferMode::kBlendingNext);
}

// The group's part of a cycle alone.
double Cycle(Rig& rig) {
  double time = 0;
  rig.Step([&](const auto& step) {
    const auto from = Clock::now();
    step();
    time = Nanoseconds(from);
  });
  return time;
}

void MovingDelta(benchmark::State& state) {
  Rig rig = DeltaRobot();
  rig.StartAt({-150, 0, -900, 0, 0, 0});
  double side = 150, largest = 0;
  for (auto _ : state) {
    if (rig.out_of_work()) {
      GivePick(rig, side);
      side = -side;
      while (!rig.state.begun) rig.Step();
    }
    rig.trace.clear();
    const double time = Cycle(rig);
    largest = std::max(largest, time);
    state.SetIterationTime(time * 1e-9);
  }
  state.counters["largest_ns"] = largest;
}

// From the commands until all four moves are planned, all Step calls; the motion begins before that (first_motion_ns).
void PickPath(benchmark::State& state) {
  double first_motion = 0;
  std::vector<double> all, cycles;
  for (auto _ : state) {
    Rig rig = DeltaRobot();
    rig.StartAt({-150, 0, -900, 0, 0, 0});
    GivePick(rig, 150);
    double time = 0;
    do {
      const bool begun = rig.state.begun;
      const std::uint64_t nodes = rig.state.planning.nodes;
      const double one = Cycle(rig);
      cycles.push_back(one);
      // The last blend waits for one more move until it must be there.
      if (rig.state.planning.stage != Stage::kIdle || rig.state.planning.nodes > nodes) time += one;
      if (!begun && rig.state.begun) first_motion += time;
    } while (!IsPlanned(rig.Now(), rig.state) && rig.cycle.count < 1000);
    state.SetIterationTime(time * 1e-9);
    all.push_back(time);
  }
  // Others on the machine take their time out of cycles: what is left is the median, and all but 2 % of the cycles.
  state.counters["median_ns"] = Share(all, 0.5);
  state.counters["p98_cycle_ns"] = Share(cycles, 0.98);
  state.counters["first_motion_ns"] = first_motion / static_cast<double>(state.iterations());
}

// GR-24: all that a group does along a circle of 30 mm radius in 500 chords of 1 mm at 150 mm/s, shared among them.
void Chords(benchmark::State& state) {
  PathTable table;
  for (int i = 1; i <= 500; ++i) {
    PathPiece piece;
    piece.to = {30 * std::sin(i / 30.0), 30 * (1 - std::cos(i / 30.0)), -850, 0, 0, 0};
    table.pieces.push_back(piece);
  }
  double largest = 0;
  for (auto _ : state) {
    Rig rig = DeltaRobot();
    rig.paths = {table};
    rig.StartAt({0, 0, -850, 0, 0, 0});
    const Ticket move = rig.Give(MovePath{.path = 0,
                                          .velocity = 150,
                                          .transition_mode = TransitionMode::kMaxCornerDeviation,
                                          .transition_parameter = 0.01});
    double time = 0;
    while (!rig.lives[move].ended()) {
      const double one = Cycle(rig);
      largest = std::max(largest, one);
      time += one;
    }
    state.SetIterationTime(time * 1e-9 / 500);
  }
  state.counters["largest_ns"] = largest;
}

void KdlInverse(benchmark::State& state) {
  const KDL::Joint z(KDL::Joint::RotZ);
  const double right = std::numbers::pi / 2;
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(431.8, 0, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(20.3, -right, 150.05, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 431.8, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, -right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, 0, 0, 0)));
  KDL::ChainFkSolverPos_recursive forward(chain);
  KDL::ChainIkSolverVel_wdls velocity(chain);
  KDL::ChainIkSolverPos_NR solver(chain, forward, velocity, 100, 1e-9);
  std::mt19937_64 random(7);
  std::vector<std::pair<KDL::JntArray, Frame>> problems;
  for (int i = 0; i < 1024; ++i) {
    KDL::JntArray joints(6);
    for (unsigned n = 0; n < 6; ++n) joints(n) = Uniform(random, 0.2, 1);
    Frame pose;
    forward.JntToCart(joints, pose);
    for (unsigned n = 0; n < 6; ++n) joints(n) += Uniform(random, -0.02, 0.02);
    problems.emplace_back(joints, pose);
  }
  KDL::JntArray out(6);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [near, pose] = problems[i++ % problems.size()];
    benchmark::DoNotOptimize(solver.CartToJnt(near, pose, out));
  }
}

BENCHMARK(MovingDelta)->Name("MovingDeltaCycle/takt")->UseManualTime();
BENCHMARK(PickPath)->Name("PlanPickPath")->UseManualTime()->Iterations(200);
BENCHMARK(Chords)->Name("ChordOfAPath")->UseManualTime()->Iterations(20);
BENCHMARK(KdlInverse)->Name("MovingDeltaCycle/kdl");

}  // namespace
}  // namespace takt::group
