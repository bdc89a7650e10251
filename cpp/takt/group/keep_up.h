// How fast a path may go on where it is not as it was planned: the motion comes later than was expected (an override,
// an interrupt, a master), or what carries it changes its speed. From one ride to the next the way of the tool is then
// another one and may ask the axes for more than the nodes of the window, and the rehearsal, know of.
//
// From then on, until the tool is where it goes over to, places ahead are looked at one after the other as the motion
// is expected to find them, and each says how fast it may be gone past. The motion is slowed down before them. Nothing
// is ever faster than planned.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace takt::group {

struct Context;
struct State;

inline constexpr std::size_t kWatched = 16;  // places

// What is known of the places ahead; follows from the state and is no part of it, as the plan.
struct KeepUp {
  struct Place {
    double velocity = 0;      // mm/s, of the motion along the path
    double acceleration = 0;  // mm/s², what the axes can do besides
    double change = 0;        // mm/s², of the acceleration in the time in which it builds up
  };
  bool on = false;
  double share = 1;                                        // of the axes' limits that may be used
  double begin = 0;                                        // mm along the path, of the first place ...
  double apart = 0;                                        // ... and between one and the next
  double brake = std::numeric_limits<double>::infinity();  // mm/s², as strongly as the axes can
  std::uint32_t next = 0;                                  // to be looked at
  std::array<Place, kWatched> places{};
};

// The speed wanted along the path, `wish` at most.
double SlowDown(const Context& c, const State& s, double wish) noexcept;

}  // namespace takt::group
