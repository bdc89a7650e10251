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

}  // namespace
}  // namespace takt::group
