// The surface as places: squares of one pitch, in rows and columns. A mover rests in the middle of a place, and moves
// straight along rows and columns, in runs over one or more places.
//
// What a plan keeps, and why it is safe even if movers brake at any moment (PL-72): between the middles of two places a
// mover has both, until no part of it covers the first one. It takes the next place at the last moment at which it
// could still rest in the middle of the one before (less kEarly). A mover is smaller than a place, so two movers that
// brake at the same time come to rest apart. A follower in the same lane need not wait for that: it departs so much
// later (Lag) that its stop position is always a mover's size behind the present position of its leader. The guard of
// movers (planar/guard.h) requires the same: the distance in which the leader would stop does not count.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "takt/routing/run.h"

namespace takt::routing {

using PlaceIndex = std::int32_t;
using MoverIndex = std::int32_t;
inline constexpr std::int32_t kNone = -1;
inline constexpr double kEarly = 0.002;  // s, for the cycles between a look and a command

enum class Direction : std::uint8_t { kNone, kRight, kLeft, kUp, kDown };
inline constexpr std::array kDirections{Direction::kRight, Direction::kLeft, Direction::kUp, Direction::kDown};

// The value of a place or a mover.
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
  PlaceIndex size() const noexcept { return width_ * height_; }
  bool blocked(PlaceIndex place) const noexcept { return blocked_[static_cast<std::size_t>(place)]; }
  // Places beside it that movers can be at.
  std::span<const PlaceIndex> beside(PlaceIndex place) const noexcept {
    const Beside& its = beside_[static_cast<std::size_t>(place)];
    return {its.places.data(), its.count};
  }
  // By place: steps from there to `target`; kUnreachable: no way leads there.
  std::vector<std::int32_t> StepsTo(PlaceIndex target) const;
  static constexpr std::int32_t kUnreachable = 1'000'000'000;
  // By place: s from there to `target` for a mover alone; infinite where no way leads there.
  std::vector<double> TimesTo(PlaceIndex target) const;

  // Direction of a run between two places of one row or column; kNone: the same place, or no run.
  Direction Towards(PlaceIndex from, PlaceIndex to) const noexcept;
  // To be added to a place.
  PlaceIndex Step(Direction direction) const noexcept { return steps_[static_cast<std::size_t>(direction)]; }
  // Places of a run. Requires: both in one row or column.
  int Count(PlaceIndex from, PlaceIndex to) const noexcept;
  // Places ahead of others in this direction have larger numbers.
  int Along(Direction direction, PlaceIndex place) const noexcept {
    return along_[static_cast<std::size_t>(place)][static_cast<std::size_t>(direction)];
  }
  // Places that a run in this direction may go on from `from`.
  int Room(Direction direction, PlaceIndex from) const noexcept {
    return room_[static_cast<std::size_t>(from)][static_cast<std::size_t>(direction)];
  }

  // A run over `count` places; of its k-th place (0: where it starts) s from its departure.
  double Duration(int count) const noexcept { return lane(count).duration; }
  double Entry(int count, int k) const noexcept { return lane(count).entry[static_cast<std::size_t>(k)]; }  // takes it
  double Exit(int count, int k) const noexcept {
    return lane(count).exit[static_cast<std::size_t>(k)];
  }  // gives it back
  double Middle(int count, int k) const noexcept { return lane(count).middle[static_cast<std::size_t>(k)]; }
  const StraightRun& run(int count) const noexcept { return lane(count).run; }
  // Returns how much later [s] than a leader on a run over `leader` places a follower on one over `follower` places may
  // depart at the earliest, `ahead` places behind it in the same lane, so that its stop position stays behind.
  // Below 0: before it.
  double Lag(int leader, int follower, int ahead) const;

 private:
  struct Beside {
    std::size_t count = 0;
    std::array<PlaceIndex, 4> places{};
  };
  struct Lane {
    StraightRun run;
    double duration;
    std::vector<double> entry, exit, middle;  // exit of the last: its duration
    std::vector<double> at, stop;             // StraightRun::At and StopAt, every sampled_ s
  };
  const Lane& lane(int count) const noexcept { return lanes_[static_cast<std::size_t>(count)]; }

  int width_, height_;
  double pitch_, mover_size_;
  std::vector<bool> blocked_;
  std::vector<Beside> beside_;
  std::array<PlaceIndex, 5> steps_;        // by direction
  std::vector<std::array<int, 5>> room_;   // by place and direction
  std::vector<std::array<int, 5>> along_;  // by place and direction
  double sampled_ = 0;                     // s
  std::vector<Lane> lanes_;                // by count
  mutable std::vector<double> lags_;       // computed when asked for; nan: not yet
};

}  // namespace takt::routing
