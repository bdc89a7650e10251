// Motion along paths compared with the least possible time, and within all limits all the time.
#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "path_courses.h"
#include "takt/trajectory/path_timing.h"

namespace takt::trajectory {
namespace {

using testing::Between;
using testing::Course;
using testing::kPeriod;
using testing::Motion;
using testing::Uniform;
using testing::Worst;

constexpr double kFast = 1e9;  // as fast as the limits allow

struct Known {
  Course course;
  double optimum_s = 0;
};

// The problems of tests/tools/path_problems.py with their least times.
std::vector<Known> KnownOnes() {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/data/path_optimum.json");
  std::vector<Known> all;
  for (const auto& p : nlohmann::json::parse(file)) {
    Known known;
    known.optimum_s = p["optimum_s"];
    known.course.name = p["name"];
    known.course.length = p["length"];
    const auto& along = p["path"];
    known.course.along = {along["velocity"], along["acceleration"], along["deceleration"], along["jerk"]};
    for (const auto& c : p["coordinates"]) {
      const std::size_t k = known.course.limits.count++;
      known.course.limits.of[k] = {c["velocity"], c["acceleration"], c["jerk"]};
      testing::Formula formula{.slope = c["slope"], .waves = {}};
      for (const auto& h : c["harmonics"]) formula.waves.push_back({h[0], h[1], h[2]});
      known.course.formulas.push_back(formula);
    }
    all.push_back(known);
  }
  return all;
}

// Largest excess of a coordinate over its limits: at full speed, which is rehearsed, only what the rounds of the
// rehearsal leave; where the motion is braked or released in bends, more.
struct Most {
  double velocity, acceleration, jerk;
};
constexpr Most kRehearsed{1.05, 1.005, 1.1};
constexpr Most kAnyhow{1.05, 1.05, 1.25};

void ExpectWithinLimits(const Worst& w, const Most& most, const std::string& what) {
  EXPECT_LE(w.velocity, most.velocity) << what;
  EXPECT_LE(w.acceleration, most.acceleration) << what;
  EXPECT_LE(w.jerk, most.jerk) << what;
  EXPECT_LE(w.along_velocity, 1 + 1e-9) << what;
  EXPECT_LE(w.along_acceleration, 1 + 1e-9) << what;
  EXPECT_LE(w.along_jerk, 1.01) << what;
  EXPECT_LE(w.step, 1e-3) << what;
}

// Largest ratio to the least time. Paths limited by jerk nearly everywhere (T would have to change along the path) or
// with bends within a fraction of T are not typical of drives: known, and bounded here.
double MostRatio(const std::string& name) {
  const auto is = [&](const char* kind) { return name.starts_with(kind); };
  if (is("warped jerk")) return 2.0;
  if (is("warped acceleration")) return 1.7;
  if (is("winding jerk")) return 1.6;
  if (is("ripple") || is("burst") || is("zigzag rounded")) return 1.3;
  if (is("circle twice")) return 1.13;
  if (is("circle")) return 1.1;
  return 1.07;
}

// GR-23: within a few percent of the least time, found by a tool of tests that knows the path as a formula.
TEST(PathTiming, ComesNearTheLeastTime) {
  Worst worst;
  for (const Known& known : KnownOnes()) {
    Motion motion(known.course);
    motion.Plan();
    ASSERT_TRUE(motion.ToRest(kFast)) << known.course.name;
    EXPECT_EQ(motion.pace.now.position, known.course.length) << known.course.name;
    const double ratio = motion.cycles * kPeriod / known.optimum_s;
    const Worst& w = motion.worst;
    std::cout << std::left << std::setw(32) << known.course.name << std::right << std::fixed << std::setprecision(3)
              << ratio << "   T " << motion.window.build_up_s() << " s, used of limits: velocity " << w.velocity
              << ", acceleration " << w.acceleration << ", jerk " << w.jerk << ", along the way " << w.along_velocity
              << ", " << w.along_acceleration << ", " << w.along_jerk << "\n";
    EXPECT_LE(ratio, MostRatio(known.course.name)) << known.course.name;
    EXPECT_GE(ratio, 0.99) << known.course.name;
    ExpectWithinLimits(w, kRehearsed, known.course.name);
    worst.Take(w);
  }
  RecordProperty("worst_jerk", std::to_string(worst.jerk));
}

// GR-23: straight on, from rest to rest, with three phases of build-up, or with those of constant acceleration and
// speed: t = L / v + v / a + a / j.
TEST(PathTiming, GoesStraightInSevenPhases) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    Course course;
    const double a = Between(random, 1000, 20000);
    const double build_up = std::round(Between(random, 5, 60)) * kPeriod;
    const double v = a * (build_up + Between(random, 0.02, 0.3));
    course.along = {v, a, a, a / build_up};
    const double cruise = Between(random, 0.01, 1);
    course.length = v * (v / a + build_up + cruise);
    Motion motion(course);
    motion.Plan();
    ASSERT_TRUE(motion.ToRest(kFast));
    const double least = course.length / v + v / a + build_up;
    EXPECT_GE(motion.cycles * kPeriod, least - 1e-9);
    // 1 % of the deceleration is for stopping exactly
    EXPECT_LE(motion.cycles * kPeriod, least + 3 * kPeriod + 0.01 * v / a);
    EXPECT_EQ(motion.pace.now.position, course.length);
    ExpectWithinLimits(motion.worst, kRehearsed, std::to_string(i));
  }
}

// GR-23: a straight line, however short and wherever its nodes are: accelerations change no faster than allowed within
// a cycle either, where the raw motion's changes at a node.
TEST(PathTiming, KeepsTheJerkOnLines) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    Course course;
    const double a = Between(random, 5000, 40000);
    course.along = {Between(random, 200, 3000), a, a, a / Between(random, 0.005, 0.05)};
    course.length = Between(random, 1, 400);
    Motion motion(course);
    motion.FindBuildUp(course.length);
    motion.SampleBegin();
    const double part = course.length / Between(random, 1, 20);
    while (motion.sampled_to < course.length) {
      const double end = motion.sampled_to + Uniform(random, 0.5, 1.5) * part;
      motion.SampleNext(std::min(end, course.length), end >= course.length);
    }
    motion.Know();
    BeginAt(motion.window, motion.window.begin(), kPeriod, motion.pace);
    ASSERT_TRUE(motion.ToRest(kFast));
    EXPECT_EQ(motion.pace.now.position, course.length);
    EXPECT_LE(motion.worst.along_jerk, 1 + 1e-6) << i;
  }
}

// GR-23: whatever the path, and whatever speed is wanted in any cycle: within the limits, never backwards, to rest at
// its end.
TEST(PathTiming, KeepsLimitsWhateverIsWanted) {
  Worst full, changing;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    const Course course = testing::RandomCourse(random);
    Motion fast(course);
    fast.Plan();
    ASSERT_TRUE(fast.ToRest(kFast)) << seed;
    EXPECT_EQ(fast.pace.now.position, course.length) << seed;
    ExpectWithinLimits(fast.worst, kRehearsed, std::to_string(seed));
    full.Take(fast.worst);

    Motion motion(course);
    motion.Plan();
    double wish = kFast;
    for (int i = 0; i < 3000 && !(motion.pace.raw_stands && Stands(motion.pace)); ++i) {
      if (random() % 40 == 0) wish = random() % 3 ? Uniform(random, 0, course.along.velocity) : 0;
      motion.Cycle(wish);
    }
    ASSERT_TRUE(motion.ToRest(kFast)) << seed;
    EXPECT_EQ(motion.pace.now.position, course.length) << seed;
    ExpectWithinLimits(motion.worst, kAnyhow, "changing " + std::to_string(seed));
    changing.Take(motion.worst);
  }
  for (const auto& [what, w] : {std::pair{"at full speed", full}, std::pair{"wishes changing", changing}}) {
    std::cout << "worst of 300 random paths, " << what << ": velocity " << w.velocity << ", acceleration "
              << w.acceleration << ", jerk " << w.jerk << ", along the way " << w.along_velocity << ", "
              << w.along_acceleration << ", " << w.along_jerk << ", step " << w.step << " mm\n";
  }
}

// GR-23: at full speed nearly every path keeps the limits of all coordinates in every cycle.
TEST(PathTiming, KeepsLimitsOfCoordinates) {
  int within = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    const Course course = testing::RandomCourse(random);
    Motion motion(course);
    motion.Plan();
    ASSERT_TRUE(motion.ToRest(kFast)) << seed;
    if (motion.worst.acceleration <= 1.005 && motion.worst.jerk <= 1.005) ++within;
  }
  EXPECT_GE(within, 275);
}

// GR-23: with a wanted speed of 0 it comes to rest on the path, from any state, and soon: after T, and the time that
// the speed takes with the allowed deceleration.
TEST(PathTiming, ComesToRestFromAnywhere) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    const Course course = testing::RandomCourse(random);
    Motion motion(course);
    motion.Plan();
    for (auto n = random() % 400; n > 0 && !motion.pace.raw_stands; --n) motion.Cycle(kFast);
    ASSERT_TRUE(motion.ToRest(0)) << seed;
    EXPECT_LE(motion.pace.now.position, course.length);
    ExpectWithinLimits(motion.worst, kAnyhow, std::to_string(seed));
    const double there = motion.pace.now.position;
    for (int i = 0; i < 10; ++i) motion.Cycle(0);
    EXPECT_EQ(motion.pace.now.position, there);
    ASSERT_TRUE(motion.ToRest(kFast)) << seed;  // and continues
    EXPECT_EQ(motion.pace.now.position, course.length) << seed;
  }
}

// GR-40: a path whose end changes in every cycle, as where chords are joined one after another, is travelled without a
// stop: plans that do not reach that end are kept. It is too long for one plan.
TEST(PathTiming, KeepsPlansThatEndBeforeAChange) {
  Course course;
  course.length = 700;
  course.along = {300, 15000, 15000, 2e6};
  course.limits.count = 1;
  course.limits.of[0] = {2000, 15000, 2e6};
  course.formulas.push_back({.slope = 0.5, .waves = {{0.5, 0.2, 0}, {0.05, 1.3, 1}}});
  Motion motion(course);
  motion.Plan();
  PathTiming timing(kPeriod);
  timing.Begin(motion.pace);
  int cycles = 0, stops = 0, ends = 0;
  double before = 0, slowest = 1e9;
  for (; motion.pace.now.position < course.length && cycles < 20000; ++cycles) {
    timing.Advance(motion.window, 1, motion.pace);
    if (motion.pace.now.position < course.length / 2) {
      ASSERT_TRUE(timing.StopBefore(motion.window, course.length - 1e-3, motion.pace)) << cycles;
    }
    timing.Ask(motion.window, 1, motion.pace);
    if (const auto number = timing.MakePlan()) timing.TakePlan(*number);
    if (timing.rest_place() != before) ++ends;
    before = timing.rest_place();
    const double s = motion.pace.now.position;
    if (s > 10 && s < course.length - 10) {
      slowest = std::min(slowest, motion.pace.now.velocity);
      stops += motion.pace.now.velocity == 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(motion.pace.now.position, course.length);
  EXPECT_GE(ends, 3) << "one plan is enough: this says nothing";
  EXPECT_EQ(stops, 0);
  EXPECT_GT(slowest, 50);
}

// GR-40: where plans reach only a short distance, since the path winds, each is used for a share of its time: plans
// cost processor time.
TEST(PathTiming, MakesFewPlans) {
  Course course;
  course.length = 600;
  course.along = {300, 8000, 8000, 4e5};
  course.limits.count = 1;
  course.limits.of[0] = {2000, 8000, 4e5};
  course.formulas.push_back({.slope = 0.5, .waves = {{0.4, 1.0, 0}, {0.12, 3.1, 1}}});
  Motion motion(course);
  motion.Plan();
  PathTiming timing(kPeriod);
  timing.Begin(motion.pace);
  int cycles = 0, plans = 0;
  for (; motion.pace.now.position < course.length && cycles < 20000; ++cycles) {
    timing.Advance(motion.window, 1, motion.pace);
    timing.Ask(motion.window, 1, motion.pace);
    if (const auto number = timing.MakePlan()) {
      timing.TakePlan(*number);
      ++plans;
    }
  }
  EXPECT_EQ(motion.pace.now.position, course.length);
  EXPECT_GE(plans, 10) << "one plan is enough: this says nothing";
  EXPECT_LE(plans, 3 + 16 * cycles * kPeriod);
}

}  // namespace
}  // namespace takt::trajectory
