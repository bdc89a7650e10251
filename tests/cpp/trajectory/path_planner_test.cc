// Plans along paths: within all limits whatever is requested, compared with known least times.
#include "takt/trajectory/path_planner.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "reference_motions.h"

namespace takt::trajectory {
namespace {

using testing::Between;
using testing::Point;
using testing::Polyline;
using testing::Reference;
using testing::Uniform;

constexpr std::size_t kMost = 1500;  // intervals
constexpr int kPlaces = 23;          // checked within an interval: others than the planner's samples

// The largest share of a limit that a plan uses.
double UseOf(const Reference& reference, const PathPlan& plan) {
  double use = 0;
  std::vector<ReferenceRate> rates(reference.limits.size());
  for (std::size_t k = 0; k < reference.lengths.size(); ++k) {
    for (int i = 0; i <= kPlaces; ++i) {
      const double share = static_cast<double>(i) / kPlaces;
      const ReferenceState at = plan.Within(k, share);
      reference.Rates(k, share, rates);
      for (std::size_t q = 0; q < rates.size(); ++q) {
        const ReferenceRate& r = rates[q];
        const RateLimits& l = reference.limits[q];
        const double v = r.first * at.rate;
        const double a = r.first * at.acceleration + r.second * at.rate * at.rate;
        const double j =
            r.first * at.jerk + 3 * r.second * at.rate * at.acceleration + r.third * at.rate * at.rate * at.rate;
        const double shares[] = {std::abs(v) / l.velocity, a / l.acceleration, -a / l.deceleration,
                                 std::abs(j) / l.jerk};
        for (const double one : shares) use = std::isnan(one) ? INFINITY : std::max(use, one);
      }
    }
  }
  return use;
}

bool IsPlan(PathPlanStatus status) {
  return status == PathPlanStatus::kPlanned || status == PathPlanStatus::kScaled;
}

// Evaluated over time, a plan passes through all of its knots and never moves back.
void ExpectRuns(const Reference& reference, const PathPlan& plan) {
  double reference_s = 0;
  for (std::size_t k = 0; k < reference.lengths.size(); ++k) {
    const ReferenceState at = plan.At(plan.knot_time(k));
    const double scale = reference.lengths[k];
    EXPECT_NEAR(at.time, reference_s, 1e-9 * (1 + scale));
    EXPECT_NEAR(at.rate * at.rate, plan.pace(k).square, 1e-9 * plan.pace(k).square);
    const double before_next = plan.knot_time(k + 1) * (1 - 1e-15);
    reference_s += reference.lengths[k];
    EXPECT_NEAR(plan.At(before_next).time, reference_s, 1e-6 * scale);
    EXPECT_GT(plan.knot_time(k + 1), plan.knot_time(k));
  }
}

Limits RandomLimits(std::mt19937_64& random) {
  const double a = Between(random, 500, 40000);
  return {Between(random, 50, 3000), a, a, a / Between(random, 0.003, 0.1)};
}

// GR-40, GR-41: whatever the polyline, corners rounded as overlaps are within all limits, a plan from rest to rest
// always exists, and it takes no longer than stops at the corners would, but for the share of the limits that a plan
// leaves.
TEST(PathPlanner, KeepsLimitsOnRandomPolylinesAndTakesNoLongerThanStops) {
  std::mt19937_64 random(41);
  PathPlanner planner(kMost, 6);
  PathPlan plan(kMost);
  const int trials = Trials(1000);
  int scaled = 0;
  double worst = 0, sum = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Limits limits = RandomLimits(random);
    const auto points = testing::RandomPoints(random, 179);
    const Polyline polyline(points, Between(random, 0.001, 2), limits, limits.acceleration / limits.jerk / 4);
    if (polyline.lengths.size() > kMost) continue;
    const PathPlanStatus status = planner.Plan(polyline.Request(), plan);
    ASSERT_TRUE(IsPlan(status)) << trial;
    ASSERT_LE(UseOf(polyline, plan), 1 + 1e-6) << trial;
    ExpectRuns(polyline, plan);
    scaled += status == PathPlanStatus::kScaled;
    const double ratio = plan.duration() / polyline.stops_s;
    worst = std::max(worst, ratio);
    sum += ratio;
  }
  std::cout << "beside stopping: mean " << sum / trials << ", worst " << worst << "; scaled " << scaled << "\n";
  EXPECT_LE(worst, 1.03);
  EXPECT_LE(sum / trials, 0.93);
  EXPECT_LE(scaled, trials / 100);
}

// GR-40: the same on smooth courses, from rest and continuing from a plan at any of its knots.
TEST(PathPlanner, KeepsLimitsOnRandomCourses) {
  std::mt19937_64 random(40);
  PathPlanner planner(kMost, 8);
  PathPlan plan(kMost), on(kMost);
  int asked = 0, went_on = 0, planned = 0;
  const int trials = Trials(100, 1000);
  for (int trial = 0; trial < trials; ++trial) {
    const testing::Smooth reference(testing::RandomCourse(random), 60);
    const PathPlanStatus status = planner.Plan(reference.Request(), plan);
    ASSERT_TRUE(IsPlan(status)) << trial;
    planned += status == PathPlanStatus::kPlanned;
    ASSERT_LE(UseOf(reference, plan), 1 + 1e-6) << trial;
    ExpectRuns(reference, plan);
    // From a knot in the first half on.
    const std::size_t knot = std::uniform_int_distribution<std::size_t>(1, reference.lengths.size() / 2)(random);
    struct Rest : Reference {
      const Reference& whole;
      std::size_t from;
      Rest(const Reference& w, std::size_t f) : whole(w), from(f) {
        lengths.assign(w.lengths.begin() + static_cast<std::ptrdiff_t>(f), w.lengths.end());
        limits = w.limits;
      }
      void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const override {
        whole.Rates(interval + from, share, out);
      }
    } rest(reference, knot);
    PathPlanRequest request = rest.Request();
    request.begin = plan.pace(knot);
    const PathPlanStatus again = planner.Plan(request, on);
    ++asked;
    if (again == PathPlanStatus::kNoPlan) continue;  // the present plan continues
    ASSERT_EQ(again, PathPlanStatus::kPlanned);
    ++went_on;
    EXPECT_EQ(on.pace(0).square, request.begin->square);
    EXPECT_EQ(on.pace(0).slope, request.begin->slope);
    ASSERT_LE(UseOf(rest, on), 1 + 1e-6) << trial;
    EXPECT_LE(on.duration(), 1.05 * (plan.duration() - plan.knot_time(knot))) << trial;
  }
  std::cout << "planned " << planned << " of " << trials << ", went on " << went_on << " of " << asked << "\n";
  EXPECT_GE(planned, 95 * trials / 100);
  EXPECT_GE(went_on, 90 * asked / 100);
}

// GR-23, GR-41: compared with the least times of tests/tools/path_optimum.py.
TEST(PathPlanner, TakesLittleLongerThanTheOptimum) {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/data/path_optimum.json");
  PathPlanner planner(kMost, 8);
  PathPlan plan(kMost);
  for (const auto& p : nlohmann::json::parse(file)) {
    testing::Course course;
    course.length = p["length"];
    const auto& along = p["path"];
    course.along = {along["velocity"], along["acceleration"], along["deceleration"], along["jerk"]};
    for (const auto& c : p["coordinates"]) {
      course.limits.of[course.limits.count++] = {c["velocity"], c["acceleration"], c["jerk"]};
      testing::Formula formula{.slope = c["slope"], .waves = {}};
      for (const auto& h : c["harmonics"]) formula.waves.push_back({h[0], h[1], h[2]});
      course.formulas.push_back(formula);
    }
    const std::string name = p["name"];
    const testing::Smooth reference(course, 160);
    ASSERT_LE(reference.lengths.size(), kMost);
    EXPECT_EQ(planner.Plan(reference.Request(), plan), PathPlanStatus::kPlanned) << name;
    EXPECT_LE(UseOf(reference, plan), 1 + 1e-6) << name;
    const double ratio = plan.duration() / p["optimum_s"].get<double>();
    std::cout << name << ": " << ratio << ", " << planner.steps() << " steps\n";
    // Bends within one interval.
    const bool bends = name.starts_with("warped") || name.ends_with("sharp") || name == "burst" || name == "ripple";
    EXPECT_LE(ratio, bends ? 1.2 : 1.03) << name;
    EXPECT_GE(ratio, 0.995) << name;
  }
}

// GR-23: a straight line takes as long as one motion from rest to rest.
TEST(PathPlanner, PlansStraightLinesLikeOneMotion) {
  std::mt19937_64 random(7);
  PathPlanner planner(kMost, 6);
  PathPlan plan(kMost);
  for (int trial = 0; trial < 50; ++trial) {
    const Limits limits = RandomLimits(random);
    const Polyline line({{0, 0, 0}, {Between(random, 1, 500), 0, 0}}, 0.1, limits,
                        limits.acceleration / limits.jerk / 4);
    if (line.lengths.size() > kMost) continue;
    ASSERT_EQ(planner.Plan(line.Request(), plan), PathPlanStatus::kPlanned) << trial;
    EXPECT_GE(plan.duration(), line.stops_s * (1 - 1e-9)) << trial;
    EXPECT_LE(plan.duration(), line.stops_s * 1.012) << trial;
  }
}

TEST(PathPlanner, RejectsWhatIsNoRequestAndLeavesThePlan) {
  const Limits limits{500, 5000, 5000, 100000};
  const Polyline good({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, 0.1, limits, 0.0125);
  PathPlanner planner(200, 6), small(5, 6), flat(200, 2);
  PathPlan plan(200);
  ASSERT_EQ(planner.Plan(good.Request(), plan), PathPlanStatus::kPlanned);
  const double duration = plan.duration();
  EXPECT_EQ(small.Plan(good.Request(), plan), PathPlanStatus::kTooLarge);
  EXPECT_EQ(flat.Plan(good.Request(), plan), PathPlanStatus::kTooLarge);
  Polyline bad = good;
  bad.lengths[2] = 0;
  EXPECT_EQ(planner.Plan(bad.Request(), plan), PathPlanStatus::kInvalid);
  bad = good;
  bad.lengths[1] = NAN;
  EXPECT_EQ(planner.Plan(bad.Request(), plan), PathPlanStatus::kInvalid);
  bad = good;
  bad.limits[3].jerk = 0;
  EXPECT_EQ(planner.Plan(bad.Request(), plan), PathPlanStatus::kInvalid);
  PathPlanRequest request = good.Request();
  request.begin = ReferencePace{NAN, 0};
  EXPECT_EQ(planner.Plan(request, plan), PathPlanStatus::kInvalid);
  request.begin = ReferencePace{1e6, 0};  // far beyond all limits
  EXPECT_EQ(planner.Plan(request, plan), PathPlanStatus::kNoPlan);
  EXPECT_EQ(plan.duration(), duration);
}

TEST(PathPlanner, RepeatsBitForBitAndAllocatesNothing) {
  const Limits limits{500, 5000, 5000, 100000};
  const Polyline stairs({{0, 0, 0}, {25, 0, 0}, {25, 25, 0}, {50, 25, 0}}, 0.05, limits, 0.0125);
  PathPlanner planner(200, 6), other(500, 8);
  PathPlan one(200), two(500);
  const PathPlanRequest request = stairs.Request();
  const long before = AllocationsOfThisThread();
  ASSERT_EQ(planner.Plan(request, one), PathPlanStatus::kPlanned);
  EXPECT_EQ(AllocationsOfThisThread(), before);
  ASSERT_EQ(other.Plan(request, two), PathPlanStatus::kPlanned);
  for (double t = 0; t < one.duration(); t += 0.0007) {
    ASSERT_EQ(one.At(t).time, two.At(t).time);
    ASSERT_EQ(one.At(t).jerk, two.At(t).jerk);
  }
}

// GR-22: the deviation of the curve of an overlap from the corner.
TEST(Overlap, ComesAsNearToTheCornerAsAsked) {
  std::mt19937_64 random(22);
  for (int trial = 0; trial < 500; ++trial) {
    const Limits limits = RandomLimits(random);
    const double deviation = Between(random, 0.001, 2);
    const Polyline polyline(testing::RandomPoints(random, 179), deviation, limits, 1);
    for (std::size_t i = 0; i < polyline.overlaps.size(); ++i) {
      const double overlap = polyline.overlaps[i];
      double nearest = INFINITY;
      for (int k = 0; k <= 200; ++k) {
        const Point p = polyline.FromCorner(i, overlap * k / 200);
        nearest = std::min(nearest, std::hypot(p[0], p[1], p[2]));
      }
      EXPECT_LE(nearest, deviation * (1 + 1e-9));
      const double longest = 0.5 * std::min(polyline.profiles[i].duration(), polyline.profiles[i + 1].duration());
      if (overlap < longest) {
        EXPECT_NEAR(nearest, deviation, 1e-9 * deviation) << trial;
      }
      // In the first phase: d = J T³ / 6, deviation |e2 - e1| d / 8.
      if (overlap < std::min(polyline.profiles[i].piece_ends_s[0], polyline.profiles[i + 1].piece_ends_s[0])) {
        const double d = limits.jerk * overlap * overlap * overlap / 6;
        EXPECT_NEAR(nearest, polyline.Turn(i) * d / 8, 1e-9 * nearest + 1e-12) << trial;
        const Point begin = polyline.FromCorner(i, 0);
        EXPECT_NEAR(std::hypot(begin[0], begin[1], begin[2]), d, 1e-9 * d + 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace takt::trajectory
