#include "takt/routing/surface.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "takt/routing/assignment.h"
#include "takt/routing/compose.h"
#include "takt/routing/improve.h"
#include "takt/routing/repair.h"
#include "takt/routing/steps.h"

namespace takt::routing {
namespace {

constexpr std::int64_t kStepEffort = 4'000'000;  // places looked at for a first plan; by mover and step
constexpr std::int64_t kLeastSteps = 5'000;
constexpr int kSeeds = 8;                     // first plans, of which the best is taken; with few movers
constexpr std::int64_t kMoversPerSeed = 400;  // ... of 8 seeds: with more movers fewer seeds
constexpr int kTurns = 6;                     // tries of prioritised planning
constexpr std::int64_t kTurnStates = 4'000;   // states that those may take
constexpr double kCrowded = 1.5;              // of the lower bound: above, movers are in the way of others
constexpr int kShares = 6;                    // of the effort: see PlanSurface
constexpr std::int64_t kStepStates = 16;      // states of steps that take as long as one of Improve
constexpr std::int64_t kCellsPerState = 16;   // of tables that are made
constexpr std::int64_t kMostCells = 2'000'000;
constexpr std::int64_t kLeastPerMover = 250;           // states of steps; with less repair finds none
constexpr std::int64_t kMostEffort = 100'000'000'000;  // for steps

// Which mover of a pool takes which of its targets, by the times alone. Returns a mover that reaches none; kNone: all
// do.
MoverIndex AssignTargets(PoolIndex pool, const std::vector<PoolIndex>& pools, Alone& alone, Task& task) {
  std::vector<MoverIndex> members;
  std::vector<PlaceIndex> targets;
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
  const auto add = [&](MoverIndex mover, PlaceIndex place, double entry, double middle) {
    std::vector<Visit>& visits = plan.visits[static_cast<std::size_t>(mover)];
    // By its middle: in one lane a follower may be bound to a place before its leader has reached it.
    at[static_cast<std::size_t>(place)].emplace_back(middle, mover, static_cast<std::int32_t>(visits.size()));
    visits.push_back({.place = place, .entry = entry});
  };
  plan.visits.resize(problem.starts.size());
  for (std::size_t i = 0; i < problem.starts.size(); ++i) {
    const auto mover = static_cast<MoverIndex>(i);
    add(mover, problem.starts[i], -1, -1);
    for (const Leg& leg : plan.legs[i]) {
      const int count = grid.Count(leg.from, leg.to);
      const PlaceIndex step = grid.Step(grid.Towards(leg.from, leg.to));
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

// Better steps than the first ones. `offer` returns the sum of the arrivals [s] that steps become.
class BetterSteps {
 public:
  using Offer = std::function<double(const std::vector<Configuration>&)>;
  BetterSteps(const Grid& grid, const Task& task, const StepTables& tables, const SurfaceProblem& problem, Offer offer)
      : grid_(grid),
        task_(task),
        tables_(tables),
        problem_(problem),
        offer_(std::move(offer)),
        cells_(Repair::Cells(grid, task, tables)),
        budget_(std::clamp<std::int64_t>(problem.effort / kShares, 0, kMostEffort) * kStepStates) {}

  // Whether some may be found with that effort.
  bool Worthwhile() const noexcept {
    return cells_ <= std::min(kMostCells, budget_ * kCellsPerState) && budget_ >= kLeastPerMover * movers();
  }
  // With two shares of the effort.
  void Run(const std::vector<Configuration>& first, double first_sum) {
    FindSome();
    if (best_) {
      ImproveBest();
    } else {
      LookForTails(first, first_sum);
    }
  }

 private:
  std::int64_t movers() const noexcept { return static_cast<std::int64_t>(task_.starts.size()); }
  std::int64_t Size(const std::vector<Configuration>& steps) const noexcept {
    return movers() * static_cast<std::int64_t>(steps.size());
  }
  // By repair, of one seed after the other.
  void FindSome() {
    double least = kForever;
    for (std::uint64_t seed = problem_.seed; spent_ < budget_; ++seed) {
      auto one = std::make_unique<Repair>(grid_, task_, tables_, problem_.pools, seed);
      const bool found = one->Find(budget_ - spent_);
      spent_ += one->looked_at() + 1 + cells_ / kCellsPerState;
      if (!found) continue;
      const std::vector<Configuration> steps = one->steps();
      spent_ += Size(steps);
      const bool alone = one->sum() == one->least_sum();  // they cannot be fewer
      if (const double sum = offer_(steps); sum < least) {
        least = sum;
        best_ = std::move(one);
      }
      if (alone) return;
    }
  }
  void ImproveBest() {
    constexpr int kParts = 8;       // each with less heat than the one before
    constexpr double kHeat = 0.02;  // of the mean of steps alone
    const double heat = kHeat * static_cast<double>(best_->least_sum()) / static_cast<double>(movers());
    for (int k = 1; k <= kParts && best_->sum() > best_->least_sum(); ++k) {
      best_->Improve(budget_ / kParts, heat * (kParts - k) / kParts);
      offer_(best_->steps());
    }
  }
  // From any step of the first ones on they are looked for anew.
  void LookForTails(std::vector<Configuration> now, double least) {
    constexpr std::int64_t kCost = 4;  // states, by mover and step
    Random random(problem_.seed);
    for (std::int64_t left = 2 * budget_ - spent_; now.size() > 1 && (left -= kCost * Size(now)) > 0;) {
      const auto at = now.begin() + static_cast<std::ptrdiff_t>(random.Below(now.size() - 1));
      const StepSearch tail =
          FindSteps(grid_, {.starts = *at, .targets = task_.targets}, tables_, random.Next(), kLeastSteps);
      if (!tail.steps) continue;
      std::vector<Configuration> steps(now.begin(), at);
      steps.insert(steps.end(), tail.steps->begin(), tail.steps->end());
      const double sum = offer_(steps);
      if (sum >= least) continue;
      least = sum;
      now = std::move(steps);
    }
  }

  const Grid& grid_;
  const Task& task_;
  const StepTables& tables_;
  const SurfaceProblem& problem_;
  Offer offer_;
  std::int64_t cells_, budget_, spent_ = 0;  // states; the budget twice
  std::unique_ptr<Repair> best_;
};

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
    const auto seeds = static_cast<std::uint64_t>(std::clamp<std::int64_t>(kMoversPerSeed / movers, 1, kSeeds));
    for (std::uint64_t k = 0; k < seeds; ++k) {
      StepSearch found = FindSteps(grid, task, tables, problem.seed + k, best ? kLeastSteps : effort);
      if (found.steps) {
        if (const double sum = offer_steps(*found.steps); sum < steps_sum) {
          steps_sum = sum;
          steps = *std::move(found.steps);
        }
      }
      if (!best) {
        const bool impossible =
            found.exhausted &&
            (different.empty() || different == std::set<PoolIndex>{kNone});  // another assignment might do
        return {.outcome = impossible ? Outcome::kImpossible : Outcome::kGivenUp};
      }
    }
  }
  offer(PlanInTurn(grid, task, alone, kTurns, kTurnStates));
  result.first_sum = SumOf(grid, *best);
  // Whoever has no target ends where the plan that improvements begin with leaves it.
  const auto improve = [&](Plan plan, std::int64_t effort) {
    return Improve(grid, task, alone, std::move(plan), {.effort = effort, .seed = problem.seed, .pools = pools});
  };
  std::int64_t left = problem.effort;
  if (!steps.empty() && result.first_sum > kCrowded * result.lower_bound) {
    if (BetterSteps better(grid, task, tables, problem, offer_steps); better.Worthwhile()) {
      // A share for the first plan, two for better steps, one for the plan that these become; the rest for the better.
      const std::int64_t share = problem.effort / kShares;
      Plan first = improve(*std::exchange(best, std::nullopt), share);
      better.Run(steps, steps_sum);
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
