// PL-30: the areas that movers sweep, and whether they come near each other: by hand, against FCL, and against sampled
// positions and angles.
#include "takt/planar/area.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "areas.h"
#include "fcl_reference.h"

namespace takt::planar {
namespace {

using testing::Ahead;
using testing::AsPoint;
using testing::DistanceByAngles;
using testing::HullAt;
using testing::kPi;
using testing::Polygon;
using testing::Random;
using testing::RandomArea;
using testing::Standing;

Area Straight(const Place& from, const Place& to, const Footprint& mover) {
  return {.places = {from, to}, .count = 2, .mover = mover};
}
// Returns the clearance from which on they count as near.
double Between(const Area& a, const Area& b) {
  double near = 2000, apart = -2000;
  while (near - apart > 1e-7) {
    const double middle = (near + apart) / 2;
    (Near(a, b, middle) ? near : apart) = middle;
  }
  return near;
}

// PL-30: a square of 100 mm swept straight along X and along the diagonal.
TEST(Areas, AreRectanglesDrawnOut) {
  const Footprint square{100, 100};
  const Area along = Straight({0, 0}, {300, 0}, square);
  EXPECT_NEAR(Between(along, Standing({400, 20}, square)), 0, 1e-6);
  EXPECT_NEAR(Between(along, Standing({150, -130}, square)), 30, 1e-6);
  EXPECT_NEAR(Between(along, Standing({-120, 0}, square)), 20, 1e-6);
  // The depth is the displacement that separates them.
  EXPECT_NEAR(Between(along, Standing({150, 90}, square)), -10, 1e-6);
  EXPECT_NEAR(Between(along, Standing({150, 150}, square, 45)), 100 - std::sqrt(2) * 50, 1e-6);
  // One side of it runs from (50, -50) to (350, 250).
  EXPECT_NEAR(Between(Straight({0, 0}, {300, 300}, square), Standing({300, 0}, square)), 100 / std::sqrt(2), 1e-6);
  const Extent extent = ExtentOf(along);
  EXPECT_NEAR(extent.lower.x, -50, 1e-9);
  EXPECT_NEAR(extent.upper.x, 350, 1e-9);
  EXPECT_NEAR(extent.lower.y, -50, 1e-9);
  EXPECT_NEAR(extent.upper.y, 50, 1e-9);
}

// PL-30: rotating by a quarter, or at any angle, a square covers the circle through its corners, a rectangle of 60 by
// 80 mm from 180° - 2 atan(60 / 80) on. The distance of two circles is independent of the direction.
TEST(Areas, AreCircles) {
  Area a = Standing({0, 0}, {100, 100});
  a.most_c = 90;
  Area c = Standing({0, 0}, {60, 80});
  c.most_c = 180 - 2 * std::atan2(60, 80) * 180 / kPi + 1e-9;
  Area d = Standing({0, 0}, {60, 80, true});
  for (double direction = 0; direction < 7; direction += 0.37) {
    for (Area* turned : {&a, &c, &d}) turned->places[0] = Ahead({30, 40}, direction, 200);
    const double corner = 50 * std::sqrt(2);
    EXPECT_NEAR(Between(a, {.places = {{{30, 40}}}, .mover = {60, 80, true}}), 200 - corner - 50, 1e-6);
    EXPECT_NEAR(Between(c, d), -100, 1e-6);
    const Extent extent = ExtentOf(c);
    EXPECT_NEAR(extent.upper.x - extent.lower.x, 100, 1e-9);
    EXPECT_NEAR(extent.upper.y - extent.lower.y, 100, 1e-9);
  }
  // Beside the corner of a rectangle, and beside its side.
  const auto beside = [](double distance) { return Standing(Ahead({50, 50}, 0.3, distance), {60, 80, true}); };
  EXPECT_FALSE(Near(Standing({0, 0}, {100, 100}), beside(50.01), kSame));
  EXPECT_TRUE(Near(Standing({0, 0}, {100, 100}), beside(49.99), kSame));
  EXPECT_NEAR(Between(Standing({0, 0}, {100, 100}), Standing({130, 110}, {60, 80, true})), 50, 1e-6);
  EXPECT_NEAR(Between(Standing({0, 0}, {100, 100}), Standing({130, 40}, {60, 80, true})), 30, 1e-6);
}

// PL-30: a square of 100 mm that rotates from 0° to 20° reaches 50 mm / cos(10°) in the direction of 100°, between the
// corners; the hull of all it covers would reach 57.9 mm. A small mover fits there.
TEST(Areas, AreTight) {
  Area turning = Standing({0, 0}, {100, 100});
  turning.most_c = 20;
  const double edge = 50 / std::cos(10 * kPi / 180);
  const double small = 0.01;
  const auto at = [&](double distance) { return Standing(Ahead({}, 100 * kPi / 180, distance), {small, small}, 100); };
  EXPECT_TRUE(Near(turning, at(edge - small), 0));
  EXPECT_FALSE(Near(turning, at(edge + kSlack + small), 0));
  // A corner moves from 45° to 65°.
  const double corner = 50 * std::sqrt(2);
  const auto beyond = [&](double direction) {
    return Standing(Ahead({}, direction * kPi / 180, corner + 1), {small, small}, direction);
  };
  for (double direction = 45; direction <= 65; direction += 2.5) {
    EXPECT_TRUE(Near(turning, beyond(direction), 1)) << direction;
    EXPECT_FALSE(Near(turning, beyond(direction), 1 - kSlack - small)) << direction;
  }
}

// PL-30: without rotation the results are those of FCL, where that can decide: pairs of areas, moved until they nearly
// touch.
TEST(Areas, AreThoseOfFcl) {
  Random random(31);
  int together = 0, apart = 0;
  for (int i = 0; i < Trials(2000); ++i) {
    Area a = RandomArea(random), b = RandomArea(random);
    a.most_c = a.least_c;
    b.most_c = b.least_c;
    if (random.Coin()) {
      // To keep the gap small.
      const double want = random.Between(-1, 1) * (random.Coin() ? 1 : 0.001);
      for (int k = 0; k < 3; ++k) {
        const double gap = Between(a, b) - want;
        const Place& at = b.places[0];
        const double length = std::hypot(at.x - a.places[0].x, at.y - a.places[0].y);
        const double x = (a.places[0].x - at.x) / length * gap, y = (a.places[0].y - at.y) / length * gap;
        for (Place& p : b.places) p = {p.x + x, p.y + y};
      }
    }
    if (std::abs(Between(a, b)) < 1e-5) continue;
    const bool near = Near(a, b, 0);
    const auto prism = [](const Area& area) { return testing::PrismOf(HullAt(area, area.least_c, area.least_c)); };
    EXPECT_EQ(near, testing::Collide(*prism(a), *prism(b)));
    EXPECT_EQ(near, Near(b, a, 0));
    (near ? together : apart) += 1;
  }
  EXPECT_GT(together, Trials(300));
  EXPECT_GT(apart, Trials(300));
}

// PL-30: areas reported as apart never come near, at any position and angle; those reported as near come that near at
// one of them, or nearly.
TEST(Areas, AreAllAndNoMore) {
  Random random(32);
  int near = 0, apart = 0;
  double most = 0;
  for (int i = 0; i < Trials(400); ++i) {
    const Area a = RandomArea(random);
    Area b = RandomArea(random);
    // Mostly cases that are not obvious.
    const Place push = Ahead({}, random.Between(-3, 3), random.Between(0, 600));
    for (Place& p : b.places) p = {p.x + push.x, p.y + push.y};
    const double said = Between(a, b);
    const double nearest = DistanceByAngles(a, b);
    if (said <= 0) {
      EXPECT_LT(nearest, kSlack);
      ++near;
      continue;
    }
    ++apart;
    EXPECT_GE(nearest, said - 1e-6);
    EXPECT_LE(nearest, said + kSlack);
    most = std::max(most, nearest - said);
    for (int k = 0; k < 100; ++k) {
      const Pose on_a{RandomPlaceOf(a, random), random.Between(a.least_c, a.most_c)};
      const Pose on_b{RandomPlaceOf(b, random), random.Between(b.least_c, b.most_c)};
      EXPECT_GE(Separation(AsPoint(on_a), a.mover, AsPoint(on_b), b.mover), said - 1e-6);
    }
  }
  EXPECT_GT(near, Trials(80));
  EXPECT_GT(apart, Trials(80));
  EXPECT_GT(most, 0.05);  // so the bound is exercised
}

// PL-30: the extent of an area contains it tightly.
TEST(Areas, ReachToTheirSides) {
  Random random(33);
  for (int i = 0; i < Trials(500); ++i) {
    const Area area = RandomArea(random);
    const Extent extent = ExtentOf(area);
    Extent seen{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (const Place& p : HullAt(area, area.least_c, area.most_c)) {
      seen.lower = {std::min(seen.lower.x, p.x), std::min(seen.lower.y, p.y)};
      seen.upper = {std::max(seen.upper.x, p.x), std::max(seen.upper.y, p.y)};
    }
    for (const auto& [is, should] :
         {std::pair{extent.upper.x, seen.upper.x}, std::pair{extent.upper.y, seen.upper.y},
          std::pair{-extent.lower.x, -seen.lower.x}, std::pair{-extent.lower.y, -seen.lower.y}}) {
      EXPECT_GE(is, should - 1e-9);
      EXPECT_LE(is, should + 0.2);  // with 64 angles
    }
  }
}

// PL-30: fit for the cycle.
TEST(Areas, AllocateNothing) {
  Random random(34);
  std::vector<Area> areas;
  for (int i = 0; i < 40; ++i) areas.push_back(RandomArea(random));
  const long before = AllocationsOfThisThread();
  int near = 0;
  for (const Area& a : areas) {
    for (const Area& b : areas) near += Near(a, b, 0) ? 1 : 0;
  }
  EXPECT_EQ(AllocationsOfThisThread(), before);
  EXPECT_GT(near, Trials(40));
}

}  // namespace
}  // namespace takt::planar
