#include "takt/routing/improve.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "takt/core/maths.h"

namespace takt::routing {
namespace {

constexpr std::int64_t kMostStates = 20'000;  // for one mover of an improvement
constexpr double kGain = 1e-6;                // [s]

// Returns the shortest time [s] after which a mover can have left a place.
double LeavesAfter(const Grid& grid, CellIndex place) {
  double least = kForever;
  for (const Direction direction : kDirections) {
    const int room = grid.Room(direction, place);
    if (room > 0) least = std::min(least, grid.Exit(room, 0));
  }
  return least;
}

class Improver {
 public:
  Improver(const Grid& grid, const Task& task, Alone& alone, Plan plan, const ImproveOptions& how)
      : grid_(grid),
        task_(task),
        alone_(alone),
        how_(how),
        random_(how.seed),
        sipp_(grid),
        timetable_(grid, task.starts.size()),
        count_(static_cast<MoverIndex>(task.starts.size())),
        now_(std::move(plan)) {
    for (MoverIndex i = 0; i < count_; ++i) {
      timetable_.Add(i, At(task_.starts, i), At(now_.legs, i));
      arrivals_.push_back(Arrival(grid, At(now_.legs, i)));
      sum_ += arrivals_.back();
    }
    best_ = now_;
    best_sum_ = sum_;
  }

  Plan Run() {
    constexpr int kMostSweeps = 60;
    constexpr double kSweepWeight = 2, kLeastGain = 0.99;
    for (int i = 0; i < kMostSweeps && Left(); ++i) {
      const double before = sum_;
      Sweep(kSweepWeight);
      Keep();
      if (sum_ > before * kLeastGain) break;
    }
    constexpr double kHeat = 0.05;  // of the mean time alone
    const std::int64_t from = sipp_.expanded();
    const double mean = std::accumulate(arrivals_.begin(), arrivals_.end(), 0.0) / std::max<double>(1, count_);
    // Each try costs at least 1, so that tries without states end, too.
    while (Left()) {
      const double passed =
          static_cast<double>(spent() - from) / static_cast<double>(std::max<std::int64_t>(1, how_.effort - from));
      heat_ = kHeat * mean * std::max(0.0, 1 - 1.1 * passed);
      Try();
      Keep();
      ++tries_;
    }
    return best_;
  }

 private:
  std::int64_t spent() const noexcept { return sipp_.expanded() + tries_; }
  bool Left() const noexcept { return count_ > 0 && spent() < how_.effort; }
  double TimeAlone(MoverIndex mover) { return alone_(At(task_.starts, mover), At(now_.targets, mover)); }
  double Delay(MoverIndex mover) { return std::max(0.0, At(arrivals_, mover) - TimeAlone(mover)); }
  void Keep() {
    if (sum_ >= best_sum_ - kGain) return;
    best_sum_ = sum_;
    best_ = now_;
  }

  void Sweep(double weight) {
    std::vector<MoverIndex> order(static_cast<std::size_t>(count_));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](MoverIndex a, MoverIndex b) { return At(arrivals_, a) < At(arrivals_, b); });
    for (const MoverIndex mover : order) {
      if (Left()) PlanAnew({mover}, weight);
      ++tries_;
    }
  }

  void Try() {
    constexpr std::size_t kMost = 8;
    constexpr double kWeight = 1.3;
    const std::size_t most = 1 + random_.Below(kMost);
    const auto kind = random_.Below(3);
    std::vector<MoverIndex> movers;
    if (kind == 2) {
      for (std::size_t i = 0; i < most; ++i) Add(movers, static_cast<MoverIndex>(random_.Below(arrivals_.size())));
    } else {
      const MoverIndex first = Delayed();
      movers.push_back(first);
      if (kind == 0) {
        for (const MoverIndex other : InTheWayOf(first)) {
          if (movers.size() < most) Add(movers, other);
        }
      } else {
        AddEncountered(movers, most);
      }
    }
    random_.Shuffle(movers);
    if (kind != 2 && random_.Below(2) == 0) {
      std::stable_sort(movers.begin(), movers.end(), [&](MoverIndex a, MoverIndex b) { return Delay(a) > Delay(b); });
    }
    PlanAnew(movers, random_.Below(2) == 0 ? 1.0 : kWeight);
  }

  static void Add(std::vector<MoverIndex>& movers, MoverIndex one) {
    if (std::find(movers.begin(), movers.end(), one) == movers.end()) movers.push_back(one);
  }
  // Draws a mover at random, with a probability that grows with its delay.
  MoverIndex Delayed() {
    constexpr double kAnyway = 1e-4;
    double sum = 0;
    for (MoverIndex i = 0; i < count_; ++i) sum += Delay(i) + kAnyway;
    double at = random_.Unit() * sum;
    for (MoverIndex i = 0; i + 1 < count_; ++i) {
      at -= Delay(i) + kAnyway;
      if (at <= 0) return i;
    }
    return count_ - 1;
  }
  // Returns movers that occupy places of the fastest path of the mover alone while it could be there.
  std::vector<MoverIndex> InTheWayOf(MoverIndex mover) {
    std::vector<MoverIndex> found;
    const std::vector<double>& alone = alone_.To(At(now_.targets, mover));
    const double delay = Delay(mover);
    double time = 0;
    for (CellIndex place = At(task_.starts, mover); place != At(now_.targets, mover);) {
      CellIndex next = kNone;
      double least = kForever;
      for (const Direction direction : kDirections) {
        for (int count = 1; count <= grid_.Room(direction, place); ++count) {
          const CellIndex to = place + count * grid_.Step(direction);
          const double one = grid_.Duration(count) + At(alone, to);
          if (one < least - kTimeRounding) {
            least = one;
            next = to;
          }
        }
      }
      if (next == kNone) break;
      const int count = grid_.Count(place, next);
      const CellIndex step = grid_.Step(grid_.Towards(place, next));
      for (int k = 0; k <= count; ++k) {
        const double from = time + grid_.Entry(count, k), to = time + grid_.Exit(count, k) + delay;
        for (const Stay& stay : timetable_.stays(place + k * step)) {
          if (stay.who != mover && stay.to > from && (k == count || stay.from < to)) Add(found, stay.who);
        }
      }
      time += grid_.Duration(count);
      place = next;
    }
    random_.Shuffle(found);
    return found;
  }
  // Adds movers that visit the same places in the present plan.
  void AddEncountered(std::vector<MoverIndex>& movers, std::size_t most) {
    for (int guard = 0; guard < 100 && movers.size() < most; ++guard) {
      const auto& places = timetable_.places_of(movers[random_.Below(movers.size())]);
      if (places.empty()) return;
      for (const Stay& stay : timetable_.stays(places[random_.Below(places.size())])) {
        if (movers.size() < most) Add(movers, stay.who);
      }
    }
  }

  // Replans these movers one after the other; undone if the sum gets worse by more than the heat allows.
  void PlanAnew(const std::vector<MoverIndex>& movers, double weight) {
    double before = 0, alone = 0;
    std::vector<CellIndex> old_targets;
    std::vector<Legs> old_legs;
    for (const MoverIndex i : movers) {
      before += At(arrivals_, i);
      old_targets.push_back(At(now_.targets, i));
      old_legs.push_back(At(now_.legs, i));
    }
    if (!how_.pools.empty() && movers.size() > 1 && random_.Below(2) == 0) {
      const MoverIndex a = movers[0], b = movers[1 + random_.Below(movers.size() - 1)];
      const bool exchangeable = At(how_.pools, a) != kNone && At(how_.pools, a) == At(how_.pools, b);
      if (exchangeable && At(task_.targets, a) != kNone && At(task_.targets, b) != kNone) {
        std::swap(At(now_.targets, a), At(now_.targets, b));
      }
    }
    for (const MoverIndex i : movers) {
      timetable_.Remove(i);
      alone += TimeAlone(i);
    }
    for (const MoverIndex i : movers)
      timetable_.Rest(At(task_.starts, i), -1, LeavesAfter(grid_, At(task_.starts, i)), i);
    const double allowed = before + (heat_ > 0 ? -heat_ * maths::Log(1 - random_.Unit()) : 0);
    double sum = 0;
    bool good = alone < allowed + kTimeRounding;
    std::size_t done = 0;
    for (; good && done < movers.size(); ++done) {
      const MoverIndex i = movers[done];
      const CellIndex start = At(task_.starts, i);
      alone -= TimeAlone(i);
      timetable_.Remove(i);
      std::optional<Legs> legs;
      if (At(task_.targets, i) == kNone && timetable_.stays(start).empty()) {
        At(now_.targets, i) = start;  // no other mover needs its place any more
        legs.emplace();
      } else {
        legs = sipp_.Find(timetable_, {.start = start,
                                       .target = At(now_.targets, i),
                                       .alone = &alone_.To(At(now_.targets, i)),
                                       .bound = allowed - sum - alone + kGain,
                                       .weight = weight,
                                       .most = kMostStates});
      }
      if (!legs) {
        good = false;
        break;
      }
      sum += Arrival(grid_, *legs);
      timetable_.Add(i, start, *legs);
      At(now_.legs, i) = *std::move(legs);
    }
    if (good && sum <= allowed + kTimeRounding) {
      for (const MoverIndex i : movers) At(arrivals_, i) = Arrival(grid_, At(now_.legs, i));
      sum_ += sum - before;
      return;
    }
    for (std::size_t k = 0; k < movers.size(); ++k) {
      timetable_.Remove(movers[k]);
      At(now_.targets, movers[k]) = old_targets[k];
      At(now_.legs, movers[k]) = std::move(old_legs[k]);
    }
    for (const MoverIndex i : movers) timetable_.Add(i, At(task_.starts, i), At(now_.legs, i));
  }

  const Grid& grid_;
  const Task& task_;
  Alone& alone_;
  const ImproveOptions how_;
  Random random_;
  Sipp sipp_;
  Timetable timetable_;
  MoverIndex count_;
  Plan now_, best_;
  std::vector<double> arrivals_;
  double sum_ = 0, best_sum_ = 0, heat_ = 0;
  std::int64_t tries_ = 0;
};

}  // namespace

double SumOf(const Grid& grid, const Plan& plan) {
  double sum = 0;
  for (const Legs& legs : plan.legs) sum += Arrival(grid, legs);
  return sum;
}

std::optional<Plan> PlanPrioritised(const Grid& grid, const Task& task, Alone& alone, int tries, std::int64_t effort) {
  const std::size_t count = task.starts.size();
  std::vector<CellIndex> targets;
  for (std::size_t i = 0; i < count; ++i)
    targets.push_back(task.targets[i] == kNone ? task.starts[i] : task.targets[i]);
  std::vector<MoverIndex> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](MoverIndex a, MoverIndex b) {
    return alone(At(task.starts, a), At(targets, a)) < alone(At(task.starts, b), At(targets, b));
  });
  Sipp sipp(grid);
  for (int i = 0; i < tries && sipp.expanded() < effort; ++i) {
    Timetable timetable(grid, count);
    // All movers occupy their starts until they can have left them.
    for (MoverIndex k = 0; k < static_cast<MoverIndex>(count); ++k) {
      timetable.Rest(At(task.starts, k), -1, LeavesAfter(grid, At(task.starts, k)), k);
    }
    std::vector<Legs> legs(count);
    std::size_t k = 0;
    for (; k < count; ++k) {
      const MoverIndex mover = order[k];
      timetable.Remove(mover);
      std::optional<Legs> found = sipp.Find(
          timetable,
          {.start = At(task.starts, mover), .target = At(targets, mover), .alone = &alone.To(At(targets, mover))});
      if (!found) break;
      timetable.Add(mover, At(task.starts, mover), *found);
      At(legs, mover) = *std::move(found);
    }
    if (k == count) return Plan{.legs = std::move(legs), .targets = std::move(targets)};
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(k),
                order.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  }
  return std::nullopt;
}

Plan Improve(const Grid& grid, const Task& task, Alone& alone, Plan plan, const ImproveOptions& how) {
  return Improver(grid, task, alone, std::move(plan), how).Run();
}

}  // namespace takt::routing
