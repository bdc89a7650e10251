// Moves that end with a velocity, and by one increment: AX-34, AX-40. The travel time told when a move begins: AX-96.
#include <gtest/gtest.h>

#include "rig.h"

namespace takt::axis {
namespace {

// Where the axis was, linearly between two samples, when its velocity first got to `velocity` for good.
double VelocityAt(const Rig& rig, double position) {
  for (std::size_t i = 1; i < rig.trace.size(); ++i) {
    const KinematicState& a = rig.trace[i - 1].setpoint;
    const KinematicState& b = rig.trace[i].setpoint;
    if ((a.position - position) * (b.position - position) > 0 || a.position == b.position) continue;
    return a.velocity + (b.velocity - a.velocity) * (position - a.position) / (b.position - a.position);
  }
  return NAN;
}

TEST(MoveContinuous, PassesItsPositionWithTheEndVelocity) {  // AX-34
  for (const double end : {0.0, 50.0, 200.0, 300.0}) {
    for (const double sign : {1.0, -1.0}) {
      SCOPED_TRACE(end * sign);
      Rig rig(LinearParams());
      ASSERT_TRUE(rig.PowerOn());
      const Ticket move = rig.Give(MoveContinuousAbsolute{.position = sign * 80, .end_velocity = end, .velocity = 200});
      rig.Run(1.5);
      EXPECT_TRUE(rig.lives[move].reached);
      EXPECT_FALSE(rig.Ended(move));
      EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
      EXPECT_NEAR(rig.out.set_velocity, sign * end, 1e-9);
      if (end > 0) {
        EXPECT_NEAR(VelocityAt(rig, sign * 80), sign * end, 0.5);
      } else {
        EXPECT_EQ(rig.position(), sign * 80);
      }
      EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
    }
  }
}

TEST(MoveContinuous, CountsFromWhereItBegins) {  // AX-34
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 20}));
  rig.Give(MoveContinuousRelative{.distance = -60, .end_velocity = 30});
  rig.Run(1);
  EXPECT_NEAR(VelocityAt(rig, -40), -30, 0.5);
}

// Where the end velocity cannot be had, as much as can be, and it says so.
TEST(MoveContinuous, SaysWhatHoldsItBack) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveContinuousAbsolute{.position = 99, .end_velocity = 400});
  rig.Run(0.1);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kPosition);
  rig.Run(2);
  EXPECT_EQ(rig.out.error, ErrorId::kSoftLimitPositive);  // as any motion without an end
  EXPECT_LE(rig.position(), 100 + 1e-6);
  Rig shorter(LinearParams());
  ASSERT_TRUE(shorter.PowerOn());
  shorter.Give(MoveContinuousRelative{.distance = 2, .end_velocity = 400});
  shorter.Run(0.05);
  EXPECT_EQ(shorter.out.limited_by, LimitedBy::kDistance);
}

// AX-102: whatever the distance, from rest or in motion, faster or slower than it is to be: it passes its position
// once, never turns back on the way, has the end velocity in the end, and says `reached` then and not before.
TEST(MoveContinuous, ReachesItsEndVelocityHoweverNearItsPosition) {
  for (const double start : {0.0, 60.0, 290.0}) {
    for (const double distance : {0.02, 0.7, 4.0, 9.0, 25.0, 90.0}) {
      for (const double end : {7.0, 120.0, 300.0}) {
        for (const double sign : {1.0, -1.0}) {
          SCOPED_TRACE(testing::Message() << start << " to " << end << " within " << sign * distance);
          AxisParams p = LinearParams();
          p.limits.lower = p.limits.upper = {};
          Rig rig(p);
          ASSERT_TRUE(rig.PowerOn());
          const Direction direction = sign > 0 ? Direction::kPositive : Direction::kNegative;
          if (start > 0) rig.Give(MoveVelocity{.velocity = start, .direction = direction});
          rig.Run(0.6);
          const double begin = rig.position();
          const Ticket move = rig.Give(MoveContinuousRelative{.distance = sign * distance, .end_velocity = end});
          bool passed = false;
          for (int i = 0; i < 4000 && !rig.lives[move].reached; ++i) {
            rig.Step();
            const double v = sign * rig.out.set_velocity;
            ASSERT_GE(v, -1e-9);
            passed |= sign * (rig.position() - begin) >= distance;
            if (rig.lives[move].reached) {
              ASSERT_NEAR(v, end, 1e-6);
              ASSERT_TRUE(passed);
            } else if (passed) {
              ASSERT_NE(rig.out.limited_by, LimitedBy::kNothing);
            }
          }
          ASSERT_TRUE(rig.lives[move].reached);
          rig.Run(0.2);
          EXPECT_NEAR(sign * rig.out.set_velocity, end, 1e-6);
          EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
          EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
        }
      }
    }
  }
}

// AX-102: where a SW limit leaves no room to go on at all, it ends in an error, and not reached for ever.
TEST(MoveContinuous, DoesNotStandReachedAtALimit) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveContinuousAbsolute{.position = 100, .end_velocity = 50});
  rig.Run(3);
  EXPECT_FALSE(rig.lives[move].reached);
  EXPECT_TRUE(rig.Ended(move));
  EXPECT_LE(rig.position(), 100 + 1e-6);
}

// AX-13, AX-102: what waits behind one that is slower than it is to be takes over in the midst of its ramp. From there
// it stops inside the SW limits, however long a cycle is and however gentle the ramps of the next command are.
TEST(MoveContinuous, IsFollowedInsideTheLimits) {
  int handed_over = 0;
  for (const double period : {0.001, 0.008, 0.02}) {
    for (const double distance : {6.0, 11.0, 19.0}) {
      for (double gap = 0.5; gap < 16; gap += 0.5) {
        SCOPED_TRACE(testing::Message() << period << " s, " << distance << " then " << gap << " to the limit");
        AxisParams p = LinearParams();
        p.limits.deceleration = 1500;
        p.limits.upper = distance + gap;
        Rig rig(p, period);
        ASSERT_TRUE(rig.PowerOn());
        const Ticket passing = rig.Give(
            MoveContinuousAbsolute{.position = distance, .end_velocity = 400, .acceleration = 1300, .jerk = 30000});
        const Ticket back = rig.Give(MoveAbsolute{.position = -30, .jerk = 2000, .buffer_mode = BufferMode::kBuffered});
        rig.RunToEnd(back, 20);
        EXPECT_LE(Highest(rig), *p.limits.upper + 1e-6);
        ExpectWithinLimits(rig);
        handed_over += rig.lives[back].done && !rig.lives[passing].reached ? 1 : 0;
      }
    }
  }
  EXPECT_GT(handed_over, 100);  // of 279
}

// What waits behind it begins at its position.
TEST(MoveContinuous, IsFollowed) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(MoveContinuousAbsolute{.position = 50, .end_velocity = 100});
  const Ticket second = rig.Give(MoveAbsolute{.position = 120, .buffer_mode = BufferMode::kBuffered});
  EXPECT_TRUE(rig.RunToEnd(second));
  EXPECT_TRUE(rig.lives[first].reached);
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_NEAR(VelocityAt(rig, 50), 100, 0.5);
  EXPECT_EQ(rig.position(), 120);
}

TEST(Inch, IsForAnAxisThatStands) {  // AX-40
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(Inch{.distance = 0.5});
  rig.Step();
  const Ticket second = rig.Give(Inch{.distance = 0.5});
  EXPECT_TRUE(rig.RunToEnd(first));
  EXPECT_EQ(rig.lives[second].error_id, ErrorId::kState);
  EXPECT_EQ(rig.position(), 0.5);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(Inch{.distance = -1})));
  EXPECT_EQ(rig.position(), -0.5);
}

// AX-96: how long a move takes is known when it begins, and is what happens.
TEST(TravelTime, IsToldWhenAMoveBegins) {
  for (const double distance : {0.01, 1.0, 77.0, -300.0}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket move = rig.Give(MoveRelative{.distance = distance, .velocity = 150});
    ASSERT_TRUE(rig.RunToEnd(move));
    const Life& life = rig.lives[move];
    const auto active = std::find_if(life.events.begin(), life.events.end(),
                                     [](const FeedbackEvent& e) { return e.state == FeedbackState::kActive; });
    const double took = static_cast<double>(life.final_cycle - life.active_cycle + 1) * 0.001;
    EXPECT_GT(active->value, 0);
    EXPECT_NEAR(took, active->value, 0.0011);
  }
}

}  // namespace
}  // namespace takt::axis
