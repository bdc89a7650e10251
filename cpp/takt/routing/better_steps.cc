#include "takt/routing/better_steps.h"

#include <algorithm>
#include <utility>

#include "takt/routing/timetable.h"

namespace takt::routing {
namespace {

constexpr std::int64_t kStates = 16;         // states of repair that take as long as one of ImproveOptions
constexpr std::int64_t kCellsPerState = 16;  // cells of tables whose setup takes as long as one state
constexpr std::int64_t kMostCells = 2'000'000;
constexpr std::int64_t kLeastPerMover = 250;  // states; repair finds none with less
constexpr std::int64_t kMostEffort = 100'000'000'000;
constexpr std::int64_t kTailEffort = 5'000;  // configurations
constexpr std::int64_t kTailCost = 4;        // states, by mover and step

}  // namespace

BetterSteps::BetterSteps(const Grid& grid, const Task& task, const StepTables& tables,
                         const std::vector<std::int32_t>& pools, const How& how)
    : grid_(grid),
      task_(task),
      tables_(tables),
      pools_(pools),
      seed_(how.seed),
      cells_(Repair::Cells(grid, task, tables)),
      budget_(std::clamp<std::int64_t>(how.effort, 0, kMostEffort) * kStates) {}

bool BetterSteps::Worthwhile() const noexcept {
  return cells_ <= std::min(kMostCells, budget_ * kCellsPerState) && budget_ >= kLeastPerMover * movers();
}

void BetterSteps::Run(std::vector<Configuration> first, double first_sum, const Offer& offer) {
  FindSome(offer);
  if (best_) {
    ImproveBest(offer);
  } else {
    ImproveTails(std::move(first), first_sum, offer);
  }
}

void BetterSteps::FindSome(const Offer& offer) {
  double least = kForever;
  for (std::uint64_t seed = seed_; spent_ < budget_; ++seed) {
    auto one = std::make_unique<Repair>(grid_, task_, tables_, pools_, seed);
    const bool found = one->Find(budget_ - spent_);
    spent_ += one->looked_at() + 1 + cells_ / kCellsPerState;
    if (!found) continue;
    const std::vector<Configuration> steps = one->steps();
    spent_ += Size(steps);
    const bool as_if_alone = one->sum() == one->least_sum();  // no sum can be less
    if (const double sum = offer(steps); sum < least) {
      least = sum;
      best_ = std::move(one);
    }
    if (as_if_alone) return;
  }
}

void BetterSteps::ImproveBest(const Offer& offer) {
  constexpr int kParts = 8;       // each with less heat than the preceding one
  constexpr double kHeat = 0.02;  // of the mean number of steps of a mover alone
  const double heat = kHeat * static_cast<double>(best_->least_sum()) / static_cast<double>(movers());
  for (int k = 1; k <= kParts && best_->sum() > best_->least_sum(); ++k) {
    best_->Improve(budget_ / kParts, heat * (kParts - k) / kParts);
    offer(best_->steps());
  }
}

void BetterSteps::ImproveTails(std::vector<Configuration> now, double least, const Offer& offer) {
  Random random(seed_);
  for (std::int64_t left = 2 * budget_ - spent_; now.size() > 1 && (left -= kTailCost * Size(now)) > 0;) {
    const auto at = now.begin() + static_cast<std::ptrdiff_t>(random.Below(now.size() - 1));
    const StepSearch tail =
        FindSteps(grid_, {.starts = *at, .targets = task_.targets}, tables_, random.Next(), kTailEffort);
    if (!tail.steps) continue;
    std::vector<Configuration> steps(now.begin(), at);
    steps.insert(steps.end(), tail.steps->begin(), tail.steps->end());
    const double sum = offer(steps);
    if (sum >= least) continue;
    least = sum;
    now = std::move(steps);
  }
}

}  // namespace takt::routing
