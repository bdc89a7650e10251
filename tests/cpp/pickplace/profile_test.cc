// PP-10 to PP-14: points and roundings of travel profiles, by hand.
#include "takt/pickplace/profile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace takt::pickplace {
namespace {

using group::CoordinateSystem;
using kinematics::Frame;
using kinematics::Pose;

const Systems kMcsOnly{Frame::Identity(), Frame::Identity(), Frame::Identity()};

Place At(const Pose& pose) {
  return {.pose = pose};
}
void ExpectAt(const Place& place, double x, double y, double z) {
  EXPECT_NEAR(place.pose.x, x, 1e-12);
  EXPECT_NEAR(place.pose.y, y, 1e-12);
  EXPECT_NEAR(place.pose.z, z, 1e-12);
}

// PP-10: start, point 1 = start + z_start_distance, point 2 = target + z_target_distance, target; without a radius it
// stops at the points. Orientation changes between the points alone (PP-12).
TEST(Profiles, LinearPoints) {
  const Profile p = MakeProfile(At({10, 20, 30, 180, 0, 0}), At({310, 420, 50, 180, 0, 90}),
                                {.start_distance = 25, .target_distance = 40}, kMcsOnly);
  ASSERT_EQ(p.error, ErrorId::kNone);
  ASSERT_EQ(p.count, 3u);
  ExpectAt(p.legs[0].to, 10, 20, 55);
  ExpectAt(p.legs[1].to, 310, 420, 90);
  ExpectAt(p.legs[2].to, 310, 420, 50);
  for (std::uint32_t i = 0; i < p.count; ++i) {
    EXPECT_EQ(p.legs[i].radius, 0);
    EXPECT_EQ(p.legs[i].turns, i == 1);
    EXPECT_FALSE(p.legs[i].arch);
    EXPECT_EQ(LineOf(p.legs[i], {}, false, group::kMaxAxes).buffer_mode, group::BufferMode::kBuffered);
  }
  EXPECT_EQ(p.legs[1].to.pose.c, 90);
}

// PP-10: the radius is limited to half of the shorter distance beside each point: 25 and 305 give 12.5 at point 1,
// 305 and 60 give 30 at point 2.
TEST(Profiles, RadiusIsLimitedToHalfTheShorterDistance) {
  const auto radii = [](double radius) {
    const Profile p = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({305, 0, -35, 0, 0, 0}),
                                  {.start_distance = 25, .target_distance = 60, .radius = radius}, kMcsOnly);
    return std::array{p.legs[1].radius, p.legs[2].radius};
  };
  EXPECT_EQ(radii(10), (std::array{10.0, 10.0}));
  EXPECT_EQ(radii(20), (std::array{12.5, 20.0}));
  EXPECT_EQ(radii(500), (std::array{12.5, 30.0}));
  const Profile p = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({305, 0, -35, 0, 0, 0}),
                                {.start_distance = 25, .target_distance = 60, .radius = 500}, kMcsOnly);
  const auto move = LineOf(p.legs[1], {}, false, group::kMaxAxes);
  EXPECT_EQ(move.buffer_mode, group::BufferMode::kBlendingNext);
  EXPECT_EQ(move.transition_mode, group::TransitionMode::kCornerDistance);
  EXPECT_EQ(move.transition_parameter, 12.5);
}

// PP-10: distances of 0 put the points onto start and target; points above one another are no corner to be rounded.
TEST(Profiles, PointsThatAreNone) {
  const Profile flat = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({100, 0, 0, 0, 0, 0}), {.radius = 10}, kMcsOnly);
  ASSERT_EQ(flat.count, 1u);
  EXPECT_EQ(flat.legs[0].radius, 0);
  const Profile above = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({0, 0, -50, 0, 0, 0}),
                                    {.start_distance = 100, .target_distance = 20, .radius = 10}, kMcsOnly);
  ASSERT_EQ(above.count, 3u);
  EXPECT_EQ(above.legs[1].radius, 0);   // up and down again: it stops
  EXPECT_EQ(above.legs[2].radius, 10);  // straight on
}

// PP-14: start in the MCS, target in a PCS turned by 90 degrees: the points lie along Z of either; the length between
// them (the 3-4-5 triangle over 300 and 400) limits the radius.
TEST(Profiles, PlacesInDifferentSystems) {
  const Frame pcs = kinematics::ToFrame({300, 400, 0, 0, 0, 90});
  const Place target{.system = CoordinateSystem::kPcs, .pcs = 7, .pose = {0, 0, 0, 180, 0, 0}};
  const Profile p =
      MakeProfile(At({0, 0, 0, 0, 0, 0}), target, {.start_distance = 1000, .target_distance = 1000, .radius = 400},
                  {Frame::Identity(), Frame::Identity(), pcs});
  ASSERT_EQ(p.count, 3u);
  EXPECT_EQ(p.legs[1].radius, 250);
  EXPECT_EQ(p.legs[2].radius, 250);
  EXPECT_EQ(p.legs[0].to.system, CoordinateSystem::kMcs);
  const auto move = LineOf(p.legs[1], {}, false, 3);
  EXPECT_EQ(move.coordinate_system, CoordinateSystem::kPcs);
  EXPECT_EQ(move.pcs, 7u);
  EXPECT_EQ(move.z, 1000);
  EXPECT_EQ(move.a, 180);
  EXPECT_TRUE(move.a4.has_value());
  EXPECT_FALSE(LineOf(p.legs[2], {}, false, 3).a.has_value());
  EXPECT_FALSE(LineOf(p.legs[1], {}, true, 3).a.has_value());
}

// PP-11: half an ellipse over the points; with distances of 0 over start and target, and then no rounding.
TEST(Profiles, Ellipse) {
  const Shape shape{
      .mode = PathMode::kElliptical, .start_distance = 20, .target_distance = 10, .height = 60, .radius = 8};
  const Profile p = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({200, 0, 30, 0, 0, 0}), shape, kMcsOnly);
  ASSERT_EQ(p.count, 3u);
  EXPECT_TRUE(p.legs[1].arch);
  EXPECT_EQ(p.legs[1].height, 60);
  ExpectAt(p.legs[0].to, 0, 0, 20);
  ExpectAt(p.legs[1].to, 200, 0, 40);
  EXPECT_EQ(p.legs[1].radius, 8);
  EXPECT_EQ(p.legs[2].radius, 5);  // half of 10
  Shape bare = shape;
  bare.start_distance = bare.target_distance = 0;
  const Profile one = MakeProfile(At({0, 0, 0, 0, 0, 0}), At({200, 0, 30, 0, 0, 0}), bare, kMcsOnly);
  ASSERT_EQ(one.count, 1u);
  EXPECT_EQ(one.legs[0].radius, 0);
  ExpectAt(one.legs[0].to, 200, 0, 30);
}

// PP-11: refused where a place is in ACS, or a coordinate system is turned about A or B; about C it may be turned.
// Lines are refused in ACS only.
TEST(Profiles, EllipseRefused) {
  const Shape shape{.mode = PathMode::kElliptical, .height = 60};
  const Place a = At({0, 0, 0, 0, 0, 0});
  const Place b = At({200, 0, 30, 0, 0, 0});
  const auto error = [&](const Pose& base, const Pose& target, const Shape& with) {
    return MakeProfile(a, b, with, {kinematics::ToFrame(base), Frame::Identity(), kinematics::ToFrame(target)}).error;
  };
  EXPECT_EQ(error({}, {}, shape), ErrorId::kNone);
  EXPECT_EQ(error({}, {0, 0, 0, 0, 0, 30}, shape), ErrorId::kNone);
  EXPECT_EQ(error({}, {0, 0, 0, 1, 0, 0}, shape), ErrorId::kTiltedEllipse);
  EXPECT_EQ(error({}, {0, 0, 0, 0, 1, 0}, shape), ErrorId::kTiltedEllipse);
  EXPECT_EQ(error({0, 0, 0, 0, 1, 0}, {}, shape), ErrorId::kTiltedEllipse);
  EXPECT_EQ(error({0, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0}, {}), ErrorId::kNone);
  Place acs = b;
  acs.system = CoordinateSystem::kAcs;
  EXPECT_EQ(MakeProfile(a, acs, {}, kMcsOnly).error, ErrorId::kParameter);
  EXPECT_EQ(MakeProfile(acs, a, {}, kMcsOnly).error, ErrorId::kParameter);
}

// PP-13: to a parking position two straight legs in either mode; the point lies z_start_distance + z_elliptical above
// the start, the rounding is z_elliptical + blending radius. From it in reverse.
TEST(Profiles, Parking) {
  Place park = At({-400, 500, 300, 0, 0, 0});
  park.parks = true;
  const Place start = At({400, 500, 100, 0, 0, 45});
  const Shape shape{
      .mode = PathMode::kElliptical, .start_distance = 50, .target_distance = 70, .height = 30, .radius = 5};
  const Profile to = MakeProfile(start, park, shape, kMcsOnly);
  ASSERT_EQ(to.count, 2u);
  ExpectAt(to.legs[0].to, 400, 500, 180);
  ExpectAt(to.legs[1].to, -400, 500, 300);
  EXPECT_EQ(to.legs[1].radius, 35);
  EXPECT_TRUE(to.legs[1].turns);
  EXPECT_FALSE(to.legs[0].turns || to.legs[1].arch);
  const Profile from = MakeProfile(park, start, shape, kMcsOnly);
  ASSERT_EQ(from.count, 2u);
  ExpectAt(from.legs[0].to, 400, 500, 200);
  ExpectAt(from.legs[1].to, 400, 500, 100);
  EXPECT_EQ(from.legs[1].radius, 35);
  EXPECT_TRUE(from.legs[0].turns);
  EXPECT_FALSE(from.legs[1].turns);
}

}  // namespace
}  // namespace takt::pickplace
