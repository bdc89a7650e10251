#include "takt/routing/surface.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "takt/routing/assignment.h"
#include "takt/routing/better_steps.h"
#include "takt/routing/compose.h"
#include "takt/routing/improve.h"
#include "takt/routing/steps.h"

namespace takt::routing {
namespace {

constexpr std::int64_t kStepEffort = 4'000'000;  // places examined for a first plan, by mover and step
constexpr std::int64_t kLeastSteps = 5'000;
constexpr int kSeeds = 8;                        // first plans, of which the best is taken, if movers are few
constexpr std::int64_t kSeedsTimesMovers = 400;  // seeds times movers at most, but at least one seed
constexpr int kTurns = 6;                        // tries of prioritised planning
constexpr std::int64_t kTurnStates = 4'000;      // states that these may expand
constexpr double kCrowded = 1.5;                 // of the lower bound; above it, movers obstruct one another
constexpr int kShares = 6;                       // of the effort: see below

// Assigns the targets of a pool to its movers, by the times alone. Returns a mover that reaches none; kNone: all do.
MoverIndex AssignTargets(PoolIndex pool, const std::vector<PoolIndex>& pools, Alone& alone, Task& task) {
  std::vector<MoverIndex> members;
  std::vector<CellIndex> targets;
  for (std::size_t i = 0; i < pools.size(); ++i) {
    if (pools[i] != pool) continue;
    members.push_back(static_cast<MoverIndex>(i));
    if (task.targets[i] != kNone) targets.push_back(std::exchange(task.targets[i], kNone));
  }
  std::vector<std::vector<double>> costs(targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    for (const MoverIndex mover : members) costs[k].push_back(alone(At(task.starts, mover), targets[k]));
  }
  const std::vector<std::size_t> taken_by = Assign(costs);
  MoverIndex unable = kNone;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const MoverIndex mover = members[taken_by[k]];
    At(task.targets, mover) = targets[k];
    if (costs[k][taken_by[k]] == kForever) unable = mover;
  }
  return unable;
}

void MakeVisits(const Grid& grid, const SurfaceProblem& problem, SurfacePlan& plan) {
  using ByTime = std::tuple<double, MoverIndex, std::int32_t>;
  std::vector<std::vector<ByTime>> at(static_cast<std::size_t>(grid.size()));
  const auto add = [&](MoverIndex mover, CellIndex place, double entry, double middle) {
    std::vector<Visit>& visits = plan.visits[static_cast<std::size_t>(mover)];
    // By the passage of its centre: in one lane a follower may be bound to a place before its leader has reached it.
    at[static_cast<std::size_t>(place)].emplace_back(middle, mover, static_cast<std::int32_t>(visits.size()));
    visits.push_back({.place = place, .entry = entry});
  };
  plan.visits.resize(problem.starts.size());
  for (std::size_t i = 0; i < problem.starts.size(); ++i) {
    const auto mover = static_cast<MoverIndex>(i);
    add(mover, problem.starts[i], -1, -1);
    for (const Leg& leg : plan.legs[i]) {
      const int count = grid.Count(leg.from, leg.to);
      const CellIndex step = grid.Step(grid.Towards(leg.from, leg.to));
      std::vector<Visit>& visits = plan.visits[i];
      visits.back().left = leg.departure + grid.Exit(count, 0);
      for (int k = 1; k <= count; ++k) {
        add(mover, leg.from + k * step, leg.departure + grid.Entry(count, k), leg.departure + grid.Middle(count, k));
        visits.back().left = leg.departure + grid.Exit(count, k);
      }
    }
  }
  for (auto& its : at) {
    std::sort(its.begin(), its.end());
    for (std::size_t k = 1; k < its.size(); ++k) {
      const auto [time, mover, index] = its[k];
      Visit& visit = plan.visits[static_cast<std::size_t>(mover)][static_cast<std::size_t>(index)];
      visit.before = std::get<1>(its[k - 1]);
      visit.before_index = std::get<2>(its[k - 1]);
    }
  }
}

}  // namespace

SurfacePlan PlanSurface(const SurfaceProblem& problem) {
  const Grid grid(problem.width, problem.height, problem.pitch, problem.mover_size, problem.dynamics, problem.blocked);
  Alone alone(grid);
  SurfacePlan result;
  Task task{.starts = problem.starts, .targets = problem.targets};
  const std::vector<PoolIndex>& pools = problem.pools;
  const std::set<PoolIndex> different(pools.begin(), pools.end());
  for (const PoolIndex pool : different) {
    if (pool == kNone) continue;
    const MoverIndex unable = AssignTargets(pool, pools, alone, task);
    if (unable != kNone) return {.outcome = Outcome::kUnreachable, .unreachable = unable};
  }
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    if (task.targets[i] == kNone) continue;
    const double time = alone(task.starts[i], task.targets[i]);
    if (time == kForever) return {.outcome = Outcome::kUnreachable, .unreachable = static_cast<MoverIndex>(i)};
    result.lower_bound += time;
  }
  std::optional<Plan> best;
  const auto offer = [&](std::optional<Plan> plan) {
    const double sum = plan ? SumOf(grid, *plan) : kForever;
    if (plan && (!best || sum < SumOf(grid, *best))) best = std::move(plan);
    return sum;
  };
  const auto offer_steps = [&](const std::vector<Configuration>& steps) {
    std::optional<std::vector<Legs>> legs = Compose(grid, steps);
    return legs ? offer(Plan{.legs = *std::move(legs), .targets = steps.back()}) : kForever;
  };
  std::vector<Configuration> steps;  // the first ones
  double steps_sum = kForever;
  StepTables tables;
  Task swapped = task;
  const bool all_have_targets = std::find(task.targets.begin(), task.targets.end(), kNone) == task.targets.end();
  const bool one_pool = different.size() == 1 && *different.begin() != kNone;
  if (one_pool && all_have_targets) {
    if (const auto steps = SwapTargets(grid, swapped, problem.seed)) offer_steps(*steps);
  }
  const auto movers = static_cast<std::int64_t>(std::max<std::size_t>(1, task.starts.size()));
  if (!best) {
    tables = MakeStepTables(grid, task);
    const std::int64_t effort = std::max(kLeastSteps, kStepEffort / movers);
    const auto seeds = static_cast<std::uint64_t>(std::clamp<std::int64_t>(kSeedsTimesMovers / movers, 1, kSeeds));
    for (std::uint64_t k = 0; k < seeds; ++k) {
      StepSearch found = FindSteps(grid, task, tables, problem.seed + k, best ? kLeastSteps : effort);
      if (found.steps) {
        if (const double sum = offer_steps(*found.steps); sum < steps_sum) {
          steps_sum = sum;
          steps = *std::move(found.steps);
        }
      }
      if (!best) {
        // With pools, another assignment might have a solution.
        const bool impossible = found.exhausted && (different.empty() || different == std::set<PoolIndex>{kNone});
        return {.outcome = impossible ? Outcome::kImpossible : Outcome::kGivenUp};
      }
    }
  }
  offer(PlanPrioritised(grid, task, alone, kTurns, kTurnStates));
  result.first_sum = SumOf(grid, *best);
  // A mover without a target ends where the plan under improvement leaves it.
  const auto improve = [&](Plan plan, std::int64_t effort) {
    return Improve(grid, task, alone, std::move(plan), {.effort = effort, .seed = problem.seed, .pools = pools});
  };
  std::int64_t left = problem.effort;
  if (!steps.empty() && result.first_sum > kCrowded * result.lower_bound) {
    // One share for the first plan, two for better steps, one for the plan composed of these; the rest for the better
    // of both.
    const std::int64_t share = problem.effort / kShares;
    BetterSteps better(grid, task, tables, pools, {.effort = share, .seed = problem.seed});
    if (better.Worthwhile()) {
      Plan first = improve(*std::exchange(best, std::nullopt), share);
      better.Run(std::move(steps), steps_sum, offer_steps);
      if (best) best = improve(*std::move(best), share);
      offer(std::move(first));
      left -= 4 * share;
    }
  }
  Plan plan = improve(*std::move(best), left);
  result.outcome = Outcome::kPlanned;
  result.sum = SumOf(grid, plan);
  result.targets = std::move(plan.targets);
  result.legs = std::move(plan.legs);
  MakeVisits(grid, problem, result);
  return result;
}

}  // namespace takt::routing
