// Legs of movers, and the occupancy of places over time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "takt/routing/grid.h"

namespace takt::routing {

inline constexpr double kForever = std::numeric_limits<double>::infinity();
inline constexpr double kTimeRounding = 1e-9;  // [s]

// A run of a mover.
struct Leg {
  double departure = 0;  // [s]
  CellIndex from = 0, to = 0;
};
using Legs = std::vector<Leg>;  // of one mover, in order; empty: it stays at its start

// Returns the time [s] of arrival at the last place; 0 without legs.
double Arrival(const Grid& grid, const Legs& legs);

// The occupancy of a place by a mover for a time.
struct Stay {
  double from = 0, to = 0;  // [s]
  MoverIndex who = kNone;
  Direction lane = Direction::kNone;  // of a run that passes the place; kNone: rest. Of that run:
  int count = 0, along = 0;           // its steps, and Grid::Along of its first place
  double departure = 0;
};

class Timetable {
 public:
  Timetable(const Grid& grid, std::size_t movers);

  const std::vector<Stay>& stays(CellIndex place) const noexcept { return stays_[static_cast<std::size_t>(place)]; }
  const std::vector<CellIndex>& places_of(MoverIndex who) const noexcept {
    return places_[static_cast<std::size_t>(who)];
  }
  // Adds the occupancy of a place by a mover at rest. `from` = -1: from the beginning.
  void Rest(CellIndex place, double from, double to, MoverIndex who);
  void Add(MoverIndex who, CellIndex start, const Legs& legs);
  void Remove(MoverIndex who);

  // Returns the index of the first stay that ends after t.
  std::size_t FirstEndingAfter(CellIndex place, double t) const noexcept {
    // A mover that comes later to a place also leaves it later.
    const std::vector<Stay>& its = stays(place);
    const auto found =
        std::partition_point(its.begin(), its.end(), [t](const Stay& stay) { return stay.to <= t + kTimeRounding; });
    return static_cast<std::size_t>(found - its.begin());
  }
  // Returns the time [s] until which the place is free from t on; t or less if it is occupied.
  double FreeUntil(CellIndex place, double t) const noexcept {
    const std::size_t i = FirstEndingAfter(place, t);
    return i < stays(place).size() ? stays(place)[i].from : kForever;
  }
  // Returns the end [s] of the last of its stays; -1 without any.
  double LastEnd(CellIndex place) const noexcept;

 private:
  void Insert(CellIndex place, const Stay& stay);

  const Grid& grid_;
  std::vector<std::vector<Stay>> stays_;        // by place, in order of time
  std::vector<std::vector<CellIndex>> places_;  // by mover; may name a place more than once
};

}  // namespace takt::routing
