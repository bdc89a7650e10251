#include "takt/routing/assignment.h"

#include <algorithm>
#include <limits>

namespace takt::routing {

std::vector<std::size_t> Assign(const std::vector<std::vector<double>>& costs) {
  if (costs.empty()) return {};
  const std::size_t rows = costs.size(), columns = costs.front().size();
  constexpr double kImpossible = 1e12;  // finite, so that potentials are
  // Row and column 0 mean "none".
  std::vector<double> row_potential(rows + 1), column_potential(columns + 1);
  std::vector<std::size_t> row_of(columns + 1, 0), before(columns + 1, 0);
  for (std::size_t row = 1; row <= rows; ++row) {
    std::vector<double> least(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<bool> reached(columns + 1, false);
    row_of[0] = row;
    std::size_t column = 0;
    do {  // adds the cheapest column to the alternating tree
      reached[column] = true;
      const std::size_t at = row_of[column];
      double delta = std::numeric_limits<double>::infinity();
      std::size_t next = 0;
      for (std::size_t k = 1; k <= columns; ++k) {
        if (reached[k]) continue;
        const double reduced = std::min(costs[at - 1][k - 1], kImpossible) - row_potential[at] - column_potential[k];
        if (reduced < least[k]) {
          least[k] = reduced;
          before[k] = column;
        }
        if (least[k] < delta) {
          delta = least[k];
          next = k;
        }
      }
      for (std::size_t k = 0; k <= columns; ++k) {
        if (reached[k]) {
          row_potential[row_of[k]] += delta;
          column_potential[k] -= delta;
        } else {
          least[k] -= delta;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = before[column]) row_of[column] = row_of[before[column]];
  }
  std::vector<std::size_t> result(rows);
  for (std::size_t k = 1; k <= columns; ++k) {
    if (row_of[k] != 0) result[row_of[k] - 1] = k - 1;
  }
  return result;
}

}  // namespace takt::routing
