// Going along a path as fast as its window allows, cycle by cycle.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/path_window.h"

namespace takt::trajectory {

// The mean is over so many cycles at most.
inline constexpr std::size_t kMostBuildUpCycles = 200;

// The raw motion in one cycle.
struct PathCycle {
  double position = 0;      // at its beginning
  double velocity = 0;      // the same
  double acceleration = 0;  // its mean
  double ahead = 0;         // the mean of the position less that at the beginning
};

struct PathPace {
  KinematicState now;        // along the path
  KinematicState raw;        // what that is the mean of; ahead of it
  std::uint64_t node = 0;    // of the window: the last one that the raw motion has reached
  std::uint64_t passed = 0;  // the last one that the mean has reached
  double entered = 0;        // the square of its speed there
  bool raw_stands = true;    // at a stop, or at the end of what is known
  std::uint32_t eased = 0;   // cycles at the ceiling until it is as if it had never been slower than it may
  std::uint32_t cycles = 1;  // the mean is over these
  std::uint32_t oldest = 0;
  std::array<PathCycle, kMostBuildUpCycles> last{};  // a ring
};

// How a motion along a path is braked; 0: as the path says.
struct PathBrake {
  double deceleration = 0;  // mm/s²
  double jerk = 0;          // mm/s³
  bool full = false;        // as hard as the coordinates can: the limits along the path do not count
};

// At rest on a node of the window.
void BeginAt(const PathWindow& window, std::uint64_t node, double period_s, PathPace& pace) noexcept;

// Where it is at the end of the next cycle. `wish`: the speed wanted, kept as soon as the limits allow; kFullSpeed: as
// fast as may be; 0: come to rest on the path. At a stop that stays the motion waits for BeginAt.
inline constexpr double kFullSpeed = std::numeric_limits<double>::infinity();
// `full`: it may brake as hard as the coordinates can, whatever the limits along the path are.
void Advance(const PathWindow& window, double wish, double period_s, PathPace& pace, bool full = false) noexcept;

// Whether it stays beneath the ceilings with an acceleration that changes no faster than it may.
bool GoesOn(const PathWindow& window, const PathPace& pace, double period_s) noexcept;

// It stands, and so does the raw motion.
bool Stands(const PathPace& pace) noexcept;

void describe(Description<PathCycle>&);
void describe(Description<PathBrake>&);
void describe(Description<PathPace>&);

}  // namespace takt::trajectory
