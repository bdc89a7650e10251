#include "takt/trajectory/planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "../core/allocations.h"
#include "problems.h"

namespace takt::trajectory {
namespace {

const Limits kSCurve{.velocity = 500, .acceleration = 2000, .deceleration = 2000, .jerk = 20000};
const Limits kTrapezoid{.velocity = 500, .acceleration = 2000, .deceleration = 2000, .jerk = 0};

Profile PlanTo(const KinematicState& from, double position, const Limits& limits, double end_velocity = 0) {
  Planner planner;
  Profile plan;
  EXPECT_TRUE(planner.ToPosition(from, position, end_velocity, limits, plan).ok());
  EXPECT_EQ(plan.start(), from);
  EXPECT_EQ(plan.end(), (KinematicState{position, end_velocity, 0}));
  return plan;
}

double RestToRest(double distance, const Limits& limits) {
  const double forth = PlanTo({10, 0, 0}, 10 + distance, limits).duration();
  const double back = PlanTo({10, 0, 0}, 10 - distance, limits).duration();
  EXPECT_NEAR(forth, back, 1e-12);
  return forth;
}

// The four shapes of the seven-piece S-curve from rest to rest. AX-13
TEST(Planner, SCurveWithCruiseLastsDistanceByVelocityPlusRamp) {
  // D/V + V/A + A/J
  EXPECT_NEAR(RestToRest(1000, kSCurve), 2.0 + 0.25 + 0.1, 1e-12);
}
TEST(Planner, SCurveThatReachesAccelerationButNotVelocity) {
  // Vp from D = Vp (Vp/A + A/J); 2 (Vp/A + A/J)
  Limits fast = kSCurve;
  fast.velocity = 1000;
  const double peak = 1000 * (std::sqrt(0.21) - 0.1);
  const Profile plan = PlanTo({0, 0, 0}, 100, fast);
  EXPECT_NEAR(plan.duration(), 2 * (peak / 2000 + 0.1), 1e-9);
  EXPECT_NEAR(plan.VelocityRange().max, peak, 1e-6);
}
TEST(Planner, SCurveThatReachesNeitherVelocityNorAcceleration) {
  // 4 (D / 2J)^(1/3)
  EXPECT_NEAR(RestToRest(2, kSCurve), 4 * std::cbrt(2.0 / 40000), 1e-9);
  EXPECT_NEAR(RestToRest(2e-6, kSCurve), 4 * std::cbrt(2e-6 / 40000), 1e-10);
}
TEST(Planner, SCurveThatReachesVelocityButNotAcceleration) {
  // D/V + 2 (V/J)^(1/2)
  Limits slow = kSCurve;
  slow.velocity = 100;
  EXPECT_NEAR(RestToRest(100, slow), 1 + 2 * std::sqrt(100.0 / 20000), 1e-12);
}

// Jerk 0 = unlimited. AX-13
TEST(Planner, TrapezoidLastsDistanceByVelocityPlusRamp) {
  EXPECT_NEAR(RestToRest(1000, kTrapezoid), 2.25, 1e-12);
}
TEST(Planner, TriangleLastsTwiceTheRoot) {
  EXPECT_NEAR(RestToRest(100, kTrapezoid), 2 * std::sqrt(100.0 / 2000), 1e-12);
}

TEST(Planner, DecelerationHasItsOwnLimit) {
  Limits l = kTrapezoid;
  l.deceleration = 500;
  // D/V + V/2 (1/A + 1/Dec)
  EXPECT_NEAR(RestToRest(1000, l), 2 + 250 * (1.0 / 2000 + 1.0 / 500), 1e-12);
  l.jerk = 20000;
  EXPECT_NEAR(RestToRest(1000, l), 2 + 0.5 * (0.25 + 0.1) + 0.5 * (1 + 0.025), 1e-12);
  const auto a = PlanTo({0, 0, 0}, 1000, l).AccelerationRange();
  EXPECT_NEAR(a.max, 2000, 1e-9);
  EXPECT_NEAR(a.min, -500, 1e-9);
}

TEST(Planner, ReversalKeepsBothBoundsThroughStandstill) {
  for (const double deceleration : {500.0, 8000.0}) {
    for (const double jerk : {0.0, 20000.0}) {
      const Limits l{500, 2000, deceleration, jerk};
      for (const double target : {-300.0, 0.0, 5.0}) {
        const Profile plan = PlanTo({0, 400, 0}, target, l);
        const auto e = testing::Audit(plan, l);
        EXPECT_LE(e.acceleration, 1e-9) << target;
        EXPECT_LE(e.deceleration, 1e-9) << target;
        EXPECT_LT(plan.VelocityRange().min, 0);
      }
    }
  }
}

// AX-14
TEST(Planner, TargetTooNearIsOvershotWithinLimitsAndReturnedTo) {
  const Profile plan = PlanTo({0, 500, 0}, 10, kSCurve);
  // Braking from 500: 0.1 s until 2000 are reached, then v²/2a; the acceleration passes standstill.
  EXPECT_NEAR(plan.PositionRange().max, 50 - 20.0 / 6 + 400.0 * 400 / 4000, 1e-9);
  EXPECT_LE(testing::Audit(plan, kSCurve).velocity, 1e-9);
}

TEST(Planner, EndVelocityThatNeedsRoomRunsBackFirst) {
  const Profile plan = PlanTo({0, 0, 0}, 0.001, kSCurve, 400);
  EXPECT_LT(plan.VelocityRange().min, 0);
  EXPECT_LT(plan.PositionRange().min, 0);
  EXPECT_LE(plan.VelocityRange().max, 500);
}

TEST(Planner, LimitsFarApartHoldOnLongWays) {
  for (const double jerk : {1e8, 1e9, 1e10, 1e12, 1e15}) {
    for (const double velocity : {10.0, 100.0, 500.0, 1000.0, 2000.0}) {
      for (const double share : {1.0, 2.0, 0.5, 3.0, 1.0001, 0.999}) {
        for (const double distance : {300.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9}) {
          const double acceleration = velocity * 1000 / share;
          const Limits limits{velocity, acceleration, acceleration, jerk};
          const Profile plan = PlanTo({0, 0, 0}, distance, limits);
          EXPECT_LE(plan.VelocityRange().max, velocity * (1 + 1e-5)) << jerk << " " << acceleration << " " << distance;
        }
      }
    }
  }
}
TEST(Planner, EndVelocityAtTheLimitIsReached) {
  EXPECT_NEAR(PlanTo({0, 0, 0}, 1000, kSCurve, 500).duration(), 2 + 0.5 * 0.35, 1e-12);
  EXPECT_NEAR(PlanTo({0, 500, 0}, 1000, kSCurve, 500).duration(), 2, 1e-12);
}

TEST(Planner, NoWayToGoTakesNoTime) {
  EXPECT_EQ(PlanTo({7, 0, 0}, 7, kSCurve).duration(), 0);
  EXPECT_EQ(PlanTo({7, 0, 0}, 7, kTrapezoid).duration(), 0);
  EXPECT_EQ(PlanTo({7, 100, 0}, 7, kSCurve, 100).duration(), 0);
  // To the same position with another velocity is a motion.
  EXPECT_GT(PlanTo({7, 0, 0}, 7, kSCurve, 100).duration(), 0);
  EXPECT_GT(PlanTo({7, 100, 0}, 7, kSCurve).duration(), 0);
  EXPECT_GT(PlanTo({7, 0, 100}, 7, kSCurve).duration(), 0);
}

TEST(Planner, WayOfOneRoundingIsPlanned) {
  const Profile plan = PlanTo({7, 0, 0}, std::nextafter(7, 8), kSCurve);
  EXPECT_LT(plan.duration(), 1e-5);
}

// AX-97: a limit lowered in motion.
TEST(Planner, AccelerationBeyondItsLimitFallsAtFullJerk) {
  Limits l = kSCurve;
  l.acceleration = l.deceleration = 500;
  for (const KinematicState from : {KinematicState{0, 100, 2000}, KinematicState{0, 300, -2000}}) {
    for (const double target : {-400.0, 400.0}) {
      const Profile plan = PlanTo(from, target, l);
      EXPECT_EQ(plan.JerkAt(0), from.acceleration > 0 ? -20000 : 20000);
      // From 2000 to 500 at 20000.
      EXPECT_NEAR(std::abs(plan.At(0.075).acceleration), 500, 1e-9);
      EXPECT_LE(testing::Audit(plan, l).acceleration, 1e-9);
      EXPECT_LE(testing::Audit(plan, l).deceleration, 1e-9);
      Planner planner;
      Profile stop;
      ASSERT_TRUE(planner.Stop(from, l, stop).ok());
      EXPECT_EQ(stop.JerkAt(0), plan.JerkAt(0));
    }
  }
}

// AX-97
TEST(Planner, SpeedBeyondItsLimitIsBrakedToItAtOnce) {
  Limits l = kSCurve;
  l.velocity = 200;
  const Profile plan = PlanTo({0, 500, 0}, 1000, l);
  EXPECT_EQ(plan.VelocityRange().max, 500);
  EXPECT_GE(plan.VelocityRange().min, 0);
  // From 500 to 200 with an acceleration of 2000 and a jerk of 20000.
  EXPECT_NEAR(plan.At(300.0 / 2000 + 0.1).velocity, 200, 1e-9);
}

TEST(Planner, ToVelocityLastsAsLongAsItsRamp) {
  Planner planner;
  Profile plan;
  ASSERT_TRUE(planner.ToVelocity({5, 0, 0}, 500, kSCurve, plan).ok());
  EXPECT_NEAR(plan.duration(), 0.35, 1e-12);
  EXPECT_NEAR(plan.end().position, 5 + 87.5, 1e-9);
  ASSERT_TRUE(planner.ToVelocity({5, 0, 0}, -500, kTrapezoid, plan).ok());
  EXPECT_NEAR(plan.duration(), 0.25, 1e-12);
  EXPECT_NEAR(plan.end().position, 5 - 62.5, 1e-9);
  ASSERT_TRUE(planner.ToVelocity({5, 100, 0}, 100, kSCurve, plan).ok());
  EXPECT_EQ(plan.duration(), 0);
}

TEST(StopPosition, IsTheTextbookOne) {
  EXPECT_NEAR(StopPosition({5, 500, 0}, kSCurve), 5 + 87.5, 1e-9);
  EXPECT_NEAR(StopPosition({5, -500, 0}, kTrapezoid), 5 - 62.5, 1e-9);
  EXPECT_EQ(StopPosition({5, 0, 0}, kSCurve), 5);
}

TEST(Planner, CallsDoNotAllocate) {
  std::vector<testing::Problem> some;
  testing::Problems problems(8, {.start_within_limits = false, .asymmetric = true, .unlimited_jerk = true});
  for (int i = 0; i < 1000; ++i) some.push_back(problems.Next());
  Planner planner;
  Profile plan;
  double sum = 0;
  const long before = AllocationsOfThisThread();
  for (const testing::Problem& p : some) {
    (void)planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan);
    sum += plan.At(0.1).position + plan.PositionRange().max + plan.VelocityRange().max + plan.AccelerationRange().max;
    (void)planner.ToVelocity(p.from, p.end_velocity, p.limits, plan);
    (void)planner.Stop(p.from, p.limits, plan);
    sum += StopPosition(p.from, p.limits);
  }
  EXPECT_EQ(AllocationsOfThisThread(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

// Every input replaced by every odd number in turn: a valid plan or a refusal that leaves `out` unchanged, never a
// hang.
TEST(Planner, OddNumbersAreRefusedOrPlanned) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const std::vector<double> odd{std::numeric_limits<double>::quiet_NaN(),
                                kInf,
                                -kInf,
                                0.0,
                                -0.0,
                                -1.0,
                                1e300,
                                -1e300,
                                1e-300,
                                5e-324,
                                -5e-324,
                                1e18,
                                1e-18,
                                std::numeric_limits<double>::max()};
  const Profile untouched(KinematicState{1, 2, 3});
  Planner planner;
  const auto judge = [&](Status status, const Profile& out, const KinematicState& from, const KinematicState& to) {
    if (status.failed()) {
      EXPECT_TRUE(status.error == ErrorId::kParameter || status.error == ErrorId::kPlanning);
      EXPECT_EQ(out.start(), untouched.start());
      EXPECT_EQ(out.size(), 0);
      return;
    }
    EXPECT_EQ(out.start(), from);
    EXPECT_EQ(out.end(), to);
    EXPECT_TRUE(std::isfinite(out.duration()));
    EXPECT_TRUE(std::isfinite(out.At(0.5 * out.duration()).position));
  };
  for (std::size_t first = 0; first < 9; ++first) {
    for (std::size_t second = first; second < 9; ++second) {
      for (const double x : odd) {
        for (const double y : odd) {
          std::array<double, 9> in{1, 10, 20, 300, 30, 500, 2000, 3000, 20000};
          in[first] = x;
          in[second] = y;
          const KinematicState from{in[0], in[1], in[2]};
          const Limits limits{in[5], in[6], in[7], in[8]};
          Profile out = untouched;
          judge(planner.ToPosition(from, in[3], in[4], limits, out), out, from, {in[3], in[4], 0});
          out = untouched;
          const Status to_velocity = planner.ToVelocity(from, in[4], limits, out);
          judge(to_velocity, out, from, {out.end().position, in[4], 0});
          out = untouched;
          const Status stop = planner.Stop(from, limits, out);
          judge(stop, out, from, {out.end().position, 0, 0});
          (void)StopPosition(from, limits);
        }
      }
    }
  }
}

TEST(Planner, RefusesWhatIsNoLimit) {
  Planner planner;
  Profile out;
  const Status refused = Status::Failed(ErrorId::kParameter);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    for (double Limits::*member : {&Limits::velocity, &Limits::acceleration, &Limits::deceleration, &Limits::jerk}) {
      if (member == &Limits::jerk && bad == 0) continue;
      Limits l = kSCurve;
      l.*member = bad;
      EXPECT_EQ(planner.ToPosition({}, 1, 0, l, out), refused);
      EXPECT_EQ(planner.ToVelocity({}, 1, l, out), refused);
      const bool needed = member == &Limits::deceleration || member == &Limits::jerk;
      EXPECT_EQ(planner.Stop({0, 1, 0}, l, out).failed(), needed);
    }
  }
  EXPECT_EQ(planner.ToPosition({}, 1, 501, kSCurve, out), refused);
  EXPECT_EQ(planner.ToVelocity({}, -501, kSCurve, out), refused);
}

// Starts far beyond the velocity limit with slow brakes and a high jerk, the target just beyond: found by the long run.
TEST(Planner, SecondScaleSolvesWhatTheFirstDoesNot) {
  Planner planner;
  Profile plan;
  const KinematicState from{-754.51641565938712, 2.6569513529451592, -0.080600538750228559};
  const Limits slow{1.9506856148825715, 0.04194110965623149, 0.04194110965623149, 439.84007363006515};
  ASSERT_TRUE(planner.ToPosition(from, -754.65385475606399, 0, slow, plan).ok());
  EXPECT_EQ(planner.counters().second_scale, 1u);
  EXPECT_LE(testing::Audit(plan, slow).velocity, 1e-9);
  EXPECT_LE(testing::Audit(plan, slow).deceleration, 1e-9);
}

// A problem without a solution in doubles is counted and leaves the caller's plan unchanged.
TEST(Planner, FailureIsCountedAndKeepsThePlanInHand) {
  Planner planner;
  Profile plan;
  ASSERT_TRUE(planner.ToPosition({}, 100, 0, kSCurve, plan).ok());
  const KinematicState half = plan.At(0.5 * plan.duration());
  const Limits absurd{1e-3, 1e8, 1e8, 1};
  EXPECT_EQ(planner.ToPosition({0, 1e9, -1e8}, 1, 0, absurd, plan), Status::Failed(ErrorId::kPlanning));
  EXPECT_EQ(plan.At(0.5 * plan.duration()), half);
  EXPECT_EQ(planner.counters().plans, 2u);
  EXPECT_EQ(planner.counters().failures, 1u);
}

}  // namespace
}  // namespace takt::trajectory
