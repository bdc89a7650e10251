// PL-24: ranges in which movers on two tracks come too near: by hand, and against sampling all pairs of positions.
#include "takt/planar/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../core/trials.h"
#include "takt/planar/nearest.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Distance;
using testing::kPi;
using testing::Line;
using testing::Make;
using testing::Random;
using testing::RandomTrack;

// PL-24: two squares of 100 mm: side by side, corner to corner, turned by 45°, overlapping.
TEST(Separations, AreThoseOfRectangles) {
  const Footprint square{100, 100};
  const TrackPoint here{{0, 0}, 0};
  EXPECT_NEAR(Separation(here, square, {{130, 20}, 0}, square), 30, 1e-12);
  EXPECT_NEAR(Separation(here, square, {{130, 140}, kPi / 2}, square), 50, 1e-12);
  EXPECT_NEAR(Separation(here, square, {{200, 0}, kPi / 4}, square), 150 - 50 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(Separation(here, square, {{90, 20}, kPi}, square), -10, 1e-12);
  EXPECT_NEAR(Separation(here, {200, 50}, {{0, 80}, 0}, {200, 50}), 30, 1e-12);
  // At any angle: circles through the corners.
  const Footprint round{60, 80, true};
  EXPECT_NEAR(Separation(here, round, {{130, 0}, 0}, round), 30, 1e-12);
  EXPECT_NEAR(Separation(here, square, {{130, 0}, 0}, round), 30, 1e-12);
}

// PL-24: random rectangles: the distance of their sampled borders.
TEST(Separations, AreDistancesOfBorders) {
  Random random(21);
  for (int i = 0; i < Trials(300); ++i) {
    const TrackPoint a{{0, 0}, random.Between(-3, 3)};
    const TrackPoint b{{random.Between(-200, 200), random.Between(-200, 200)}, random.Between(-3, 3)};
    const Footprint on_a{random.Between(20, 150), random.Between(20, 150)};
    const Footprint on_b{random.Between(20, 150), random.Between(20, 150)};
    const auto border = [&](const TrackPoint& p, const Footprint& mover) {
      std::vector<Place> places;
      for (int k = 0; k < 400; ++k) {
        const int side = k / 100;
        const double t = (k % 100) / 50.0 - 1;
        const double along = (side == 0 ? 1 : side == 1 ? -1 : t) * mover.width / 2;
        const double across = (side == 2 ? 1 : side == 3 ? -1 : t) * mover.height / 2;
        places.push_back(testing::Ahead(testing::Ahead(p.place, p.direction, along), p.direction + kPi / 2, across));
      }
      return places;
    };
    double least = INFINITY;
    for (const Place& p : border(a, on_a)) {
      for (const Place& q : border(b, on_b)) least = std::min(least, Distance(p, q));
    }
    const double said = Separation(a, on_a, b, on_b);
    EXPECT_NEAR(Separation(b, on_b, a, on_a), said, 1e-9);
    if (said > 0) {
      EXPECT_NEAR(least, said, 3);
      EXPECT_GE(least, said - 1e-9);
    } else {
      // Moved by the depth they touch in some direction, and by less in none.
      double move = INFINITY;
      for (int k = 0; k < 720; ++k) {
        TrackPoint moved = b;
        moved.place = testing::Ahead(b.place, k * kPi / 360, -said * 1.001 + 1e-6);
        move = std::min(move, -Separation(a, on_a, moved, on_b));
        moved.place = testing::Ahead(b.place, k * kPi / 360, -said * 0.99);
        EXPECT_LE(Separation(a, on_a, moved, on_b), 1e-9);
      }
      EXPECT_LT(move, 0.01 * -said + 1e-3);
    }
  }
}

// PL-24: lines that run side by side 115 mm apart from 200 mm on: movers of 113 mm with 5 mm between them conflict
// where the centre of one is within 113 + sqrt(5² - 2²) mm of the other line.
TEST(Conflicts, AreThoseOfLines) {
  const Footprint mover{113, 113};
  const Track a = Make({.elements = {Line({0, 0}, {1000, 0})}});
  const Track b = Make({.elements = {Line({500, 115}, {700, 115})}});
  const auto ranges = Conflicts(a, mover, b, mover, 5, 0.01);
  ASSERT_EQ(ranges.size(), 1u);
  const double reach = 113 + std::sqrt(21);
  EXPECT_LE(ranges[0].from, 500 - reach);
  EXPECT_GE(ranges[0].to, 700 + reach);
  EXPECT_NEAR(ranges[0].from, 500 - reach, 0.1);
  EXPECT_NEAR(ranges[0].to, 700 + reach, 0.1);
  EXPECT_TRUE(Conflicts(a, mover, b, mover, 1.9, 0.01).empty());
  EXPECT_EQ(ReachFromStart(ranges), 0);
  EXPECT_EQ(ReachFromEnd(ranges, a.length), 0);
  // At any angle movers cover circles of 79.9 mm.
  const Footprint round{113, 113, true};
  const Track c = Make({.elements = {Line({500, 170}, {700, 170})}});
  for (const Footprint& other : {mover, round}) {
    const double free = 170 - 79.9 - (other.any_angle ? 79.9 : 56.5);
    EXPECT_TRUE(Conflicts(a, round, c, other, free - 0.2, 0.01).empty());
    EXPECT_TRUE(Conflicts(c, other, a, round, free - 0.2, 0.01).empty());
    EXPECT_EQ(Conflicts(a, round, c, other, free + 0.2, 0.01).size(), 1u);
  }
}

// PL-24: two tracks that start from the end of one, at a right angle to each other: near the switch they conflict,
// beyond a certain position they do not; equally far on both, as they mirror each other. For movers at any angle the
// manual's rule holds: as far as a track is within twice their radius of the other one.
TEST(Conflicts, ReachFromASwitch) {
  const TrackPoint start{{0, 0}, 0};
  const Track left = Make({.elements = {Line({100, 100}, {100, 600})}, .from = start});
  const Track right = Make({.elements = {Line({100, -100}, {100, -600})}, .from = start});
  const Footprint along{113, 113}, round{113, 113, true};
  const auto conflicts = Conflicts(left, round, right, round, 0, 0.1);
  const double reach = ReachFromStart(conflicts);
  EXPECT_NEAR(NearestTo(right, At(left, reach).place).distance, 113 * std::sqrt(2), 0.1);
  EXPECT_EQ(conflicts.size(), 1u);
  EXPECT_EQ(ReachFromEnd(conflicts, left.length), 0);
  EXPECT_NEAR(ReachFromStart(Conflicts(right, round, left, round, 0, 0.1)), reach, 0.2);
  const double shorter = ReachFromStart(Conflicts(left, along, right, along, 0, 0.1));
  EXPECT_LT(shorter, reach);
  EXPECT_GT(shorter, 113);
}

// PL-24: no position with a conflict is left out, and none is included where movers keep well apart.
TEST(Conflicts, AreAllAndNoMore) {
  Random random(22);
  int conflicts = 0, free = 0;
  for (int i = 0; i < Trials(25); ++i) {
    const Track a = RandomTrack(random), b = RandomTrack(random);
    const Footprint on_a{random.Between(20, 160), random.Between(20, 160), random.Below(4) == 0};
    const Footprint on_b{random.Between(20, 160), random.Between(20, 160), random.Below(4) == 0};
    const double clearance = random.Between(0, 20);
    const double resolution = random.Between(0.2, 3);
    const auto ranges = Conflicts(a, on_a, b, on_b, clearance, resolution);
    for (std::size_t k = 1; k < ranges.size(); ++k) EXPECT_LT(ranges[k - 1].to, ranges[k].from);
    // The most that a corner of the other mover moves between a sample and its nearest position.
    const double sampling = 0.25 * (1 + std::hypot(on_b.width, on_b.height) / 2 * PeakCurvature(b, 0, b.length));
    std::vector<TrackPoint> others;
    const int count = static_cast<int>(b.length) * 2;
    for (int k = 0; k <= count; ++k) others.push_back(At(b, b.length * k / count));
    for (int k = 0; k < 200; ++k) {
      const double s = random.Between(0, a.length);
      const TrackPoint here = At(a, s);
      double least = INFINITY;
      for (const TrackPoint& other : others) least = std::min(least, Separation(here, on_a, other, on_b));
      const bool named = std::ranges::any_of(ranges, [&](const Range& r) { return r.from <= s && s <= r.to; });
      (named ? conflicts : free) += 1;
      if (least < clearance) {
        EXPECT_TRUE(named) << s;
      }
      if (named) {
        EXPECT_LT(least, clearance + resolution + sampling) << s;
      }
    }
  }
  EXPECT_GT(conflicts, Trials(500));
  EXPECT_GT(free, Trials(500));
}

}  // namespace
}  // namespace takt::planar
