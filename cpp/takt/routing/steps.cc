#include "takt/routing/steps.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <unordered_map>

#include "takt/routing/random.h"

namespace takt::routing {
namespace {

// Weights of PIBT's choice among places, in steps.
constexpr double kAtRandom = 0.5;
constexpr double kOccupied = 0.25;
constexpr double kStraightOn = 0.3;
constexpr double kHindrance = 0.2;  // for each neighbour that would get nearer to its target there
constexpr double kNoReason = 0.6;   // to leave, without a target

// Computes the next step with PIBT.
class Stepper {
 public:
  Stepper(const Grid& grid, const Task& task, const StepTables& tables, std::uint64_t seed)
      : grid_(grid),
        task_(task),
        random_(seed),
        anywhere_(static_cast<std::size_t>(grid.size()), 0),
        who_now_(static_cast<std::size_t>(grid.size()), kNone),
        who_next_(static_cast<std::size_t>(grid.size()), kNone),
        asked_(task.starts.size(), false) {
    for (const CellIndex target : task.targets) {
      left_.push_back(target == kNone ? &anywhere_ : &tables.at(target));
    }
  }

  Random& random() noexcept { return random_; }
  std::int32_t Left(MoverIndex mover, CellIndex place) const { return At(*At(left_, mover), place); }

  struct Constraint {
    MoverIndex mover;
    CellIndex place;
  };

  // Returns true if there is a step from `now` that satisfies the constraints; it is in `next` then.
  bool Make(const Configuration& now, const Configuration* before, const std::vector<MoverIndex>& order,
            const std::vector<Constraint>& constraints, Configuration& next) {
    now_ = &now;
    before_ = before;
    next_.assign(now.size(), kNone);
    const auto count = static_cast<MoverIndex>(now.size());
    for (MoverIndex i = 0; i < count; ++i) At(who_now_, At(now, i)) = i;
    bool good = true;
    for (const Constraint& one : constraints) {
      if (At(who_next_, one.place) != kNone) {
        good = false;
        break;
      }
      Take(one.mover, one.place);
    }
    for (std::size_t k = 0; good && k < order.size(); ++k) {
      if (At(next_, order[k]) == kNone) Choose(order[k]);
    }
    // Fails if a mover that has to stay is in the way of a constraint.
    for (MoverIndex i = 0; good && i < count; ++i) good = At(who_next_, At(next_, i)) == i;
    for (const CellIndex place : now) At(who_next_, place) = kNone;
    for (const CellIndex place : next_) {
      if (place != kNone) At(who_next_, place) = kNone;
    }
    for (const Constraint& one : constraints) At(who_next_, one.place) = kNone;
    if (good) KeepExecutableMoves();
    for (const CellIndex place : now) At(who_now_, place) = kNone;
    next = next_;
    return good;
  }

 private:
  CellIndex Now(MoverIndex mover) const { return At(*now_, mover); }
  void Take(MoverIndex mover, CellIndex place) {
    At(next_, mover) = place;
    At(who_next_, place) = mover;
  }

  // Returns true if the mover, by entering the place, would wait for itself through other movers.
  bool ClosesRing(MoverIndex mover, CellIndex place) const {
    for (;;) {
      const MoverIndex other = At(who_now_, place);
      if (other == kNone) return false;
      if (other == mover) return true;
      if (At(next_, other) == kNone) return At(asked_, other);
      if (At(next_, other) == Now(other)) return true;
      place = At(next_, other);
    }
  }

  bool Choose(MoverIndex mover) {
    struct Candidate {
      CellIndex place = kNone;
      double cost = 0;
    };
    std::array<Candidate, 5> candidates;
    std::size_t count = 0;
    const CellIndex here = Now(mover);
    const bool has_target = At(task_.targets, mover) != kNone;
    const CellIndex last = before_ ? At(*before_, mover) : here;
    const CellIndex straight_on = last == here ? kNone : 2 * here - last;
    const auto add = [&](CellIndex place) {
      double cost = Left(mover, place) + kAtRandom * random_.Unit();
      if (place != here) {
        if (At(who_now_, place) != kNone) cost += kOccupied;
        if (!has_target) cost += kNoReason;
      }
      if (place == straight_on && has_target) cost -= kStraightOn;
      for (const CellIndex beside : grid_.beside(place)) {
        const MoverIndex other = At(who_now_, beside);
        if (other != kNone && other != mover && beside != here && Left(other, place) < Left(other, beside)) {
          cost += kHindrance;
        }
      }
      candidates[count++] = {place, cost};
    };
    for (const CellIndex place : grid_.beside(here)) add(place);
    add(here);
    const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(count);
    std::stable_sort(candidates.begin(), end, [](const auto& a, const auto& b) { return a.cost < b.cost; });
    const MoverIndex partner = SwapPartner(mover, candidates[0].place);
    if (partner != kNone) std::reverse(candidates.begin(), end);
    At(asked_, mover) = true;
    for (std::size_t k = 0; k < count; ++k) {
      const CellIndex place = candidates[k].place;
      if (At(who_next_, place) != kNone) continue;
      if (place != here && ClosesRing(mover, place)) continue;
      Take(mover, place);
      const MoverIndex other = At(who_now_, place);
      if (other != kNone && other != mover && At(next_, other) == kNone && !Choose(other)) {
        At(next_, mover) = kNone;  // the other mover stays, and keeps the place
        continue;
      }
      At(asked_, mover) = false;
      if (k == 0 && partner != kNone && At(next_, partner) == kNone && At(who_next_, here) == kNone &&
          !ClosesRing(partner, here)) {
        Take(partner, here);
      }
      return true;
    }
    Take(mover, here);
    At(asked_, mover) = false;
    return false;
  }

  // --- PIBT's swap rule: two movers that have to pass each other in a narrow place back out of it together ---

  // Returns the number of places that lead on from `at`, coming from `from`; `next`: the last of them.
  int Onwards(CellIndex from, CellIndex at, CellIndex& next) const {
    int count = 0;
    for (const CellIndex place : grid_.beside(at)) {
      const MoverIndex other = At(who_now_, place);
      const bool dead_end = grid_.beside(place).size() == 1 && other != kNone && At(task_.targets, other) == place;
      if (place == from || dead_end) continue;
      ++count;
      next = place;
    }
    return count;
  }
  bool SwapNeeded(MoverIndex pusher, MoverIndex puller, CellIndex pusher_at, CellIndex puller_at) const {
    for (std::int32_t guard = grid_.size(); guard > 0; --guard) {
      if (Left(pusher, puller_at) >= Left(pusher, pusher_at)) break;
      CellIndex next = kNone;
      const int count = Onwards(pusher_at, puller_at, next);
      if (count >= 2) return false;
      if (count == 0) break;
      pusher_at = puller_at;
      puller_at = next;
    }
    return Left(puller, pusher_at) < Left(puller, puller_at) &&
           (Left(pusher, pusher_at) == 0 || Left(pusher, puller_at) < Left(pusher, pusher_at));
  }
  bool SwapPossible(CellIndex pusher_at, CellIndex puller_at) const {
    const CellIndex first = pusher_at;
    for (std::int32_t guard = grid_.size(); guard > 0 && puller_at != first; --guard) {
      CellIndex next = kNone;
      const int count = Onwards(pusher_at, puller_at, next);
      if (count >= 2) return true;
      if (count == 0) return false;
      pusher_at = puller_at;
      puller_at = next;
    }
    return false;
  }
  MoverIndex SwapPartner(MoverIndex mover, CellIndex first) const {
    const CellIndex here = Now(mover);
    if (first == here) return kNone;
    const MoverIndex ahead = At(who_now_, first);
    if (ahead != kNone && ahead != mover && At(next_, ahead) == kNone && SwapNeeded(mover, ahead, here, first) &&
        SwapPossible(first, here)) {
      return ahead;
    }
    for (const CellIndex beside : grid_.beside(here)) {
      const MoverIndex other = At(who_now_, beside);
      if (other == kNone || beside == first) continue;
      if (SwapNeeded(other, mover, here, first) && SwapPossible(first, here)) return other;
    }
    return kNone;
  }

  // Keeps only moves into empty places, and straight on behind a mover that moves in the same direction.
  void KeepExecutableMoves() {
    for (bool again = true; again;) {
      again = false;
      for (MoverIndex i = 0; i < static_cast<MoverIndex>(next_.size()); ++i) {
        CellIndex& next = At(next_, i);
        if (next == Now(i)) continue;
        const MoverIndex other = At(who_now_, next);
        if (other == kNone || At(next_, other) - Now(other) == next - Now(i)) continue;
        next = Now(i);
        again = true;
      }
    }
  }

  const Grid& grid_;
  const Task& task_;
  Random random_;
  std::vector<std::int32_t> anywhere_;
  std::vector<const std::vector<std::int32_t>*> left_;  // by mover: steps to its target
  std::vector<MoverIndex> who_now_, who_next_;          // by place
  std::vector<bool> asked_;                             // movers whose choice is being made
  Configuration next_;
  const Configuration* now_ = nullptr;
  const Configuration* before_ = nullptr;
};

struct Hash {
  std::size_t operator()(const Configuration& configuration) const noexcept {
    std::size_t hash = configuration.size();
    for (const CellIndex place : configuration) {
      hash ^= static_cast<std::size_t>(place) + 0x9e3779b9U + (hash << 6U) + (hash >> 2U);
    }
    return hash;
  }
};

// A configuration of the search.
struct Node {
  Configuration places;
  const Node* parent = nullptr;
  std::vector<double> priorities;
  std::vector<MoverIndex> order;
  std::deque<std::vector<Stepper::Constraint>> constraints;  // not tried yet
};

bool Arrived(const Configuration& places, const Task& task) noexcept {
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (task.targets[i] != kNone && places[i] != task.targets[i]) return false;
  }
  return true;
}

}  // namespace

StepTables MakeStepTables(const Grid& grid, const Task& task) {
  StepTables tables;
  for (const CellIndex target : task.targets) {
    if (target != kNone && !tables.contains(target)) tables.emplace(target, grid.StepsTo(target));
  }
  return tables;
}

StepSearch FindSteps(const Grid& grid, const Task& task, const StepTables& tables, std::uint64_t seed,
                     std::int64_t effort) {
  Stepper stepper(grid, task, tables, seed);
  const auto count = static_cast<MoverIndex>(task.starts.size());
  std::deque<Node> nodes;
  std::unordered_map<Configuration, Node*, Hash> known;
  const auto make = [&](const Configuration& places, const Node* parent) {
    Node& node = nodes.emplace_back();
    node.places = places;
    node.parent = parent;
    for (MoverIndex i = 0; i < count; ++i) {
      const std::int32_t left = stepper.Left(i, At(places, i));
      // Movers that have been under way longest come first.
      double priority = left / 1e4;
      if (parent) {
        const double its = At(parent->priorities, i);
        priority = left == 0 ? its - std::floor(its) : its + 1;
      }
      node.priorities.push_back(priority);
    }
    node.order.resize(task.starts.size());
    std::iota(node.order.begin(), node.order.end(), 0);
    std::stable_sort(node.order.begin(), node.order.end(),
                     [&](MoverIndex a, MoverIndex b) { return At(node.priorities, a) > At(node.priorities, b); });
    node.constraints.emplace_back();
    known.emplace(places, &node);
    return &node;
  };
  std::vector<Node*> open{make(task.starts, nullptr)};
  Configuration next;
  while (!open.empty()) {
    Node& node = *open.back();
    if (Arrived(node.places, task)) {
      std::vector<Configuration> steps;
      for (const Node* at = &node; at; at = at->parent) steps.push_back(at->places);
      std::reverse(steps.begin(), steps.end());
      return {.steps = std::move(steps)};
    }
    if (node.constraints.empty()) {
      open.pop_back();
      continue;
    }
    if (--effort < 0) return {};
    const std::vector<Stepper::Constraint> constraints = std::move(node.constraints.front());
    node.constraints.pop_front();
    if (constraints.size() < node.order.size()) {
      const MoverIndex mover = node.order[constraints.size()];
      const auto beside = grid.beside(At(node.places, mover));
      std::vector<CellIndex> places(beside.begin(), beside.end());
      places.push_back(At(node.places, mover));
      stepper.random().Shuffle(places);
      for (const CellIndex place : places) {
        node.constraints.push_back(constraints);
        node.constraints.back().push_back({mover, place});
      }
    }
    const Configuration* before = node.parent ? &node.parent->places : nullptr;
    if (!stepper.Make(node.places, before, node.order, constraints, next)) continue;
    const auto found = known.find(next);
    open.push_back(found == known.end() ? make(next, &node) : found->second);
  }
  return {.steps = {}, .exhausted = true};
}

std::optional<std::vector<Configuration>> SwapTargets(const Grid& grid, Task& task, std::uint64_t seed) {
  constexpr int kMostSteps = 5000;
  Random random(seed);
  const StepTables tables = MakeStepTables(grid, task);
  Configuration now = task.starts;
  Configuration& targets = task.targets;
  const auto count = static_cast<MoverIndex>(now.size());
  std::vector<MoverIndex> who(static_cast<std::size_t>(grid.size()), kNone);
  for (MoverIndex i = 0; i < count; ++i) At(who, At(now, i)) = i;
  const auto wants = [&](MoverIndex mover) {  // the place to which it would move, preferably an empty one
    const auto& left = tables.at(At(targets, mover));
    const CellIndex here = At(now, mover);
    CellIndex best = here;
    std::size_t least = 4;
    for (const CellIndex place : grid.beside(here)) {
      if (At(left, place) >= At(left, here)) continue;
      const std::size_t cost = (At(who, place) != kNone ? 2U : 0U) + random.Below(2);
      if (cost < least) {
        least = cost;
        best = place;
      }
    }
    return best;
  };
  std::vector<Configuration> steps{now};
  for (int step = 0; step < kMostSteps; ++step) {
    if (now == targets) return steps;
    for (MoverIndex i = 0; i < count; ++i) {
      if (At(now, i) == At(targets, i)) continue;
      const CellIndex place = wants(i);
      const MoverIndex other = At(who, place);
      if (other == kNone) {
        At(who, At(now, i)) = kNone;
        At(now, i) = place;
        At(who, place) = i;
        continue;
      }
      if (place == At(targets, other)) {
        std::swap(At(targets, i), At(targets, other));
        continue;
      }
      // A ring of movers, each of which wants the place of the next: their targets rotate instead.
      std::vector<MoverIndex> ring{i};
      bool closed = false;
      for (MoverIndex at = other; at != kNone;) {
        closed = at == i;
        if (closed || At(now, at) == At(targets, at) || std::find(ring.begin(), ring.end(), at) != ring.end()) break;
        ring.push_back(at);
        at = At(who, wants(at));
      }
      if (!closed) continue;
      for (std::size_t k = ring.size() - 1; k > 0; --k) std::swap(At(targets, ring[k]), At(targets, ring[k - 1]));
    }
    steps.push_back(now);
  }
  return std::nullopt;
}

}  // namespace takt::routing
