// CV-03, CV-20 to CV-23: moves in product coordinate systems that go along with belts and tables.
#include <random>

#include "belts.h"

namespace takt::group {
namespace {

constexpr double kOnObject = 1e-9;  // mm

MoveLinearAbsolute Line(double x, double y, double z, std::uint32_t pcs = 0, BufferMode buffer = BufferMode::kAborting,
                        double radius = 0) {
  MoveLinearAbsolute m{.x = x, .y = y, .z = z};
  if (pcs != 0) {
    m.coordinate_system = CoordinateSystem::kPcs;
    m.pcs = pcs;
  }
  m.buffer_mode = buffer;
  if (radius > 0) {
    m.transition_mode = TransitionMode::kCornerDistance;
    m.transition_parameter = radius;
  }
  return m;
}

// How far the tool is from a place on an object in the cycle recorded last.
double Off(const Rig& rig, const Belts& belts, std::size_t belt, double from, const Pose& on, const Pose& place) {
  const Frame object = ObjectOn(belts, belt, from, on, rig.cycle.count - 1);
  return (ToolOf(rig).p - object * kinematics::ToFrame(place).p).Norm();
}

// CV-20, CV-21: from standstill onto a belt, and along with it.
TEST(Riding, OntoABeltAndAlongWithIt) {
  for (const double speed : {0.0, 100.0, 400.0, -250.0}) {
    SCOPED_TRACE(speed);
    Rig rig = Gantry();
    rig.StartAt({0, 0, 0});
    const auto belts = Put(rig, {BeltAt("belt", {50, 200, -100}, [=](double t) { return Steady(t, speed); })});
    const Pose on = {20, 10, 5};
    rig.RunToEnd(rig.Give(SetDynCoordTransform{
        .pcs = 3, .carrier = Name::Of("belt"), .x = 20, .y = 10, .z = 5, .recorded_position = 30.0}));
    rig.trace.clear();
    const Ticket move = rig.Give(Line(0, 0, 40, 3));
    ASSERT_TRUE(rig.RunToEnd(move, 5));
    ASSERT_TRUE(rig.lives[move].done) << static_cast<int>(rig.lives[move].error_id);
    for (int i = 0; i < 300; ++i) {
      rig.Step();
      ASSERT_LE(Off(rig, *belts, 0, 30, on, {0, 0, 40}), kOnObject);
    }
    EXPECT_EQ(rig.out().state, speed == 0 ? rig.out().state : GroupState::kMoving);
    ExpectSmooth(rig);
  }
}

MoveArch Arch(double x, double y, double z, double height, std::uint32_t pcs, BufferMode buffer, double radius = 0) {
  MoveArch m{.x = x, .y = y, .z = z, .height = height};
  if (pcs != 0) {
    m.coordinate_system = CoordinateSystem::kPcs;
    m.pcs = pcs;
  }
  m.buffer_mode = buffer;
  if (radius > 0) {
    m.transition_mode = TransitionMode::kCornerDistance;
    m.transition_parameter = radius;
  }
  return m;
}

// PP-11: an arch that stands keeps to its ellipse.
TEST(Arch, KeepsToItsEllipse) {
  Rig rig = Gantry();
  rig.StartAt({-150, 0, 0});
  const Ticket move = rig.Give(Arch(150, 0, 0, 60, 0, BufferMode::kBuffered));
  ASSERT_TRUE(rig.RunToEnd(move, 5));
  EXPECT_TRUE(rig.lives[move].done);
  ExpectSmooth(rig);
  double highest = 0;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = ToolOf(rig, sample).p;
    highest = std::max(highest, p.z());
    EXPECT_NEAR(p.x() * p.x() / (150 * 150) + p.z() * p.z() / (60 * 60), 1, 1e-3);
  }
  EXPECT_NEAR(highest, 60, 1e-2);
}

// PP-11, CV-23: onto a belt along an arch, between a lift and a lowering.
TEST(Arch, LeadsOntoABelt) {
  Rig rig = Gantry();
  rig.StartAt({-150, 0, 0});
  const auto belts = Put(rig, {BeltAt("belt", {0, 100, -20}, [](double t) { return Steady(t, 300); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt"), .recorded_position = 0.0}));
  rig.trace.clear();
  rig.Give(Line(-150, 0, 30, 0, BufferMode::kBuffered));
  rig.Give(Arch(0, 0, 30, 50, 1, BufferMode::kBlendingNext, 10));
  const Ticket down = rig.Give(Line(0, 0, 0, 1, BufferMode::kBlendingNext, 10));
  ASSERT_TRUE(rig.RunToEnd(down, 5));
  ASSERT_TRUE(rig.lives[down].done) << static_cast<int>(rig.lives[down].error_id);
  EXPECT_LE(Off(rig, *belts, 0, 0, {}, {}), kOnObject);
  ExpectSmooth(rig);
  // No stop on the way.
  bool moving = false;
  for (std::size_t n = 50; n + 50 < rig.trace.size(); ++n) {
    moving |= rig.trace[n].out.path_velocity > 0;
    EXPECT_GT(rig.trace[n].out.path_velocity, 20) << n;
  }
  EXPECT_TRUE(moving);
}

}  // namespace
}  // namespace takt::group
