// Motion along a path, cycle by cycle, as fast as its window allows.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/path_window.h"

namespace takt::trajectory {

// Largest number of cycles in the mean.
inline constexpr std::size_t kMostBuildUpCycles = 200;

// The raw motion in one cycle.
struct PathCycle {
  double position = 0;      // [mm] at the beginning of the cycle
  double velocity = 0;      // [mm/s] at the beginning of the cycle
  double acceleration = 0;  // mean over the cycle
  double ahead = 0;         // mean of the position minus the one at the beginning of the cycle
};

struct PathPace {
  KinematicState now;        // along the path: the mean of the raw motion
  KinematicState raw;        // raw motion; ahead of `now`
  std::uint64_t node = 0;    // of the window: last node that the raw motion has reached
  std::uint64_t passed = 0;  // last node that the mean has reached
  double entered = 0;        // squared speed of the raw motion at `node`
  bool raw_stands = true;    // raw motion is at a stop, or at the end of the known path
  std::uint32_t eased = 0;   // cycles left at the ceiling before the full acceleration cap applies again
  std::uint32_t cycles = 1;  // number of cycles in the mean
  std::uint32_t oldest = 0;
  std::array<PathCycle, kMostBuildUpCycles> last{};  // ring buffer
};

// How a motion along a path is braked; 0: with the limits of the path.
struct PathBrake {
  double deceleration = 0;  // [mm/s²]
  double jerk = 0;          // [mm/s³]
  bool full = false;        // as hard as the coordinates can: the limits along the path are ignored
};

// Sets `pace` to rest on a node of the window.
void BeginAt(const PathWindow& window, std::uint64_t node, double period_s, PathPace& pace) noexcept;

// Advances `pace` by one cycle. `wish`: wanted speed [mm/s], reached as soon as the limits allow; kFullSpeed: as fast
// as possible; 0: come to rest on the path. At a node with a stop the motion waits for BeginAt.
inline constexpr double kFullSpeed = std::numeric_limits<double>::infinity();
// `full`: the motion may brake as hard as the coordinates can, whatever the limits along the path are.
void Advance(const PathWindow& window, double wish, double period_s, PathPace& pace, bool full = false) noexcept;

// Returns true if the motion stays below the ceilings with an acceleration that changes no faster than allowed.
bool GoesOn(const PathWindow& window, const PathPace& pace, double period_s) noexcept;

// Returns true if the motion and the raw motion are at rest.
bool Stands(const PathPace& pace) noexcept;

void describe(Description<PathCycle>&);
void describe(Description<PathBrake>&);
void describe(Description<PathPace>&);

}  // namespace takt::trajectory
