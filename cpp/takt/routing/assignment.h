// Assignment of interchangeable targets to movers. The Hungarian method in the form with potentials (Kuhn 1955, Munkres
// 1957): O(n² m).
#pragma once

#include <cstddef>
#include <vector>

namespace takt::routing {

// Returns, by row, the assigned column, with the least sum of costs. Costs may be infinite; a row that can only get an
// infinite cost gets one. Requires: all rows have the same length, no less than the number of rows.
std::vector<std::size_t> Assign(const std::vector<std::vector<double>>& costs);

}  // namespace takt::routing
