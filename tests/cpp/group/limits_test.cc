// GR-12, GR-23: on every mechanism: each axis within its limits in every cycle, the tool on its path.
#include <random>

#include "../core/allocations.h"
#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

struct Seen {
  double off_path = 0;
  int moves = 0;
};

// Lines between random places, one after the other.
Seen GoAround(const Kind& kind, std::uint64_t seed, int moves) {
  std::mt19937_64 random(seed);
  Rig rig = kind.make();
  rig.StartAt(kind.place(random));
  rig.Step();
  Seen seen;
  for (int i = 0; i < moves; ++i) {
    rig.trace = {rig.trace.back()};
    const Frame from = ToolOf(rig);
    const Pose to = kind.place(random);
    const Ticket move = rig.Give(MoveLinearAbsolute{.x = to.x, .y = to.y, .z = to.z, .a = to.a, .b = to.b, .c = to.c});
    EXPECT_TRUE(rig.RunToEnd(move)) << kind.name;
    ExpectSmooth(rig, kind.name);
    if (!rig.lives[move].done) {
      EXPECT_TRUE(rig.lives[move].error_id == ErrorId::kUnreachable || rig.lives[move].error_id == ErrorId::kSingular);
      EXPECT_LE((ToolOf(rig).p - from.p).Norm(), 1e-9) << "refused, but moved";
      continue;
    }
    ++seen.moves;
    const Frame target = kinematics::ToFrame(to);
    EXPECT_LE((ToolOf(rig).p - target.p).Norm(), 1e-6) << kind.name;
    for (const Sample& sample : rig.trace) {
      const Frame tool = ToolOf(rig, sample);
      EXPECT_TRUE(kinematics::Finite(tool));
      seen.off_path = std::max(seen.off_path, FromLine(tool.p, from.p, target.p));
    }
  }
  return seen;
}

TEST(Limits, OfAllAxesOnLines) {
  for (const Kind& kind : Kinds()) {
    Seen all;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      SCOPED_TRACE(kind.name + " " + std::to_string(seed));
      const Seen seen = GoAround(kind, seed, 8);
      all.off_path = std::max(all.off_path, seen.off_path);
      all.moves += seen.moves;
    }
    std::cout << kind.name << ": " << all.moves << " lines, " << all.off_path << " mm from them at worst\n";
    EXPECT_GE(all.moves, 50) << kind.name;
    EXPECT_LE(all.off_path, kOnPath) << kind.name;
  }
}

// GR-23: short lines on which the axes and not the limits along the path say how fast: they end where they should, and
// do not run beyond that.
TEST(Limits, OfAllAxesOnShortLines) {
  for (const Kind& kind : Kinds()) {
    double off = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      std::mt19937_64 random(seed);
      Rig rig = kind.make();
      const Pose from = kind.place(random), far = kind.place(random);
      const double share = std::exp(Uniform(random, -5, -1));
      rig.StartAt(from);
      rig.Step();
      const KDL::Vector begin = ToolOf(rig).p;
      const KDL::Vector end = begin + share * (kinematics::ToFrame(far).p - begin);
      const Ticket move = rig.Give(MoveLinearAbsolute{
          .x = end.x(), .y = end.y(), .z = end.z(), .velocity = 5000, .acceleration = 50000, .jerk = 3e6});
      ASSERT_TRUE(rig.RunToEnd(move));
      if (!rig.lives[move].done) continue;
      ExpectSmooth(rig, kind.name);
      off = std::max(off, WorstFromLine(rig, begin, end));
    }
    EXPECT_LE(off, 1e-3) << kind.name;
  }
}

// How far from its circle a gantry's tool was; `interrupts`: at random, and on again.
double GoRound(double radius, std::uint64_t seed, bool interrupts) {
  std::mt19937_64 random(seed);
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  rig.Step();
  MoveCircularAbsolute half{.circ_mode = path::CircMode::kBorder, .velocity = 2000, .acceleration = 20000};
  half.aux_x = radius;
  half.aux_y = radius;
  half.x = 2 * radius;
  half.y = 0;
  MoveCircularAbsolute back = half;
  back.aux_y = -radius;
  back.x = 0;
  back.buffer_mode = BufferMode::kBlendingHigh;
  Ticket last = 0;
  for (int i = 0; i < 3; ++i) {
    rig.Give(half);
    last = rig.Give(back);
    half.buffer_mode = BufferMode::kBlendingHigh;
  }
  for (int i = 0; i < 4 && interrupts; ++i) {
    rig.Run(Uniform(random, 0.01, 0.15));
    rig.Give(Interrupt{});
    rig.Run(Uniform(random, 0.01, 0.15));
    rig.Give(Continue{});
  }
  EXPECT_TRUE(rig.RunToEnd(last));
  EXPECT_TRUE(rig.lives[last].done);
  ExpectSmooth(rig);
  double off = 0;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = ToolOf(rig, sample).p;
    off = std::max(off, std::abs(std::hypot(p.x() - radius, p.y()) - radius));
  }
  return off;
}

// GR-23: on circles as fast as the axes can.
TEST(Limits, OfAllAxesOnCircles) {
  for (const double radius : {2.0, 5.0, 20.0, 50.0, 150.0}) {
    EXPECT_LE(GoRound(radius, 0, false), kOnPath) << radius;
    double off = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) off = std::max(off, GoRound(radius, seed, true));
    std::cout << "radius " << radius << " mm, interrupted: " << off << " mm from the circle at worst\n";
    EXPECT_LE(off, kOnPath) << radius;
  }
}

void ExpectRefused(Rig& rig, const Command& command, ErrorId error, kinematics::Reason reason) {
  const std::vector<KinematicState> before = rig.trace.back().set;
  const Ticket move = rig.Give(command);
  ASSERT_TRUE(rig.RunToEnd(move, 1));
  EXPECT_TRUE(rig.lives[move].error);
  EXPECT_EQ(rig.lives[move].error_id, error);
  EXPECT_EQ(rig.out().reason, reason);
  rig.Run(0.05);
  EXPECT_EQ(rig.trace.back().set, before);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
}

// GR-12: refused before anything moves.
TEST(Limits, WhatCannotBeReachedIsRefused) {
  Rig delta = DeltaRobot();
  delta.StartAt({0, 0, -850, 0, 0, 0});
  delta.Step();
  ExpectRefused(delta, MoveLinearAbsolute{.x = 2000}, ErrorId::kUnreachable, kinematics::Reason::kOutOfReach);
  ExpectRefused(delta, MoveDirectAbsolute{.x = 2000, .coordinate_system = CoordinateSystem::kMcs},
                ErrorId::kUnreachable, kinematics::Reason::kOutOfReach);

  Rig scara = ScaraRobot();  // the end is good, the way is not: through the column
  scara.StartAt({300, 250, 0, 0, 0, 0});
  scara.Step();
  ExpectRefused(scara, MoveLinearAbsolute{.x = -300, .y = -250}, ErrorId::kUnreachable,
                kinematics::Reason::kOutOfReach);
  EXPECT_GT(scara.out().blocked_at, 300);

  // Through a place where the wrist is stretched: beyond it two axes would have to be half a turn further.
  Rig wrist = SixAxisRobot();
  wrist.Start(
      {202.49630212634239, -46.652576833184639, -115.82857850336389, 0, 162.48115533654851, -202.49630212634239});
  wrist.Step();
  ExpectRefused(wrist, MoveLinearRelative{.x = -89.58, .y = -67.46, .z = -50.312}, ErrorId::kSingular,
                kinematics::Reason::kSingular);
  EXPECT_NEAR(wrist.out().blocked_at, 111.067, 0.01);

  Rig gantry = Gantry();
  gantry.axes[1].limits.upper = 100;
  gantry.Start();
  gantry.Step();
  ExpectRefused(gantry, MoveLinearAbsolute{.x = 50, .y = 150}, ErrorId::kUnreachable, kinematics::Reason::kAxisLimit);
  MoveCircularAbsolute over{.circ_mode = path::CircMode::kBorder};  // begins and ends within, but bulges out
  over.aux_x = 150;
  over.aux_y = 120;
  over.x = 300;
  ExpectRefused(gantry, over, ErrorId::kUnreachable, kinematics::Reason::kAxisLimit);
  ExpectRefused(gantry, MoveLinearAbsolute{.a = 10, .b = 5}, ErrorId::kUnreachable, kinematics::Reason::kOrientation);
}

// A place in the middle of a queue: what comes before is gone, and it stops there.
TEST(Limits, WhatCannotBeReachedEndsTheQueue) {
  Rig rig = DeltaRobot();
  rig.StartAt({0, 0, -850, 0, 0, 0});
  const Ticket good = rig.Give(MoveLinearAbsolute{.x = 100});
  const Ticket bad = rig.Give(MoveLinearAbsolute{.x = 3000, .buffer_mode = BufferMode::kBlendingNext});
  const Ticket behind = rig.Give(MoveLinearAbsolute{.x = 0, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(good));
  EXPECT_TRUE(rig.lives[good].done);
  EXPECT_EQ(rig.lives[bad].error_id, ErrorId::kUnreachable);
  EXPECT_TRUE(rig.lives[behind].aborted);
  EXPECT_NEAR(rig.out().x, 100, 1e-6);
  ExpectSmooth(rig);
}

// GR-30: nothing that a cycle does takes memory.
TEST(Limits, NoMemoryIsTakenInTheCycle) {
  Rig rig = DeltaRobot();
  rig.StartAt({0, 0, -850, 0, 0, 0});
  rig.Step();
  Context c = rig.Now();
  const Command moves[] = {
      MoveLinearAbsolute{.x = 100},
      MoveLinearAbsolute{.z = -900,
                         .buffer_mode = BufferMode::kBlendingNext,
                         .transition_mode = TransitionMode::kMaxCornerDeviation,
                         .transition_parameter = 5},
      MoveDirectAbsolute{.a1 = 10, .buffer_mode = BufferMode::kBuffered},
  };
  // What a command may be is described when it is first asked for; an engine asks for all when it starts.
  for (const Command& move : moves) EXPECT_EQ(Diagnose(move), "");
  for (const Command& other : {Command{Interrupt{}}, Command{Continue{}}, Command{Stop{}}})
    EXPECT_EQ(Diagnose(other), "");
  Outputs out;
  const long before = AllocationsOfThisThread();
  Ticket ticket = 1000;
  for (const Command& move : moves) Apply(c, ++ticket, 0, move, rig.state);
  for (int i = 0; i < 2000; ++i) {
    Step(c, rig.state);
    for (std::size_t k = 0; k < 3; ++k) axis::Move(rig.AxisContext(k), rig.states[k]);
    Publish(c, rig.state, out);
    c.feedback.Clear();
    if (i == 60) Apply(c, ++ticket, 0, Interrupt{}, rig.state);
    if (i == 200) Apply(c, ++ticket, 0, Continue{}, rig.state);
    if (i == 300) Apply(c, ++ticket, 0, Stop{}, rig.state);
  }
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
}

}  // namespace
}  // namespace takt::group
