// GR-22, GR-24: from one move into the next; and motion that is slowed, interrupted and continued.
#include <random>

#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

// The largest step of the tool's acceleration (a vector) in a cycle, mm/s². Only of a gantry.
double WorstAccelerationStep(const Rig& rig) {
  double worst = 0;
  for (std::size_t n = 1; n < rig.trace.size(); ++n) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = rig.trace[n].set[k].acceleration - rig.trace[n - 1].set[k].acceleration;
      square += step * step;
    }
    worst = std::max(worst, std::sqrt(square));
  }
  return worst;
}

struct Corner {
  BufferMode buffer;
  TransitionMode transition;
  double parameter;
};

struct Taken {
  double nearest = 1e99;  // to the corner, mm
  double slowest = 1e99;  // where it is nearest, mm/s
  double off_path = 0;    // from the two lines, mm
};

Taken Go(const Corner& corner, const KDL::Vector& at, const KDL::Vector& to, double v1 = 300, double v2 = 600) {
  Rig rig = Gantry();
  rig.Start();
  rig.Give(MoveLinearAbsolute{.x = at.x(), .y = at.y(), .z = at.z(), .velocity = v1});
  const Ticket second = rig.Give(MoveLinearAbsolute{.x = to.x(),
                                                    .y = to.y(),
                                                    .z = to.z(),
                                                    .velocity = v2,
                                                    .buffer_mode = corner.buffer,
                                                    .transition_mode = corner.transition,
                                                    .transition_parameter = corner.parameter});
  EXPECT_TRUE(rig.RunToEnd(second, 10));
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_LE((ToolOf(rig).p - to).Norm(), 1e-9);
  ExpectSmooth(rig);
  EXPECT_LE(WorstAccelerationStep(rig), std::sqrt(3) * 500000 * rig.cycle.period_s * (1 + 1e-6));
  Taken gone;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = ToolOf(rig, sample).p;
    gone.off_path = std::max(gone.off_path, std::min(FromLine(p, KDL::Vector::Zero(), at), FromLine(p, at, to)));
    if ((p - at).Norm() > gone.nearest) continue;
    gone.nearest = (p - at).Norm();
    gone.slowest = sample.out.velocity;
  }
  return gone;
}

// GR-22: every buffer mode with every transition mode.
TEST(Transitions, OfEveryMode) {
  const KDL::Vector at(200, 0, 0), to(200, 200, 0);
  for (const BufferMode buffer : {BufferMode::kBuffered, BufferMode::kBlendingLow, BufferMode::kBlendingPrevious,
                                  BufferMode::kBlendingNext, BufferMode::kBlendingHigh}) {
    for (const TransitionMode transition :
         {TransitionMode::kNone, TransitionMode::kStartVelocity, TransitionMode::kConstantVelocity,
          TransitionMode::kCornerDistance, TransitionMode::kMaxCornerDeviation}) {
      const bool velocity =
          transition == TransitionMode::kStartVelocity || transition == TransitionMode::kConstantVelocity;
      const Taken gone = Go({buffer, transition, velocity ? 150.0 : 10.0}, at, to);
      SCOPED_TRACE(testing::Message() << static_cast<int>(buffer) << " " << static_cast<int>(transition));
      if (buffer == BufferMode::kBuffered || transition == TransitionMode::kNone) {
        EXPECT_LE(gone.nearest, 1e-9);  // through the corner, where it stops
        EXPECT_LE(gone.slowest, 1e-9);
        EXPECT_LE(gone.off_path, 1e-9);
        continue;
      }
      EXPECT_GT(gone.nearest, 0.1);
      EXPECT_GT(gone.slowest, 50);
      const double most = buffer == BufferMode::kBlendingLow || buffer == BufferMode::kBlendingPrevious ? 300 : 600;
      EXPECT_LE(gone.slowest, most * (1 + 1e-6));
      EXPECT_TRUE(transition != TransitionMode::kMaxCornerDeviation || gone.nearest <= 10.01) << gone.nearest;
      EXPECT_TRUE(transition != TransitionMode::kCornerDistance || gone.off_path <= 10) << gone.off_path;
    }
  }
}

// GR-22: however sharp the corner, the tool comes at least as near to it as was asked for.
TEST(Transitions, KeepTheDeviation) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 60; ++i) {
    const KDL::Vector at(Uniform(random, 30, 200), Uniform(random, -50, 50), Uniform(random, -50, 50));
    const KDL::Vector to(Uniform(random, -100, 300), Uniform(random, -200, 200), Uniform(random, -100, 100));
    const double deviation = std::exp(Uniform(random, std::log(0.05), std::log(20)));
    const Taken gone =
        Go({BufferMode::kBlendingNext, TransitionMode::kMaxCornerDeviation, deviation}, at, to, 1000, 1000);
    // It may have been nearest in the middle between two cycles.
    EXPECT_LE(gone.nearest, std::hypot(deviation, 0.5 * gone.slowest * 0.001) * (1 + 1e-3) + 0.01) << i;
    EXPECT_LE(gone.off_path, deviation * (1 + 1e-3) + 0.01) << i;
  }
}

// GR-24: 200 chords of 1 mm on a circle of 30 mm radius, at the speed that the limits allow, without stopping.
TEST(Transitions, LookFarAhead) {
  Rig rig = Gantry();
  const auto at = [](int i) {
    const double angle = i / 30.0;
    return KDL::Vector(30 * std::cos(angle), 30 * std::sin(angle), 0);
  };
  rig.Start({30, 0, 0});
  Ticket last = 0;
  const double speed = 150;
  int given = 0;
  const auto give = [&] {
    const KDL::Vector to = at(++given);
    last = rig.Give(MoveLinearAbsolute{.x = to.x(),
                                       .y = to.y(),
                                       .velocity = speed,
                                       .buffer_mode = BufferMode::kBlendingNext,
                                       .transition_mode = TransitionMode::kMaxCornerDeviation,
                                       .transition_parameter = 0.01});
  };
  while (given < 100) give();
  while (given < 200) {
    rig.Step();
    if (rig.out().buffered < 100) give();
  }
  ASSERT_TRUE(rig.RunToEnd(last, 20));
  EXPECT_TRUE(rig.lives[last].done);
  ExpectSmooth(rig);
  double slowest = 1e99, worst = 0;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = ToolOf(rig, sample).p;
    worst = std::max(worst, std::abs(p.Norm() - 30));
    const double angle = std::fmod(std::atan2(p.y(), p.x()) + 2 * std::numbers::pi, 2 * std::numbers::pi);
    const double way = 30 * angle;
    if (way > 20 && way < 160) slowest = std::min(slowest, sample.out.velocity);
  }
  EXPECT_GE(slowest, 0.5 * speed);
  EXPECT_LE(worst, 1.0 / 8 / 30 + 0.011);
  std::cout << "chords: slowest " << slowest << " mm/s of " << speed << ", " << worst << " mm off the circle\n";
}

// Slowed, held, interrupted at any time, and continued: on the path all the time, and at its end at last.
TEST(Transitions, InterruptedAnywhere) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    Rig rig = Gantry();
    rig.Start();
    const KDL::Vector to(300, 200, -50);
    const Ticket move = rig.Give(MoveLinearAbsolute{.x = to.x(), .y = to.y(), .z = to.z()});
    for (int i = 0; i < 4; ++i) {
      rig.Run(Uniform(random, 0.01, 0.15));
      if (rig.lives[move].ended()) break;
      if (random() % 2) {
        const Ticket interrupt = rig.Give(Interrupt{});
        if (random() % 2) {
          ASSERT_TRUE(rig.RunToEnd(interrupt, 2)) << seed;
        }
        rig.Run(Uniform(random, 0.001, 0.1));
        rig.Give(Continue{});
      } else {
        rig.Give(SetOverride{.velocity_factor = random() % 3 ? Uniform(random, 0, 1) : 0});
      }
    }
    rig.Give(SetOverride{});
    rig.Give(Continue{});
    ASSERT_TRUE(rig.RunToEnd(move, 5)) << seed;
    EXPECT_TRUE(rig.lives[move].done);
    EXPECT_LE((ToolOf(rig).p - to).Norm(), 1e-9);
    EXPECT_LE(WorstFromLine(rig, KDL::Vector::Zero(), to), 1e-9);
    ExpectSmooth(rig);
  }
}

// Interrupted, it stands still on the path for as long as it takes; the state stays GroupMoving.
TEST(Transitions, RestOnThePath) {
  Rig rig = Gantry();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 300});
  rig.Run(0.2);
  const Ticket interrupt = rig.Give(Interrupt{.deceleration = 2000});
  ASSERT_TRUE(rig.RunToEnd(interrupt, 2));
  EXPECT_TRUE(rig.lives[interrupt].done);
  const double there = rig.out().x;
  rig.Run(0.5);
  EXPECT_EQ(rig.out().x, there);
  EXPECT_TRUE(rig.out().interrupted);
  EXPECT_EQ(rig.out().state, GroupState::kMoving);
  rig.Give(Continue{});
  ASSERT_TRUE(rig.RunToEnd(move, 5));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_NEAR(rig.out().x, 300, 1e-9);
  ExpectSmooth(rig);
}

}  // namespace
}  // namespace takt::group
