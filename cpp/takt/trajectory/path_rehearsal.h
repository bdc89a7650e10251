// Going along a window ahead of the motion, as fast as may be, to see what that asks of the coordinates: where it is
// more than their limits the window is weakened, and the way gone again.
//
// A few of these rounds bring nearly everything within the limits. A motion that may not go as fast (override, a stop
// on the path) is not looked at, and is more careful in bends by itself (AccelerationCap::gentle).
#pragma once

#include <array>

#include "takt/trajectory/path_pace.h"

namespace takt::trajectory {

using PathCoordinateValues = std::array<double, kPathCoordinates>;

// What a motion asks of coordinates that depend on more than the way: on what moves by itself.
struct PathProbe {
  // At a place, `ahead_s` from now; `positions` are those of the place looked at before (NaN: none). False: there the
  // slopes of the nodes say all.
  bool (*look)(const void* owner, const KinematicState& along, double ahead_s, PathCoordinateValues& positions,
               PathCoordinateValues& velocities, PathCoordinateValues& accelerations) noexcept = nullptr;
  const void* owner = nullptr;
};

class PathRehearsal {
 public:
  // The motion has begun, or what lies before it is another path.
  void Clear() noexcept;
  // The window has become longer, and is swept.
  void GoOn(const PathWindow& window) noexcept;
  // So many cycles at most, for a motion that has come to `now` in this cycle of the engine. True: there is nothing
  // left to be done.
  bool Run(PathWindow& window, const PathPace& now, int cycles, std::uint64_t cycle, double period_s,
           const PathProbe& probe = {}) noexcept;
  // The cycle at the end of which the motion stands at the end of what is known, if nothing slows it down; 0: not known
  // yet.
  std::uint64_t end_cycle() const noexcept { return end_cycle_; }

 private:
  // The motion as it is rehearsed, and what it asked of the coordinates last.
  struct Place {
    PathPace pace;
    std::uint64_t cycle = 0;  // of the engine, in which it will be there
    PathCoordinateValues positions{};
    PathCoordinateValues accelerations{};
  };

  double AheadOf(std::uint64_t cycle, double period_s) const noexcept;
  void StartFrom(const PathPace& pace, std::uint64_t cycle) noexcept;
  void Save() noexcept;
  void GoBack(const PathWindow& window) noexcept;
  void Look(const PathWindow& window, const KinematicState& before, double ahead_s, double period_s,
            const PathProbe& probe) noexcept;
  void EndTrouble(PathWindow& window, const PathPace& now, double period_s) noexcept;

  Place here_;
  Place mark_;                  // where a longer path would begin to make a difference
  std::array<Place, 8> saved_;  // to go again from there: a ring
  std::size_t save_to_ = 0;     // the oldest of them
  int until_save_ = 0;          // cycles
  bool again_ = false;          // what was weakened just now
  bool started_ = false, marked_ = false, through_ = true;
  bool weakened_ = false;  // in this round
  int rounds_ = 0;
  bool measuring_ = false;  // nothing is weakened any more: when it ends
  std::uint64_t end_cycle_ = 0;
  double free_until_ = 0;  // mm along the path
  // What was too much, from where to where.
  bool trouble_ = false;
  double from_ = 0, to_ = 0;
  double tried_to_ = 0;  // up to here it was gone again ...
  int tries_ = 0;        // ... so often
  PathShares shares_;
};

}  // namespace takt::trajectory
