// GR-10: poses and frames. GR-21: the great arc.
#include "takt/kinematics/frames.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "../core/trials.h"
#include "mechanisms.h"
#include "takt/core/verify.h"

namespace takt::kinematics {
namespace {

using testing::DegreesBetween;
using testing::Difference;
using testing::Random;

constexpr double kPi = std::numbers::pi;

void ExpectVector(const KDL::Vector& v, double x, double y, double z, double tolerance = 1e-12) {
  EXPECT_NEAR(v.x(), x, tolerance);
  EXPECT_NEAR(v.y(), y, tolerance);
  EXPECT_NEAR(v.z(), z, tolerance);
}

// GR-10: each rotation alone, by hand: a quarter turn about X takes Y to Z, about Y takes Z to X, about Z takes X to Y.
TEST(Frames, TurnEachAxisTheRightWay) {
  ExpectVector(ToFrame({.a = 90}).M * KDL::Vector(0, 1, 0), 0, 0, 1);
  ExpectVector(ToFrame({.b = 90}).M * KDL::Vector(0, 0, 1), 1, 0, 0);
  ExpectVector(ToFrame({.c = 90}).M * KDL::Vector(1, 0, 0), 0, 1, 0);
}

// GR-10: the order, by hand. The point (0, 1, 0) with A = 90 goes to (0, 0, 1), then with B = 90 to (1, 0, 0), then
// with C = 90 to (0, 1, 0). Any other order of the three ends elsewhere.
TEST(Frames, TurnAboutXFirstThenYThenZ) {
  const Frame frame = ToFrame({1, 2, 3, 90, 90, 90});
  ExpectVector(frame.M * KDL::Vector(0, 1, 0), 0, 1, 0);
  ExpectVector(frame.M * KDL::Vector(1, 0, 0), 0, 0, -1);  // stays, to (0, 0, -1), stays
  ExpectVector(frame.M * KDL::Vector(0, 0, 1), 1, 0, 0);   // to (0, -1, 0), stays, to (1, 0, 0)
  ExpectVector(frame * KDL::Vector(0, 1, 0), 1, 3, 3);
  // A = 90, then C = 90: X goes to Y; Y goes to Z and stays; Z goes to -Y and then to X.
  const KDL::Rotation ac = ToFrame({.a = 90, .c = 90}).M;
  ExpectVector(ac * KDL::Vector(1, 0, 0), 0, 1, 0);
  ExpectVector(ac * KDL::Vector(0, 1, 0), 0, 0, 1);
  ExpectVector(ac * KDL::Vector(0, 0, 1), 1, 0, 0);
}

// GR-10: a belt as in the pick-and-place manual's example: at X 400, Y 500, Z 100, turned by C = 180. A workpiece at
// X 210, Y -50, Z 10 on it is at X 190, Y 550, Z 110 in the machine.
TEST(Frames, PlaceAWorkpieceOnATurnedBelt) {
  const Frame belt = ToFrame({.x = 400, .y = 500, .z = 100, .c = 180});
  const Pose place = ToPose(belt * ToFrame({.x = 210, .y = -50, .z = 10}));
  EXPECT_NEAR(place.x, 190, 1e-10);
  EXPECT_NEAR(place.y, 550, 1e-10);
  EXPECT_NEAR(place.z, 110, 1e-10);
  EXPECT_NEAR(place.c, 180, 1e-10);
}

// GR-10: there and back over all orientations, with the angles in their ranges, beside Eigen's own composition.
TEST(Frames, PropertyPosesComeBack) {
  Random random(1);
  for (int i = 0; i < Trials(20000); ++i) {
    const Pose pose{random.Between(-2000, 2000), random.Between(-2000, 2000), random.Between(-2000, 2000),
                    random.Between(-180, 180),   random.Between(-89, 89),     random.Between(-180, 180)};
    const Frame frame = ToFrame(pose);
    const auto about = [](double degrees, const Eigen::Vector3d& axis) {
      return Eigen::AngleAxisd(degrees * kPi / 180, axis);
    };
    const Eigen::Matrix3d expected = (about(pose.c, Eigen::Vector3d::UnitZ()) *
                                      about(pose.b, Eigen::Vector3d::UnitY()) * about(pose.a, Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(frame.M(r, c), expected(r, c), 1e-14);
    }
    const Pose back = ToPose(frame);
    ASSERT_EQ(back.x, pose.x);
    ASSERT_EQ(back.y, pose.y);
    ASSERT_EQ(back.z, pose.z);
    ASSERT_NEAR(back.a, pose.a, 1e-11);
    ASSERT_NEAR(back.b, pose.b, 1e-11);
    ASSERT_NEAR(back.c, pose.c, 1e-11);
  }
}

// GR-10: at the lock A is 0 and C has all of it; near the lock the rotation still comes back.
TEST(Frames, AnswerInTheGimbalLock) {
  const Pose up = ToPose(ToFrame({.a = 20, .b = 90, .c = 50}));
  EXPECT_EQ(up.a, 0);
  EXPECT_NEAR(up.b, 90, 1e-12);
  EXPECT_NEAR(up.c, 30, 1e-9);  // about the same axis, in the opposite sense
  const Pose down = ToPose(ToFrame({.a = 20, .b = -90, .c = 50}));
  EXPECT_EQ(down.a, 0);
  EXPECT_NEAR(down.b, -90, 1e-12);
  EXPECT_NEAR(down.c, 70, 1e-9);
  Random random(2);
  for (int i = 0; i < Trials(20000); ++i) {
    const double off = std::pow(10, random.Between(-16, 0));
    const Frame frame = ToFrame({.a = random.Between(-180, 180),
                                 .b = (random.Between(-1, 1) < 0 ? -1 : 1) * (90 - off),
                                 .c = random.Between(-180, 180)});
    const Pose pose = ToPose(frame);
    ASSERT_LT(DegreesBetween(ToFrame(pose).M, frame.M), 2e-10) << "off by " << off;
    ASSERT_TRUE(pose.a > -180 && pose.a <= 180 && pose.c > -180 && pose.c <= 180 && std::abs(pose.b) <= 90);
  }
}

// GR-10: half a turn reads 180, never -180.
TEST(Frames, HalfATurnIsPositive) {
  EXPECT_EQ(ToPose(ToFrame({.c = -180})).c, 180);
  EXPECT_EQ(ToPose(ToFrame({.a = -180})).a, 180);
}

// GR-21: by hand: from A = 90 to nothing is a quarter turn about -X; half of it leaves A = 45.
TEST(GreatArc, TurnsOneAxisEvenly) {
  const GreatArc arc = ArcBetween(ToFrame({.a = 90}).M, KDL::Rotation::Identity());
  ExpectVector(arc.axis, -1, 0, 0);
  EXPECT_NEAR(arc.angle, kPi / 2, 1e-15);
  const KDL::RotationAcc half = Along(arc, {0.5, 2, 3});
  EXPECT_NEAR(ToPose(Frame(half.R)).a, 45, 1e-12);
  ExpectVector(half.w, -kPi, 0, 0);
  ExpectVector(half.dw, -1.5 * kPi, 0, 0);
}

// GR-21: it ends where it is to end, is the shortest way (beside Eigen's slerp), and its angular velocity and
// acceleration are those of the orientations themselves (central differences).
TEST(GreatArc, PropertyIsTheShortestWayAndKnowsItsSpeed) {
  Random random(3);
  for (int i = 0; i < Trials(5000); ++i) {
    const auto any = [&] { return KDL::Rotation::Rot(random.Direction(), random.Between(-kPi, kPi)); };
    const KDL::Rotation from = any();
    const KDL::Rotation to = i % 3 == 0 ? KDL::Rotation::Rot(random.Direction(), 1e-8) * from : any();
    const GreatArc arc = ArcBetween(from, to);
    ASSERT_LT(DegreesBetween(Along(arc, {1, 0, 0}).R, to), 1e-12);
    ASSERT_LT(DegreesBetween(Along(arc, {0, 0, 0}).R, from), 1e-13);
    ASSERT_LE(arc.angle, kPi);

    const auto quaternion = [](const KDL::Rotation& r) {
      Eigen::Quaterniond q;
      r.GetQuaternion(q.x(), q.y(), q.z(), q.w());
      return q;
    };
    const double share = random.Between(0, 1);
    const Eigen::Quaterniond expected = quaternion(from).slerp(share, quaternion(to));
    const KDL::Rotation rotation = KDL::Rotation::Quaternion(expected.x(), expected.y(), expected.z(), expected.w());
    if (arc.angle < kPi - 1e-3) {
      ASSERT_LT(DegreesBetween(Along(arc, {share, 0, 0}).R, rotation), 1e-6);
    }

    const auto at = [&](double t) { return Share{0.5 + 0.3 * std::sin(t), 0.3 * std::cos(t), -0.3 * std::sin(t)}; };
    const double t = random.Between(0, 6), h = 1e-4;
    const KDL::RotationAcc now = Along(arc, at(t)), before = Along(arc, at(t - h)), after = Along(arc, at(t + h));
    const KDL::Vector w = TurnBetween(before.R, after.R) / (2 * h);
    ExpectVector(now.w, w.x(), w.y(), w.z(), 1e-7);
    const KDL::Vector dw = (after.w - before.w) / (2 * h);
    ExpectVector(now.dw, dw.x(), dw.y(), dw.z(), 1e-7);
  }
}

// GR-21: between opposite orientations there is an answer, the same each time, and none is NaN.
TEST(GreatArc, AnswersForHalfTurnsAndForNone) {
  const GreatArc none = ArcBetween(ToFrame({.a = 12, .b = 34}).M, ToFrame({.a = 12, .b = 34}).M);
  EXPECT_NEAR(none.angle, 0, 1e-15);
  EXPECT_NEAR(none.axis.Norm(), 1, 1e-15);
  for (const Pose& half : {Pose{.a = 180}, Pose{.b = 180}, Pose{.c = 180}, Pose{.a = 180, .c = 45}}) {
    const GreatArc arc = ArcBetween(KDL::Rotation::Identity(), ToFrame(half).M);
    EXPECT_NEAR(arc.angle, kPi, 1e-14);
    EXPECT_LT(DegreesBetween(Along(arc, {1, 0, 0}).R, ToFrame(half).M), 1e-12);
    EXPECT_TRUE(std::isfinite(Along(arc, {0.5, 1, 0}).w.Norm()));
  }
}

// GR-10: a frame on a frame that moves: velocities and accelerations of the product are those of its place (central
// differences), with Coriolis' and centripetal parts.
TEST(MovingFrames, PropertyMultiplyLikeTheirPlaces) {
  Random random(4);
  for (int i = 0; i < Trials(500); ++i) {
    const KDL::Vector v0 = random.Direction() * 300, v1 = random.Direction() * 200, a1 = random.Direction() * 500;
    const KDL::Vector w0 = random.Direction(), w1 = random.Direction();
    const double turn0 = random.Between(-2, 2), turn1 = random.Between(-2, 2);
    const auto outer = [&](double t) {
      return MovingFrame(KDL::RotationAcc(KDL::Rotation::Rot(w0, turn0 * t), w0 * turn0, KDL::Vector::Zero()),
                         KDL::VectorAcc(v0 * t, v0, KDL::Vector::Zero()));
    };
    const auto inner = [&](double t) {
      return MovingFrame(
          KDL::RotationAcc(KDL::Rotation::Rot(w1, turn1 * t * t), w1 * (2 * turn1 * t), w1 * (2 * turn1)),
          KDL::VectorAcc(v1 * t + a1 * (t * t / 2), v1 + a1 * t, a1));
    };
    const double t = random.Between(-1, 1), h = 1e-5;
    const auto product = [&](double at) { return outer(at) * inner(at); };
    const MovingFrame now = product(t), before = product(t - h), after = product(t + h);
    const KDL::Twist velocity = Difference(before.GetFrame(), after.GetFrame()) / (2 * h);
    ASSERT_TRUE(KDL::Equal(now.GetTwist().vel, velocity.vel, 1e-4));
    ASSERT_TRUE(KDL::Equal(now.GetTwist().rot, velocity.rot, 1e-6));
    const KDL::Twist acceleration = (after.GetTwist() - before.GetTwist()) / (2 * h);
    ASSERT_TRUE(KDL::Equal(now.GetAccTwist().vel, acceleration.vel, 1e-4));
    ASSERT_TRUE(KDL::Equal(now.GetAccTwist().rot, acceleration.rot, 1e-6));
    const MovingFrame back = now * now.Inverse();
    ASSERT_TRUE(KDL::Equal(back.GetTwist(), KDL::Twist::Zero(), 1e-9));
    ASSERT_TRUE(KDL::Equal(back.GetAccTwist(), KDL::Twist::Zero(), 1e-9));
  }
}

TEST(Frames, KnowWhatIsFinite) {
  Frame frame = ToFrame({.x = 1, .a = 20});
  EXPECT_TRUE(Finite(frame));
  frame.p.y(std::nan(""));
  EXPECT_FALSE(Finite(frame));
  MovingFrame moving(ToFrame({.x = 1}));
  EXPECT_TRUE(Finite(moving));
  moving.M.dw.z(INFINITY);
  EXPECT_FALSE(Finite(moving));
}

TEST(Frames, AreDescribed) {
  EXPECT_EQ(Verify(TypeOf<Pose>()), std::vector<std::string>{});
}

}  // namespace
}  // namespace takt::kinematics
