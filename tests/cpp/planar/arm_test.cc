// PL-73: areas of a mover attached to a carrier.
#include "takt/planar/arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "areas.h"

namespace takt::planar {
namespace {

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double between(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

 private:
  std::mt19937 random_;
};

Place RandomPlace(Chance& chance, double most) {
  return {chance.between(-most, most), chance.between(-most, most)};
}

// Returns a random point in the hull of some places.
Place Within(std::span<const Place> places, Chance& chance) {
  double sum = 0;
  Place place;
  for (const Place& p : places) {
    const double weight = chance.whole(0, 2) == 0 ? chance.between(0, 1) : 0;
    place = {place.x + weight * p.x, place.y + weight * p.y};
    sum += weight;
  }
  return sum > 0 ? Place{place.x / sum, place.y / sum} : places.front();
}

// Returns true if a point is in the hull: a mover of no size there touches it.
bool Covers(const Area& area, const Pose& pose) {
  Area places = area;
  places.mover = {};
  return Near(places, testing::Standing(pose.place, {}, pose.c), 1e-6) && pose.c >= area.least_c - 1e-9 &&
         pose.c <= area.most_c + 1e-9;
}

Arm RandomArm(Chance& chance) {
  return {RandomPlace(chance, 500), chance.between(-180, 180), {chance.between(20, 200), chance.between(20, 200)}};
}

TEST(Arms, StandWhereTheCarrierHasThem) {
  const Pose end = PoseAt({{300, 0}, 10, {}}, {{100, 50}, 90});
  EXPECT_NEAR(end.place.x, 100, 1e-9);
  EXPECT_NEAR(end.place.y, 350, 1e-9);
  EXPECT_NEAR(end.c, 100, 1e-9);
}

// A carrier without rotation: the attached mover moves like the carrier.
TEST(Arms, GoStraightWithTheCarrier) {
  const Arm arm{{0, 100}, 0, {50, 50}};
  const Area area = AreaOf(arm, {.places = {Place{0, 0}, Place{400, 0}}, .count = 2, .least_c = 90, .most_c = 90});
  ASSERT_EQ(area.count, 2);
  EXPECT_NEAR(area.places[1].x, 300, 1e-9);
  EXPECT_NEAR(area.places[1].y, 0, 1e-9);
}

// A quarter turn in place: the hull of the arc, and no more than 2 % of the arm beyond it.
TEST(Arms, SweepAnArc) {
  const Arm arm{{300, 0}, 0, {}};
  const Area area = AreaOf(arm, {.places = {}, .count = 1, .least_c = 0, .most_c = 90});
  const Extent extent = ExtentOf(area);
  EXPECT_NEAR(extent.lower.x, 0, 1e-9);
  EXPECT_NEAR(extent.lower.y, 0, 1e-9);
  for (int angle = 0; angle <= 90; ++angle) {
    const double c = angle * std::numbers::pi / 180;
    const auto at = [&](double r) { return Pose{{r * std::cos(c), r * std::sin(c)}, 45}; };
    EXPECT_TRUE(Covers(area, at(300))) << angle;
    EXPECT_FALSE(Covers(area, at(306.1))) << angle;
  }
  EXPECT_FALSE(Covers(area, {{100, 100}, 45}));
}

// For any pose of the carrier within its area, its arm is within the area of the arm; likewise on a move.
TEST(Arms, PropertyCoverAllThatTheyComeTo) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    Chance chance(seed);
    const Arm arm = RandomArm(chance);
    const double turn = chance.whole(0, 3) == 0 ? 0 : chance.between(0, 400);
    Pose from{RandomPlace(chance, 500), chance.between(-300, 300)};
    Move move{.target = {chance.whole(0, 1) == 0 ? from.place : RandomPlace(chance, 500),
                         from.c + (chance.whole(0, 1) == 0 ? turn : -turn)}};
    if (chance.whole(0, 2) == 0) move.over = RandomPlace(chance, 500);
    if (turn > 0 && chance.whole(0, 2) == 0) move.over_c = from.c + chance.between(-20, 20);
    if (chance.whole(0, 2) == 0) {
      move.corner_count = 4;
      for (Place& corner : move.corners) corner = RandomPlace(chance, 500);
    }
    const auto reserved = [](const Footprint& mover, const Pose& at, const Move& way) {
      return AreaOf(Reservation{.present = true, .moving = true, .mover = mover, .pose = at, .move = way});
    };
    const Area carrier = reserved({100, 100}, from, move);
    const Area whole = reserved(arm.mover, PoseAt(arm, from), MoveOf(arm, from, move));
    for (int i = 0; i < 50; ++i) {
      const Pose pose{Within(std::span(carrier.places.data(), carrier.count), chance),
                      chance.between(carrier.least_c, carrier.most_c)};
      EXPECT_TRUE(Covers(whole, PoseAt(arm, pose))) << seed;
      EXPECT_TRUE(carrier.count > 6 || Covers(AreaOf(arm, carrier), PoseAt(arm, pose))) << seed;
    }
  }
}

}  // namespace
}  // namespace takt::planar
