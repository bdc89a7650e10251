// Bounds the path speed where a carried path differs from its plan: the motion is later than expected (override,
// interrupt, master), or a carrier changes its velocity. Between two carrier bindings the tool then moves along another
// path, which may demand more of the axes than the nodes of the window, and the rehearsal, account for.
//
// From then on, until the tool has changed over, points ahead are checked one after the other as the motion is expected
// to find them; each gives a bound of the path speed, and the motion is slowed down before it. It is never faster than
// planned.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace takt::group {

struct Context;
struct State;

inline constexpr std::size_t kPointsAhead = 16;  // points ahead

// The points ahead; follows from the state and, like the plan, is not part of it.
struct CarriedSpeedBound {
  struct Place {
    double velocity = 0;      // [mm/s] bound of the path speed
    double acceleration = 0;  // [mm/s²] path acceleration that the axes have left
    double change = 0;        // [mm/s²] change of acceleration within the build-up time
  };
  bool on = false;
  double share = 1;                                        // of the axes' limits that may be used
  double begin = 0;                                        // [mm] arc length of the first point ...
  double apart = 0;                                        // ... and distance from one point to the next
  double brake = std::numeric_limits<double>::infinity();  // [mm/s²] deceleration that the axes have left
  std::uint32_t next = 0;                                  // point to be checked
  std::array<Place, kPointsAhead> places{};
};

// Returns the demanded path speed [mm/s]: at most `wish`, except as far as accelerations have to be taken back.
double SlowDown(const Context& c, const State& s, double wish) noexcept;

}  // namespace takt::group
