// Following a demand: within limits whatever it does, and in step with it where that is possible. AX-13, AX-43, AX-45.
#include "takt/trajectory/demand_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rig.h"

namespace takt::axis {
namespace {

using trajectory::DemandFollowerState;
using trajectory::DemandMode;

// A master that goes from one random velocity to the next.
class Master {
 public:
  Master(const trajectory::Limits& limits, std::mt19937& random) : limits_(limits), random_(random) {}

  KinematicState Next(double period_s) {
    time_ += period_s;
    if (time_ > profile_.duration() + hold_) {
      const KinematicState from = state_;
      profile_ = trajectory::Profile{from};
      time_ = period_s;
      hold_ = std::uniform_real_distribution(0.0, 0.5)(random_);
      EXPECT_TRUE(planner_
                      .ToVelocity(from, std::uniform_real_distribution(-1.0, 1.0)(random_) * limits_.velocity, limits_,
                                  profile_)
                      .ok());
    }
    return state_ = profile_.At(time_);
  }

 private:
  trajectory::Limits limits_;
  std::mt19937& random_;
  trajectory::Planner planner_;
  trajectory::Profile profile_;
  KinematicState state_;
  double time_ = 0, hold_ = 0;
};

// One axis that chases; every step is held against the limits.
class Follower {
 public:
  explicit Follower(const AxisParams& p) : params(p) {}

  void Step(DemandMode mode, const KinematicState& demand) {
    const trajectory::Limits own = params.planner_limits();
    const KinematicState before = at;
    at = FollowDemand({params.planner_limits(), planner, own, kPeriod}, mode, before, demand, state);
    EXPECT_LE(std::abs(at.velocity), own.velocity * (1 + 1e-8));
    const double limit = at.velocity * at.acceleration > 0 ? own.acceleration : own.deceleration;
    // Where the sense turns within a step, what was allowed for growing may still be there for falling.
    const double carried = std::abs(before.acceleration) - own.jerk * kPeriod;
    EXPECT_LE(std::abs(at.acceleration),
              std::max(limit, std::max(carried, std::abs(before.acceleration))) * (1 + 1e-8));
    EXPECT_LE(std::abs(at.acceleration), std::max(own.acceleration, own.deceleration) * (1 + 1e-8));
    EXPECT_LE(std::abs(at.acceleration - before.acceleration), own.jerk * kPeriod * (1 + 2e-6) + 1e-9);
    const double mean = 0.5 * (before.acceleration + at.acceleration);
    EXPECT_NEAR(at.velocity, before.velocity + mean * kPeriod, 0.25 * own.jerk * kPeriod * kPeriod + 1e-6);
    EXPECT_NEAR(at.position, before.position + 0.5 * kPeriod * (before.velocity + at.velocity),
                0.15 * own.jerk * kPeriod * kPeriod * kPeriod + 1e-6);
  }

  static constexpr double kPeriod = 0.001;
  AxisParams params;
  trajectory::Planner planner;
  KinematicState at;
  DemandFollowerState state;
};

AxisParams Drawn(std::mt19937& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  AxisParams p = LinearParams();
  p.limits.velocity = between(50, 1000);
  p.limits.acceleration = between(500, 20000);
  p.limits.deceleration = between(500, 20000);
  p.limits.jerk = between(1e4, 1e6);
  return p;
}

TEST(DemandFollower, KeepsTheLimitsWhateverTheDemand) {  // AX-13
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Follower follower(Drawn(random));
    trajectory::Limits masters = follower.params.planner_limits();
    const double stronger = std::uniform_real_distribution(0.2, 3.0)(random);
    masters.velocity *= stronger;
    masters.acceleration *= stronger;
    masters.deceleration *= stronger;
    masters.jerk *= stronger;
    Master master(masters, random);
    double jump = 0;
    for (int i = 0; i < 4000; ++i) {
      if (i % 997 == 500) jump += std::uniform_real_distribution(-50.0, 50.0)(random);
      KinematicState demand = master.Next(Follower::kPeriod);
      demand.position += jump;
      if (seed % 5 == 4) demand.velocity += std::normal_distribution(0.0, 5.0)(random);  // measured, with noise
      follower.Step(seed % 2 == 0 ? DemandMode::kPosition : DemandMode::kVelocity, demand);
      if (testing::Test::HasFailure()) FAIL() << "cycle " << i;
    }
  }
}

TEST(DemandFollower, GetsInStepWithAWeakerMasterAndStaysThere) {  // AX-43, AX-45
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Follower follower(Drawn(random));
    trajectory::Limits masters = follower.params.planner_limits();
    const double least = std::min(masters.acceleration, masters.deceleration);
    masters.velocity *= 0.6;
    masters.acceleration = masters.deceleration = 0.4 * least;
    masters.jerk *= 0.8;
    Master master(masters, random);
    follower.at.position = std::uniform_real_distribution(-20.0, 20.0)(random);
    const DemandMode mode = seed % 2 == 0 ? DemandMode::kPosition : DemandMode::kVelocity;
    int first = -1;
    double offset = 0;
    for (int i = 0; i < 8000; ++i) {
      const KinematicState demand = master.Next(Follower::kPeriod);
      follower.Step(mode, demand);
      if (testing::Test::HasFailure()) FAIL() << "cycle " << i;
      if (first < 0 && follower.state.in_step) {
        first = i;
        offset = follower.at.position - demand.position;
      }
      if (first < 0) continue;
      ASSERT_TRUE(follower.state.in_step) << "lost in cycle " << i << ", gained in " << first;
      EXPECT_NEAR(follower.at.velocity, demand.velocity, 1e-9 * masters.velocity);
      EXPECT_NEAR(follower.at.position - demand.position, mode == DemandMode::kPosition ? 0 : offset, 1e-9);
    }
    EXPECT_GE(first, 0);
  }
}

TEST(DemandFollower, TakesADemandThatContinuesTheMotionBitForBit) {
  Follower follower(LinearParams());
  trajectory::Profile profile;
  ASSERT_TRUE(follower.planner.ToPosition({}, 100, 0, follower.params.planner_limits(), profile).ok());
  for (int i = 1; i < 800; ++i) {
    const KinematicState demand = profile.At(i * Follower::kPeriod);
    follower.Step(DemandMode::kPosition, demand);
    ASSERT_TRUE(follower.state.in_step) << i;
    EXPECT_EQ(follower.at.position, demand.position);
    EXPECT_EQ(follower.at.velocity, demand.velocity);
  }
}

TEST(DemandFollower,
     CatchesUpInTheLeastTime) {  // a place ahead of a demand at constant speed: the move there in its frame
  Follower follower(LinearParams());
  const trajectory::Limits own = follower.params.planner_limits();
  follower.at = {-30, 200, 0};
  trajectory::Profile least;
  const double weaker = std::min(own.acceleration, own.deceleration);
  ASSERT_TRUE(
      follower.planner.ToPosition({-30, 0, 0}, 0, 0, {own.velocity - 200, weaker, weaker, own.jerk}, least).ok());
  int cycles = 0;
  while (!follower.state.in_step && cycles < 5000) {
    ++cycles;
    follower.Step(DemandMode::kPosition, {200 * cycles * Follower::kPeriod, 200, 0});
  }
  EXPECT_NEAR(cycles * Follower::kPeriod, least.duration(), 0.003);
}

}  // namespace
}  // namespace takt::axis
