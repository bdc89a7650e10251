// Random start states, targets and limits in several units: properties of every plan. A million of each:
// long_trajectory in cpp/bench.
#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>
#include <string>

#include "problems.h"
#include "reference_search.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/ruckig_solver.h"

namespace takt::trajectory::testing {
namespace {

constexpr int kProblems = 10'000;

struct Case {
  const char* name;
  Mix mix;
  bool replanned = false;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

std::string Describe(const Problem& p) {
  char text[400];
  std::snprintf(text, sizeof text, "from {%.17g, %.17g, %.17g} to {%.17g, %.17g}, limits {%.17g, %.17g, %.17g, %.17g}",
                p.from.position, p.from.velocity, p.from.acceleration, p.position, p.end_velocity, p.limits.velocity,
                p.limits.acceleration, p.limits.deceleration, p.limits.jerk);
  return text;
}

// Published: limits and steps of velocity and acceleration 1e-9 of the limit; steps of position 1e-6 of the distance
// (Ruckig's own tolerance shows in very short motions).
void ExpectSound(const Profile& plan, const Problem& p) {
  const Excess e = Audit(plan, p.limits);
  ASSERT_LE(e.velocity, 1e-9) << Describe(p);
  ASSERT_LE(e.acceleration, 1e-9) << Describe(p);
  ASSERT_LE(e.deceleration, 1e-9) << Describe(p);
  ASSERT_LE(e.jerk, 1e-12) << Describe(p);
  ASSERT_LE(e.position_step, 1e-6) << Describe(p);
  ASSERT_LE(e.velocity_step, 1e-9) << Describe(p);
  ASSERT_LE(e.acceleration_step, 1e-9) << Describe(p);
  ASSERT_EQ(plan.start(), p.from) << Describe(p);
  ASSERT_EQ(plan.At(0), p.from) << Describe(p);
}

class PlannerProperty : public ::testing::TestWithParam<Case> {
 protected:
  // The next problem; already in motion to its target if the case says so.
  Problem Next(Problems& problems, Planner& planner) {
    Problem p = problems.Next();
    Profile plan;
    if (GetParam().replanned && planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan).ok()) {
      p.from = plan.At(plan.duration() * (0.5 + problems.Signed(0.5)));
    }
    return p;
  }
};

// AX-13, AX-14
TEST_P(PlannerProperty, ToPositionStaysWithinLimitsAndEndsExactly) {
  Problems problems(1, GetParam().mix);
  Planner planner;
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = Next(problems, planner);
    Profile plan;
    ASSERT_TRUE(planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan).ok()) << Describe(p);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(plan, p));
    ASSERT_EQ(plan.end(), (KinematicState{p.position, p.end_velocity, 0})) << Describe(p);
    ASSERT_EQ(plan.At(plan.duration()), plan.end());
  }
  EXPECT_EQ(planner.counters().failures, 0u);
}

// AX-13, AX-14
TEST_P(PlannerProperty, ToVelocityStaysWithinLimitsAndEndsExactly) {
  Problems problems(2, GetParam().mix);
  Planner planner;
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = Next(problems, planner);
    Profile plan;
    ASSERT_TRUE(planner.ToVelocity(p.from, p.end_velocity, p.limits, plan).ok()) << Describe(p);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(plan, p));
    ASSERT_EQ(plan.end().velocity, p.end_velocity);
    ASSERT_EQ(plan.end().acceleration, 0);
  }
}

// AX-13, AX-36
TEST_P(PlannerProperty, StopEndsWhereStopPositionSays) {
  Problems problems(3, GetParam().mix);
  Planner planner;
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = Next(problems, planner);
    Profile stop;
    ASSERT_TRUE(planner.Stop(p.from, p.limits, stop).ok()) << Describe(p);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(stop, p));
    const double reach = std::abs(stop.end().position - p.from.position) + std::abs(p.from.position);
    ASSERT_NEAR(StopPosition(p.from, p.limits), stop.end().position, 1e-9 * reach) << Describe(p);
    Profile to_zero;
    ASSERT_TRUE(planner.ToVelocity(p.from, 0, p.limits, to_zero).ok());
    ASSERT_NEAR(to_zero.end().position, stop.end().position, 1e-9 * reach) << Describe(p);
    ASSERT_NEAR(to_zero.duration(), stop.duration(), 1e-9 * stop.duration()) << Describe(p);
  }
}

// Where acceleration and deceleration are equal, no motion is quicker. Ruckig is called in metres, where it has fewest
// failures.
class PlannerOptimum : public PlannerProperty {};

TEST_P(PlannerOptimum, IsNotSlowerThanRuckigNorThanTheReference) {
  const Mix& mix = GetParam().mix;
  Problems problems(4, mix);
  Planner planner;
  int compared = 0;
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = Next(problems, planner);
    Profile plan;
    ASSERT_TRUE(planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan).ok());
    const double m = 0.001 / mix.unit;
    const Limits& l = p.limits;
    const PositionProblem raw{m * (p.position - p.from.position),
                              m * p.from.velocity,
                              m * p.from.acceleration,
                              m * p.end_velocity,
                              m * l.velocity,
                              {m * l.acceleration, m * l.deceleration, m * l.jerk}};
    Solution solution;
    if (SolveWithRuckig(raw, solution)) {
      double duration = 0;
      for (const Stretch& s : solution.all()) duration += s.duration;
      // Ruckig calls 1e-8 m near enough, which saves it some time where the distance is small.
      ASSERT_LE(plan.duration(), duration * (1 + 1e-6) + 2e-5) << Describe(p);
      ++compared;
    }
    // A start faster than allowed is braked as Ruckig does it, which is not always the best for what follows.
    if (p.end_velocity == 0 && mix.start_within_limits) {
      const double best = ReferenceDuration(p);
      ASSERT_LE(plan.duration(), best * (1 + 2e-5) + 1e-7) << Describe(p);
      // Quicker only by what the tolerance at the end gives.
      ASSERT_GE(plan.duration(), best * (1 - 2e-3) - 2e-5) << Describe(p);
    }
  }
  EXPECT_GT(compared, kProblems * 9 / 10);
}

std::string Name(const ::testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

const Case kSymmetric[] = {{"micrometres", {.unit = kUnits[0]}},
                           {"millimetres", {.unit = kUnits[1]}},
                           {"metres", {.unit = kUnits[2]}},
                           {"degrees", {.unit = kUnits[3]}},
                           {"start_beyond_limits", {.start_within_limits = false}},
                           {"jerk_unlimited_too", {.unlimited_jerk = true}},
                           {"replanned_underway", {}, true}};
const Case kAsymmetric[] = {{"deceleration_differs", {.asymmetric = true}},
                            {"start_beyond_limits", {.start_within_limits = false, .asymmetric = true}},
                            {"jerk_unlimited_too", {.asymmetric = true, .unlimited_jerk = true}},
                            {"replanned_underway", {.asymmetric = true}, true}};
INSTANTIATE_TEST_SUITE_P(Symmetric, PlannerProperty, ::testing::ValuesIn(kSymmetric), Name);
INSTANTIATE_TEST_SUITE_P(Asymmetric, PlannerProperty, ::testing::ValuesIn(kAsymmetric), Name);
INSTANTIATE_TEST_SUITE_P(Symmetric, PlannerOptimum, ::testing::ValuesIn(kSymmetric), Name);

// The same problem in another unit has the same solution: the duration does not depend on whether an axis counts in µm
// or m.
TEST(Planner, AnswerDoesNotDependOnTheUnit) {
  Problems problems(5, {});
  Planner planner;
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = problems.Next();
    Profile in_mm;
    ASSERT_TRUE(planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, in_mm).ok());
    for (const double u : kUnits) {
      const Limits l{u * p.limits.velocity, u * p.limits.acceleration, u * p.limits.deceleration, u * p.limits.jerk};
      Profile in_u;
      const KinematicState from{u * p.from.position, u * p.from.velocity, u * p.from.acceleration};
      ASSERT_TRUE(planner.ToPosition(from, u * p.position, u * p.end_velocity, l, in_u).ok());
      ASSERT_NEAR(in_u.duration(), in_mm.duration(), 1e-5 * in_mm.duration()) << Describe(p);
    }
  }
}

// Faster, or still speeding up, never stops earlier.
TEST(StopPosition, IsMonotoneInVelocityAndAcceleration) {
  Problems problems(6, {.asymmetric = true, .unlimited_jerk = true});
  for (int i = 0; i < kProblems; ++i) {
    const Problem p = problems.Next();
    const double stop = StopPosition(p.from, p.limits);
    const double rounding = 1e-12 * (std::abs(p.from.position) + std::abs(stop));
    KinematicState faster = p.from;
    faster.velocity += problems.Decades(1e-9, 1) * p.limits.velocity;
    ASSERT_GE(StopPosition(faster, p.limits), stop - rounding) << Describe(p);
    KinematicState pushing = p.from;
    pushing.acceleration += problems.Decades(1e-9, 1) * p.limits.acceleration;
    ASSERT_GE(StopPosition(pushing, p.limits), stop - rounding) << Describe(p);
  }
}

}  // namespace
}  // namespace takt::trajectory::testing
