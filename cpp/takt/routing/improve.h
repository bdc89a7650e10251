// Improvement of a plan: some movers are replanned among all others, and better results are kept. First sweeps, mover
// by mover; then large neighbourhood search (Shaw 1998; for many movers Li et al., IJCAI 2021) with simulated
// annealing. The effort is counted in states that SIPP expands, not in time: the same plan on every host.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "takt/routing/random.h"
#include "takt/routing/sipp.h"
#include "takt/routing/steps.h"

namespace takt::routing {

struct Plan {
  std::vector<Legs> legs;          // by mover
  std::vector<CellIndex> targets;  // by mover: where it ends
};

// Times to targets for a mover alone, computed once.
class Alone {
 public:
  explicit Alone(const Grid& grid) : grid_(grid) {}
  const std::vector<double>& To(CellIndex target) {
    const auto [found, is_new] = times_.try_emplace(target);
    if (is_new) found->second = grid_.TimesTo(target);
    return found->second;
  }
  double operator()(CellIndex from, CellIndex target) { return To(target)[static_cast<std::size_t>(from)]; }

 private:
  const Grid& grid_;
  std::map<CellIndex, std::vector<double>> times_;
};

// Prioritised planning: one mover after the other, those with short paths first; a mover without a path is the first of
// the next try. Returns nothing after `tries` failed ones, or `effort` states of SIPP: the method is not complete.
// Movers without a target stay.
std::optional<Plan> PlanPrioritised(const Grid& grid, const Task& task, Alone& alone, int tries, std::int64_t effort);

// Returns the sum of the arrivals of a plan [s].
double SumOf(const Grid& grid, const Plan& plan);

struct ImproveOptions {
  std::int64_t effort = 0;  // states of SIPP
  std::uint64_t seed = 0;
  // by mover; targets may be exchanged within a pool; kNone, or empty: none
  std::vector<std::int32_t> pools{};
};
// Requires: the plan solves the task. Returns a plan that is not worse.
Plan Improve(const Grid& grid, const Task& task, Alone& alone, Plan plan, const ImproveOptions& how);

}  // namespace takt::routing
