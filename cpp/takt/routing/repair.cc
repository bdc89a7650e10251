#include "takt/routing/repair.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "takt/core/maths.h"

namespace takt::routing {
namespace {

constexpr std::size_t kMostMovers = 8;  // replanned together
constexpr int kMostConflicts = 400;     // of one mover
constexpr int kMoreSteps = 20;          // than twice the longest path
constexpr int kMostDraws = 40;          // of a set of movers

}  // namespace

int Repair::LastStep(const Task& task, const StepTables& tables) {
  std::int32_t longest = 0;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    if (task.targets[i] != kNone) longest = std::max(longest, At(tables.at(task.targets[i]), task.starts[i]));
  }
  return 2 * longest + kMoreSteps;
}

std::int64_t Repair::Cells(const Grid& grid, const Task& task, const StepTables& tables) {
  return static_cast<std::int64_t>(LastStep(task, tables) + 1) * grid.size();
}

Repair::Repair(const Grid& grid, Task task, const StepTables& tables, const std::vector<std::int32_t>& pools,
               std::uint64_t seed)
    : grid_(grid),
      task_(std::move(task)),
      pools_(pools),
      random_(seed),
      count_(static_cast<MoverIndex>(task_.starts.size())),
      places_(static_cast<std::size_t>(grid.size())),
      last_(LastStep(task_, tables)),
      anywhere_(places_, 0),
      where_(Line(count_, 0), kNone),
      first_at_(Cell(last_ + 1, 0), kNone),
      next_at_(where_.size(), kNone),
      arrivals_(task_.starts.size(), 0),
      in_conflict_(task_.starts.size()),
      reached_(first_at_.size(), 0),
      its_conflicts_(first_at_.size(), 0),
      from_(first_at_.size(), kNone) {
  for (const CellIndex target : task_.targets) left_.push_back(target == kNone ? &anywhere_ : &tables.at(target));
  for (MoverIndex i = 0; i < count_; ++i) least_sum_ += Alone(i);
}

// --- Positions of the movers ----------------------------------------------------------------------------------------

template <typename See>
void Repair::ForConflicts(int step, CellIndex from, CellIndex to, const See& see) const {
  ForMoversAt(step + 1, to, see);
  if (from == to) return;
  ForMoversAt(step, to, [&](MoverIndex other) {
    // A chain of movers, each of which enters the place that the next one leaves: does it lead back to `from`?
    CellIndex at = to, next = PlaceOf(other, step + 1);
    for (MoverIndex k = 0; k < count_ && next != at; ++k) {
      if (next == from) {
        see(other);
        return;
      }
      const MoverIndex ahead = first_at_[Cell(step, next)];
      if (ahead == kNone) return;
      at = std::exchange(next, PlaceOf(ahead, step + 1));
    }
  });
}

int Repair::TakenAfter(int step, CellIndex place) const {
  int count = 0;
  for (int k = step + 1; k <= last_; ++k) ForMoversAt(k, place, [&](MoverIndex) { ++count; });
  return count;
}

void Repair::Put(MoverIndex mover, const Steps& steps) {
  int arrival = 0;
  for (int k = 0; k <= last_; ++k) {
    const CellIndex place = steps[static_cast<std::size_t>(k)];
    where_[Line(mover, k)] = place;
    next_at_[Line(mover, k)] = std::exchange(first_at_[Cell(k, place)], mover);
    if (k > 0 && place != steps[static_cast<std::size_t>(k) - 1]) arrival = k;
  }
  At(arrivals_, mover) = arrival;
  sum_ += arrival;
}

Repair::Steps Repair::Remove(MoverIndex mover) {
  Steps steps;
  for (int k = 0; k <= last_; ++k) {
    steps.push_back(PlaceOf(mover, k));
    MoverIndex* link = &first_at_[Cell(k, steps.back())];
    while (*link != mover) link = &next_at_[Line(*link, k)];
    *link = next_at_[Line(mover, k)];
  }
  sum_ -= At(arrivals_, mover);
  return steps;
}

void Repair::CountConflicts(MoverIndex mover) {
  ForgetConflicts(mover);
  Movers& its = At(in_conflict_, mover);
  for (int k = 0; k < last_; ++k) {
    ForConflicts(k, PlaceOf(mover, k), PlaceOf(mover, k + 1), [&](MoverIndex other) {
      if (other != mover) Add(its, other);
    });
  }
  for (const MoverIndex other : its) At(in_conflict_, other).push_back(mover);
  conflicts_ += static_cast<std::int64_t>(its.size());
}

void Repair::ForgetConflicts(MoverIndex mover) {
  Movers& its = At(in_conflict_, mover);
  for (const MoverIndex other : its) std::erase(At(in_conflict_, other), mover);
  conflicts_ -= static_cast<std::int64_t>(its.size());
  its.clear();
}

// --- The steps of one mover -----------------------------------------------------------------------------------------

bool Repair::Search(MoverIndex mover, int conflicts, int bound) {
  const std::vector<std::int32_t>& left = Left(mover);
  const CellIndex target = At(task_.targets, mover), start = At(task_.starts, mover);
  int earliest = 0;  // first step from which the mover can stay at its target without a conflict
  taken_after_.assign(static_cast<std::size_t>(last_) + 1, 0);
  if (target != kNone) {
    int count = 0;
    for (int k = last_; k >= 0; --k) {
      taken_after_[static_cast<std::size_t>(k)] = count;
      ForMoversAt(k, target, [&](MoverIndex) { ++count; });
      if (count > 0 && earliest == 0) earliest = k + 1;
    }
  }
  const int least = conflicts == 0 ? earliest : 0;
  bound = std::min(bound, last_ + 1);
  ++search_;
  for (std::size_t row = 0; row < open_.size() && row <= static_cast<std::size_t>(conflicts); ++row) {
    for (auto& cells : open_[row]) cells.clear();
  }
  const auto push = [&](int step, CellIndex place, int with, std::int32_t from) {
    const std::size_t cell = Cell(step, place);
    const int estimate = std::max(step + At(left, place), least);
    if (with > conflicts || estimate >= bound || (reached_[cell] == search_ && its_conflicts_[cell] <= with)) return;
    reached_[cell] = search_;
    its_conflicts_[cell] = with;
    from_[cell] = from;
    const auto row = static_cast<std::size_t>(with);
    if (open_.size() <= row) open_.resize(row + 1);
    if (open_[row].empty()) open_[row].resize(static_cast<std::size_t>(last_) + 1);
    open_[row][static_cast<std::size_t>(estimate)].push_back(static_cast<std::int32_t>(cell));
  };
  push(0, start, 0, kNone);
  std::int32_t best = kNone;
  int best_conflicts = conflicts + 1, best_step = 0;
  for (int row = 0; row < std::min(best_conflicts, static_cast<int>(open_.size())); ++row) {
    for (std::size_t estimate = 0; estimate < open_[static_cast<std::size_t>(row)].size() && row < best_conflicts;) {
      // push may reallocate them: looked up anew each time.
      std::vector<std::int32_t>& cells = open_[static_cast<std::size_t>(row)][estimate];
      if (cells.empty()) {
        ++estimate;
        continue;
      }
      if (looked_at_ >= end_) return false;
      const std::int32_t cell = cells.back();
      cells.pop_back();
      if (its_conflicts_[static_cast<std::size_t>(cell)] < row) continue;
      ++looked_at_;
      const int step = cell / grid_.size();
      const CellIndex place = cell % grid_.size();
      if (target == kNone || place == target) {
        const int later = target == kNone ? TakenAfter(step, place) : taken_after_[static_cast<std::size_t>(step)];
        if (row + later < best_conflicts || (row + later == best_conflicts && step < best_step)) {
          best = cell;
          best_conflicts = row + later;
          best_step = step;
          if (later == 0) break;
        }
      }
      if (step == last_) continue;
      std::array<CellIndex, 5> to{place};
      std::size_t count = 1;
      for (const CellIndex beside : grid_.beside(place)) to[count++] = beside;
      for (std::size_t k = count; k > 1; --k) std::swap(to[k - 1], to[random_.Below(k)]);
      // The last in is the first out: nearer places come last.
      std::stable_sort(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](CellIndex a, CellIndex b) { return At(left, a) > At(left, b); });
      for (std::size_t k = 0; k < count; ++k) {
        int with = row;
        ForConflicts(step, place, to[k], [&](MoverIndex) { ++with; });
        push(step + 1, to[k], with, cell);
      }
    }
  }
  if (best == kNone) return false;
  found_.assign(static_cast<std::size_t>(last_) + 1, best % grid_.size());
  for (std::int32_t cell = best; cell != kNone; cell = from_[static_cast<std::size_t>(cell)]) {
    found_[static_cast<std::size_t>(cell / grid_.size())] = cell % grid_.size();
  }
  return true;
}

// --- Which movers ---------------------------------------------------------------------------------------------------

void Repair::Add(Movers& movers, MoverIndex one) {
  if (std::find(movers.begin(), movers.end(), one) == movers.end()) movers.push_back(one);
}

// Adds movers near some of these within a few steps.
void Repair::AddNeighbours(Movers& movers, std::size_t most) {
  constexpr int kSteps = 4;
  for (int draw = 0; draw < kMostDraws && movers.size() < most; ++draw) {
    const MoverIndex one = movers[random_.Below(movers.size())];
    const auto step = static_cast<int>(random_.Below(static_cast<std::size_t>(At(arrivals_, one)) + 1));
    CellIndex place = PlaceOf(one, step);
    const auto beside = grid_.beside(place);
    if (const std::size_t k = random_.Below(beside.size() + 1); k < beside.size()) place = beside[k];
    const int then = step + static_cast<int>(random_.Below(2 * kSteps + 1)) - kSteps;
    ForMoversAt(std::clamp(then, 0, last_), place, [&](MoverIndex other) {
      if (movers.size() < most) Add(movers, other);
    });
  }
}

Repair::Movers Repair::SomeInConflict() {
  Movers all;
  for (MoverIndex i = 0; i < count_; ++i) {
    if (!At(in_conflict_, i).empty()) all.push_back(i);
  }
  Movers movers{all[random_.Below(all.size())]};
  const std::size_t most = std::min(2 + random_.Below(kMostMovers - 1), static_cast<std::size_t>(count_));
  switch (random_.Below(3)) {
    case 0:  // movers in conflict with one another
      for (int draw = 0; draw < kMostDraws && movers.size() < most; ++draw) {
        const Movers& others = At(in_conflict_, movers[random_.Below(movers.size())]);
        if (!others.empty()) Add(movers, others[random_.Below(others.size())]);
      }
      break;
    case 1:
      AddNeighbours(movers, most);
      break;
    default:
      while (movers.size() < most) Add(movers, static_cast<MoverIndex>(random_.Below(in_conflict_.size())));
  }
  random_.Shuffle(movers);
  return movers;
}

Repair::Movers Repair::SomeDelayed() {
  const std::size_t most = 1 + random_.Below(kMostMovers);
  const std::size_t kind = random_.Below(3);
  Movers movers;
  if (kind == 2) {
    for (std::size_t k = 0; k < most; ++k) Add(movers, static_cast<MoverIndex>(random_.Below(arrivals_.size())));
  } else {
    // A mover at random, with a probability that is proportional to its delay.
    auto at = static_cast<std::int64_t>(random_.Below(static_cast<std::size_t>(sum_ - least_sum_)));
    MoverIndex late = 0;
    while (late + 1 < count_ && (at -= Delay(late)) >= 0) ++late;
    movers.push_back(late);
    // Movers on a shorter path of that mover.
    const std::vector<std::int32_t>& left = Left(late);
    for (int draw = 0; kind == 0 && draw < kMostDraws && movers.size() < most; ++draw) {
      int step = static_cast<int>(random_.Below(static_cast<std::size_t>(std::max(1, At(arrivals_, late)))));
      for (CellIndex place = PlaceOf(late, step); step < last_ && movers.size() < most; ++step) {
        std::array<CellIndex, 5> quicker{};
        std::size_t count = 0;
        const auto consider = [&](CellIndex to) {
          if (step + 1 + At(left, to) < At(arrivals_, late)) quicker[count++] = to;
        };
        consider(place);
        for (const CellIndex beside : grid_.beside(place)) consider(beside);
        if (count == 0) break;
        place = quicker[random_.Below(count)];
        for (const int then : {step, step + 1}) {
          ForMoversAt(then, place, [&](MoverIndex other) {
            if (movers.size() < most) Add(movers, other);
          });
        }
      }
    }
    if (kind == 1) AddNeighbours(movers, most);
  }
  random_.Shuffle(movers);
  if (random_.Below(2) == 0) {
    std::stable_sort(movers.begin(), movers.end(), [&](MoverIndex a, MoverIndex b) { return Delay(a) > Delay(b); });
  }
  return movers;
}

// --- Replanning some movers -----------------------------------------------------------------------------------------

// Replans these movers; undone if that makes more conflicts.
void Repair::RepairSubset(Movers movers) {
  const std::int64_t before = conflicts_;
  std::vector<Steps> old;
  for (const MoverIndex i : movers) {
    ForgetConflicts(i);
    old.push_back(Remove(i));
  }
  std::size_t done = 0;
  for (; done < movers.size() && Search(movers[done], kMostConflicts, last_ + 1); ++done) {
    Put(movers[done], found_);
    CountConflicts(movers[done]);
  }
  if (done == movers.size() && conflicts_ <= before) return;
  while (done-- > 0) {
    ForgetConflicts(movers[done]);
    Remove(movers[done]);
  }
  for (std::size_t k = 0; k < movers.size(); ++k) {
    Put(movers[k], old[k]);
    CountConflicts(movers[k]);
  }
}

// Replans these movers; undone if their arrivals get later by more than the heat allows.
void Repair::ImproveSubset(Movers movers, double heat) {
  std::int64_t before = sum_, alone = 0;
  std::vector<Steps> old;
  for (const MoverIndex i : movers) old.push_back(Remove(i));
  before -= sum_;
  // Two of a pool may exchange their targets.
  MoverIndex a = kNone, b = kNone;
  if (!pools_.empty() && movers.size() > 1 && random_.Below(2) == 0) {
    a = movers[0];
    b = movers[1 + random_.Below(movers.size() - 1)];
    const bool both = At(task_.targets, a) != kNone && At(task_.targets, b) != kNone;
    if (!both || At(pools_, a) == kNone || At(pools_, a) != At(pools_, b)) a = b = kNone;
  }
  const auto exchange = [&] {
    if (a == kNone) return;
    least_sum_ -= Alone(a) + Alone(b);
    std::swap(At(task_.targets, a), At(task_.targets, b));
    std::swap(At(left_, a), At(left_, b));
    least_sum_ += Alone(a) + Alone(b);
  };
  exchange();
  for (const MoverIndex i : movers) alone += Alone(i);
  const std::int64_t others = sum_;
  const double worse = heat > 0 ? -heat * maths::Log(1 - random_.Unit()) : 0;
  const std::int64_t allowed = before + static_cast<std::int64_t>(std::min(worse, 1e6));
  std::size_t done = 0;
  for (; done < movers.size(); ++done) {
    alone -= Alone(movers[done]);
    const std::int64_t bound = allowed - (sum_ - others) - alone + 1;
    if (bound <= 0 || !Search(movers[done], 0, static_cast<int>(std::min<std::int64_t>(bound, last_ + 1)))) break;
    Put(movers[done], found_);
  }
  if (done == movers.size()) return;
  while (done-- > 0) Remove(movers[done]);
  exchange();
  for (std::size_t k = 0; k < movers.size(); ++k) Put(movers[k], old[k]);
}

bool Repair::Find(std::int64_t effort) {
  end_ = effort;
  Movers order(static_cast<std::size_t>(count_));
  std::iota(order.begin(), order.end(), 0);
  random_.Shuffle(order);
  for (const MoverIndex i : order) {
    if (!Search(i, kMostConflicts, last_ + 1)) return false;
    Put(i, found_);
  }
  // A ring may form although its last mover has not been counted: all conflicts are counted anew before the search
  // ends.
  for (;;) {
    for (const MoverIndex i : order) CountConflicts(i);
    if (conflicts_ == 0) return true;
    while (conflicts_ > 0) {
      if (looked_at_ >= end_) return false;
      RepairSubset(SomeInConflict());
      ++looked_at_;
    }
  }
}

void Repair::Improve(std::int64_t effort, double heat) {
  end_ = looked_at_ + effort;
  while (looked_at_ < end_ && sum_ > least_sum_) {
    ImproveSubset(SomeDelayed(), heat);
    ++looked_at_;
  }
}

std::vector<Configuration> Repair::steps() const {
  const int end = arrivals_.empty() ? 0 : *std::max_element(arrivals_.begin(), arrivals_.end());
  std::vector<Configuration> steps(static_cast<std::size_t>(end) + 1);
  for (int k = 0; k <= end; ++k) {
    for (MoverIndex i = 0; i < count_; ++i) steps[static_cast<std::size_t>(k)].push_back(PlaceOf(i, k));
  }
  return steps;
}

}  // namespace takt::routing
