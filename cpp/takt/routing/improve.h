// A plan made better: some movers are planned anew between all others, and what is quicker stays. First sweeps, mover
// by mover; then large neighbourhood search (Shaw 1998; for many movers Li et al., IJCAI 2021) with simulated
// annealing. What it may take is counted in states that SIPP looks at, not in time: the same plan on every host.
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
  std::vector<Legs> legs;           // by mover
  std::vector<PlaceIndex> targets;  // by mover, where it ends
};

// Times to targets for a mover alone, computed once.
class Alone {
 public:
  explicit Alone(const Grid& grid) : grid_(grid) {}
  const std::vector<double>& To(PlaceIndex target) {
    const auto [found, is_new] = times_.try_emplace(target);
    if (is_new) found->second = grid_.TimesTo(target);
    return found->second;
  }
  double operator()(PlaceIndex from, PlaceIndex target) { return To(target)[static_cast<std::size_t>(from)]; }

 private:
  const Grid& grid_;
  std::map<PlaceIndex, std::vector<double>> times_;
};

// Prioritised planning: one mover after the other, those with short ways first; one that finds no way is the first of
// the next try. Returns nothing if `tries` were in vain: it is not complete. Movers without a target stay.
std::optional<Plan> PlanInTurn(const Grid& grid, const Task& task, Alone& alone, int tries, std::int64_t effort);

// Sum of the arrivals of a plan, s.
double SumOf(const Grid& grid, const Plan& plan);

struct Improving {
  std::int64_t effort = 0;            // states
  std::uint64_t seed = 0;             //
  std::vector<std::int32_t> pools{};  // by mover: within one, targets may be exchanged; kNone: its own. Empty: all
};
// Requires: the plan is one of the task. Returns one that is not worse.
Plan Improve(const Grid& grid, const Task& task, Alone& alone, Plan plan, const Improving& how);

}  // namespace takt::routing
