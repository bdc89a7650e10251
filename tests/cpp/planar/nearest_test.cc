// PL-20: the nearest point of a track: by hand, and against an exhaustive search.
#include "takt/planar/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../core/allocations.h"
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

TEST(NearestPlaces, AreThoseOfLinesAndArcs) {
  const Track line = Make({.elements = {Line({0, 0}, {400, 0})}});
  for (const auto& [place, s] : {std::pair{Place{150, 30}, 150.0}, {{-10, 5}, 0.0}, {{500, 5}, 400.0}}) {
    EXPECT_NEAR(NearestTo(line, place).s, s, 1e-12);
  }
  const Track arc = Make({.elements = {Arc({100, 0}, {-100, 0}, {0, 0}, false)}});
  EXPECT_NEAR(NearestTo(arc, {0, 30}).s, 50 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(NearestTo(arc, {0, 30}).distance, 70, 1e-12);
  EXPECT_NEAR(NearestTo(arc, {50, -1}).s, 0, 1e-12);
  EXPECT_NEAR(NearestTo(arc, {-50, -1}).s, arc.length, 1e-12);
}

// PL-20: of equally near points the first.
TEST(NearestPlaces, AreTheFirstOfMany) {
  const Track circle = Make({.elements = {Arc({100, 0}, {100, 0}, {0, 0}, false)}, .closed = true});
  EXPECT_NEAR(NearestTo(circle, {0, 0}).distance, 100, 1e-12);
  EXPECT_EQ(NearestTo(circle, {0, 0}).s, 0);
  const Track around = Make({.elements = {Line({0, 0}, {300, 0}), Line({300, 200}, {0, 200})}});
  EXPECT_NEAR(NearestTo(around, {100, 100}).s, 100, 1e-9);
}

// PL-20: no point of a random track is nearer than the one found, which is at s, and perpendicular to the track or at
// an end; to 1e-6 mm.
TEST(NearestPlaces, AreNowhereElse) {
  Random random(11);
  for (int i = 0; i < Trials(100); ++i) {
    const Track track = RandomTrack(random);
    const int samples = 2 * static_cast<int>(track.length);
    std::vector<Place> places;
    for (int k = 0; k <= samples; ++k) places.push_back(At(track, track.length * k / samples).place);
    for (int k = 0; k < 200; ++k) {
      // Also on the track, and about the centres of its curves, from which much of it is equally far.
      const TrackPoint near = At(track, random.Between(0, track.length));
      double off = k < 5 ? 0 : random.Between(-300, 300);
      if (k >= 15 && std::abs(near.curvature) > 1e-3) off = random.Between(0.9, 1.1) / near.curvature;
      const Place place = testing::Ahead(near.place, near.direction + std::numbers::pi / 2, off);
      const Nearest found = NearestTo(track, place);
      double least = INFINITY;
      for (const Place& p : places) least = std::min(least, Distance(p, place));
      EXPECT_LE(found.distance, least + 1e-9);
      EXPECT_LE(found.distance, std::abs(off) + 1e-9);
      const TrackPoint there = At(track, found.s);
      EXPECT_LT(Distance(there.place, found.place), 1e-8);
      EXPECT_NEAR(Distance(found.place, place), found.distance, 1e-9);
      const double along =
          std::cos(there.direction) * (place.x - found.place.x) + std::sin(there.direction) * (place.y - found.place.y);
      const bool ends = found.s == 0 || found.s >= track.length - 1e-9;
      if (!ends || track.closed) {
        EXPECT_LT(std::abs(along), 1e-6) << found.s << " of " << track.length;
      }
    }
  }
}

// PL-60: does not allocate.
TEST(NearestPlaces, AreFoundWithoutMemory) {
  Random random(12);
  const Track track = RandomTrack(random);
  const long before = AllocationsOfThisThread();
  double sum = 0;
  for (int i = 0; i < 100; ++i) sum += NearestTo(track, {random.Between(-500, 500), random.Between(-500, 500)}).s;
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace takt::planar
