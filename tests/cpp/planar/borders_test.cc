// Movers on linked tracks: PL-23, PL-24, PL-26. Destinations on loops: PL-12.
#include <gtest/gtest.h>

#include <cmath>

#include "streets.h"
#include "takt/planar/traffic.h"

namespace takt::planar {
namespace {

using testing::TrackNetworkState;
using testing::Watcher;

const Pace kEasyPace = testing::PaceOf(1000, 8000, 200000);

// Tracks along y = 0, one after the other, of these lengths.
std::vector<Layout> Cut(const std::vector<double>& lengths) {
  std::vector<Layout> layouts;
  double x = 0;
  for (const double length : lengths) {
    layouts.push_back({{testing::Line({x, 0}, {x + length, 0})}});
    x += length;
  }
  return layouts;
}

// The gap holds across tracks that are shorter, also to a mover that has only been put there.
TEST(Borders, TheGapReachesOverShortTracks) {  // PL-24
  for (const double shorter : {5.0, 20.0, 60.0, 150.0}) {
    for (const int between : {1, 2, 5}) {
      const double way = shorter * between;
      std::vector<double> lengths{1500};
      lengths.insert(lengths.end(), static_cast<std::size_t>(between), shorter);
      lengths.push_back(1500);
      const std::vector<Layout> layouts = Cut(lengths);
      const auto last = static_cast<std::uint32_t>(between + 1);
      for (const double gap : {120.0, 300.0}) {
        TrackNetworkState streets(layouts, 2);
        streets.Put(0, 0, 100, kEasyPace, 120);
        streets.Put(1, last, 5, kEasyPace, gap);  // the larger gap counts
        streets.Send(0, 0, 1500);
        const bool free = way + 5 >= gap;
        EXPECT_EQ(streets.Run(5), free) << way;
        if (!free) {
          // Or before it would get too near at the end of its route.
          EXPECT_NEAR(streets[0].at.position, std::max(1505 + way - gap, 1500.0 - 120), 0.05);
          EXPECT_EQ(streets[0].waits_for, 1U);
        }
        // It comes no nearer on the way back, either; and when it moves ahead it makes room.
        streets.Send(1, last, 0);
        EXPECT_EQ(streets.Run(3), way >= gap);
        const double apart = 1500 - streets[0].at.position + way + streets[1].at.position;
        EXPECT_GT(apart, std::min(gap, 5 + way) - 1e-5);
        streets.Send(1, last, 1000);
        EXPECT_TRUE(streets.Run(5));
        EXPECT_DOUBLE_EQ(streets[0].at.position, 1500);
      }
    }
  }
}

// A mover that has passed many short tracks still blocks a mover from the branch where those begin.
TEST(Borders, TheGapReachesBackOverShortTracks) {  // PL-24
  for (const std::uint32_t over : {3U, 5U, 6U, 8U, 12U}) {
    std::vector<Layout> layouts = Cut({1000, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 1000});
    layouts.push_back({{testing::Line({0, 500}, {400, 500}), testing::Line({990, 0}, {1000, 0})}});
    TrackNetworkState streets(layouts, 2);
    streets.Put(0, 0, 500, kEasyPace, 120);
    streets.Put(1, 14, 100, kEasyPace, 120);
    streets.Send(0, over, 5);
    ASSERT_TRUE(streets.Run(5));
    ASSERT_EQ(streets[0].route.first(), over);
    const double beyond = 15 * (over - 1) + 5, length = streets.track(14).length;
    streets.Send(1, 14, length);
    const bool free = beyond >= 120;
    EXPECT_EQ(streets.Run(5), free) << over;
    const double apart = length - streets[1].at.position + beyond;
    EXPECT_GT(apart, 120 - 1e-5) << over;
    if (!free) {
      EXPECT_EQ(streets[1].waits_for, 0U) << over;
      streets.Send(0, 13, 500);
      EXPECT_TRUE(streets.Run(5));
    }
  }
}

// Head-on across a border between tracks.
TEST(Borders, FaceToFaceIsADeadlock) {  // PL-26
  for (const int later : {1300, 1500, 1700}) {
    for (const double from : {300.0, 400.0}) {
      TrackNetworkState streets(Cut({1500, 1500}), 2);
      streets.Put(0, 1, from, kEasyPace, 120);
      streets.Put(1, 0, 0, kEasyPace, 200);
      ASSERT_TRUE(streets.Send(1, 1, from - 100));
      for (int i = 0; i < later; ++i) streets.Step();
      ASSERT_TRUE(streets.Send(0, 1, 0));
      EXPECT_FALSE(streets.Run(6));
      EXPECT_EQ(streets[0].waits, Waits::kMover);
      EXPECT_EQ(streets[0].waits_for, 1U) << later;
      EXPECT_EQ(streets[1].waits_for, 0U);
      EXPECT_TRUE(IsDeadlocked(streets.riders(), 0) && IsDeadlocked(streets.riders(), 1)) << later << " " << from;
      const double ahead = streets[0].at.position + (streets[1].route.first() == 0 ? 1500 : 0);
      EXPECT_NEAR(ahead - streets[1].at.position, 200, 0.1);
    }
  }
}

Layout Ring() {
  return {.elements = {testing::Line({200, 600}, {500, 600}), testing::Line({500, 900}, {200, 900})}, .closed = true};
}

// Returns the distance travelled, with its sign.
double Went(TrackNetworkState& streets, const Destination& to) {
  const double before = streets[0].at.position + streets[0].origin;
  EXPECT_TRUE(streets.Send(0, to));
  EXPECT_TRUE(streets.Run(20));
  return streets[0].at.position + streets[0].origin - before;
}

// Turns are added wherever the mover is, also at its target, or within the tolerance of it.
TEST(Borders, TurnsOfALoopAreMade) {  // PL-12
  TrackNetworkState streets({Ring()}, 1);
  const double length = streets.track(0).length;
  for (const std::uint32_t turns : {0U, 1U, 3U}) {
    for (const double tolerance : {0.0, 1.0}) {
      const auto to = [&](double position, Way way) {
        return Destination{.position = position, .way = way, .additional_turns = turns, .modulo_tolerance = tolerance};
      };
      const double all = turns * length;
      streets.Put(0, 0, 100, kEasyPace);
      EXPECT_NEAR(Went(streets, to(100, Way::kPositive)), all, 1e-6);
      EXPECT_NEAR(Went(streets, to(100, Way::kNegative)), -all, 1e-6);
      EXPECT_NEAR(Went(streets, to(400, Way::kPositive)), 300 + all, 1e-6);
      EXPECT_NEAR(Went(streets, to(100, Way::kNegative)), -300 - all, 1e-6);
      // A little against its direction, within the tolerance; else all the way round.
      const double slightly = tolerance > 0 ? -0.5 : length - 0.5;
      EXPECT_NEAR(Went(streets, to(99.5, Way::kPositive)), slightly + all, 1e-6) << turns << " " << tolerance;
    }
  }
}

}  // namespace
}  // namespace takt::planar
