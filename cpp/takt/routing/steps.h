// The discrete stage: from step to step each mover stays or moves to a neighbouring place, until all are at their
// targets. Complete: given enough effort it finds a solution, or proves that there is none.
//
// The search is LaCAM (Okumura, AAAI 2023): depth first over configurations, each expanded lazily under constraints
// that fix the next places of some movers; the rest of the step is found by PIBT (Okumura et al., Artificial
// Intelligence 2022) with its swap rule. Ours: a step is taken only if movers that enter a place after it is empty can
// execute it. So after PIBT only those moves are kept that lead into an empty place, or straight on behind a mover that
// moves in the same direction in this step. Rings, in which each mover would enter the place of the next, are never
// closed. The search stays complete: steps in which one mover moves into an empty place are among those that
// constraints name.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "takt/routing/grid.h"

namespace takt::routing {

using Configuration = std::vector<CellIndex>;  // by mover

struct Task {
  Configuration starts;   // pairwise different
  Configuration targets;  // kNone: anywhere
};

// Number of steps from each place to a target, by target.
using StepTables = std::map<CellIndex, std::vector<std::int32_t>>;
StepTables MakeStepTables(const Grid& grid, const Task& task);

struct StepSearch {
  std::optional<std::vector<Configuration>> steps{};  // from the starts to the targets, both included; none: not found
  bool exhausted = false;                             // true: no solution exists; false without steps: effort used up
};

// Searches for steps, with `effort` attempted ones at most. The result depends on `seed` and is the same on every host.
// Requires: `tables` hold every target of `task` (MakeStepTables).
StepSearch FindSteps(const Grid& grid, const Task& task, const StepTables& tables, std::uint64_t seed,
                     std::int64_t effort);

// Finds steps to interchangeable targets: movers whose paths meet swap their targets (TSWAP, Okumura and Défago, 2023).
// `task.targets` are the initial targets, and on return the final ones. Returns nothing if the targets are not reached
// in 5000 steps. Requires: each mover has a target; starts and targets are each pairwise different.
std::optional<std::vector<Configuration>> SwapTargets(const Grid& grid, Task& task, std::uint64_t seed);

}  // namespace takt::routing
