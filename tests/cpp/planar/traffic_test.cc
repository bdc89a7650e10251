// Traffic on tracks: PL-12, PL-15, PL-21, PL-23 to PL-26.
#include "takt/planar/traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "../core/trials.h"
#include "streets.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {
namespace {

using testing::Straight;
using testing::TrackNetworkState;
using testing::Watcher;

TEST(Traffic, AMoverAloneTakesNoLongerThanThePlannerNeeds) {  // PL-12, PL-15
  testing::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const double length = random.Between(500, 5000);
    const Pace pace = testing::PaceOf(random.Between(300, 3000), random.Between(3000, 20000), random.Between(5e4, 5e5));
    TrackNetworkState streets({Straight(length)}, 1);
    const double from = random.Between(0, length), to = random.Between(0, length);
    streets.Put(0, 0, from, pace);
    ASSERT_TRUE(streets.Send(0, 0, to));
    trajectory::Planner planner;
    const double expected = TimeAlone(planner, streets.network(), streets[0]);
    Watcher watcher(streets);
    streets.watch = [&] { watcher.Look(); };
    ASSERT_TRUE(streets.Run(30)) << trial;
    EXPECT_DOUBLE_EQ(streets[0].at.position, to);
    trajectory::Profile optimum;
    ASSERT_TRUE(planner.ToPosition({from, 0, 0}, to, 0, pace.limits, optimum).ok());
    EXPECT_NEAR(expected, optimum.duration(), 1e-9) << trial;
    EXPECT_LE(streets.now(), optimum.duration() + 1.001 * testing::kPeriod) << trial;
    EXPECT_LE(watcher.speed, 1 + 1e-9);
    EXPECT_LE(watcher.acceleration, 1 + 1e-9);
    EXPECT_LE(watcher.jerk, 1 + 1e-6);
  }
}

TEST(Traffic, AMoverStopsBehindAnother) {  // PL-24
  TrackNetworkState streets({Straight(3000)}, 2);
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

// A target just at the gap behind another mover is reached.
TEST(Traffic, GoesUpToTheGap) {  // PL-24
  for (const double from : {100.0, 1200.0, 1299.9, 1299.9995}) {
    TrackNetworkState streets({Straight(3000)}, 2);
    const Pace pace = testing::PaceOf(2000, 10000, 200000);
    streets.Put(0, 0, from, pace, 200);
    streets.Put(1, 0, 1500, pace, 200);
    streets.Send(0, 0, 1300);
    EXPECT_TRUE(streets.Run(5)) << from;
    EXPECT_DOUBLE_EQ(streets[0].at.position, 1300);
  }
}

// Counts the reversals of the jerk of a mover, by more than half of its limit.
class Turns {
 public:
  explicit Turns(TrackNetworkState& streets)
      : streets_(streets), before_(streets.riders().size()), last_(before_.size()) {}
  void Look() {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      const Rider& r = streets_[i];
      const double jerk = (r.at.acceleration - before_[i]) / testing::kPeriod / r.pace.limits.jerk;
      if (jerk * last_[i] < 0 && std::abs(jerk - last_[i]) > 0.5) ++count;
      before_[i] = r.at.acceleration;
      last_[i] = jerk;
    }
  }
  int count = 0;

 private:
  TrackNetworkState& streets_;
  std::vector<double> before_, last_;
};

TEST(Traffic, FollowsWithoutChatter) {  // PL-25
  TrackNetworkState streets({Straight(20000)}, 2);
  streets.Put(0, 0, 100, testing::PaceOf(2000, 10000, 200000), 200);
  streets.Put(1, 0, 1500, testing::PaceOf(700, 10000, 200000), 200);
  streets.Send(0, 0, 19000);
  streets.Send(1, 0, 19500);
  double most = 0, apart = 0;
  Turns turns(streets);
  streets.watch = [&] {
    turns.Look();
    if (streets.now() < 5) return;
    most = std::max(most, std::abs(streets[0].at.acceleration));
    apart = std::max(apart, streets[1].at.position - streets[0].at.position);
  };
  EXPECT_FALSE(streets.Run(20));
  EXPECT_LT(most, 1e-4 * 10000);  // 1 % is required
  EXPECT_LT(apart, 210);
  EXPECT_LT(turns.count, 10);
}

// Twenty movers at their gaps, with different dynamics, start and stop with the first one, again and again.
TEST(Traffic, AStreamOpensAndClosesLikeAnAccordion) {  // PL-25
  testing::Random random(3);
  TrackNetworkState streets({Straight(60000)}, 20);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Pace pace =
        testing::PaceOf(random.Between(1500, 2000), random.Between(8000, 12000), random.Between(1e5, 3e5));
    streets.Put(i, 0, 6000 - 200.0 * i, pace, 200);
    streets.Send(i, 0, 59000 - 200.0 * i);
  }
  streets[0].pace.limits.velocity = 1000;
  Watcher watcher(streets);
  Turns turns(streets);
  double missing = -INFINITY, longest = 0;
  streets.watch = [&] {
    watcher.Look();
    turns.Look();
    missing = std::max(missing, streets.Missing());
    longest = std::max(longest, streets[0].at.position - streets[19].at.position);
  };
  for (int i = 0; i < 6; ++i) {
    streets.Send(0, 0, 59000);
    streets.Run(3);
    EXPECT_GT(streets[19].at.velocity, 900);
    streets.Halt(0);
    streets.Run(3);
    EXPECT_EQ(streets[0].at.velocity, 0);
    EXPECT_NEAR(streets[0].at.position - streets[19].at.position, 19 * 200, 1);
  }
  EXPECT_LT(missing, 1e-5);
  EXPECT_GT(longest, 19 * 200 + 20);
  EXPECT_LE(watcher.speed, 1 + 1e-9);
  EXPECT_LE(watcher.acceleration, 1 + 1e-9);
  EXPECT_LE(watcher.jerk, 1 + 1e-6);
  // Six phases of speeding up and braking: some reversals for each of them, no chatter.
  EXPECT_LT(turns.count, 20 * 6 * 8);
  RecordProperty("turns", turns.count);
}

// The first of twenty movers with dynamics of their own, which is the slowest, is halted: its followers brake as hard
// as it does, or less, and do not speed up again.
TEST(Traffic, NobodyBrakesHarderThanTheFirst) {  // PL-25
  testing::Random random(5);
  for (int trial = 0; trial < 10; ++trial) {
    TrackNetworkState streets({Straight(9000)}, 20);
    for (std::uint32_t i = 0; i < 20; ++i) {
      const Pace pace =
          i == 0 ? testing::PaceOf(500, 4000, 8e4)
                 : testing::PaceOf(random.Between(500, 1500), random.Between(4e3, 12e3), random.Between(8e4, 3e5));
      streets.Put(i, 0, 100 + 151.0 * (19 - i), pace, 150);
      streets.Send(i, 0, 8900 - 150.0 * i);
    }
    streets.Run(3);
    streets.Halt(0);
    std::vector<double> slowest(20, INFINITY);
    double hardest = 0, faster = 0;
    streets.watch = [&] {
      for (std::uint32_t i = 0; i < 20; ++i) {
        const KinematicState& at = streets[i].at;
        hardest = std::max(hardest, -at.acceleration);
        slowest[i] = std::min(slowest[i], at.velocity);
        faster = std::max(faster, at.velocity - slowest[i]);
      }
    };
    streets.Run(0.6);
    EXPECT_LT(hardest, 1.1 * 4000) << trial;
    EXPECT_LT(faster, 0.05 * 500) << trial;
    EXPECT_EQ(streets[19].at.velocity, 0) << trial;
    EXPECT_NEAR(streets[0].at.position - streets[19].at.position, 19 * 150, 0.5) << trial;
  }
}

// A straight line and a bend of each kind, at the highest speeds possible without regard to jerk.
TEST(Traffic, TakesCurvesNotMuchSlowerThanCanBe) {  // PL-15, PL-21
  testing::Random random(5);
  double worst = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Layout layout;
    double x = 0, y = 0;
    for (int i = 0; i < 4; ++i) {
      const double length = random.Between(400, 1200), side = random.Coin() ? 1 : -1, radius = random.Between(60, 200);
      const bool across = i % 2 == 0;
      const Place to{across ? x + length : x, across ? y : y + side * length};
      layout.elements.push_back(testing::Line({x, y}, to));
      x = across ? to.x + radius : to.x + radius;
      y = across ? to.y + (random.Coin() ? radius : -radius) : to.y + side * radius;
      if (!across) continue;
      // The next one leads away from this corner.
    }
    Track track;
    if (MakeTrack(layout, track).problem != Problem::kNone) continue;
    const Pace pace = testing::PaceOf(2000, 10000, 400000, random.Between(3000, 10000));
    TrackNetworkState streets({layout}, 1);
    streets.Put(0, 0, 0, pace);
    streets.Send(0, 0, track.length);
    Watcher watcher(streets);
    streets.watch = [&] { watcher.Look(); };
    ASSERT_TRUE(streets.Run(30));
    EXPECT_LE(watcher.lateral, 1 + 1e-6);
    EXPECT_LE(watcher.speed, 1 + 1e-9);
    // Without jerk: up from the start, down to the end, and below the bound everywhere.
    const auto steps = static_cast<std::size_t>(track.length);
    const double step = track.length / static_cast<double>(steps);
    std::vector<double> square(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i) {
      const double bound = SpeedBound(At(track, step * static_cast<double>(i)), pace.lateral);
      square[i] = std::pow(std::min(bound, pace.limits.velocity), 2);
    }
    square[0] = square[steps] = 0;
    for (std::size_t i = 1; i <= steps; ++i) square[i] = std::min(square[i], square[i - 1] + 2 * 10000 * step);
    for (std::size_t i = steps; i-- > 0;) square[i] = std::min(square[i], square[i + 1] + 2 * 10000 * step);
    double best = 0;
    for (std::size_t i = 0; i < steps; ++i) best += 2 * step / (std::sqrt(square[i]) + std::sqrt(square[i + 1]));
    // The cost of jerk at both ends, which is unavoidable.
    best += pace.limits.acceleration / pace.limits.jerk;
    worst = std::max(worst, streets.now() / best);
    EXPECT_GT(streets.now(), 0.98 * best);
  }
  // Against a bound that includes jerk only at both ends.
  EXPECT_LT(worst, 1.07);
  RecordProperty("worst", std::to_string(worst));
}

// Tracks with bends in a row; each mover is queried at rest or on the move.
TEST(Traffic, SaysHowLongAWayTakes) {  // PL-12
  testing::Random random(7);
  trajectory::Planner planner;
  double least = 10, most = 0;
  for (int trial = 0; trial < Trials(50, 4); ++trial) {
    std::vector<Layout> layouts;
    const int tracks = random.Below(5) + 1;
    double x = 0, y = 0;
    for (int i = 0; i < tracks; ++i) {
      Layout layout;
      for (int k = 0; k < 3; ++k) {
        const double length = random.Between(200, 900), aside = random.Between(-200, 200),
                     gap = random.Between(200, 400);
        layout.elements.push_back(testing::Line({x, y}, {x + length, y}));
        x += length + gap;
        y += aside;
      }
      layout.elements.push_back(testing::Line({x, y}, {x + 100, y}));
      x += 100;
      layouts.push_back(layout);
    }
    const double velocity = random.Between(300, 3000), acceleration = random.Between(3000, 20000);
    Pace pace = testing::PaceOf(velocity, acceleration, random.Between(5e4, 5e5));
    if (random.Coin()) pace = testing::InPlane(pace);
    TrackNetworkState streets(layouts, 1);
    streets.Put(0, 0, random.Between(0, 300), pace);
    const auto last = static_cast<std::uint32_t>(tracks - 1);
    ASSERT_TRUE(streets.Send(0, last, streets.track(last).length));
    if (random.Coin()) streets.Run(random.Between(0, 0.3));
    const double begin = streets.now(), expected = TimeAlone(planner, streets.network(), streets[0]);
    ASSERT_TRUE(streets.Run(60)) << trial;
    const double ratio = expected / (streets.now() - begin);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    EXPECT_GT(ratio, 0.7) << trial;
    EXPECT_LT(ratio, 1.1) << trial;
  }
  RecordProperty("least", std::to_string(least));
  RecordProperty("most", std::to_string(most));
}

// On a ring the tracks beyond the first plans are the same one again.
TEST(Traffic, SaysHowLongTurnsTake) {  // PL-12
  trajectory::Planner planner;
  for (const double radius : {80.0, 250.0}) {
    for (const int turns : {1, 3, 40}) {
      Layout ring;
      ring.closed = true;
      ring.elements.push_back(testing::Arc({radius, 0}, {-radius, 0}, {0, 0}, false));
      ring.elements.push_back(testing::Arc({-radius, 0}, {radius, 0}, {0, 0}, false));
      TrackNetworkState streets({ring}, 1);
      streets.Put(0, 0, 10, testing::PaceOf(2000, 10000, 200000));
      ASSERT_TRUE(streets.Send(
          0,
          {.track = 0, .position = 200, .way = Way::kPositive, .additional_turns = static_cast<std::uint32_t>(turns)}));
      const double expected = TimeAlone(planner, streets.network(), streets[0]);
      ASSERT_TRUE(streets.Run(300)) << turns;
      EXPECT_NEAR(expected / streets.now(), 1, 0.1) << radius << " mm, " << turns << " turns";
    }
  }
}

// Two tracks that merge: the first to arrive passes first, the other waits outside, and both continue.
TEST(Traffic, GivesWayWhereTracksJoin) {  // PL-23, PL-24
  Layout below{{testing::Line({0, 0}, {1000, 0}), testing::Line({1300, 200}, {1600, 200})}};
  Layout above{{testing::Line({0, 400}, {1000, 400}), testing::Line({1300, 200}, {1600, 200})}};
  Layout on{{testing::Line({1600, 200}, {3000, 200})}};
  TrackNetworkState streets({below, above, on}, 2);
  EXPECT_GT(streets.network()[0].range_at_end, 300);
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  streets.Put(0, 0, 100, pace, 200);
  streets.Put(1, 1, 60, pace, 200);
  streets.Send(0, 2, 1000);
  streets.Send(1, 2, 600);
  double nearest = INFINITY;
  streets.watch = [&] { nearest = std::min(nearest, streets.Nearest()); };
  ASSERT_TRUE(streets.Run(10));
  EXPECT_GT(nearest, 0);
  EXPECT_EQ(streets[0].route.first(), 2U);
  EXPECT_DOUBLE_EQ(streets[0].at.position, 1000);
  EXPECT_DOUBLE_EQ(streets[1].at.position, 600);
}

// As in the manual: within the range of the other track a stationary mover blocks it; the mover that waits stops where
// its own range begins.
TEST(Traffic, StopsWhereTheRangeBegins) {  // PL-24
  Layout below{{testing::Line({0, 0}, {1000, 0}), testing::Line({1300, 200}, {1600, 200})}};
  Layout above{{testing::Line({0, 400}, {1000, 400}), testing::Line({1300, 200}, {1600, 200})}};
  Layout on{{testing::Line({1600, 200}, {3000, 200})}};
  for (const double gap : {150.0, 700.0}) {
    TrackNetworkState streets({below, above, on}, 2);
    const double length = streets.track(0).length, range = streets.network()[1].range_at_end;
    const Pace pace = testing::PaceOf(1000, 8000, 200000);
    streets.Put(0, 0, length - 100, pace, 150);
    streets.Put(1, 1, 60, pace, gap);
    streets.Send(1, 2, 600);
    streets.Run(5);
    // Behind the other one along the track, or outside of the shared range.
    const double expected = length - std::min(std::max(gap, range), 100 + gap);
    EXPECT_NEAR(streets[1].at.position, expected, 0.05) << gap;
    EXPECT_EQ(streets[1].waits_for, 0U);
    streets.Send(0, 2, 1350);
    EXPECT_TRUE(streets.Run(5));
  }
}

// Side by side before the ranges of two tracks that merge: neither is active there yet. A larger gap, or a displaced
// mover elsewhere, does not bring both into the ranges side by side.
TEST(Traffic, NobodyGetsSideBySideIntoAJoinByBeingTold) {  // PL-13, PL-24
  Layout below{{testing::Line({0, 0}, {1000, 0}), testing::Line({1300, 200}, {1600, 200})}};
  Layout above{{testing::Line({0, 400}, {1000, 400}), testing::Line({1300, 200}, {1600, 200})}};
  Layout on{{testing::Line({1600, 200}, {3000, 200})}};
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (const bool gap : {true, false}) {
    TrackNetworkState streets({below, above, on}, 3);
    for (const std::uint32_t k : {0U, 1U}) {
      streets.Put(k, k, streets.track(k).length - streets.network()[k].range_at_end - 0.5, pace, 150);
    }
    if (gap) {
      streets[0].gap = streets[1].gap = 700;
    } else {
      streets.Put(2, 2, 1390, pace, 150).off = 60;
      EXPECT_EQ(streets.TooNear(2), kNobody);
    }
    double nearest = INFINITY;
    streets.watch = [&] { nearest = std::min(nearest, streets.Nearest()); };
    streets.Send(0, 2, 1100);
    streets.Send(1, 2, 350);
    ASSERT_TRUE(streets.Run(10)) << gap;
    EXPECT_GT(nearest, 0) << gap;
    EXPECT_DOUBLE_EQ(streets[0].at.position, 1100);
    EXPECT_DOUBLE_EQ(streets[1].at.position, 350);
  }
}

// Two bends side by side, with a common end or start; the outer one is 157 mm longer.
struct Bends {
  explicit Bends(bool end) {
    const Place center{-300, 400}, node{0, 0}, before{200, 0};
    if (end) {
      outer = {{testing::Line({-700, 1500}, {-700, 700}), testing::Arc({-700, 400}, {-300, 0}, center, false),
                testing::Line(node, before)}};
      inner = {{testing::Arc({-600, 400}, {-300, 100}, center, false), testing::Line(node, before)}};
      common = {{testing::Line(before, {1500, 0})}};
    } else {
      outer = {{testing::Line(before, node), testing::Arc({-300, 0}, {-700, 400}, center, true),
                testing::Line({-700, 700}, {-700, 1500})}};
      inner = {{testing::Line(before, node), testing::Arc({-300, 100}, {-600, 400}, center, true)}};
      common = {{testing::Line({1500, 0}, before)}};
    }
  }
  Layout outer, inner, common;
};

// Beside a mover at rest on the shorter track, a mover on the longer one may be farther from the merge by more than the
// gap, and still touch it; likewise at a branch, in the other direction.
TEST(Traffic, KeepsClearOfTracksThatRunBeside) {  // PL-24
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (const bool end : {true, false}) {
    const Bends bends(end);
    TrackNetworkState streets({bends.outer, bends.inner, bends.common}, 2);
    const double lead = end ? LeadAtEnd(streets.network(), 1, 0) : LeadAtStart(streets.network(), 0, 1);
    EXPECT_GT(lead, 170 + 50);
    double nearest = INFINITY;
    streets.watch = [&] { nearest = std::min(nearest, streets.Nearest()); };
    streets.Put(0, end ? 1 : 2, end ? 20 : 400, pace, 170);
    streets.Put(1, end ? 0 : 2, 0, pace, 170);
    if (end) {
      streets.Send(1, 2, 900);
    } else {
      streets.Send(0, 0, 750);
      streets.Send(1, 1, 600);
    }
    streets.Run(5);
    const auto from_node = [&](std::uint32_t mover) {
      const Rider& r = streets[mover];
      if (!end) return r.route.first() == 2 ? r.at.position - streets.track(2).length : r.at.position;
      return r.at.position - streets.track(r.route.first()).length;
    };
    EXPECT_NEAR(from_node(0) - from_node(1), lead, 0.05);
    EXPECT_EQ(streets[1].waits_for, 0U);
    EXPECT_GT(nearest, 0);
    // It continues when the other one has left.
    streets.Send(0, end ? 2 : 0, end ? 1200 : 1700);
    EXPECT_TRUE(streets.Run(5));
    EXPECT_GT(nearest, 0);
  }
}

// Against all pairs of positions.
TEST(Traffic, LeadsAreAsLongAsTheyHaveToBe) {  // PL-24
  testing::Random random(8);
  double longest = 0;
  constexpr double kStep = 4;
  for (int trial = 0; trial < 5; ++trial) {
    const std::vector<Layout> layouts = testing::RandomCity(random, 14, 100);
    TrackNetworkState streets(layouts, 0);
    Network& network = streets.network();
    const double reach = network[0].reach;
    // For movers of this size: the values of LeadAtStart and LeadAtEnd.
    const auto most = [&](std::uint32_t near, std::uint32_t far, bool at_end, double size) {
      const auto range = [&](std::uint32_t track) {
        return at_end ? network[track].range_at_end : network[track].range_at_start;
      };
      const auto place = [&](std::uint32_t track, double s) {
        return At(streets.track(track), at_end ? network[track].length - s : s).place;
      };
      double most = 0;
      for (double s = 0; s <= range(near); s += kStep) {
        const Place here = place(near, s);
        for (double t = s + most; t <= range(far); t += kStep) {
          if (testing::Distance(here, place(far, t)) < size) most = t - s;
        }
      }
      return most;
    };
    for (std::uint32_t a = 0; a < layouts.size(); ++a) {
      for (std::uint32_t b = 0; b < layouts.size(); ++b) {
        if (a == b) continue;
        if (network[a].end_node != kNoNode && network[a].end_node == network[b].end_node) {
          const double lead = LeadAtEnd(network, a, b);
          EXPECT_GE(lead, most(a, b, true, reach));
          EXPECT_LE(lead, most(a, b, true, reach + kLeadSlack) + kLeadSlack + kStep);
          longest = std::max(longest, lead);
        }
        if (network[a].start_node != kNoNode && network[a].start_node == network[b].start_node) {
          const double lead = LeadAtStart(network, a, b);
          EXPECT_GE(lead, most(b, a, false, reach));
          EXPECT_LE(lead, most(b, a, false, reach + kLeadSlack) + kLeadSlack + kStep);
          longest = std::max(longest, lead);
        }
      }
    }
  }
  EXPECT_GT(longest, std::hypot(100, 100));
}

// A mover just at the gap behind is not in the way, whatever the rounding.
TEST(Traffic, GoesBeforeOneThatIsJustAtTheGap) {  // PL-24
  Layout below{{testing::Line({0, 0}, {1000, 0}), testing::Line({1300, 200}, {1600, 200})}};
  Layout above{{testing::Line({0, 400}, {1000, 400}), testing::Line({1300, 200}, {1600, 200})}};
  Layout on{{testing::Line({1600, 200}, {3000, 200})}};
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (int trial = 0; trial < 20; ++trial) {
    TrackNetworkState streets({below, above, on}, 2);
    // It is active there already, while the other one is at rest where it would become active.
    const double ahead = 600 + 7.1 * trial, behind = 800 + 7.1 * trial;
    streets.network().roads[0].range_at_end = 1000;
    streets.network().roads[1].range_at_end = ahead - 0.001;
    streets.Put(0, 0, streets.track(0).length - behind, pace, 200);
    streets.Put(1, 1, streets.track(1).length - ahead, pace, 200);
    streets.Send(1, 2, 600);
    EXPECT_TRUE(streets.Run(5)) << trial;
  }
}

// A displaced mover gets a gap that is larger by its displacement; from movers that approach, and at nodes.
TEST(Traffic, KeepsMoreAwayFromWhoIsOffItsPlace) {  // PL-13, PL-24
  const Pace pace = testing::PaceOf(2000, 10000, 200000);
  const std::vector<Layout> layouts{Straight(2000),
                                    {{testing::Line({2000, 0}, {2100, 0}), testing::Line({2500, 300}, {2900, 300})}},
                                    {{testing::Line({2000, 0}, {2100, 0}), testing::Line({2500, -300}, {2900, -300})}}};
  for (const bool at_node : {false, true}) {
    TrackNetworkState streets(layouts, 2);
    streets.Put(0, 0, 100, pace, 200);
    streets.Put(1, at_node ? 1 : 0, at_node ? 40 : 1500, pace, 200).off = 70;
    EXPECT_EQ(streets.TooNear(1), kNobody);
    streets.Send(0, at_node ? 2 : 0, at_node ? 500 : 1900);
    EXPECT_FALSE(streets.Run(5));
    EXPECT_NEAR(streets[0].at.position, (at_node ? 2040 : 1500) - 270, 0.05);
    EXPECT_EQ(streets[0].waits_for, 1U);
    EXPECT_EQ(streets.TooNear(1), kNobody);
    streets[1].off = 71;
    EXPECT_EQ(streets.TooNear(1), 0U);
    streets[1].off = 0;
    streets.Run(2);
    EXPECT_NEAR(streets[0].at.position, (at_node ? 2040 : 1500) - 200, 0.05);
  }
}

TEST(Traffic, FaceToFaceIsADeadlock) {  // PL-26
  TrackNetworkState streets({Straight(3000)}, 3);
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (std::uint32_t i = 0; i < 3; ++i) streets.Put(i, 0, 200 + 1000 * i, pace, 200);
  streets.Send(0, 0, 2900);
  streets.Send(1, 0, 100);
  streets.Run(5);
  EXPECT_NEAR(streets[1].at.position - streets[0].at.position, 200, 0.05);
  EXPECT_TRUE(IsDeadlocked(streets.riders(), 0));
  EXPECT_TRUE(IsDeadlocked(streets.riders(), 1));
  EXPECT_FALSE(IsDeadlocked(streets.riders(), 2));
  streets.Send(1, 0, 900);
  streets.Send(0, 0, 400);
  EXPECT_TRUE(streets.Run(5));
  EXPECT_FALSE(IsDeadlocked(streets.riders(), 0));
}

// Random commands, halts and faults of random movers in random cities: the invariant, by its visible consequences. A
// mover in a deadlock is taken off its track, and joins another one where it may.
class CityProperty : public ::testing::TestWithParam<int> {
 protected:
  static constexpr double kGap = 170;

  void Put(std::uint32_t mover, std::uint32_t track, double s) {
    const Pace pace = testing::PaceOf(random.Between(300, 2000), random.Between(2000, 15000), random.Between(5e4, 4e5),
                                      random.Between(2000, 10000));
    Rider& r = streets.Put(mover, track, s, pace, kGap);
    r.brakes.deceleration *= random.Between(1, 2);
    most[mover] = pace.limits;
  }
  // A command with dynamics and a gap of its own.
  void Send(std::uint32_t mover, std::uint32_t track, double s) {
    if (!streets.Send(mover, track, s)) return;
    const auto share = [&] { return random.Coin() ? 1 : random.Between(0.2, 1); };
    const trajectory::Limits& l = most[mover];
    streets[mover].pace.limits = {share() * l.velocity, share() * l.acceleration, share() * l.deceleration,
                                  share() * l.jerk};
    streets[mover].gap = random.Coin() ? kGap : random.Between(kGap, 1.5 * kGap);
  }
  // Ends of the stretch of a track that is away from all others.
  double from(std::uint32_t track) { return std::max(kGap, streets.network()[track].range_at_start) + 1; }
  double to(std::uint32_t track) {
    return streets.network()[track].length - std::max(kGap, streets.network()[track].range_at_end) - 1;
  }
  // As on a machine: no mover joins a track in use; elsewhere, none may be too near.
  void Join(std::uint32_t mover) {
    const std::uint32_t track = AnyTrack();
    const bool used = std::ranges::any_of(streets.riders(), [&](const Rider& r) {
      const bool goes = r.on && (!Rests(r.at) || (r.aim != Aim::kRest && !r.there));
      return goes && r.route.Contains(track);
    });
    if (used) return;
    Put(mover, track, random.Between(0, streets.network()[track].length));
    const std::uint32_t who = streets.TooNear(mover);
    if (who != kNobody) {
      streets[mover] = {};
      ++refused_joins;
    } else {
      ++joins;
    }
  }
  // Displaces a mover by this distance, if there is room for that.
  void ReserveDisplacement(std::uint32_t mover, double off) {
    Rider& r = streets[mover];
    const double before = r.off;
    r.off = off;
    if (off > before && streets.TooNear(mover) != kNobody) r.off = before;
  }
  std::uint32_t AnyTrack() { return static_cast<std::uint32_t>(random.Below(static_cast<int>(layouts.size()))); }

  int joins = 0, refused_joins = 0;
  testing::Random random{static_cast<unsigned>(GetParam())};
  const std::vector<Layout> layouts = testing::RandomCity(random, 14, 100);
  TrackNetworkState streets{layouts, 50};
  std::vector<trajectory::Limits> most{50};  // by mover
};

TEST_P(CityProperty, NobodyComesTooNear) {  // PL-23, PL-24
  const int cycles = Trials(20000, 30);
  std::uint32_t put = 0;
  std::vector<double> was;  // last position of each
  for (std::uint32_t track = 0; track < layouts.size(); ++track) {
    for (double s = from(track); s < to(track) && put < 50; s += 180 + random.Between(0, 500)) {
      Put(put++, track, s);
      was.push_back(s);
    }
  }
  double missing = -INFINITY, nearest = INFINITY, travelled = 0;
  std::vector<int> down(put);  // until this cycle, after a fault
  Watcher watcher(streets);
  int refused = 0, taken_off = 0;
  for (int i = 0; i < cycles && !HasFailure(); ++i) {
    for (std::uint32_t k = 0; k < put; ++k) {
      Rider& r = streets[k];
      if (!r.on) {
        Join(k);
        was[k] = r.at.position;
        continue;
      }
      travelled += std::abs(r.at.position + r.origin - was[k]);
      was[k] = r.at.position + r.origin;
      if (random.Below(2000) == 0) streets.Halt(k);
      if (random.Below(20000) == 0) {
        streets.Halt(k);
        down[k] = i + random.Below(3000);
      }
      if (random.Below(5000) == 0) ReserveDisplacement(k, random.Between(0, 60));
      if (i < down[k]) continue;
      if (i % 1000 == 0 && IsDeadlocked(streets.riders(), k)) {
        r = {};
        ++taken_off;
      } else if (random.Below(30000) == 0 && Rests(r.at)) {
        r = {};  // it leaves
      } else if (((r.aim == Aim::kRest || r.there) && random.Below(300) == 0) || random.Below(5000) == 0) {
        const std::uint32_t track = AnyTrack();
        Send(k, track, random.Between(0, streets.track(track).length));
      }
    }
    streets.Step();
    refused += static_cast<int>(streets.traffic().refused());
    watcher.Look();
    missing = std::max(missing, streets.Missing(kGap));
    EXPECT_LT(missing, 1e-5) << i;
    if (i % 5 == 0) nearest = std::min(nearest, streets.Nearest());
    EXPECT_GT(nearest, 0) << i;
  }
  EXPECT_GT(travelled, 0.5 * cycles);  // [mm] otherwise the test would prove nothing
  EXPECT_LT(refused, cycles / 5);      // dynamics, gaps and displacements change from one cycle to the next
  EXPECT_LE(watcher.acceleration, 1 + 1e-6);
  EXPECT_LE(watcher.jerk, 1 + 1e-6);
  EXPECT_LE(watcher.speed, 1 + 1e-8);
  EXPECT_LE(watcher.lateral, 1 + 1e-6);
  std::printf(
      "%u movers on %zu tracks, %.0f m: gap kept to %.1e mm, bodies %.1f mm apart, %.1f refusals a second, %d"
      " taken off, %d joined, %d not\n",
      put, layouts.size(), travelled / 1000, std::max(0.0, missing), nearest, 1000.0 * refused / cycles, taken_off,
      joins, refused_joins);
}

// TAKT_SEED: the first seed.
int FirstSeed() {
  const char* seed = std::getenv("TAKT_SEED");
  return seed ? std::atoi(seed) : 0;
}
INSTANTIATE_TEST_SUITE_P(Seeds, CityProperty, ::testing::Range(FirstSeed(), FirstSeed() + Trials(2, 150)),
                         [](const auto& seed) { return std::to_string(seed.param); });

}  // namespace
}  // namespace takt::planar
