// Without a limit of jerk, 1 u at 1 u/s with 1 u/s² takes 2 s.
#include <cstdio>
#include <takt/msgs/axis_state.hpp>

#include "takt/trajectory/planner.h"

int main() {
  takt::trajectory::Planner planner;
  takt::trajectory::Profile profile;
  const takt::trajectory::Limits limits{.velocity = 1, .acceleration = 1, .deceleration = 1, .jerk = 0};
  const takt::Status status = planner.ToPosition({}, 1.0, 0.0, limits, profile);
  const takt::msgs::axis_state message{};
  std::printf("%.1f s, %s\n", profile.duration(), message.getEncodedSize() > 0 ? "message" : "nothing");
  return status.ok() ? 0 : 1;
}
