// PL-81: courses of movers until they rest, and the search for near ones among many.
#include "takt/planar/guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../core/trials.h"
#include "takt/planar/clearance.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Line;
using testing::Make;
using testing::Random;
using testing::RandomTrack;

Area BodyAt(const Place& place, double width, double height, double c) {
  return {.places = {place}, .count = 1, .least_c = c, .most_c = c, .mover = {width, height}, .margin = 0};
}

// A network of only this track, and a mover on it.
struct Alone {
  explicit Alone(Track of) : track(std::move(of)) {
    network.roads.resize(1);
    network.roads[0].track = &track;
    network.roads[0].length = track.length;
    network.roads[0].closed = track.closed;
    rider.on = true;
    rider.route.count = 1;
    rider.brakes = {5000, 100'000};
  }
  Track track;
  Network network;
  Rider rider;
};

// Every position of the stretch is in the course, and the course is no larger than specified.
TEST(CourseProperty, CoversItsStretch) {
  Random random(3);
  for (int i = 0; i < Trials(200); ++i) {
    Alone alone(RandomTrack(random));
    const double length = alone.track.length;
    const double from = random.Between(0, length), to = std::min(length, from + random.Between(0, 300));
    const Area point{.places = {}, .count = 0};
    const Course course = CourseOn(alone.network, alone.rider, from, to, point);
    ASSERT_GT(course.count, 0u);
    for (double s = from; s <= to; s += std::max(0.01, (to - from) / 50)) {
      const Area at{.places = {At(alone.track, s).place}, .count = 1};
      bool covered = false;
      for (const Area& area : course.all()) covered = covered || Near(at, area, 1e-6);
      EXPECT_TRUE(covered) << "trial " << i << " at " << s << " of " << from << " to " << to;
      EXPECT_FALSE(Apart(ExtentOf(at), course.extent, 1e-6));
    }
  }
}

// The grid finds the same as a search through all, after any insertions, removals and moves.
TEST(GuardProperty, FindsTheFirstInTheWay) {
  Random random(5);
  constexpr std::uint32_t kCount = 60;
  Guard guard(kCount);
  struct Known {
    bool here = false, there = false;
    std::uint32_t system = 0, system_there = 0;
    Course course, course_there;
  };
  std::vector<Known> known(kCount);
  const auto course = [&] {
    Course out;
    const double reach = random.Below(20) == 0 ? 6000 : 400;
    const Place place{random.Between(-4000, 4000), random.Between(-4000, 4000)};
    for (int n = random.Below(5); n >= 0; --n) {
      Area area = BodyAt(place, random.Between(50, 300), random.Between(50, 300), random.Between(-180, 180));
      area.places[1] = {place.x + random.Between(-reach, reach), place.y + random.Between(-reach, reach)};
      area.count = 2;
      Add(area, out);
    }
    return out;
  };
  const auto overlap = [](const Course& a, const Course& b) {
    for (const Area& one : a.all()) {
      for (const Area& other : b.all()) {
        if (Near(one, other, -kSame)) return true;
      }
    }
    return false;
  };
  int found = 0;
  for (int i = 0; i < Trials(20'000); ++i) {
    const auto mover = static_cast<std::uint32_t>(random.Below(kCount));
    Known& one = known[mover];
    const auto system = static_cast<std::uint32_t>(random.Below(2));
    switch (random.Below(4)) {
      case 0:
        guard.figure(mover).body = random.Below(3) == 0 ? static_cast<std::uint32_t>(1 + random.Below(5)) : 0;
        guard.figure(mover).system = one.system = system;
        one.here = true;
        one.course = course();
        guard.Put(mover, one.course);
        break;
      case 1:
        one.there = random.Coin();
        one.system_there = system;
        one.course_there = course();
        one.there ? guard.PutThere(mover, system, one.course_there) : guard.ClearThere(mover);
        break;
      default: {
        const Course asked = course();
        std::uint32_t expected = kNobody;
        for (std::uint32_t k = 0; k < kCount && expected == kNobody; ++k) {
          const std::uint32_t body = guard.figure(k).body;
          if (k == mover || (body != 0 && body == guard.figure(mover).body)) continue;
          const bool here = known[k].here && known[k].system == system && overlap(asked, known[k].course);
          const bool there = known[k].there && known[k].system_there == system && overlap(asked, known[k].course_there);
          if (here || there) expected = k;
        }
        EXPECT_EQ(guard.Find(mover, system, asked), expected) << i;
        found += expected != kNobody ? 1 : 0;
      }
    }
  }
  EXPECT_GT(found, Trials(500));
}

// Two movers that brake one behind the other: if they are reported to stay apart, they do at all times, at their
// angles.
TEST(CourseProperty, KnowsWhatIsApart) {
  Random random(7);
  int by_order = 0, in_time = 0, overlaps = 0;
  for (int i = 0; i < Trials(3000); ++i) {
    Alone alone(RandomTrack(random));
    const double gap = random.Between(60, 300);
    if (alone.track.length < gap + 400) continue;
    const double at = random.Between(0, alone.track.length - gap - 400);
    const auto start = [&](double place) {
      return KinematicState{place, random.Between(0, 1000), random.Between(-2000, 2000)};
    };
    const Braking behind = Brake(start(at), alone.rider.brakes), ahead = Brake(start(at + gap), alone.rider.brakes);
    if (behind.lowest < 0 || ahead.highest > alone.track.length || LeastDistance(behind, ahead, 0) <= 0) continue;
    Area own = BodyAt({}, random.Between(50, 200), random.Between(50, 200), random.Between(-45, 45));
    Area its = BodyAt({}, random.Between(50, 200), random.Between(50, 200), random.Between(-45, 45));
    own.count = its.count = 0;
    if (random.Below(4) == 0) its.most_c += random.Between(0, 20);
    const bool ordered = ApartByOrder(alone.network, alone.rider, behind, own, ahead, its, 0);
    const bool timed = ApartInTime(alone.network, {alone.rider, behind, own}, {alone.rider, ahead, its}, 0.001);
    double least = INFINITY;
    for (double t = 0; t <= std::max(behind.ends_s.back(), ahead.ends_s.back()) + 0.001; t += 0.001) {
      for (const double c : {its.least_c, its.most_c}) {
        TrackPoint one = At(alone.track, behind.At(t).position), other = At(alone.track, ahead.At(t).position);
        one.direction = own.least_c * M_PI / 180;
        other.direction = c * M_PI / 180;
        least = std::min(least, Separation(one, own.mover, other, its.mover));
      }
    }
    by_order += ordered ? 1 : 0;
    in_time += timed ? 1 : 0;
    overlaps += least < -1e-4 ? 1 : 0;
    if (ordered || timed) {
      EXPECT_GT(least, -1e-4) << "trial " << i << ": " << ordered << ", " << timed;
    }
  }
  EXPECT_GT(by_order, Trials(20));
  EXPECT_GT(in_time, Trials(20));
  EXPECT_GT(overlaps, Trials(5));
}

// On a straight line squares aligned with it need no more than their side, rotated ones the extent of their corners.
TEST(Course, TakesTheGapOfAStraightLine) {
  Alone alone(Make({.elements = {Line({0, 0}, {1000, 0})}}));
  const auto apart = [&](double gap, double c) {
    const Area kind{.places = {}, .count = 0, .least_c = c, .most_c = c, .mover = {113, 113}};
    const Braking behind = Brake({100, 0, 0}, alone.rider.brakes), ahead = Brake({100 + gap, 0, 0}, alone.rider.brakes);
    return ApartByOrder(alone.network, alone.rider, behind, kind, ahead, kind, 0);
  };
  EXPECT_TRUE(apart(113, 0));
  EXPECT_FALSE(apart(112.999, 0));
  EXPECT_TRUE(apart(113 / std::cos(0.2) + 1e-6, 0.2 * 180 / M_PI));
  EXPECT_FALSE(apart(113 / std::cos(0.2) - 1e-3, 0.2 * 180 / M_PI));
  EXPECT_TRUE(apart(113 * M_SQRT2 + 1e-6, 45));
}

}  // namespace
}  // namespace takt::planar
