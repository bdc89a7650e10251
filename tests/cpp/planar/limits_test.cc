// Limits that a mover on tracks never exceeds, whatever is commanded: PL-15, PL-21.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../core/trials.h"
#include "streets.h"
#include "takt/planar/going_along.h"
#include "takt/planar/traffic.h"

namespace takt::planar {
namespace {

using testing::TrackNetworkState;
using testing::Watcher;

const Pace kBriskPace = testing::PaceOf(2000, 10000, 200000);

// Straight on, and round a corner.
Layout Corner() {
  return {{testing::Line({0, 0}, {1500, 0}), testing::Line({1600, 100}, {1600, 3000})}};
}

void ExpectWithin(const Watcher& watcher, const char* what) {
  EXPECT_LE(watcher.speed, 1 + 1e-8) << what;
  EXPECT_LE(watcher.acceleration, 1 + 1e-8) << what;
  EXPECT_LE(watcher.jerk, 1 + 1e-5) << what;
  EXPECT_LE(watcher.lateral, 1 + 1e-6) << what;
  EXPECT_LE(watcher.vector_acceleration, 1 + 1e-6) << what;
  EXPECT_LE(watcher.vector_jerk, 1 + 2e-5) << what;
}

// A line into a corner, as tight as its distance from both sides, and on.
Layout CornerOf(double distance) {
  return {{testing::Line({0, 0}, {500, 0}), testing::Line({500 + distance, distance}, {500 + distance, 1200})}};
}
// Corners to both sides without a line between them.
Layout Serpentine(double distance) {
  Layout layout;
  for (int i = 0; i < 8; ++i) {
    const double x = 2.5 * distance * i, y = i % 2 == 0 ? 0 : 1.5 * distance;
    layout.elements.push_back(testing::Line({x, y}, {x + 0.5 * distance, y}));
  }
  return layout;
}

// The position is known up to rounding, and so is whether it is on the track.
TEST(Limits, AMoverMayBeBeforeItsTrackByRounding) {
  TrackNetworkState streets({Corner()}, 1);
  for (const double place : {-1.2e-13, 0.0, 100.0}) {
    streets.Put(0, 0, -1.2e-13, kBriskPace);
    const Start start{&streets[0].route, -1.2e-13, 1, 0, 0};
    EXPECT_GE(CapsAhead(streets.network(), start, 0, kBriskPace).count, 1U);
    ASSERT_TRUE(streets.Send(0, 0, place));
    EXPECT_TRUE(streets.Run(3));
    EXPECT_NEAR(streets[0].at.position, place, 1e-9);
  }
}

// The commanded jerk would take longer to remove the acceleration than the speed limit admits.
TEST(Limits, ALowerJerkIsNoReasonToGetTooFast) {  // PL-15
  for (const double jerk : {1000.0, 5000.0, 20000.0}) {
    for (const double velocity : {2000.0, 500.0}) {
      for (const int after : {60, 100, 150}) {
        TrackNetworkState streets({{{testing::Line({0, 0}, {20000, 0})}}}, 1);
        streets.Put(0, 0, 0, kBriskPace);
        Watcher watcher(streets);
        streets.watch = [&] { watcher.Look(); };
        streets.Send(0, 0, 19000);
        for (int i = 0; i < after; ++i) streets.Step();
        const KinematicState at = streets[0].at;
        ASSERT_GT(at.acceleration, 9000);
        streets.Send(0, 0, 19000);
        streets[0].pace = testing::PaceOf(velocity, 10000, jerk);
        double fastest = 0;
        streets.watch = [&] {
          watcher.Look();
          fastest = std::max(fastest, streets[0].at.velocity);
        };
        EXPECT_TRUE(streets.Run(60));
        ExpectWithin(watcher, "one that speeds up");
        // No faster than it must.
        const double least = at.velocity + at.acceleration * at.acceleration / (2 * 200000);
        EXPECT_LE(fastest, 1e-6 + std::max(velocity, least + at.acceleration * testing::kPeriod)) << jerk << after;
        EXPECT_DOUBLE_EQ(streets[0].at.position, 19000);
      }
    }
  }
}

// The commanded dynamics are too low to slow down for the corner.
TEST(Limits, LessDynamicsAreNoReasonToTakeACurveTooFast) {  // PL-21
  const Pace paces[] = {testing::PaceOf(2000, 100, 200000), testing::PaceOf(2000, 1000, 200000),
                        testing::PaceOf(2000, 10000, 1000), testing::PaceOf(2000, 10000, 10000),
                        testing::PaceOf(1000, 100, 200000)};
  for (const Pace& pace : paces) {
    for (const double place : {200.0, 1000.0, 1260.0, 1400.0}) {
      for (const bool geared : {false, true}) {
        TrackNetworkState streets({Corner()}, 1);
        streets.Put(0, 0, 0, kBriskPace);
        Watcher watcher(streets);
        streets.watch = [&] { watcher.Look(); };
        streets.Send(0, 0, 3500);
        while (streets[0].at.position < place) streets.Step();
        if (geared) {
          streets[0].aim = Aim::kFollow;
          streets[0].gear = {};
          streets[0].demand = {3500, 0, 0};
        } else {
          streets.Send(0, 0, 4000);
        }
        streets[0].pace = pace;
        for (int i = 0; i < 40000 && !(streets[0].there || (geared && streets[0].gear.in_step)); ++i) streets.Step();
        ExpectWithin(watcher, geared ? "geared" : "sent");
        EXPECT_NEAR(streets[0].at.position, geared ? 3500 : 4000, 1e-6) << place;
      }
    }
  }
}

// However tight the track, with any maxima, up to a lateral acceleration that uses all of the acceleration: alone on
// it, a mover keeps the maxima of both vectors, and reaches the end without a stop before.
TEST(Limits, VectorsKeepTheirMaximaInCurvesAndTransitions) {  // PL-82
  double hardest = 0;
  for (const double distance : {15.0, 45.0, 120.0, 260.0}) {
    for (const Layout& layout : {CornerOf(distance), Serpentine(distance)}) {
      for (const double jerk : {40000.0, 150000.0, 900000.0}) {
        for (const double lateral : {1500.0, 5000.0, 9000.0}) {
          const Pace pace = testing::InPlane(testing::PaceOf(2500, 9000, jerk, lateral));
          TrackNetworkState streets({layout}, 1);
          streets.Put(0, 0, 0, pace);
          streets.Send(0, 0, streets.track(0).length);
          Watcher watcher(streets);
          double slowest = INFINITY;
          streets.watch = [&] {
            watcher.Look();
            const double at = streets[0].at.position;
            if (at > 0.1 * streets.track(0).length && at < 0.9 * streets.track(0).length) {
              slowest = std::min(slowest, streets[0].at.velocity);
            }
          };
          EXPECT_TRUE(streets.Run(60));
          const auto what = std::to_string(distance) + " " + std::to_string(jerk) + " " + std::to_string(lateral);
          ExpectWithin(watcher, what.c_str());
          EXPECT_GT(slowest, 20) << what;
          hardest = std::max(hardest, watcher.vector_jerk);
        }
      }
    }
  }
  EXPECT_GT(hardest, 0.99);
}

// A halt uses the commanded deceleration and jerk; behind a mover that brakes harder it brakes like that.
TEST(Limits, AHaltBrakesAsItIsTold) {  // PL-11
  for (const double deceleration : {500.0, 3000.0, 10000.0}) {
    for (const double jerk : {5000.0, 50000.0}) {
      TrackNetworkState streets({{{testing::Line({0, 0}, {20000, 0})}}}, 2);
      streets.Put(0, 0, 0, kBriskPace, 200);
      streets.Send(0, 0, 19000);
      for (int i = 0; i < 1000; ++i) streets.Step();
      const KinematicState at = streets[0].at;
      ASSERT_EQ(at.velocity, 2000);
      Watcher watcher(streets);
      streets.watch = [&] { watcher.Look(); };
      streets.HaltSoftly(0, deceleration, jerk);
      double hardest = 0;
      int cycles = 0;
      for (; streets[0].at.velocity > 0; ++cycles) {
        streets.Step();
        hardest = std::max(hardest, -streets[0].at.acceleration);
        ASSERT_EQ(streets[0].waits, Waits::kNot);
      }
      const Braking expected = Brake(at, {deceleration, jerk});
      EXPECT_NEAR(streets[0].at.position, expected.rest, 1e-6);
      EXPECT_NEAR(cycles * testing::kPeriod, expected.ends_s.back(), 1.5 * testing::kPeriod);
      EXPECT_LE(hardest, deceleration * (1 + 1e-9));
      EXPECT_LE(watcher.jerk, jerk / 200000 * (1 + 1e-6));
    }
  }
  TrackNetworkState streets({{{testing::Line({0, 0}, {20000, 0})}}}, 2);
  streets.Put(0, 0, 0, kBriskPace, 200);
  streets.Put(1, 0, 250, kBriskPace, 200);
  streets.Send(0, 0, 18000);
  streets.Send(1, 0, 19000);
  streets.Run(2);
  ASSERT_GT(streets[0].at.velocity, 1990);
  Watcher watcher(streets);
  streets.watch = [&] {
    watcher.Look();
    EXPECT_LT(streets.Missing(), 1e-5);
  };
  streets.HaltSoftly(0, 500, 20000);
  streets.Halt(1);
  streets.Run(3);
  for (int i = 0; i < 3000; ++i) streets.Step();
  EXPECT_NEAR(streets[1].at.position - streets[0].at.position, 200, 0.05);
  EXPECT_EQ(streets[0].waits, Waits::kNot);
  ExpectWithin(watcher, "halted");
}

// Random commands to few movers of random cities, each with dynamics of its own; gears with jumping masters; halts.
TEST(Limits, AreKeptWhateverAMoverIsTold) {  // PL-14, PL-15, PL-21
  const int trials = Trials(24);
  double travelled = 0, fastest = 0, hardest = 0;
  for (int trial = 0; trial < trials; ++trial) {
    testing::Random random(static_cast<unsigned>(trial));
    const std::vector<Layout> layouts = testing::RandomCity(random, 10, 100);
    const auto tracks = static_cast<std::uint32_t>(layouts.size());
    if (tracks == 0) continue;
    TrackNetworkState streets(layouts, 3);
    std::vector<Pace> most;
    for (std::uint32_t k = 0; k < 3; ++k) {
      most.push_back(testing::PaceOf(random.Between(500, 3000), random.Between(3000, 15000), random.Between(5e4, 4e5),
                                     random.Between(2000, 10000)));
      const std::uint32_t track = k % tracks;
      streets.Put(k, track, streets.track(track).length * (0.3 + 0.2 * k), most.back());
      streets[k].brakes.deceleration *= random.Between(1, 2);
    }
    const auto share = [&] { return random.Below(3) == 0 ? 1 : std::pow(10, random.Between(-2.5, 0)); };
    const auto anew = [&](std::uint32_t k) {
      trajectory::Limits& limits = streets[k].pace.limits;
      limits = most[k].limits;
      limits.velocity *= std::max(0.05, share());
      limits.acceleration *= share();
      limits.deceleration *= share();
      limits.jerk *= share();
      streets[k].gap = random.Between(120, 300);
    };
    Watcher watcher(streets);
    double missing = -INFINITY;
    for (int i = 0; i < 20000 && !HasFailure(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        Rider& r = streets[k];
        const auto track = static_cast<std::uint32_t>(random.Below(static_cast<int>(tracks)));
        switch (random.Below(r.aim == Aim::kRest || r.there ? 30 : 1500)) {
          case 0:
            random.Coin() ? streets.Halt(k) : streets.HaltSoftly(k, 500, 20000);
            break;
          case 1:
          case 2:
          case 3:
            if (streets.Send(k, track, random.Between(0, streets.track(track).length))) anew(k);
            break;
          case 4:
          case 5:
            r.aim = Aim::kFollow;
            r.planned = r.there = false;
            r.gear = {.sense = static_cast<std::int8_t>(random.Below(3) - 1)};
            r.demand = {r.at.position + r.origin + random.Between(-300, 1500), 0, 0};
            anew(k);
            break;
          default:
            break;
        }
        if (r.aim == Aim::kFollow) {
          const double speed = r.demand.velocity;
          if (random.Below(300) == 0) r.demand.velocity = random.Between(-1, 1) * most[k].limits.velocity;
          r.demand.position += 0.5 * (speed + r.demand.velocity) * testing::kPeriod;
        }
        travelled += std::abs(r.at.velocity) * testing::kPeriod;
        fastest = std::max(fastest, std::abs(r.at.velocity) / r.top_speed);
      }
      streets.Step();
      watcher.Look();
      missing = std::max(missing, streets.Missing());
    }
    ExpectWithin(watcher, "told anything");
    hardest = std::max(hardest, watcher.lateral);
  }
  // Otherwise the test would prove nothing.
  EXPECT_GT(travelled, 2000.0 * trials);
  EXPECT_GT(fastest, 0.99);
  if (kSanitized) return;  // too few trials for rare events
  EXPECT_GT(hardest, 0.99);
}

}  // namespace
}  // namespace takt::planar
