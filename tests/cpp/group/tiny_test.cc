// GR-43: tiny displacements beside large ones.
#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

// The gantry of a plotter: its accelerations take 50 ms to build up.
Rig Plotter() {
  KinematicsParams k;
  k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
  return Machine(k, {"x", "y", "z", "u"}, {500, 5000, 100000},
                 {.velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000});
}

// A tiny displacement of the tool does not slow down, or throw beyond its end, what moves far beside it.
TEST(Tiny, DisplacementsDoNotCountBesideLargeOnes) {
  const auto run = [](double tiny, bool blends) {
    Rig rig = Plotter();
    rig.Start();
    rig.Step();
    rig.trace = {rig.trace.back()};
    const auto mode = blends ? BufferMode::kBlendingHigh : BufferMode::kBuffered;
    const auto transition = blends ? TransitionMode::kMaxCornerDeviation : TransitionMode::kNone;
    const auto give = [&](double x, double y, double u) {
      return rig.Give(MoveLinearAbsolute{.x = x,
                                         .y = y,
                                         .a4 = u,
                                         .buffer_mode = mode,
                                         .transition_mode = transition,
                                         .transition_parameter = blends ? 0.1 : 0});
    };
    give(4, 3, 2);
    give(4 + tiny, 3 + tiny, 80);
    const Ticket last = give(0, 0, 0);
    EXPECT_TRUE(rig.RunToEnd(last, 30));
    double most = 0;
    for (const Sample& sample : rig.trace) most = std::max(most, sample.set[3].position);
    EXPECT_LE(most, 80 + 1e-6) << tiny;
    EXPECT_NEAR(rig.trace.back().set[0].position, 0, 1e-6);
    return static_cast<double>(rig.trace.size()) * rig.cycle.period_s;
  };
  for (const bool blends : {false, true}) {
    const double alone = run(0, blends);
    for (const double tiny : {3e-7, 2e-6, 3e-5, 1e-4}) {
      const double time = run(tiny, blends);
      std::cout << (blends ? "blends " : "stops ") << tiny << " mm: " << time / alone << "\n";
      EXPECT_LE(time, 1.02 * alone + 0.002) << tiny << (blends ? " blends" : " stops");
    }
  }
}

}  // namespace
}  // namespace takt::group
