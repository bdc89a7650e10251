// Properties of every mechanism, at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "mechanisms.h"

namespace takt::kinematics {
namespace {

using testing::Case;
using testing::Cases;
using testing::ConditionOf;
using testing::DegreesBetween;
using testing::Difference;
using testing::ForwardOrFail;
using testing::Random;

class Every : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Case& tried() const { return Cases()[GetParam()]; }
  const Kinematics& kinematics() const { return tried().kinematics; }
};

std::string NameOf(const ::testing::TestParamInfo<std::size_t>& info) {
  return Cases()[info.param].name;
}
INSTANTIATE_TEST_SUITE_P(Mechanisms, Every, ::testing::Range(std::size_t{0}, std::size_t{12}), NameOf);

TEST(Mechanisms, AreAllTried) {
  EXPECT_EQ(Cases().size(), 12u);
}

Joints Nudged(Random& random, const Case& c, const Joints& joints, double by) {
  Joints out = joints;
  for (std::size_t i = 0; i < c.sample.size(); ++i) out[i] += random.Between(-by, by);
  return out;
}

// GR-11: forward(inverse(pose)) is the pose, within 1e-9 mm and 1e-9 deg, all over the workspace; and with the same
// branch and turns requested, the axes are at their positions.
TEST_P(Every, PropertyComesBack) {
  Random random(11);
  const Case& c = tried();
  double worst = 0;
  for (int i = 0; i < Trials(c.closed_form ? 5000 : 1000); ++i) {
    const Joints joints = random.In(c);
    const Frame pose = ForwardOrFail(c.kinematics, joints);
    Joints near = Nudged(random, c, joints, c.closed_form ? 1 : 5);
    if (c.closed_form && i % 4 == 0) near.fill(std::nan(""));
    const Configuration wanted = ConfigurationOf(c.kinematics, joints);
    Joints found{};
    const Reason reason = Inverse(c.kinematics, pose, wanted, near, found);
    if (reason == Reason::kSingular && ConditionOf(c.kinematics, joints) > 1e5) continue;  // met one in a million
    ASSERT_EQ(reason, Reason::kNone) << "trial " << i;
    const Frame back = ForwardOrFail(c.kinematics, found);
    ASSERT_LT((back.p - pose.p).Norm(), 1e-9) << "trial " << i;
    ASSERT_LT(DegreesBetween(back.M, pose.M), 1e-9) << "trial " << i;
    worst = std::max(worst, (back.p - pose.p).Norm());
    if (!c.closed_form || i % 4 == 0 || ConfigurationOf(c.kinematics, near) != wanted) continue;
    for (std::size_t k = 0; k < c.sample.size(); ++k) ASSERT_NEAR(found[k], joints[k], 1e-6) << "axis " << k;
  }
  RecordProperty("worst_mm", std::to_string(worst));
}

// GR-11, GR-23: the Jacobian is the derivative of forward (central differences).
TEST_P(Every, PropertyJacobianIsTheDerivative) {
  Random random(12);
  const Case& c = tried();
  for (int i = 0; i < Trials(300); ++i) {
    const Joints joints = random.In(c);
    Jacobian columns;
    ASSERT_EQ(JacobianAt(c.kinematics, joints, columns), Reason::kNone);
    const double scale = 1 + [&] {
      double largest = 0;
      for (std::size_t k = 0; k < c.sample.size(); ++k) largest = std::max(largest, columns[k].vel.Norm());
      return largest;
    }();
    for (std::size_t k = 0; k < c.sample.size(); ++k) {
      constexpr double kStep = 1e-4;
      Joints less = joints, more = joints;
      less[k] -= kStep;
      more[k] += kStep;
      Frame a, b;
      if (Forward(c.kinematics, less, a) != Reason::kNone || Forward(c.kinematics, more, b) != Reason::kNone) continue;
      const KDL::Twist expected = Difference(a, b) / (2 * kStep);
      if (scale > 100) continue;  // a Delta whose arms all but cannot hold it
      ASSERT_LT((columns[k].vel - expected.vel).Norm(), 1e-5 * scale) << "axis " << k;
      ASSERT_LT((columns[k].rot - expected.rot).Norm(), 1e-8) << "axis " << k;
    }
    for (std::size_t k = c.sample.size(); k < kMaxJoints; ++k) ASSERT_EQ(columns[k], KDL::Twist::Zero());
  }
}

JointMotion SomeMotion(Random& random, const Case& c) {
  JointMotion motion{.position = random.In(c), .velocity = {}, .acceleration = {}};
  for (std::size_t k = 0; k < c.sample.size(); ++k) {
    motion.velocity[k] = random.Between(-100, 100);
    motion.acceleration[k] = random.Between(-1000, 1000);
  }
  return motion;
}

Joints At(const JointMotion& motion, double t) {
  Joints joints = motion.position;
  for (std::size_t k = 0; k < kMaxJoints; ++k) joints[k] += motion.velocity[k] * t + motion.acceleration[k] * t * t / 2;
  return joints;
}

// GR-23: velocity and acceleration of the tool are the derivatives of its position (differences).
TEST_P(Every, PropertyMotionGoesForward) {
  Random random(13);
  const Case& c = tried();
  for (int i = 0; i < Trials(300); ++i) {
    const JointMotion motion = SomeMotion(random, c);
    Jacobian columns;
    ASSERT_EQ(JacobianAt(c.kinematics, motion.position, columns), Reason::kNone);
    if (std::any_of(columns.begin(), columns.end(), [](const KDL::Twist& t) { return t.vel.Norm() > 100; })) continue;
    MovingFrame tool;
    ASSERT_EQ(Forward(c.kinematics, motion, tool), Reason::kNone);
    ASSERT_TRUE(KDL::Equal(tool.GetFrame(), ForwardOrFail(c.kinematics, motion.position), 1e-9));
    KDL::Twist by_columns = KDL::Twist::Zero();
    for (std::size_t k = 0; k < kMaxJoints; ++k) by_columns += columns[k] * motion.velocity[k];
    ASSERT_TRUE(KDL::Equal(tool.GetTwist(), by_columns, 1e-8 * (1 + by_columns.vel.Norm())));
    constexpr double kStep = 1e-5;
    const auto twist_at = [&](double t) {
      JointMotion then{.position = At(motion, t), .velocity = motion.velocity, .acceleration = motion.acceleration};
      for (std::size_t k = 0; k < kMaxJoints; ++k) then.velocity[k] += motion.acceleration[k] * t;
      MovingFrame frame;
      EXPECT_EQ(Forward(c.kinematics, then, frame), Reason::kNone);
      return frame.GetTwist();
    };
    const KDL::Twist expected = (twist_at(kStep) - twist_at(-kStep)) / (2 * kStep);
    const double size = 1 + expected.vel.Norm();
    ASSERT_LT((tool.GetAccTwist().vel - expected.vel).Norm(), 1e-5 * size);
    ASSERT_LT((tool.GetAccTwist().rot - expected.rot).Norm(), 1e-4);
  }
}

// GR-11, GR-23: velocities and accelerations are recovered, too. With a redundant axis only the tool's are.
TEST_P(Every, PropertyMotionComesBack) {
  Random random(14);
  const Case& c = tried();
  for (int i = 0; i < Trials(c.closed_form ? 2000 : 500); ++i) {
    const JointMotion motion = SomeMotion(random, c);
    MovingFrame tool;
    ASSERT_EQ(Forward(c.kinematics, motion, tool), Reason::kNone);
    JointMotion found;
    const Reason reason = Inverse(c.kinematics, tool, {}, motion.position, found);
    if (reason == Reason::kSingular && ConditionOf(c.kinematics, motion.position) > 1e5) continue;
    ASSERT_EQ(reason, Reason::kNone) << "trial " << i;
    if (c.sample.size() <= 6 && ConditionOf(c.kinematics, motion.position) < 1e3) {
      for (std::size_t k = 0; k < c.sample.size(); ++k) {
        ASSERT_NEAR(found.velocity[k], motion.velocity[k], 1e-4) << "axis " << k;
        ASSERT_NEAR(found.acceleration[k], motion.acceleration[k], 1e-2) << "axis " << k;
      }
    }
    MovingFrame back;
    ASSERT_EQ(Forward(c.kinematics, found, back), Reason::kNone);
    const double speed = 1 + tool.GetTwist().vel.Norm(), change = 1 + tool.GetAccTwist().vel.Norm();
    ASSERT_TRUE(KDL::Equal(back.GetTwist(), tool.GetTwist(), 1e-6 * speed));
    ASSERT_TRUE(KDL::Equal(back.GetAccTwist(), tool.GetAccTwist(), 1e-6 * change));
  }
}

// A straight line with an even turn, in one second.
class Line {
 public:
  Line(const Frame& from, const Frame& to) : from_(from.p), way_(to.p - from.p), arc_(ArcBetween(from.M, to.M)) {}
  MovingFrame At(double t) const {
    return {Along(arc_, {t, 1, 0}), KDL::VectorAcc(from_ + way_ * t, way_, KDL::Vector::Zero())};
  }

 private:
  KDL::Vector from_, way_;
  GreatArc arc_;
};

// Returns true if the axes moved from one motion to the next as their velocities say, which may change as their
// accelerations say. A redundant axis may also drift by changes of the smallest motion, which its acceleration does not
// include.
bool Continuous(const Case& c, const JointMotion& from, const JointMotion& to, double period) {
  for (std::size_t k = 0; k < c.sample.size(); ++k) {
    const double moved = to.position[k] - from.position[k];
    const double mean = (to.velocity[k] + from.velocity[k]) / 2 * period;
    const double bend = (std::abs(to.acceleration[k]) + std::abs(from.acceleration[k])) * period * period +
                        (c.sample.size() > 6 ? 2 * std::abs(mean) : 0);
    if (std::abs(moved) > 10 || std::abs(moved - mean) > bend + 0.01) return false;
  }
  return true;
}

// GR-12: along a straight line with an even turn, point by point, each solved from the previous one: the branch stays
// and no axis jumps. Where axes are fast near a singularity the points come closer; a jump would stay one however close
// they are. Where the line leaves the workspace, a reason is given and nothing moves.
TEST_P(Every, PropertyBranchNeverJumpsAlongAPath) {
  Random random(15);
  const Case& c = tried();
  int points = 0, refused = 0;
  for (int i = 0; i < Trials(150); ++i) {
    JointMotion present{.position = random.In(c), .velocity = {}, .acceleration = {}};
    const Line line(ForwardOrFail(c.kinematics, present.position), ForwardOrFail(c.kinematics, random.In(c)));
    const Configuration branch = ConfigurationOf(c.kinematics, present.position);
    if (Inverse(c.kinematics, line.At(0), {}, present.position, present) != Reason::kNone) continue;
    double period = 1e-3;
    for (double t = 0; t < 1;) {
      JointMotion next = present;
      const Reason reason = Inverse(c.kinematics, line.At(t + period), {}, present.position, next);
      if (reason != Reason::kNone) {
        ASSERT_TRUE(reason == Reason::kOutOfReach || reason == Reason::kSingular || reason == Reason::kAxisLimit);
        ASSERT_EQ(next.position, present.position);
        ++refused;
        break;
      }
      ASSERT_EQ(ConfigurationOf(c.kinematics, next.position), branch) << "trial " << i << " at " << t;
      if (!Continuous(c, present, next, period)) {
        period /= 2;
        ASSERT_GT(period, 1e-12) << "trial " << i << " at " << t;
        continue;
      }
      ++points;
      present = next;
      t += period;
      period = std::min(2 * period, 1e-3);
    }
  }
  EXPECT_GT(points, Trials(20000));
  RecordProperty("refused", refused);
}

// GR-12: whatever is requested, the result is a reason or finite numbers; a refusal leaves the output unchanged.
TEST_P(Every, PropertyAnswersEverything) {
  Random random(16);
  const Case& c = tried();
  const std::vector<double> odd{0, -0.0, 1e-300, 1e300, -1e300, 1e18, std::nan(""), INFINITY, -INFINITY};
  for (int i = 0; i < Trials(3000); ++i) {
    const double size = std::pow(10, random.Between(-3, 6));
    Frame pose(KDL::Rotation::Rot(random.Direction(), i % 2 ? random.Between(-4, 4) : 0), random.Direction() * size);
    if (i % 3 == 0) pose.M = KDL::Rotation::RotZ(random.Between(-4, 4));
    if (i % 5 == 0) pose.p.data[i % 3] = odd[static_cast<std::size_t>(i / 5) % odd.size()];
    if (i % 17 == 0) pose.M.data[i % 9] = odd[static_cast<std::size_t>(i / 17) % odd.size()];
    Joints near = random.In(c);
    if (i % 7 == 0)
      near[static_cast<std::size_t>(i) % c.sample.size()] = odd[static_cast<std::size_t>(i / 7) % odd.size()];
    Joints joints{};
    joints.fill(7);
    const Reason reason = Inverse(c.kinematics, pose, {}, near, joints);
    ASSERT_EQ(reason == Reason::kNotFinite, !Finite(pose));
    for (std::size_t k = 0; k < kMaxJoints; ++k) {
      if (reason == Reason::kNone) {
        ASSERT_TRUE(std::isfinite(joints[k]));
      } else {
        ASSERT_EQ(joints[k], 7);
      }
    }
    JointMotion motion;
    const MovingFrame moving(pose, KDL::Twist(random.Direction() * size, random.Direction()), KDL::Twist());
    if (Inverse(c.kinematics, moving, {}, near, motion) == Reason::kNone) {
      for (std::size_t k = 0; k < kMaxJoints; ++k) ASSERT_TRUE(std::isfinite(motion.velocity[k]));
      for (std::size_t k = 0; k < kMaxJoints; ++k) ASSERT_TRUE(std::isfinite(motion.acceleration[k]));
    }
    Joints axes{};
    for (std::size_t k = 0; k < c.sample.size(); ++k) axes[k] = random.Between(-1, 1) * size;
    if (i % 4 == 0)
      axes[static_cast<std::size_t>(i) % c.sample.size()] = odd[static_cast<std::size_t>(i / 4) % odd.size()];
    Frame tool;
    if (Forward(c.kinematics, axes, tool) == Reason::kNone) {
      ASSERT_TRUE(Finite(tool));
    }
    MovingFrame moved;
    if (Forward(c.kinematics, {axes, axes, axes}, moved) == Reason::kNone) {
      ASSERT_TRUE(Finite(moved));
    }
  }
}

// GR-12: an axis' range is kept: a position just inside is returned, one beyond is refused.
TEST_P(Every, PropertyKeepsRangesOfAxes) {
  Random random(17);
  const Case& c = tried();
  if (c.sample.size() > 6) return;  // a redundant axis moves elsewhere
  for (int i = 0; i < Trials(300); ++i) {
    const Joints joints = random.In(c);
    const Frame pose = ForwardOrFail(c.kinematics, joints);
    const std::size_t k = static_cast<std::size_t>(i) % c.sample.size();
    Kinematics limited = c.kinematics;
    limited.ranges[k] = {joints[k] - 1, joints[k] + 1e-5};
    Joints found{};
    ASSERT_EQ(Inverse(limited, pose, {}, joints, found), Reason::kNone);
    limited.ranges[k] = {joints[k] - 1, joints[k] - 1e-5};
    ASSERT_EQ(Inverse(limited, pose, {}, joints, found), Reason::kAxisLimit);
    limited.ranges[k] = {joints[k] + 1e-5, joints[k] + 1};
    ASSERT_EQ(Inverse(limited, pose, {}, joints, found), Reason::kAxisLimit);
  }
}

// GR-30, GR-11: nothing of this allocates.
TEST_P(Every, AllocatesNothing) {
  Random random(18);
  const Case& c = tried();
  const JointMotion motion = SomeMotion(random, c);
  const Joints near = Nudged(random, c, motion.position, 1);
  const long before = AllocationsOfThisThread();
  Frame frame;
  MovingFrame tool;
  Jacobian columns;
  Joints joints{};
  JointMotion found;
  const Configuration branch = ConfigurationOf(c.kinematics, near);
  Reason worst = Forward(c.kinematics, motion.position, frame);
  worst = std::max(worst, Forward(c.kinematics, motion, tool));
  worst = std::max(worst, JacobianAt(c.kinematics, near, columns));
  worst = std::max(worst, Inverse(c.kinematics, frame, branch, near, joints));
  worst = std::max(worst, Inverse(c.kinematics, tool, branch, near, found));
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_EQ(worst, Reason::kNone);
}

}  // namespace
}  // namespace takt::kinematics
