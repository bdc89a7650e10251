#include "takt/routing/compose.h"

#include <algorithm>
#include <compare>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace takt::routing {
namespace {

struct PassageId {
  MoverIndex mover = kNone;
  std::size_t index = 0;
  auto operator<=>(const PassageId&) const = default;
};

struct Passage {
  CellIndex place = 0;
  std::size_t step = 0;
  PassageId before{};    // the preceding passage of the place
  double left = -1;      // [s] when the place is freed; negative: not known yet
  double departure = 0;  // [s] of the run that leaves the place
  Direction lane = Direction::kNone;
  int count = 0, along = 0;
};

class Composer {
 public:
  Composer(const Grid& grid, const std::vector<Configuration>& steps) : grid_(grid), passages_(steps.front().size()) {
    std::vector<std::vector<std::tuple<std::size_t, PassageId>>> at(static_cast<std::size_t>(grid.size()));
    for (std::size_t i = 0; i < passages_.size(); ++i) {
      for (std::size_t step = 0; step < steps.size(); ++step) {
        const CellIndex place = steps[step][i];
        if (step > 0 && steps[step - 1][i] == place) continue;
        at[static_cast<std::size_t>(place)].push_back({step, {static_cast<MoverIndex>(i), passages_[i].size()}});
        passages_[i].push_back({.place = place, .step = step});
      }
    }
    for (auto& its : at) {
      std::sort(its.begin(), its.end());
      for (std::size_t k = 1; k < its.size(); ++k) passage(std::get<1>(its[k])).before = std::get<1>(its[k - 1]);
    }
  }

  std::optional<std::vector<Legs>> Run() {
    std::vector<Legs> legs(passages_.size());
    std::vector<std::size_t> at(passages_.size(), 0);  // the present passage of each mover, since:
    std::vector<double> since(passages_.size(), 0);
    using Entry = std::pair<double, MoverIndex>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (std::size_t i = 0; i < passages_.size(); ++i) open.emplace(0.0, static_cast<MoverIndex>(i));
    std::map<PassageId, std::vector<MoverIndex>> waiting;
    while (!open.empty()) {
      const MoverIndex mover = open.top().second;
      open.pop();
      const auto i = static_cast<std::size_t>(mover);
      std::vector<Passage>& its = passages_[i];
      const std::size_t first = at[i];
      if (first + 1 >= its.size()) continue;
      const CellIndex step = its[first + 1].place - its[first].place;
      std::size_t last = first;
      while (last + 1 < its.size() && its[last + 1].place - its[last].place == step && Known(mover, its[last + 1])) {
        ++last;
      }
      if (last == first) {
        waiting[its[first + 1].before].push_back(mover);
        continue;
      }
      const std::size_t stop = BestStop(mover, first, last, since[i]);
      const double departure = Departure(mover, first, stop, since[i]);
      const int count = static_cast<int>(stop - first);
      legs[i].push_back({departure, its[first].place, its[stop].place});
      const Direction lane = grid_.Towards(its[first].place, its[stop].place);
      for (std::size_t k = first; k < stop; ++k) {
        its[k].left = departure + grid_.Exit(count, static_cast<int>(k - first));
        its[k].departure = departure;
        its[k].lane = lane;
        its[k].count = count;
        its[k].along = grid_.Along(lane, its[first].place);
        const auto found = waiting.find({mover, k});
        if (found == waiting.end()) continue;
        for (const MoverIndex other : found->second) open.emplace(since[static_cast<std::size_t>(other)], other);
        waiting.erase(found);
      }
      at[i] = stop;
      since[i] = departure + grid_.Duration(count);
      open.emplace(since[i], mover);
    }
    for (std::size_t i = 0; i < passages_.size(); ++i) {
      if (at[i] + 1 < passages_[i].size()) return std::nullopt;
    }
    return legs;
  }

 private:
  Passage& passage(const PassageId& id) noexcept { return passages_[static_cast<std::size_t>(id.mover)][id.index]; }
  const Passage* Before(MoverIndex mover, const Passage& one) noexcept {
    return one.before.mover == kNone || one.before.mover == mover ? nullptr : &passage(one.before);
  }
  bool Known(MoverIndex mover, const Passage& one) noexcept {
    const Passage* before = Before(mover, one);
    return !before || before->left >= 0;
  }

  // Returns the earliest departure [s], not before `at`, of a run from one passage to another.
  double Departure(MoverIndex mover, std::size_t from, std::size_t to, double at) noexcept {
    const std::vector<Passage>& its = passages_[static_cast<std::size_t>(mover)];
    const int count = static_cast<int>(to - from);
    const Direction lane = grid_.Towards(its[from].place, its[to].place);
    const int along = grid_.Along(lane, its[from].place);
    for (std::size_t k = from + 1; k <= to; ++k) {
      const Passage* before = Before(mover, its[k]);
      if (!before) continue;
      const double entry = grid_.Entry(count, static_cast<int>(k - from));
      if (before->lane != lane) {
        at = std::max(at, before->left - entry);
        continue;
      }
      at = std::max(
          {at, before->departure - entry, before->departure + grid_.Lag(before->count, count, before->along - along)});
      if (k == to) at = std::max(at, before->left - grid_.Duration(count));  // the mover rests there
    }
    return at;
  }

  // Returns the end of the next run: the last passage, or a stop on the way, which frees the places before it earlier,
  // if the arrival is earlier then.
  std::size_t BestStop(MoverIndex mover, std::size_t first, std::size_t last, double at) noexcept {
    const auto duration = [&](std::size_t a, std::size_t b) { return grid_.Duration(static_cast<int>(b - a)); };
    std::size_t best = last;
    double arrival = Departure(mover, first, last, at) + duration(first, last);
    for (std::size_t stop = first + 1; stop < last; ++stop) {
      double time = Departure(mover, first, stop, at) + duration(first, stop);
      time = Departure(mover, stop, last, time) + duration(stop, last);
      if (time < arrival - kTimeRounding) {
        arrival = time;
        best = stop;
      }
    }
    return best;
  }

  const Grid& grid_;
  std::vector<std::vector<Passage>> passages_;  // by mover
};

}  // namespace

std::optional<std::vector<Legs>> Compose(const Grid& grid, const std::vector<Configuration>& steps) {
  return Composer(grid, steps).Run();
}

}  // namespace takt::routing
