#include "takt/axis/coordinates.h"

namespace takt::axis {

void ShiftCoordinates(double by, State& s) noexcept {
  s.setpoint.position += by;
  if (s.superimposed) s.overlay.base.position += by;
  s.due += by;
  s.actual.position += by;
  s.motion.profile.Shift(by);
  s.motion.target += by;
  s.origin -= by;
  s.homing.captured += by;
  s.probe.touch_position += by;
  if (s.cam_switch.list >= 0) Shift(by, s.cam_switch);
}

}  // namespace takt::axis
