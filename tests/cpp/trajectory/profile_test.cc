#include "takt/trajectory/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "takt/core/verify.h"

namespace takt::trajectory {
namespace {

// 1 s of jerk 2, 2 s of acceleration 2, 1 s of jerk -2: from rest to 6 at 12.
Profile Ramp() {
  Profile p(KinematicState{0, 0, 0});
  EXPECT_TRUE(p.Append(1, 2));
  EXPECT_TRUE(p.Append(2, 0));
  EXPECT_TRUE(p.Append(1, -2));
  return p;
}

TEST(Profile, WithoutPiecesGoesOnAtItsVelocity) {
  const Profile p(KinematicState{1, 2, 0});
  EXPECT_EQ(p.duration(), 0);
  EXPECT_EQ(p.size(), 0);
  EXPECT_EQ(p.At(-1), (KinematicState{1, 2, 0}));
  EXPECT_EQ(p.At(0), (KinematicState{1, 2, 0}));
  EXPECT_EQ(p.At(3), (KinematicState{7, 2, 0}));
  EXPECT_EQ(p.JerkAt(0), 0);
}

TEST(Profile, IntegratesItsPieces) {
  const Profile p = Ramp();
  EXPECT_EQ(p.duration(), 4);
  EXPECT_DOUBLE_EQ(p.At(1).position, 1.0 / 3);
  EXPECT_DOUBLE_EQ(p.At(1).velocity, 1);
  EXPECT_DOUBLE_EQ(p.At(1).acceleration, 2);
  EXPECT_DOUBLE_EQ(p.At(3).velocity, 5);
  EXPECT_DOUBLE_EQ(p.end().position, 12);
  EXPECT_DOUBLE_EQ(p.end().velocity, 6);
  EXPECT_DOUBLE_EQ(p.end().acceleration, 0);
  EXPECT_EQ(p.JerkAt(0), 2);
  EXPECT_EQ(p.JerkAt(1), 0);
  EXPECT_EQ(p.JerkAt(3.5), -2);
  EXPECT_EQ(p.JerkAt(4), 0);
  EXPECT_EQ(p.JerkAt(-0.1), 0);
}

TEST(Profile, AfterTheEndMovesOnWithoutAcceleration) {
  Profile p(KinematicState{0, 0, 0});
  p.AppendWithAcceleration(2, 3, 0);
  EXPECT_EQ(p.At(2), (KinematicState{6, 6, 3}));
  EXPECT_EQ(p.At(3), (KinematicState{12, 6, 0}));
}

TEST(Profile, SnapEndReplacesTheEndOnly) {
  Profile p = Ramp();
  const KinematicState before = p.At(3.9);
  p.SnapEnd({12.5, 6, 0});
  EXPECT_EQ(p.At(3.9), before);
  EXPECT_EQ(p.At(4), (KinematicState{12.5, 6, 0}));
  EXPECT_EQ(p.At(5), (KinematicState{18.5, 6, 0}));
}

TEST(Profile, EvaluationDoesNotDependOnTheOrder) {
  const Profile p = Ramp();
  std::array<KinematicState, 100> forward;
  for (std::size_t i = 0; i < forward.size(); ++i) forward[i] = p.At(0.05 * static_cast<double>(i));
  for (std::size_t i = forward.size(); i-- > 0;) EXPECT_EQ(p.At(0.05 * static_cast<double>(i)), forward[i]);
}

TEST(Profile, AppendsAnother) {
  Profile p = Ramp();
  Profile next(p.end());
  next.AppendWithAcceleration(3, -2, 0);
  EXPECT_TRUE(p.Append(next));
  EXPECT_EQ(p.duration(), 7);
  EXPECT_EQ(p.size(), 4);
  EXPECT_EQ(p.end(), next.end());
  EXPECT_EQ(p.At(5.5), next.At(1.5));
}

// The rest is the same motion.
TEST(Profile, SkipsItsBeginning) {
  const Profile whole = Ramp();
  for (const double t : {-1.0, 0.0, 0.4, 1.0, 2.2, 3.0, 3.9, 4.0, 7.0}) {
    Profile rest = whole;
    rest.Skip(t);
    const double from = std::max(t, 0.0);
    EXPECT_NEAR(rest.duration(), std::max(0.0, 4 - from), 1e-15);
    for (const double later : {0.0, 0.1, 0.6, 1.0, 2.5, 5.0}) {
      const KinematicState is = rest.At(later), was = whole.At(from + later);
      EXPECT_NEAR(is.position, was.position, 1e-12);
      EXPECT_NEAR(is.velocity, was.velocity, 1e-12);
      EXPECT_NEAR(is.acceleration, was.acceleration, 1e-12);
    }
  }
}

TEST(Profile, RefusesWhatDoesNotFit) {
  Profile p(KinematicState{});
  for (int i = 0; i < Profile::kCapacity; ++i) EXPECT_TRUE(p.Append(1, 0.1));
  const KinematicState end = p.end();
  EXPECT_FALSE(p.Append(1, 0.1));
  EXPECT_FALSE(p.Append(Ramp()));
  EXPECT_EQ(p.size(), Profile::kCapacity);
  EXPECT_EQ(p.end(), end);
  EXPECT_EQ(p.At(16), end);
}

TEST(Profile, IgnoresDurationsThatAreNone) {
  Profile p(KinematicState{1, 1, 0});
  EXPECT_TRUE(p.Append(0, 5));
  EXPECT_TRUE(p.Append(-1, 5));
  EXPECT_TRUE(p.Append(std::numeric_limits<double>::quiet_NaN(), 5));
  EXPECT_EQ(p.size(), 0);
}

TEST(Profile, TimeThatIsNoNumberGivesNoNumber) {
  EXPECT_TRUE(std::isnan(Ramp().At(std::numeric_limits<double>::quiet_NaN()).position));
  EXPECT_TRUE(std::isnan(Profile(KinematicState{}).At(std::numeric_limits<double>::quiet_NaN()).position));
}

TEST(Profile, ExtremesLieBetweenTheEnds) {
  Profile p(KinematicState{0, -2, 4});
  p.Append(2, -4);  // v = -2 + 4t - 2t²: rises to 0 at 1 and falls; a from 4 to -4
  EXPECT_DOUBLE_EQ(p.VelocityRange().max, 0);
  EXPECT_DOUBLE_EQ(p.VelocityRange().min, -2);
  EXPECT_DOUBLE_EQ(p.AccelerationRange().max, 4);
  EXPECT_DOUBLE_EQ(p.AccelerationRange().min, -4);
  Profile thrown(KinematicState{0, 10, 0});
  thrown.AppendWithAcceleration(3, -10, 0);  // highest at 1 s
  EXPECT_DOUBLE_EQ(thrown.PositionRange().max, 5);
  EXPECT_DOUBLE_EQ(thrown.PositionRange().min, -15);
  Profile swing(KinematicState{0, 3, -4});
  swing.Append(4, 2);  // v = (t - 1)(t - 3): reverses at 1 and 3
  EXPECT_DOUBLE_EQ(swing.PositionRange().max, 4.0 / 3);
  EXPECT_NEAR(swing.At(3).position, 0, 1e-15);
  EXPECT_DOUBLE_EQ(swing.VelocityRange().min, -1);
}

TEST(Profile, IsDescribedInFull) {
  EXPECT_EQ(Verify(TypeOf<Piece>()), std::vector<std::string>{});
  EXPECT_EQ(Verify(TypeOf<Profile>()), std::vector<std::string>{});
}

}  // namespace
}  // namespace takt::trajectory
