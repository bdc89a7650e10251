// The discrete stage: from step to step each mover stays, or moves to a place beside it, until all are at their
// targets. Complete: given enough effort it finds such steps, or knows that there are none.
//
// The search is LaCAM (Okumura, AAAI 2023): depth first over configurations, each expanded lazily under constraints of
// who has to be where next, the rest of the step being found by PIBT (Okumura et al., Artificial Intelligence 2022)
// with its swap rule. Ours: no step is taken that could not be carried out by movers that need a place to be empty
// before they enter it. So after PIBT only those moves are kept that lead into an empty place, or straight on behind a
// mover that moves the same way in this step. Rings, in which each would enter the place of the next, are never closed.
// It stays complete: steps in which one mover moves into an empty place are among those that constraints name.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "takt/routing/grid.h"

namespace takt::routing {

using Configuration = std::vector<PlaceIndex>;  // by mover

struct Task {
  Configuration starts;   // all different
  Configuration targets;  // kNone: anywhere
};

// Steps from each place to a target, computed once.
using StepTables = std::map<PlaceIndex, std::vector<std::int32_t>>;
StepTables MakeStepTables(const Grid& grid, const Task& task);

struct StepSearch {
  std::optional<std::vector<Configuration>> steps{};  // the first are the starts
  bool exhausted = false;                             // there are none
};

// Looks for steps; gives up after `effort` generated ones. The result depends on `seed`, the same on every host.
StepSearch FindSteps(const Grid& grid, const Task& task, const StepTables& tables, std::uint64_t seed,
                     std::int64_t effort);

// Steps to interchangeable targets: movers whose ways meet swap their targets (TSWAP, Okumura and Défago, 2023).
// `task.targets` are what each begins with, and in the end who went where. Requires: each mover has a target.
std::optional<std::vector<Configuration>> SwapTargets(const Grid& grid, Task& task, std::uint64_t seed);

}  // namespace takt::routing
