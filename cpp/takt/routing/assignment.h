// Who goes where if targets are interchangeable. The Hungarian method in the form with potentials (Kuhn 1955, Munkres
// 1957): O(n² m).
#pragma once

#include <cstddef>
#include <vector>

namespace takt::routing {

// Returns by row the column it is given, such that the sum of costs is least. Costs may be infinite; if a row can only
// get an infinite one, so it does. Requires: all rows have the same length, no less than the number of rows.
std::vector<std::size_t> Assign(const std::vector<std::vector<double>>& costs);

}  // namespace takt::routing
