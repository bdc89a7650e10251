// PL-23: tracks that cross themselves.
#include "takt/planar/crossing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../core/trials.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Arc;
using testing::Distance;
using testing::Line;
using testing::Make;
using testing::Random;
using testing::RandomTrack;

// An arc over a line: through (100, 0) and, descending, once more.
TEST(Crossings, AreFoundByHand) {
  const Track bow = Make({.elements = {Line({0, 0}, {200, 0}), Arc({300, 100}, {100, 100}, {200, 100}, false),
                                       Line({100, 60}, {100, -100})}});
  const auto crossing = SelfCrossing(bow);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->first, 100, 2e-3);
  EXPECT_LT(Distance(At(bow, crossing->second).place, {100, 0}), 2e-3);
}

TEST(Crossings, AreNotWhereATrackGoesOn) {
  EXPECT_FALSE(SelfCrossing(Make({.elements = {Line({0, 0}, {200, 0})}})));
  const Element circle = Arc({100, 0}, {100, 0}, {0, 0}, false);
  EXPECT_FALSE(SelfCrossing(Make({.elements = {circle}, .closed = true})));
  EXPECT_TRUE(SelfCrossing(Make({.elements = {circle}})));  // its ends touch
  const Track stadium = Make({.elements = {Line({0, 0}, {300, 0}), Line({300, 200}, {0, 200})}, .closed = true});
  EXPECT_FALSE(SelfCrossing(stadium));
  // A spiral inwards, of two turns.
  const Track spiral =
      Make({.elements = {Arc({200, 0}, {-200, 0}, {0, 0}, false), Arc({-150, -50}, {150, -50}, {0, -50}, false),
                         Arc({120, 0}, {-120, 0}, {0, 0}, false)}});
  EXPECT_FALSE(SelfCrossing(spiral));
}

// PL-23: crossings are found whenever straight pieces cross, and only where the track passes a point twice.
TEST(Crossings, AreThoseOfPolylines) {
  Random random(31);
  int crossing = 0;
  const int trials = Trials(100);
  for (int i = 0; i < trials; ++i) {
    const Track track = RandomTrack(random);
    constexpr int kCount = 1200;
    std::vector<Place> p;
    for (int k = 0; k <= kCount; ++k) p.push_back(At(track, track.length * k / kCount).place);
    const auto side = [&](int a, int b) {
      return (p[a + 1].x - p[a].x) * (p[b].y - p[a].y) - (p[a + 1].y - p[a].y) * (p[b].x - p[a].x);
    };
    bool crosses = false;
    for (int a = 0; a < kCount && !crosses; ++a) {
      for (int b = a + 2; b < kCount && !crosses; ++b) {
        if (track.closed && a == 0 && b + 1 == kCount) continue;
        if (Distance(p[a], p[b]) > 2 * track.length / kCount) continue;
        crosses = side(a, b) * side(a, b + 1) < 0 && side(b, a) * side(b, a + 1) < 0;
      }
    }
    const auto found = SelfCrossing(track);
    if (crosses) {
      ++crossing;
      EXPECT_TRUE(found);
    }
    if (found) {
      EXPECT_LT(Distance(At(track, found->first).place, At(track, found->second).place), 2 * kTouch);
      EXPECT_GT(found->second - found->first, 1);
    }
  }
  EXPECT_GT(crossing, trials / 10);
  EXPECT_LT(crossing, trials * 9 / 10);
}

}  // namespace
}  // namespace takt::planar
