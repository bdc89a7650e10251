// PL-72: steps for many movers, found by repair.
#include "takt/routing/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <set>

#include "takt/routing/compose.h"

namespace takt::routing {
namespace {

constexpr Dynamics kOfSquares{.velocity = 2000, .acceleration = 10'000, .jerk = 200'000};

struct World {
  int width, height;
  std::vector<bool> blocked;
  Task task{};
  std::vector<std::int32_t> pools{};
};

World AnyWorld(Random& random, int trial) {
  const int width = 3 + static_cast<int>(random.Below(6)), height = 3 + static_cast<int>(random.Below(6));
  World world{.width = width, .height = height, .blocked = std::vector<bool>(static_cast<std::size_t>(width * height))};
  if (trial % 2 == 1) {  // holes, with free borders, so that the surface stays connected
    for (int y = 1; y + 1 < height; y += 2) {
      for (int x = 1; x + 1 < width; ++x) world.blocked[static_cast<std::size_t>(y * width + x)] = random.Below(3) == 0;
    }
  }
  std::vector<CellIndex> places;
  for (CellIndex i = 0; i < width * height; ++i) {
    if (!world.blocked[static_cast<std::size_t>(i)]) places.push_back(i);
  }
  const std::size_t count = 1 + random.Below(places.size() * 7 / 10);
  const auto draw = [&] {
    random.Shuffle(places);
    return Configuration(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count));
  };
  world.task = {.starts = draw(), .targets = draw()};
  if (trial % 3 == 1) {
    for (std::size_t i = 0; i < count; i += 3) world.task.targets[i] = kNone;
  }
  if (trial % 3 == 2) {
    for (std::size_t i = 0; i < count; ++i) world.pools.push_back(static_cast<std::int32_t>(i % 3) - 1);
  }
  return world;
}

// Returns what is wrong with the steps; empty: nothing. Knows places only as columns and rows.
std::string Fault(const World& world, const std::vector<Configuration>& steps) {
  const std::size_t count = world.task.starts.size();
  if (steps.empty() || steps.front() != world.task.starts) return "begins elsewhere";
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (std::set<CellIndex>(steps[k].begin(), steps[k].end()).size() != count) return "two at one place";
    for (const CellIndex place : steps[k]) {
      if (world.blocked[static_cast<std::size_t>(place)]) return "at a place that is blocked";
    }
    if (k == 0) continue;
    // Movers move one after the other, each as soon as the place that it enters is empty: all have to get there.
    Configuration now = steps[k - 1];
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = 0; i < count; ++i) {
        const CellIndex to = steps[k][i];
        if (now[i] == to) continue;
        const int columns = std::abs(now[i] % world.width - to % world.width);
        const int rows = std::abs(now[i] / world.width - to / world.width);
        if (columns + rows != 1) return "a step over more than one place";
        if (std::find(now.begin(), now.end(), to) != now.end()) continue;
        now[i] = to;
        again = true;
      }
    }
    if (now != steps[k]) return "a ring, or two that exchange places";
  }
  for (std::size_t i = 0; i < count; ++i) {
    const CellIndex target = world.task.targets[i];
    if (target == kNone) continue;
    const auto there = std::find(steps.back().begin(), steps.back().end(), target);
    if (there == steps.back().end()) return "nobody at a target";
    const auto other = static_cast<std::size_t>(there - steps.back().begin());
    const bool of_one_pool = !world.pools.empty() && world.pools[i] != kNone && world.pools[i] == world.pools[other];
    if (other != i && !of_one_pool) return "another one at a target";
  }
  return {};
}

std::int64_t SumOfArrivals(const std::vector<Configuration>& steps) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < steps.front().size(); ++i) {
    std::size_t arrival = steps.size() - 1;
    while (arrival > 0 && steps[arrival - 1][i] == steps[arrival][i]) --arrival;
    sum += static_cast<std::int64_t>(arrival);
  }
  return sum;
}

TEST(Repair, StepsOfRandomWorldsCanBeCarriedOut) {
  Random random(17);
  int found = 0;
  constexpr int kTrials = 150;
  for (int trial = 0; trial < kTrials; ++trial) {
    const World world = AnyWorld(random, trial);
    const Grid grid(world.width, world.height, 120, 118, kOfSquares, world.blocked);
    const StepTables tables = MakeStepTables(grid, world.task);
    Repair repair(grid, world.task, tables, world.pools, random.Next());
    if (!repair.Find(100'000)) continue;
    ++found;
    EXPECT_EQ(Fault(world, repair.steps()), "") << trial;
    EXPECT_EQ(repair.sum(), SumOfArrivals(repair.steps())) << trial;
    EXPECT_TRUE(Compose(grid, repair.steps()).has_value()) << trial;
    const std::int64_t before = repair.sum();
    repair.Improve(20'000, 0);
    EXPECT_EQ(Fault(world, repair.steps()), "") << trial;
    EXPECT_EQ(repair.sum(), SumOfArrivals(repair.steps())) << trial;
    EXPECT_LE(repair.sum(), before) << trial;
    EXPECT_GE(repair.sum(), repair.least_sum()) << trial;
    EXPECT_TRUE(Compose(grid, repair.steps()).has_value()) << trial;
    repair.Improve(5'000, 2);  // worse steps are accepted, too
    EXPECT_EQ(Fault(world, repair.steps()), "") << trial;
  }
  EXPECT_GT(found, kTrials * 9 / 10);
}

TEST(Repair, IsAloneAsQuickAsItCanBe) {
  const World world{
      .width = 5, .height = 4, .blocked = std::vector<bool>(20), .task = {.starts = {0}, .targets = {19}}};
  const Grid grid(world.width, world.height, 120, 118, kOfSquares, world.blocked);
  const StepTables tables = MakeStepTables(grid, world.task);
  Repair repair(grid, world.task, tables, world.pools, 1);
  ASSERT_TRUE(repair.Find(1000));
  EXPECT_EQ(repair.sum(), 7);
  EXPECT_EQ(repair.steps().size(), 8U);
}

TEST(Repair, SaysWhereThereAreNone) {
  // Two movers in a row that have to exchange places.
  const World world{
      .width = 4, .height = 1, .blocked = std::vector<bool>(4), .task = {.starts = {0, 3}, .targets = {3, 0}}};
  const Grid grid(world.width, world.height, 120, 118, kOfSquares, world.blocked);
  const StepTables tables = MakeStepTables(grid, world.task);
  Repair repair(grid, world.task, tables, world.pools, 1);
  EXPECT_FALSE(repair.Find(20'000));
  EXPECT_LE(repair.looked_at(), 20'100);
}

TEST(Repair, ClosesNoRing) {
  // Four movers in a square, each bound for the place of the next: they have to use the free places beside them.
  World world{.width = 3, .height = 2, .blocked = std::vector<bool>(6)};
  world.task = {.starts = {0, 1, 4, 3}, .targets = {1, 4, 3, 0}};
  const Grid grid(world.width, world.height, 120, 118, kOfSquares, world.blocked);
  const StepTables tables = MakeStepTables(grid, world.task);
  Repair repair(grid, world.task, tables, world.pools, 3);
  ASSERT_TRUE(repair.Find(100'000));
  EXPECT_EQ(Fault(world, repair.steps()), "");
  EXPECT_GT(repair.sum(), 4);
}

TEST(Repair, KnowsRingsOfAnyLength) {
  // A border of 62 places, all filled, each mover bound for the next place: nothing can move.
  World world{.width = 17, .height = 16, .blocked = std::vector<bool>(272, true)};
  for (int x = 0; x < 17; ++x) world.task.starts.push_back(x);
  for (int y = 1; y < 16; ++y) world.task.starts.push_back(17 * y + 16);
  for (int x = 15; x >= 0; --x) world.task.starts.push_back(17 * 15 + x);
  for (int y = 14; y > 0; --y) world.task.starts.push_back(17 * y);
  world.task.targets = world.task.starts;
  std::rotate(world.task.targets.begin(), world.task.targets.begin() + 1, world.task.targets.end());
  for (const CellIndex place : world.task.starts) world.blocked[static_cast<std::size_t>(place)] = false;
  const Grid grid(world.width, world.height, 120, 118, kOfSquares, world.blocked);
  const StepTables tables = MakeStepTables(grid, world.task);
  Repair repair(grid, world.task, tables, world.pools, 1);
  EXPECT_FALSE(repair.Find(20'000));
}

}  // namespace
}  // namespace takt::routing
