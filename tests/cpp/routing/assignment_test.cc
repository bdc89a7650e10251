// PL-72: interchangeable targets, against all permutations.
#include "takt/routing/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "takt/routing/random.h"

namespace takt::routing {
namespace {

double SumOf(const std::vector<std::vector<double>>& costs, const std::vector<std::size_t>& columns) {
  double sum = 0;
  for (std::size_t i = 0; i < costs.size(); ++i) sum += costs[i][columns[i]];
  return sum;
}

TEST(Assignment, IsTheBestOfAllOrders) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const std::size_t rows = 1 + random.Below(5), columns = rows + random.Below(3);
    std::vector<std::vector<double>> costs(rows);
    for (auto& row : costs) {
      for (std::size_t k = 0; k < columns; ++k) row.push_back(static_cast<double>(random.Below(20)));
    }
    std::vector<std::size_t> order(columns);
    std::iota(order.begin(), order.end(), 0U);
    double best = std::numeric_limits<double>::infinity();
    do {
      best = std::min(best, SumOf(costs, order));
    } while (std::next_permutation(order.begin(), order.end()));
    std::vector<std::size_t> assigned = Assign(costs);
    EXPECT_EQ(SumOf(costs, assigned), best);
    std::sort(assigned.begin(), assigned.end());
    EXPECT_EQ(std::adjacent_find(assigned.begin(), assigned.end()), assigned.end());
  }
}

TEST(Assignment, ShunsWhatCannotBeReached) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Assign({{1, kNever}, {0, 5}}), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(Assign({{1, kNever}, {2, kNever}}).size(), 2U);
  EXPECT_TRUE(Assign({}).empty());
}

}  // namespace
}  // namespace takt::routing
