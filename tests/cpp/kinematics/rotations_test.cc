// EN-35: rotations with the same bits on every processor, compared with KDL's and urdfdom's.
#include "takt/kinematics/rotations.h"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <numbers>
#include <random>

#include "takt/kinematics/urdf_angles.h"

namespace takt::kinematics {
namespace {

double Off(const KDL::Rotation& got, const KDL::Rotation& wanted) {
  double most = 0;
  for (int i = 0; i < 9; ++i) most = std::max(most, std::abs(got.data[i] - wanted.data[i]));
  return most;
}

TEST(Rotations, AreThoseOfKdl) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(-7, 7), number(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double a = angle(random), b = angle(random), c = angle(random);
    KDL::Vector axis(number(random), number(random), number(random));
    axis.Normalize();
    ASSERT_LT(Off(AboutX(a), KDL::Rotation::RotX(a)), 1e-15);
    ASSERT_LT(Off(AboutY(a), KDL::Rotation::RotY(a)), 1e-15);
    ASSERT_LT(Off(AboutZ(a), KDL::Rotation::RotZ(a)), 1e-15);
    ASSERT_LT(Off(About(axis, a), KDL::Rotation::Rot2(axis, a)), 1e-15);
    ASSERT_LT(Off(RollPitchYaw(a, b, c), KDL::Rotation::RPY(a, b, c)), 1e-15);
  }
}

TEST(Rotations, KeepTheAxisAndComeBackAfterAWholeTurn) {
  const KDL::Vector axis(2.0 / 7, -3.0 / 7, 6.0 / 7);
  for (const double angle : {0.0, 1e-9, 0.3, -2.0, std::numbers::pi, 1e6}) {
    const KDL::Rotation turned = About(axis, angle);
    EXPECT_LT((turned * axis - axis).Norm(), 1e-15) << angle;
    EXPECT_LT(Off(turned * About(axis, -angle), KDL::Rotation::Identity()), 1e-15) << angle;
    EXPECT_LT(Off(About(axis, 2 * std::numbers::pi), KDL::Rotation::Identity()), 1e-15);
  }
  EXPECT_EQ(Off(About(axis, 0), KDL::Rotation::Identity()), 0);
}

// Every notation of an orientation, and none, in joints and in shapes, of which a link has several.
constexpr const char* kUrdf = R"(<?xml version="1.0"?>
<robot name="two">
  <link name="base">
    <collision><origin xyz="0 0 1" rpy="0.1 -2.5 3.9"/><geometry><sphere radius="0.1"/></geometry></collision>
    <visual><origin rpy="9 9 9"/><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin rpy="  1.5707963267948966   0 -1e-3 "/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="tip"/>
  <link name="end"/>
  <joint name="first" type="continuous">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 0.2" rpy="-3 0.7 12"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="second" type="fixed"><parent link="tip"/><child link="end"/></joint>
</robot>)";

KDL::Rotation OfUrdfdom(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return KDL::Rotation::Quaternion(q.x, q.y, q.z, q.w);
}

TEST(UrdfAngles, AreThoseOfUrdfdom) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(kUrdf);
  ASSERT_TRUE(model);
  const UrdfAngles angles = ReadUrdfAngles(kUrdf);
  ASSERT_EQ(angles.joints.size(), model->joints_.size());
  for (const auto& [name, joint] : model->joints_) {
    EXPECT_LT(Off(angles.joints.at(name), OfUrdfdom(joint->parent_to_joint_origin_transform)), 2e-15) << name;
  }
  ASSERT_EQ(angles.collisions.size(), model->links_.size());
  for (const auto& [name, link] : model->links_) {
    const std::vector<KDL::Rotation>& shapes = angles.collisions.at(name);
    ASSERT_EQ(shapes.size(), link->collision_array.size()) << name;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      EXPECT_LT(Off(shapes[i], OfUrdfdom(link->collision_array[i]->origin)), 2e-15) << name << " " << i;
    }
  }
  EXPECT_EQ(angles.collisions.at("base").size(), 4u);
}

}  // namespace
}  // namespace takt::kinematics
