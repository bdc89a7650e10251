// What a group knows of the path ahead: stretches of geometry, and the window of nodes that says how fast it may go.
// Made from the moves in the queue alone, so it is no part of the state.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/group/request.h"
#include "takt/path/segment.h"
#include "takt/trajectory/path_window.h"

namespace takt::group {

inline constexpr std::size_t kStretches = 512;
inline constexpr std::size_t kNodes = 4096;

struct Stretch {
  path::Segment segment;
  double from = 0;   // of the segment ...
  double to = 0;     // ... is gone
  double begin = 0;  // along the path
  std::uint64_t move = 0;
  bool joints = false;        // its auxiliaries are all axes; else the tool moves
  kinematics::Frame to_base;  // from its coordinate system to that of the kinematics
  trajectory::AlongPath limits;

  double end() const noexcept { return begin + to - from; }
};

struct LookAhead {
  LookAhead(const trajectory::CoordinateLimits& limits, double period_s)
      : window(kNodes, limits, period_s), stretches(kStretches) {}

  trajectory::PathWindow window;
  std::vector<Stretch> stretches;  // a ring
  std::uint64_t first = 0;         // number of the oldest one
  std::uint64_t count = 0;

  Stretch& operator[](std::uint64_t number) noexcept { return stretches[number % stretches.size()]; }
  const Stretch& operator[](std::uint64_t number) const noexcept { return stretches[number % stretches.size()]; }
  std::uint64_t end() const noexcept { return first + count; }
};

}  // namespace takt::group
