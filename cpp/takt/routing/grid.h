// The surface as a grid of places: squares of one pitch, in rows and columns. A mover rests at the centre of a place,
// and moves straight along rows and columns, in runs over one or more places.
//
// The safety rule of a plan, which holds even if movers brake at any moment (PL-72): between the centres of two places
// a mover occupies both, until no part of it covers the first one. It takes the next place at the last moment at which
// it could still come to rest at the centre of the preceding one (less kEarly). A mover is smaller than a place, so two
// movers that brake at the same time come to rest without overlap. A follower in the same lane need not wait for that:
// it departs so much later (Lag) that its stop position is always the size of a mover behind the present position of
// its leader. The guard of movers (planar/guard.h) requires the same: the stopping distance of the leader does not
// count.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "takt/routing/run.h"

namespace takt::routing {

using CellIndex = std::int32_t;
using MoverIndex = std::int32_t;
inline constexpr std::int32_t kNone = -1;
inline constexpr double kEarly = 0.002;  // [s] for the cycles between a decision and its command

enum class Direction : std::uint8_t { kNone, kRight, kLeft, kUp, kDown };
inline constexpr std::array kDirections{Direction::kRight, Direction::kLeft, Direction::kUp, Direction::kDown};

// Returns the value of a place or a mover.
template <typename Values>
decltype(auto) At(Values& values, std::int32_t i) noexcept {
  return values[static_cast<std::size_t>(i)];
}

class Grid {
 public:
  // Requires: width, height > 0; 0 < mover_size <= pitch, mm; blocked: by place, row by row from below.
  Grid(int width, int height, double pitch, double mover_size, const Dynamics& dynamics, std::vector<bool> blocked);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  double pitch() const noexcept { return pitch_; }
  CellIndex size() const noexcept { return width_ * height_; }
  bool blocked(CellIndex place) const noexcept { return blocked_[static_cast<std::size_t>(place)]; }
  // Returns the neighbours of a place that are not blocked.
  std::span<const CellIndex> beside(CellIndex place) const noexcept {
    const Beside& its = beside_[static_cast<std::size_t>(place)];
    return {its.places.data(), its.count};
  }
  // Returns, by place, the number of steps to `target`; kUnreachable if there is no path.
  std::vector<std::int32_t> StepsTo(CellIndex target) const;
  static constexpr std::int32_t kUnreachable = 1'000'000'000;
  // Returns, by place, the time [s] to `target` for a mover alone; infinite if there is no path.
  std::vector<double> TimesTo(CellIndex target) const;

  // Returns the direction of a run between two places of one row or column; kNone for the same place, or if there is no
  // run.
  Direction Towards(CellIndex from, CellIndex to) const noexcept;
  // Returns the difference of place indices for one step.
  CellIndex Step(Direction direction) const noexcept { return steps_[static_cast<std::size_t>(direction)]; }
  // Returns the number of steps of a run. Requires: both places in one row or column.
  int Count(CellIndex from, CellIndex to) const noexcept;
  // Returns the coordinate of a place along the direction: larger for places further ahead.
  int Along(Direction direction, CellIndex place) const noexcept {
    return along_[static_cast<std::size_t>(place)][static_cast<std::size_t>(direction)];
  }
  // Returns the number of places ahead of `from` in this direction up to the border or a blocked place.
  int Room(Direction direction, CellIndex from) const noexcept {
    return room_[static_cast<std::size_t>(from)][static_cast<std::size_t>(direction)];
  }

  // Times [s] of a run of `count` steps after its departure: its duration, and for its k-th place (0: the start) when
  // the mover takes the place (Entry), frees it (Exit) and passes its centre.
  double Duration(int count) const noexcept { return lane(count).duration; }
  double Entry(int count, int k) const noexcept { return lane(count).entry[static_cast<std::size_t>(k)]; }
  double Exit(int count, int k) const noexcept { return lane(count).exit[static_cast<std::size_t>(k)]; }
  double Middle(int count, int k) const noexcept { return lane(count).middle[static_cast<std::size_t>(k)]; }
  const StraightRun& run(int count) const noexcept { return lane(count).run; }
  // Returns how much later [s] than a leader on a run of `leader` steps a follower on a run of `follower` steps,
  // `ahead` places behind it in the same lane, may depart at the earliest so that its stop position stays behind.
  // Negative: before it.
  double Lag(int leader, int follower, int ahead) const;

 private:
  struct Beside {
    std::size_t count = 0;
    std::array<CellIndex, 4> places{};
  };
  struct Lane {
    StraightRun run;
    double duration;
    std::vector<double> entry, exit, middle;  // exit of the last place: the duration
    std::vector<double> at, stop;             // StraightRun::At and StopAt, every sampled_ s
  };
  const Lane& lane(int count) const noexcept { return lanes_[static_cast<std::size_t>(count)]; }

  int width_, height_;
  double pitch_, mover_size_;
  std::vector<bool> blocked_;
  std::vector<Beside> beside_;
  std::array<CellIndex, 5> steps_;         // by direction
  std::vector<std::array<int, 5>> room_;   // by place and direction
  std::vector<std::array<int, 5>> along_;  // by place and direction
  double sampled_ = 0;                     // [s]
  std::vector<Lane> lanes_;                // by count
  mutable std::vector<double> lags_;       // computed on demand; nan: not yet
};

}  // namespace takt::routing
