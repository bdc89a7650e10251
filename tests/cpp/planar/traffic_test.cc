// Traffic on tracks: PL-12, PL-15, PL-21, PL-23 to PL-26.
#include "takt/planar/traffic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "streets.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {
namespace {

using testing::Streets;
using testing::Watcher;

Layout Straight(double length) {
  return {{testing::Line({0, 0}, {length, 0})}};
}

TEST(Traffic, AMoverAloneTakesNoLongerThanThePlannerNeeds) {  // PL-12, PL-15
  testing::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const double length = random.Between(500, 5000);
    const Pace pace = testing::PaceOf(random.Between(300, 3000), random.Between(3000, 20000), random.Between(5e4, 5e5));
    Streets streets({Straight(length)}, 1);
    const double from = random.Between(0, length), to = random.Between(0, length);
    streets.Put(0, 0, from, pace);
    ASSERT_TRUE(streets.Send(0, 0, to));
    Watcher watcher(streets);
    streets.watch = [&] { watcher.Look(); };
    ASSERT_TRUE(streets.Run(30)) << trial;
    EXPECT_DOUBLE_EQ(streets[0].at.position, to);
    trajectory::Planner planner;
    trajectory::Profile optimum;
    ASSERT_TRUE(planner.ToPosition({from, 0, 0}, to, 0, pace.limits, optimum).ok());
    EXPECT_LE(streets.now(), optimum.duration() + 1.001 * testing::kPeriod) << trial;
    EXPECT_LE(watcher.speed, 1 + 1e-9);
    EXPECT_LE(watcher.acceleration, 1 + 1e-9);
    EXPECT_LE(watcher.jerk, 1 + 1e-6);
  }
}

TEST(Traffic, AMoverStopsBehindAnother) {  // PL-24
  Streets streets({Straight(3000)}, 2);
  const Pace pace = testing::PaceOf(2000, 10000, 200000);
  streets.Put(0, 0, 100, pace, 200);
  streets.Put(1, 0, 1500, pace, 200);
  streets.Send(0, 0, 2500);
  EXPECT_FALSE(streets.Run(5));
  EXPECT_NEAR(streets[0].at.position, 1300, 0.02);
  EXPECT_EQ(streets[0].waits, Waits::kMover);
  EXPECT_EQ(streets[0].waits_for, 1U);
  streets.Send(1, 0, 2900);
  EXPECT_TRUE(streets.Run(5));
}

TEST(Traffic, FollowsWithoutChatter) {  // PL-25
  Streets streets({Straight(20000)}, 2);
  streets.Put(0, 0, 100, testing::PaceOf(2000, 10000, 200000), 200);
  streets.Put(1, 0, 1500, testing::PaceOf(700, 10000, 200000), 200);
  streets.Send(0, 0, 19000);
  streets.Send(1, 0, 19500);
  double most = 0, rough = 0, before = 0;
  int turns = 0;
  double last_jerk = 0;
  streets.watch = [&] {
    const double jerk = (streets[0].at.acceleration - before) / testing::kPeriod;
    if (jerk * last_jerk < 0 && std::abs(jerk - last_jerk) > 2000) ++turns;
    last_jerk = jerk;
    if (streets.now() > 5 && streets.now() < 20) {
      most = std::max(most, std::abs(streets[0].at.acceleration));
      rough = std::max(rough, std::abs(streets[0].at.acceleration - before));
    }
    before = streets[0].at.acceleration;
    if (std::getenv("SHOW")) {
      std::printf("%g %g %g %g %g %g %g\n", streets.now(), streets[0].at.position, streets[0].at.velocity,
                  streets[0].at.acceleration, streets[1].at.position, streets[1].at.velocity,
                  streets[1].at.acceleration);
    }
  };
  EXPECT_FALSE(streets.Run(20));
  EXPECT_LT(most, 0.01 * 10000);
  EXPECT_LT(turns, 20);
  std::printf("most %g turns %d gap %g refused\n", most, turns, streets[1].at.position - streets[0].at.position);
}

// Random commands to random movers in random cities: the invariant, by what is seen of it.
TEST(Traffic, NobodyComesTooNear) {  // PL-23, PL-24
  const int trials = testing::Trials(3);
  for (int trial = 0; trial < trials; ++trial) {
    testing::Random random(static_cast<unsigned>(trial));
    const std::vector<Layout> layouts = testing::RandomCity(random, 14, 100);
    Streets streets(layouts, 50);
    double length = 0;
    std::uint32_t put = 0;
    for (std::uint32_t track = 0; track < layouts.size(); ++track) {
      length += streets.track(track).length;
      const Road& road = streets.network()[track];
      const double from = std::max(170.0, road.range_at_start) + 1,
                   to = road.length - std::max(170.0, road.range_at_end) - 1;
      for (double s = from; s < to && put < 50; s += 180 + random.Between(0, 500)) {
        const Pace pace = testing::PaceOf(random.Between(300, 2000), random.Between(2000, 15000),
                                          random.Between(5e4, 4e5), random.Between(2000, 10000));
        Rider& r = streets.Put(put++, track, s, pace, 170);
        r.brakes.deceleration *= random.Between(1, 2);
      }
    }
    double missing = -INFINITY, nearest = INFINITY, travelled = 0;
    Watcher watcher(streets);
    int arrived = 0, refused = 0;
    for (int i = 0; i < 20000; ++i) {
      for (std::uint32_t k = 0; k < put; ++k) {
        Rider& r = streets[k];
        if (random.Below(2000) == 0) streets.Halt(k);
        if (((r.aim == Aim::kRest || r.there) && random.Below(300) == 0) || random.Below(5000) == 0) {
          arrived += r.there ? 1 : 0;
          const auto track = static_cast<std::uint32_t>(random.Below(static_cast<int>(layouts.size())));
          streets.Send(k, track, random.Between(0, streets.track(track).length));
        }
      }
      streets.Step();
      refused += static_cast<int>(streets.traffic().refused());
      watcher.Look();
      missing = std::max(missing, streets.Missing());
      if (i % 5 == 0) nearest = std::min(nearest, streets.Nearest());
    }
    for (std::uint32_t k = 0; k < put; ++k) travelled += streets[k].origin;
    std::printf("trial %d: %zu tracks %.0f mm, %u movers, arrived %d refused %d, travelled %.0f, missing %g nearest %g; "
                "speed %g acc %g jerk %g lateral %g\n", trial, layouts.size(), length, put, arrived, refused, travelled,
                missing, nearest, watcher.speed, watcher.acceleration, watcher.jerk, watcher.lateral);
    EXPECT_LT(missing, 1e-3);
    EXPECT_GT(nearest, 0);
    EXPECT_LE(watcher.acceleration, 1 + 1e-6);
    EXPECT_LE(watcher.jerk, 1 + 1e-6);
  }
}

}  // namespace
}  // namespace takt::planar
