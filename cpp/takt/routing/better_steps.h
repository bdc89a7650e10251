// Better steps than the first ones of FindSteps, where movers are in each other's way: by repair, from one seed after
// the other, the best of which are improved. Where repair fails, by FindSteps from any of the steps on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "takt/routing/repair.h"

namespace takt::routing {

class BetterSteps {
 public:
  struct How {
    std::int64_t effort = 0;  // states of Improving that would take as long; taken twice
    std::uint64_t seed = 0;
  };
  // Keeps references. `pools`: as those of Improving.
  BetterSteps(const Grid& grid, const Task& task, const StepTables& tables, const std::vector<std::int32_t>& pools,
              const How& how);

  // Whether some may be found with that effort.
  bool Worthwhile() const noexcept;

  // Takes steps; returns the sum of the arrivals [s] that they become.
  using Offer = std::function<double(const std::vector<Configuration>&)>;
  // `first`: steps that there are, and their sum. Requires: there is a mover.
  void Run(std::vector<Configuration> first, double first_sum, const Offer& offer);

 private:
  std::int64_t movers() const noexcept { return static_cast<std::int64_t>(task_.starts.size()); }
  std::int64_t Size(const std::vector<Configuration>& steps) const noexcept {
    return movers() * static_cast<std::int64_t>(steps.size());
  }
  void FindSome(const Offer& offer);
  void ImproveBest(const Offer& offer);
  void LookForTails(std::vector<Configuration> now, double least, const Offer& offer);

  const Grid& grid_;
  const Task& task_;
  const StepTables& tables_;
  const std::vector<std::int32_t>& pools_;
  std::uint64_t seed_;
  std::int64_t cells_, budget_, spent_ = 0;  // states of steps; the budget twice
  std::unique_ptr<Repair> best_;
};

}  // namespace takt::routing
