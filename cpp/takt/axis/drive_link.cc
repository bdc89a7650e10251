#include "takt/axis/drive_link.h"

namespace takt::axis {

void Locate(const Context& c, const KinematicState& sampled, State& s) noexcept {
  const bool lost = s.sampling.link == DriveLink::kLost;
  if (lost && s.loop_closed && !s.blind) {
    s.blind = true;
    s.loop = ControlLoopState{};
  }
  if (s.blind) {
    s.actual = {s.setpoint.position, s.setpoint.velocity, 0};
  } else if (lost) {
    s.actual.velocity = 0;
  } else {
    s.actual = sampled;
    s.actual.position += sampled.velocity * s.sampling.age * c.cycle.period_s;
  }
  if (lost && c.params.position_encoder().type == EncoderType::kIncremental) s.homing.homed = false;
}

void WatchLink(const Context& c, State& s) noexcept {
  if (s.blind) {
    Fail(c, ErrorId::kDrive, AtRest(s), s);
  } else if (s.sampling.link == DriveLink::kLost) {
    Fail(c, ErrorId::kDrive, true, s);
  }
}

ControlLoop WithoutFeedback(const ControlLoop& params) noexcept {
  ControlLoop alone = params;
  alone.kp = alone.ki = alone.kd = 0;
  alone.ff = 1;
  return alone;
}

}  // namespace takt::axis
