// Better steps than the first ones of FindSteps for crowded problems. Steps are found by repair from successive seeds,
// and the best of these are improved further. If repair finds none, FindSteps replaces tails of the known steps, from
// random steps on.
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
    std::int64_t effort = 0;  // states of ImproveOptions that take as long as each of the two stages
    std::uint64_t seed = 0;
  };
  // Keeps references. `pools`: as in ImproveOptions.
  BetterSteps(const Grid& grid, const Task& task, const StepTables& tables, const std::vector<std::int32_t>& pools,
              const How& how);

  // Returns true if the effort may be enough to find steps.
  bool Worthwhile() const noexcept;

  // Receives steps; returns the sum of the arrivals [s] of the plan composed of them.
  using Offer = std::function<double(const std::vector<Configuration>&)>;
  // `first`: known steps, with their sum [s]. Requires: at least one mover.
  void Run(std::vector<Configuration> first, double first_sum, const Offer& offer);

 private:
  std::int64_t movers() const noexcept { return static_cast<std::int64_t>(task_.starts.size()); }
  std::int64_t Size(const std::vector<Configuration>& steps) const noexcept {
    return movers() * static_cast<std::int64_t>(steps.size());
  }
  void FindSome(const Offer& offer);
  void ImproveBest(const Offer& offer);
  void ImproveTails(std::vector<Configuration> now, double least, const Offer& offer);

  const Grid& grid_;
  const Task& task_;
  const StepTables& tables_;
  const std::vector<std::int32_t>& pools_;
  std::uint64_t seed_;
  std::int64_t cells_, budget_, spent_ = 0;  // budget and spent: states of repair; the budget is available twice
  std::unique_ptr<Repair> best_;
};

}  // namespace takt::routing
