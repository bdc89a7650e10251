// PL-72: routes for many movers on the free surface.
#include "takt/routing/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "takt/routing/assignment.h"
#include "takt/routing/random.h"

namespace takt::routing {
namespace {

constexpr Dynamics kDynamics{.velocity = 2000, .acceleration = 10'000, .jerk = 200'000};
constexpr double kPitch = 120, kRoom = 0.1;  // [mm]; kRoom: movers are smaller than planned

SurfaceProblem Empty(int width, int height) {
  return {.width = width,
          .height = height,
          .pitch = kPitch,
          .mover_size = kPitch,
          .dynamics = kDynamics,
          .blocked = std::vector<bool>(static_cast<std::size_t>(width * height), false),
          .effort = 2'000};
}

std::vector<CellIndex> RandomPlaces(const SurfaceProblem& problem, std::size_t count, Random& random) {
  std::vector<CellIndex> places;
  for (CellIndex i = 0; i < problem.width * problem.height; ++i) {
    if (!problem.blocked[static_cast<std::size_t>(i)]) places.push_back(i);
  }
  random.Shuffle(places);
  places.resize(count);
  return places;
}

// --- the checker: rectangles with motions of its own, without places and reservations ---

struct Motion {
  double s = 0, v = 0, a = 0;
};
void Go(Motion& m, double jerk, double t) {
  m.s += t * (m.v + t * (m.a / 2 + t * jerk / 6));
  m.v += t * (m.a + t * jerk / 2);
  m.a += t * jerk;
}
using Pieces = std::vector<std::pair<double, double>>;  // jerk, duration
Motion After(Motion m, const Pieces& pieces, double t) {
  for (const auto& [jerk, duration] : pieces) {
    Go(m, jerk, std::clamp(t, 0.0, duration));
    t -= duration;
  }
  return m;
}
Pieces Whole(double length) {
  const double v = kDynamics.velocity, a = kDynamics.acceleration, j = kDynamics.jerk;
  // By bisection between 0 and the full velocity: the fastest that fits.
  double low = 0, high = v;
  const auto ramp = [&](double to) { return to < a * a / j ? 2 * std::sqrt(to / j) : to / a + a / j; };
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (middle * ramp(middle) <= length ? low : high) = middle;
  }
  const double tj = std::min(a / j, std::sqrt(low / j)), ta = ramp(low) - 2 * tj;
  const double cruise = (length - low * ramp(low)) / low;
  return {{j, tj}, {0, ta}, {-j, tj}, {0, cruise}, {-j, tj}, {0, ta}, {j, tj}};
}
Pieces Braking(const Motion& m) {
  const double a = kDynamics.acceleration, j = kDynamics.jerk;
  const auto down = [&](double from) {
    const double tj = std::min(a / j, std::sqrt(std::max(0.0, from) / j)), ta = tj < a / j ? 0 : from / a - tj;
    return Pieces{{-j, tj}, {0, ta}, {j, tj}};
  };
  const double q = std::abs(m.a) / j;
  if (m.a >= 0) {
    Pieces pieces = down(m.v + m.a * q / 2);
    pieces.insert(pieces.begin(), {-j, q});
    return pieces;
  }
  Pieces pieces = down(m.v + m.a * m.a / (2 * j));  // braking has begun already
  double passed = q;
  for (auto& [jerk, duration] : pieces) {
    const double part = std::min(passed, duration);
    duration -= part;
    passed -= part;
  }
  return pieces;
}
struct Box {
  double from_x, from_y, to_x, to_y;
};
bool Overlap(const Box& a, const Box& b) {
  return a.from_x < b.to_x && b.from_x < a.to_x && a.from_y < b.to_y && b.from_y < a.to_y;
}

class Checker {
 public:
  Checker(const SurfaceProblem& problem, const SurfacePlan& plan) : problem_(problem), plan_(plan) {
    for (const Legs& legs : plan.legs) {
      for (const Leg& leg : legs) {
        end_ = std::max(end_, leg.departure + Total(PiecesOf(leg)));
      }
    }
  }

  // Pairs of movers that overlap at some time, by the area that they sweep between two samples.
  std::set<std::pair<std::size_t, std::size_t>> Overlaps(double step) const {
    std::set<std::pair<std::size_t, std::size_t>> found;
    for (double t = 0; t < end_ + step; t += step) {
      std::vector<Box> boxes;
      for (std::size_t i = 0; i < plan_.legs.size(); ++i) boxes.push_back(Swept(PlaceAt(i, t), PlaceAt(i, t + step)));
      Add(boxes, found);
    }
    return found;
  }
  // The same if all braked together at some time.
  std::set<std::pair<std::size_t, std::size_t>> OverlapsBraking(double step) const {
    std::set<std::pair<std::size_t, std::size_t>> found;
    constexpr double kLongest = 0.3, kLook = 0.01;
    for (double t = 0; t < end_; t += step) {
      for (double braking = 0; braking < kLongest; braking += kLook) {
        std::vector<Box> boxes;
        for (std::size_t i = 0; i < plan_.legs.size(); ++i) {
          boxes.push_back(Swept(PlaceAt(i, t, braking), PlaceAt(i, t, braking)));
        }
        Add(boxes, found);
      }
    }
    return found;
  }
  // The same with the area that each covers from some time on until it rests, if it brakes then: the check of the
  // guard.
  std::set<std::pair<std::size_t, std::size_t>> CoursesOverlap(double step) const {
    std::set<std::pair<std::size_t, std::size_t>> found;
    constexpr double kRests = 10;
    for (double t = 0; t < end_; t += step) {
      std::vector<Box> boxes;
      for (std::size_t i = 0; i < plan_.legs.size(); ++i) boxes.push_back(Swept(PlaceAt(i, t), PlaceAt(i, t, kRests)));
      Add(boxes, found);
    }
    return found;
  }
  // Legs are consecutive, over places that are not blocked, and end at the targets.
  void CheckLegs() const {
    for (std::size_t i = 0; i < plan_.legs.size(); ++i) {
      CellIndex at = problem_.starts[i];
      double since = 0;
      for (const Leg& leg : plan_.legs[i]) {
        EXPECT_EQ(leg.from, at);
        EXPECT_GE(leg.departure, since - 1e-9);
        const auto [dx, dy] = Way(leg);
        EXPECT_TRUE((dx == 0) != (dy == 0));
        const int count = std::abs(dx) + std::abs(dy);
        for (int k = 1; k <= count; ++k) {
          const int x = leg.from % problem_.width + k * dx / count, y = leg.from / problem_.width + k * dy / count;
          EXPECT_FALSE(problem_.blocked[static_cast<std::size_t>(y * problem_.width + x)]);
        }
        at = leg.to;
        since = leg.departure + Total(PiecesOf(leg));
      }
      EXPECT_EQ(at, plan_.targets[i]);
      if (PoolOf(i) == kNone && problem_.targets[i] != kNone) {
        EXPECT_EQ(at, problem_.targets[i]);
      }
    }
    for (std::size_t i = 0; i < plan_.targets.size(); ++i) {  // each is the end of a mover of its pool
      if (problem_.targets[i] == kNone) continue;
      const auto there = std::find(plan_.targets.begin(), plan_.targets.end(), problem_.targets[i]);
      ASSERT_NE(there, plan_.targets.end());
      EXPECT_EQ(PoolOf(static_cast<std::size_t>(there - plan_.targets.begin())), PoolOf(i));
    }
  }
  double Sum() const {
    double sum = 0;
    for (const Legs& legs : plan_.legs) {
      if (!legs.empty()) sum += legs.back().departure + Total(PiecesOf(legs.back()));
    }
    return sum;
  }

 private:
  using Point = std::array<double, 2>;
  PoolIndex PoolOf(std::size_t i) const { return problem_.pools.empty() ? kNone : problem_.pools[i]; }
  static double Total(const Pieces& pieces) {
    return std::accumulate(pieces.begin(), pieces.end(), 0.0, [](double sum, const auto& p) { return sum + p.second; });
  }
  std::pair<int, int> Way(const Leg& leg) const {
    const int width = problem_.width;
    return {leg.to % width - leg.from % width, leg.to / width - leg.from / width};
  }
  const Pieces& PiecesOf(const Leg& leg) const {
    const auto [dx, dy] = Way(leg);
    const auto count = static_cast<std::size_t>(std::abs(dx) + std::abs(dy));
    if (pieces_.size() <= count) pieces_.resize(count + 1);
    if (pieces_[count].empty()) pieces_[count] = Whole(kPitch * static_cast<double>(count));
    return pieces_[count];
  }
  // Returns its centre at t, or after braking from t on for the given time.
  Point PlaceAt(std::size_t mover, double t, double braking = 0) const {
    CellIndex at = problem_.starts[mover];
    const auto point = [&](CellIndex place) {
      return Point{kPitch * (place % problem_.width), kPitch * (place / problem_.width)};
    };
    for (const Leg& leg : plan_.legs[mover]) {
      if (t < leg.departure) break;
      const Pieces& pieces = PiecesOf(leg);
      at = leg.to;
      if (t - leg.departure >= Total(pieces)) continue;
      Motion motion = After({}, pieces, t - leg.departure);
      if (braking > 0) motion = After(motion, Braking(motion), braking);
      const auto [dx, dy] = Way(leg);
      const double length = kPitch * (std::abs(dx) + std::abs(dy));
      const Point from = point(leg.from);
      return {from[0] + kPitch * dx * motion.s / length, from[1] + kPitch * dy * motion.s / length};
    }
    return point(at);
  }
  Box Swept(const Point& a, const Point& b) const {
    const double half = (problem_.mover_size - kRoom) / 2;
    return {std::min(a[0], b[0]) - half, std::min(a[1], b[1]) - half, std::max(a[0], b[0]) + half,
            std::max(a[1], b[1]) + half};
  }
  static void Add(const std::vector<Box>& boxes, std::set<std::pair<std::size_t, std::size_t>>& found) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (Overlap(boxes[i], boxes[k])) found.emplace(k, i);
      }
    }
  }

  const SurfaceProblem& problem_;
  const SurfacePlan& plan_;
  mutable std::vector<Pieces> pieces_;
  double end_ = 0;
};

SurfacePlan PlanAndCheck(const SurfaceProblem& problem) {
  SurfacePlan plan = PlanSurface(problem);
  EXPECT_EQ(plan.outcome, Outcome::kPlanned);
  if (plan.outcome != Outcome::kPlanned) return plan;
  const Checker checker(problem, plan);
  checker.CheckLegs();
  EXPECT_TRUE(checker.Overlaps(0.0005).empty());
  EXPECT_TRUE(checker.OverlapsBraking(0.023).empty());
  EXPECT_TRUE(checker.CoursesOverlap(0.0011).empty());
  EXPECT_NEAR(checker.Sum(), plan.sum, 1e-6);
  EXPECT_LE(plan.sum, plan.first_sum + 1e-9);
  if (std::find(problem.targets.begin(), problem.targets.end(), kNone) == problem.targets.end()) {
    EXPECT_GE(plan.sum, plan.lower_bound - 1e-9);
  }
  return plan;
}

// Executes the visits one by one, in an order that only they determine: all have to be completed.
bool CanBeCarriedOut(const SurfacePlan& plan) {
  std::vector<std::size_t> at(plan.visits.size(), 0);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = at.size(); i-- > 0;) {
      while (at[i] + 1 < plan.visits[i].size()) {
        const Visit& next = plan.visits[i][at[i] + 1];
        const bool left = next.before == kNone || next.before == static_cast<MoverIndex>(i) ||
                          at[static_cast<std::size_t>(next.before)] > static_cast<std::size_t>(next.before_index);
        if (!left) break;
        ++at[i];
        again = true;
      }
    }
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] + 1 < plan.visits[i].size()) return false;
  }
  return true;
}

TEST(Surface, OneMoverGoesAsQuicklyAsItCan) {
  SurfaceProblem problem = Empty(5, 4);
  problem.starts = {0};
  problem.targets = {19};
  const SurfacePlan plan = PlanAndCheck(problem);
  EXPECT_NEAR(plan.sum, StraightRun(4 * kPitch, kDynamics).duration() + StraightRun(3 * kPitch, kDynamics).duration(),
              1e-9);
  EXPECT_NEAR(plan.sum, plan.lower_bound, 1e-9);
  EXPECT_EQ(plan.legs[0].size(), 2U);
}

TEST(Surface, TwoMoversChangePlacesInARowWithOneSiding) {
  // . . . .
  // # o # #
  SurfaceProblem problem = Empty(4, 2);
  problem.blocked = {false, false, false, false, true, false, true, true};
  problem.starts = {0, 3};
  problem.targets = {3, 0};
  EXPECT_TRUE(CanBeCarriedOut(PlanAndCheck(problem)));
  // Without the siding there is no solution, and the plan says so.
  problem.blocked[5] = true;
  EXPECT_EQ(PlanSurface(problem).outcome, Outcome::kImpossible);
}

TEST(Surface, RandomWorldsAreSafeAndCanBeCarriedOut) {
  Random random(7);
  for (int trial = 0; trial < 12; ++trial) {
    const int width = 4 + static_cast<int>(random.Below(5)), height = 4 + static_cast<int>(random.Below(5));
    SurfaceProblem problem = Empty(width, height);
    problem.seed = random.Next();
    if (trial % 2 == 1) problem.mover_size = 40 + static_cast<double>(random.Below(80));
    if (trial % 3 == 0) {  // holes, with free borders, so that the surface stays connected
      for (int y = 1; y + 1 < height; y += 2) {
        for (int x = 1; x + 1 < width; ++x)
          problem.blocked[static_cast<std::size_t>(y * width + x)] = random.Below(3) == 0;
      }
    }
    const std::size_t room = static_cast<std::size_t>(width * height) / 2, count = 2 + random.Below(room - 2);
    problem.starts = RandomPlaces(problem, count, random);
    problem.targets = RandomPlaces(problem, count, random);
    if (trial % 4 == 1) {
      for (std::size_t i = 0; i < count; i += 3) problem.targets[i] = kNone;  // may be moved aside
    }
    if (trial % 4 == 2) problem.pools.assign(count, 0);
    if (trial % 4 == 3) {  // two pools, and movers with targets of their own
      for (std::size_t i = 0; i < count; ++i) problem.pools.push_back(static_cast<PoolIndex>(i % 3) - 1);
    }
    EXPECT_TRUE(CanBeCarriedOut(PlanAndCheck(problem))) << trial;
  }
}

TEST(Surface, ThreeQuartersFilled) {
  Random random(3);
  SurfaceProblem problem = Empty(6, 6);
  problem.starts = RandomPlaces(problem, 27, random);
  problem.targets = RandomPlaces(problem, 27, random);
  EXPECT_TRUE(CanBeCarriedOut(PlanAndCheck(problem)));
}

TEST(Surface, CrowdedPlacesAreMuchQuickerThanAtFirst) {
  Random random(13);
  SurfaceProblem problem = Empty(7, 7);
  problem.starts = RandomPlaces(problem, 36, random);
  problem.targets = RandomPlaces(problem, 36, random);
  problem.effort = 60'000;
  const SurfacePlan plan = PlanAndCheck(problem);
  EXPECT_TRUE(CanBeCarriedOut(plan));
  EXPECT_LT(plan.sum, 0.6 * plan.first_sum);  // 0.79 without better steps
}

TEST(Surface, InterchangeableTargetsComeNearTheBestAssignment) {
  Random random(5);
  SurfaceProblem problem = Empty(6, 6);
  problem.pools.assign(12, 0);
  problem.starts = RandomPlaces(problem, 12, random);
  problem.targets = RandomPlaces(problem, 12, random);
  const SurfacePlan plan = PlanAndCheck(problem);
  EXPECT_LT(plan.sum, 1.36 * plan.lower_bound);
  // Fewer targets than movers: the remaining movers stay, or make room.
  std::fill(problem.targets.begin() + 5, problem.targets.end(), kNone);
  PlanAndCheck(problem);
}

TEST(Surface, TheCheckerSeesWhatIsWrong) {
  SurfaceProblem problem = Empty(4, 10);
  problem.starts = {36, 4};  // down the first column; out of its path
  problem.targets = {0, 7};
  SurfacePlan plan = PlanAndCheck(problem);
  plan.legs[0] = {{0, 36, 0}};
  // The other mover clears the path later and later: at first nothing is wrong, then only if both brake, then in any
  // case.
  int good = 0, only_braking = 0, wrong = 0;
  for (double later = 0; later < 0.8; later += 0.02) {
    plan.legs[1] = {{later, 4, 7}};
    const Checker checker(problem, plan);
    const bool overlap = !checker.Overlaps(0.0005).empty(), braking = !checker.OverlapsBraking(0.005).empty();
    if (overlap) {
      ++wrong;
    } else {
      ++(braking ? only_braking : good);
    }
  }
  EXPECT_GT(good, 3);
  EXPECT_GT(only_braking, 1);
  EXPECT_GT(wrong, 3);
}

TEST(Surface, SmallMoversGetIntoEachOthersPlacesEarlier) {
  Random random(11);
  SurfaceProblem problem = Empty(6, 6);
  problem.starts = RandomPlaces(problem, 16, random);
  problem.targets = RandomPlaces(problem, 16, random);
  const double large = PlanAndCheck(problem).sum;
  problem.mover_size = kPitch / 2;
  EXPECT_LT(PlanAndCheck(problem).sum, 0.95 * large);
}

TEST(Surface, TheSameBitsEachTime) {
  Random random(9);
  SurfaceProblem problem = Empty(6, 6);
  problem.starts = RandomPlaces(problem, 12, random);
  problem.targets = RandomPlaces(problem, 12, random);
  const SurfacePlan one = PlanSurface(problem), two = PlanSurface(problem);
  ASSERT_EQ(one.legs.size(), two.legs.size());
  EXPECT_EQ(one.sum, two.sum);
  for (std::size_t i = 0; i < one.legs.size(); ++i) {
    ASSERT_EQ(one.legs[i].size(), two.legs[i].size());
    for (std::size_t k = 0; k < one.legs[i].size(); ++k) {
      EXPECT_EQ(one.legs[i][k].departure, two.legs[i][k].departure);
      EXPECT_EQ(one.legs[i][k].to, two.legs[i][k].to);
    }
  }
}

TEST(Surface, NamesAMoverThatCannotGetThere) {
  SurfaceProblem problem = Empty(3, 1);
  problem.blocked[1] = true;
  problem.starts = {0};
  problem.targets = {2};
  const SurfacePlan plan = PlanSurface(problem);
  EXPECT_EQ(plan.outcome, Outcome::kUnreachable);
  EXPECT_EQ(plan.unreachable, 0);
  problem.pools = {0};
  EXPECT_EQ(PlanSurface(problem).outcome, Outcome::kUnreachable);
  EXPECT_EQ(PlanSurface(Empty(2, 2)).outcome, Outcome::kPlanned);  // no mover
}

}  // namespace
}  // namespace takt::routing
