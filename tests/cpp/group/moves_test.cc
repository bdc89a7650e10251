// GR-20, GR-21: moves of every kind in every coordinate system, against closed forms.
#include <random>

#include "machines.h"
#include "takt/core/angle.h"
#include "watch.h"

namespace takt::group {
namespace {

const Pose kBase{1000, 200, 50, 0, 0, 90};  // of the MCS in the world
const Pose kProduct{40, 30, 10, 0, 0, 30};  // of PCS 3 in the MCS
constexpr double kSlow = 200;               // mm/s: what the axes can do is no matter here; see limits_test.cc
const Pose kStart{10, 20, 30, 0, 0, 0};

Frame SystemOf(CoordinateSystem system) {
  if (system == CoordinateSystem::kWcs) return kinematics::ToFrame(kBase).Inverse();
  if (system == CoordinateSystem::kPcs) return kinematics::ToFrame(kProduct);
  return Frame::Identity();
}

class InSystem : public testing::TestWithParam<CoordinateSystem> {
 protected:
  InSystem() : rig(Gantry({}, kBase)), system(SystemOf(GetParam())) {
    rig.StartAt(kStart);
    rig.RunToEnd(rig.Give(SetCartesianTransform{3, kProduct.x, kProduct.y, kProduct.z, 0, 0, kProduct.c}));
    rig.trace.clear();
  }
  void ExpectStraight(Ticket move, const KDL::Vector& to) {
    ASSERT_TRUE(rig.RunToEnd(move));
    EXPECT_TRUE(rig.lives[move].done) << static_cast<int>(rig.lives[move].error_id);
    EXPECT_LE((ToolOf(rig).p - to).Norm(), 1e-9);
    EXPECT_LE(WorstFromLine(rig, KDL::Vector(kStart.x, kStart.y, kStart.z), to), 1e-9);
    EXPECT_EQ(rig.out().state, GroupState::kStandby);
    ExpectSmooth(rig);
  }
  Rig rig;
  Frame system;
};

TEST_P(InSystem, GoesStraightTo) {
  const Frame tool = system.Inverse() * ToolOf(rig.trace.empty() ? (rig.Step(), rig) : rig);
  // What is not given stays as it is in that system.
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 150, .y = -60, .coordinate_system = GetParam(), .pcs = 3});
  ExpectStraight(move, system * KDL::Vector(150, -60, tool.p.z()));
}
TEST_P(InSystem, GoesStraightBy) {
  const Ticket move = rig.Give(MoveLinearRelative{.x = 100, .z = -20, .coordinate_system = GetParam(), .pcs = 3});
  ExpectStraight(move, KDL::Vector(kStart.x, kStart.y, kStart.z) + system.M * KDL::Vector(100, 0, -20));
}
// A gantry's axes are the coordinates: what goes evenly in them goes straight.
TEST_P(InSystem, GoesDirectlyTo) {
  const Ticket move = rig.Give(MoveDirectAbsolute{.x = 1, .y = 2, .z = 3, .coordinate_system = GetParam(), .pcs = 3});
  ExpectStraight(move, system * KDL::Vector(1, 2, 3));
}
TEST_P(InSystem, GoesDirectlyBy) {
  const Ticket move = rig.Give(MoveDirectRelative{.y = 70, .coordinate_system = GetParam(), .pcs = 3});
  ExpectStraight(move, KDL::Vector(kStart.x, kStart.y, kStart.z) + system.M * KDL::Vector(0, 70, 0));
}
// Half a circle about a centre of that system.
TEST_P(InSystem, GoesAround) {
  const KDL::Vector begin = system.Inverse() * KDL::Vector(kStart.x, kStart.y, kStart.z);
  MoveCircularAbsolute circle{.circ_mode = path::CircMode::kCenter, .coordinate_system = GetParam(), .pcs = 3};
  circle.aux_x = begin.x() + 50;
  circle.aux_y = begin.y();
  circle.aux_z = begin.z();
  circle.x = begin.x() + 100;
  circle.velocity = kSlow;
  const Ticket move = rig.Give(circle);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_LE((ToolOf(rig).p - system * KDL::Vector(begin.x() + 100, begin.y(), begin.z())).Norm(), 1e-9);
  double lowest = 0;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = system.Inverse() * ToolOf(rig, sample).p - begin - KDL::Vector(50, 0, 0);
    EXPECT_NEAR(p.Norm(), 50, 1e-6);
    lowest = std::min(lowest, p.y());
  }
  EXPECT_NEAR(lowest, -50, 0.01);  // counterclockwise from the left: below
}

INSTANTIATE_TEST_SUITE_P(Group, InSystem,
                         testing::Values(CoordinateSystem::kMcs, CoordinateSystem::kWcs, CoordinateSystem::kPcs));

// GR-20: in ACS lines are lines of the axes, too.
TEST(Moves, OfAxes) {
  Rig rig = DeltaRobot();
  rig.StartAt({0, 0, -850, 0, 0, 0});
  const std::vector<KinematicState> at = (rig.Step(), rig.trace.back().set);
  const Ticket by = rig.Give(MoveLinearRelative{.a1 = 10, .a2 = -5, .coordinate_system = CoordinateSystem::kAcs});
  ASSERT_TRUE(rig.RunToEnd(by));
  EXPECT_TRUE(rig.lives[by].done);
  for (const Sample& sample : rig.trace) {
    EXPECT_NEAR(sample.set[1].position - at[1].position, -0.5 * (sample.set[0].position - at[0].position), 1e-9);
    EXPECT_EQ(sample.set[2].position, at[2].position);
  }
  const Ticket to = rig.Give(MoveLinearAbsolute{.a1 = 5, .a3 = 8, .coordinate_system = CoordinateSystem::kAcs});
  ASSERT_TRUE(rig.RunToEnd(to));
  EXPECT_TRUE(rig.lives[to].done);
  EXPECT_NEAR(rig.trace.back().set[0].position, 5, 1e-9);
  EXPECT_NEAR(rig.trace.back().set[1].position, at[1].position - 5, 1e-9);
  EXPECT_NEAR(rig.trace.back().set[2].position, 8, 1e-9);
  ExpectSmooth(rig);
}

// An arc of the gantry from (100, 0, 0) about the origin, and what it must be: about Z, through `turn` degrees, rising.
struct ArcCase {
  std::string name;
  MoveCircularAbsolute move;
  KDL::Vector centre;
  double turn, rise;
};

MoveCircularAbsolute Arc(path::CircMode mode, const KDL::Vector& aux, path::PathChoice choice, double x, double y,
                         double z = 0, std::uint32_t turns = 0) {
  MoveCircularAbsolute m{.circ_mode = mode};
  m.aux_x = aux.x();
  m.aux_y = aux.y();
  m.aux_z = aux.z();
  m.path_choice = choice;
  m.turns = turns;
  m.velocity = kSlow;
  m.x = x;
  m.y = y;
  m.z = z;
  if (mode == path::CircMode::kCenter) m.normal_z = 1;
  return m;
}

std::vector<ArcCase> Arcs() {
  using path::CircMode;
  using path::PathChoice;
  const double h = 100 * std::sqrt(0.5);
  const KDL::Vector centre(0, 0, 0);
  const auto ccw = PathChoice::kCounterclockwise, cw = PathChoice::kClockwise;
  return {{"border", Arc(CircMode::kBorder, {h, h, 0}, ccw, 0, 100), centre, 90, 0},
          {"border the long way", Arc(CircMode::kBorder, {-100, 0, 0}, ccw, 0, 100), centre, -270, 0},
          {"centre", Arc(CircMode::kCenter, centre, ccw, 0, 100), centre, 90, 0},
          {"centre clockwise", Arc(CircMode::kCenter, centre, cw, 0, 100), centre, -270, 0},
          {"whole circle", Arc(CircMode::kCenter, centre, ccw, 100, 0), centre, 360, 0},
          {"two turns more", Arc(CircMode::kCenter, centre, ccw, 0, 100, 0, 2), centre, 810, 0},
          {"helix", Arc(CircMode::kCenter, centre, ccw, -100, 0, 40, 1), centre, 540, 40},
          {"radius short", Arc(CircMode::kRadius, {0, 0, 100}, PathChoice::kShort, 0, 100), centre, 90, 0},
          {"radius long", Arc(CircMode::kRadius, {0, 0, 100}, PathChoice::kLong, 0, 100), {100, 100, 0}, 270, 0},
          {"radius the other way", Arc(CircMode::kRadius, {0, 0, -100}, PathChoice::kLong, 0, 100), centre, -270, 0}};
}

// GR-20: every mode of arcs, both senses, whole turns and helices.
TEST(Moves, GoAroundInEveryMode) {
  for (const ArcCase& arc : Arcs()) {
    Rig rig = Gantry();
    rig.StartAt({100, 0, 0, 0, 0, 0});
    const Ticket move = rig.Give(arc.move);
    ASSERT_TRUE(rig.RunToEnd(move)) << arc.name;
    EXPECT_TRUE(rig.lives[move].done) << arc.name;
    double angle = 0;
    KDL::Vector before = KDL::Vector(100, 0, 0) - arc.centre;
    double worst = 0;
    for (const Sample& sample : rig.trace) {
      const KDL::Vector p = ToolOf(rig, sample).p - arc.centre;
      angle += std::atan2(before.x() * p.y() - before.y() * p.x(), before.x() * p.x() + before.y() * p.y());
      before = p;
      worst = std::max(
          {worst, std::abs(std::hypot(p.x(), p.y()) - 100), std::abs(p.z() - arc.rise * angle / (arc.turn * kDegree))});
    }
    EXPECT_NEAR(angle / kDegree, arc.turn, 1e-6) << arc.name;
    EXPECT_LE(worst, 1e-6) << arc.name;
    ExpectSmooth(rig, arc.name);
  }
}

// GR-20: relative arcs count the centre and the end from the beginning.
TEST(Moves, GoAroundRelatively) {
  Rig rig = Gantry();
  rig.StartAt({500, 300, 20, 0, 0, 0});
  MoveCircularRelative m{.circ_mode = path::CircMode::kCenter};
  m.aux_x = -50;
  m.x = -50;
  m.y = 50;
  m.velocity = kSlow;
  const Ticket move = rig.Give(m);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  ExpectAt(ToolOf(rig), {450, 350, 20, 0, 0, 0}, 1e-9);
  for (const Sample& s : rig.trace) EXPECT_NEAR((ToolOf(rig, s).p - KDL::Vector(450, 300, 20)).Norm(), 50, 1e-6);
}

// GR-20: direct moves: all axes begin and arrive in the same cycle, one of them at its limit.
TEST(Moves, ArriveTogether) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20; ++i) {
    Rig rig = ScaraRobot();
    rig.Start({0, 60, 0, 0});
    const std::array<double, 4> to = {Uniform(random, -60, 60), Uniform(random, 20, 120), Uniform(random, -100, 100),
                                      Uniform(random, -180, 180)};
    const Ticket move = rig.Give(MoveDirectAbsolute{.a1 = to[0], .a2 = to[1], .a3 = to[2], .a4 = to[3]});
    ASSERT_TRUE(rig.RunToEnd(move));
    ASSERT_TRUE(rig.lives[move].done);
    const std::vector<KinematicState> begin = rig.trace.front().set;
    for (const Sample& sample : rig.trace) {
      const double share = (sample.set[0].position - begin[0].position) / (to[0] - begin[0].position);
      for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_NEAR(sample.set[k].position, begin[k].position + share * (to[k] - begin[k].position), 1e-3);
      }
    }
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(rig.trace.back().set[k].position, to[k], 1e-9);
    const Use use = UseOf(rig);
    EXPECT_GE(std::max({use.velocity, use.acceleration, use.jerk}), 0.9);
    ExpectSmooth(rig);
  }
}

// GR-21: the tool turns about one axis, evenly with the way, and arrives.
TEST(Moves, TurnAlongTheGreatArc) {
  Rig rig = SixAxisRobot({0, 0, 50, 0, 0, 0});
  rig.StartAt({500, -100, 500, 0, 80, 0});
  const Frame begin = (rig.Step(), ToolOf(rig));
  const Pose target{520, 150, 450, 20, 60, 30};
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 520, .y = 150, .z = 450, .a = 20, .b = 60, .c = 30});
  ASSERT_TRUE(rig.RunToEnd(move));
  ASSERT_TRUE(rig.lives[move].done) << static_cast<int>(rig.lives[move].error_id);
  ExpectAt(ToolOf(rig), target);
  const Frame end = kinematics::ToFrame(target);
  const KDL::Vector turn = KDL::diff(begin.M, end.M);
  for (const Sample& sample : rig.trace) {
    const Frame tool = ToolOf(rig, sample);
    const double share = (tool.p - begin.p).Norm() / (end.p - begin.p).Norm();
    EXPECT_LE((KDL::diff(begin.M, tool.M) - share * turn).Norm(), 1e-6);
    EXPECT_LE(FromLine(tool.p, begin.p, end.p), 1e-6);
  }
  ExpectSmooth(rig);
}

// Several in one cycle: each aborts the one before, the last one is gone.
TEST(Moves, OfOneCycleAbortEachOther) {
  Rig rig = Gantry();
  rig.Start();
  const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100});
  const Ticket second = rig.Give(MoveLinearAbsolute{.y = 100});
  const Ticket third = rig.Give(MoveLinearAbsolute{.z = 100});
  ASSERT_TRUE(rig.RunToEnd(third, 5));
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_TRUE(rig.lives[second].aborted);
  EXPECT_TRUE(rig.lives[third].done);
  ExpectAt(ToolOf(rig), {0, 0, 100, 0, 0, 0}, 1e-9);
}

// GR-21: auxiliary axes go along with the path.
TEST(Moves, TakeAuxiliaryAxesAlong) {
  Rig rig = GantryWithAuxiliary();
  rig.Start();
  const Ticket line = rig.Give(MoveLinearAbsolute{.x = 300, .y = 400, .a4 = 50});
  ASSERT_TRUE(rig.RunToEnd(line));
  ASSERT_TRUE(rig.lives[line].done);
  for (const Sample& sample : rig.trace) {
    EXPECT_NEAR(sample.set[3].position, std::hypot(sample.set[0].position, sample.set[1].position) / 10, 1e-9);
  }
  const Ticket alone = rig.Give(MoveLinearRelative{.a4 = -20});  // the tool stands
  ASSERT_TRUE(rig.RunToEnd(alone));
  EXPECT_TRUE(rig.lives[alone].done);
  EXPECT_NEAR(rig.trace.back().set[3].position, 30, 1e-9);
  EXPECT_NEAR(rig.trace.back().set[0].position, 300, 1e-9);
  ExpectSmooth(rig);
}

}  // namespace
}  // namespace takt::group
