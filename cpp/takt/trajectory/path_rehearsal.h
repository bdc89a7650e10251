// Rehearsal: runs along a window ahead of the motion, at full speed, and checks what that demands of the coordinates.
// Where it exceeds their limits the window is weakened and that stretch is run again.
//
// A few of these rounds bring nearly everything within the limits. Motions that may not go as fast (override, a stop on
// the path) are not rehearsed; they are more careful in bends by themselves (AccelerationCap::gentle).
#pragma once

#include <array>

#include "takt/trajectory/path_pace.h"

namespace takt::trajectory {

using PathCoordinateValues = std::array<double, kPathCoordinates>;

// Demands on coordinates that depend on more than the arc length: on bodies that move by themselves.
struct PathProbe {
  // Evaluates the point `along` of the path `ahead_s` [s] from now. `positions`: in, those of the previous point
  // evaluated (NaN: none); out, those of this one. Returns false if the slopes of the nodes describe the motion
  // completely there.
  bool (*look)(const void* owner, const KinematicState& along, double ahead_s, PathCoordinateValues& positions,
               PathCoordinateValues& velocities, PathCoordinateValues& accelerations) noexcept = nullptr;
  const void* owner = nullptr;
};

class PathRehearsal {
 public:
  // Restarts: the motion has begun, or the path ahead of it has changed.
  void Clear() noexcept;
  // Continues after the window has become longer. Requires: the window is swept.
  void GoOn(const PathWindow& window) noexcept;
  // Rehearses at most `cycles` cycles for a motion whose state in this cycle of the engine is `now`. Returns true if
  // nothing is left to be done.
  bool Run(PathWindow& window, const PathPace& now, int cycles, std::uint64_t cycle, double period_s,
           const PathProbe& probe = {}) noexcept;
  // Returns the engine cycle at the end of which the motion is at rest at the end of the known path, if nothing slows
  // it down; 0: not known yet.
  std::uint64_t end_cycle() const noexcept { return end_cycle_; }

 private:
  // State of the rehearsed motion and its last demands on the coordinates.
  struct Place {
    PathPace pace;
    std::uint64_t cycle = 0;  // of the engine, in which the motion will be there
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
  Place mark_;                  // the last state that a longer path does not change
  std::array<Place, 8> saved_;  // states to return to: a ring buffer
  std::size_t save_to_ = 0;     // index of the oldest of them
  int until_save_ = 0;          // cycles until the next one is saved
  bool again_ = false;          // the stretch that was just weakened is to be run again
  bool started_ = false, marked_ = false, through_ = true;
  bool weakened_ = false;  // in this round
  int rounds_ = 0;
  bool measuring_ = false;  // nothing is weakened any more: the end time is measured
  std::uint64_t end_cycle_ = 0;
  double free_until_ = 0;  // [mm] along the path: up to there a longer path changes nothing
  // A stretch in which limits were exceeded: from_ to to_ [mm].
  bool trouble_ = false;
  double from_ = 0, to_ = 0;
  double tried_to_ = 0;  // largest to_ that was run again ...
  int tries_ = 0;        // ... and how often
  PathShares shares_;
};

}  // namespace takt::trajectory
