// Steps for many movers, found by repair. First each mover takes the path with the fewest conflicts with those before
// it; then movers in conflict are replanned, a few at a time, until no conflict is left (MAPF-LNS2: Li et al., AAAI
// 2022). After that the sum of the arrivals is reduced in the same manner (MAPF-LNS: Li et al., IJCAI 2021). If many
// places are occupied, the result has far fewer steps than that of FindSteps; but the search is not complete.
//
// Two movers are in conflict if they are at one place at a time, exchange places, or take part in a ring in which each
// enters the place of the next. To enter a place in the step in which another mover leaves it is no conflict: Compose
// lets the mover wait until the place is empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "takt/routing/random.h"
#include "takt/routing/steps.h"

namespace takt::routing {

class Repair {
 public:
  // Keeps references to all but the task. Not to be copied or moved. `pools`: as in ImproveOptions.
  Repair(const Grid& grid, Task task, const StepTables& tables, const std::vector<std::int32_t>& pools,
         std::uint64_t seed);
  Repair(const Repair&) = delete;
  Repair& operator=(const Repair&) = delete;

  // Returns the size of the tables, which have a row for each step and a column for each place.
  static std::int64_t Cells(const Grid& grid, const Task& task, const StepTables& tables);

  // Returns true if no conflict is left; false if the search gives up, at the latest after `effort` expanded states.
  bool Find(std::int64_t effort);
  // Reduces the sum of the arrivals. Worse steps are accepted with a probability that falls with `heat` [steps], so the
  // last steps need not be the best. Requires: Find returned true.
  void Improve(std::int64_t effort, double heat);

  // Returns the configurations step by step; the first are the starts. Requires: Find returned true.
  std::vector<Configuration> steps() const;
  std::int64_t sum() const noexcept { return sum_; }              // [steps] sum of all arrivals
  std::int64_t least_sum() const noexcept { return least_sum_; }  // [steps] if each mover were alone
  std::int64_t looked_at() const noexcept { return looked_at_; }  // number of states expanded so far

 private:
  using Movers = std::vector<MoverIndex>;
  using Steps = std::vector<CellIndex>;  // place of one mover, by step

  static int LastStep(const Task& task, const StepTables& tables);
  std::size_t Cell(int step, CellIndex place) const noexcept {
    return static_cast<std::size_t>(step) * places_ + static_cast<std::size_t>(place);
  }
  std::size_t Line(MoverIndex mover, int step) const noexcept {
    return static_cast<std::size_t>(mover) * (static_cast<std::size_t>(last_) + 1) + static_cast<std::size_t>(step);
  }
  CellIndex PlaceOf(MoverIndex mover, int step) const noexcept { return where_[Line(mover, step)]; }
  // Calls `see` with each mover at the place in that step.
  template <typename See>
  void ForMoversAt(int step, CellIndex place, const See& see) const {
    for (MoverIndex i = first_at_[Cell(step, place)]; i != kNone; i = next_at_[Line(i, step)]) see(i);
  }
  // Calls `see` with each mover in conflict with a mover that is at `from` in that step, and at `to` in the next.
  template <typename See>
  void ForConflicts(int step, CellIndex from, CellIndex to, const See& see) const;

  const std::vector<std::int32_t>& Left(MoverIndex mover) const { return *At(left_, mover); }
  int Alone(MoverIndex mover) const { return At(Left(mover), At(task_.starts, mover)); }
  int Delay(MoverIndex mover) const { return At(arrivals_, mover) - Alone(mover); }
  // Returns the number of visits of the place by other movers after that step.
  int TakenAfter(int step, CellIndex place) const;

  void Put(MoverIndex mover, const Steps& steps);
  Steps Remove(MoverIndex mover);
  void CountConflicts(MoverIndex mover);
  void ForgetConflicts(MoverIndex mover);

  // Finds the steps of one mover with the fewest conflicts, of these the shortest: with at most `conflicts`, and with
  // an arrival before `bound`. Returns true if it has found some before `end_` states were expanded; they are in
  // `found_` then.
  bool Search(MoverIndex mover, int conflicts, int bound);

  static void Add(Movers& movers, MoverIndex one);
  void AddNeighbours(Movers& movers, std::size_t most);
  Movers SomeInConflict();
  Movers SomeDelayed();
  void RepairSubset(Movers movers);
  void ImproveSubset(Movers movers, double heat);

  const Grid& grid_;
  Task task_;
  const std::vector<std::int32_t>& pools_;
  Random random_;
  MoverIndex count_;
  std::size_t places_;
  int last_;  // last step: all movers have to be at their targets by then
  std::vector<std::int32_t> anywhere_;
  std::vector<const std::vector<std::int32_t>*> left_;  // by mover: steps to its target
  std::vector<CellIndex> where_;                        // by mover and step
  std::vector<MoverIndex> first_at_;                    // by step and place: head of the list of movers there ...
  std::vector<MoverIndex> next_at_;                     // by mover and step: the next one in that list
  std::vector<int> arrivals_;                           // by mover: step
  std::vector<Movers> in_conflict_;                     // by mover: the movers in conflict with it
  std::int64_t conflicts_ = 0;                          // number of pairs of movers
  std::int64_t sum_ = 0, least_sum_ = 0, looked_at_ = 0, end_ = 0;

  // State of the search, by step and place
  std::vector<std::uint32_t> reached_;  // number of the search that has reached the cell
  std::vector<std::int32_t> its_conflicts_, from_;
  std::uint32_t search_ = 0;
  std::vector<std::vector<std::vector<std::int32_t>>> open_;  // cells by conflicts and estimate
  std::vector<int> taken_after_;  // visits of the target by other movers after that step, by step
  Steps found_;
};

}  // namespace takt::routing
