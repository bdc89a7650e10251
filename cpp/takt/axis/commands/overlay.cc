#include "takt/axis/commands/overlay.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<MoveSuperimposed>& d) {
  using C = MoveSuperimposed;
  d.about("Moves by a distance on top of the motion in progress, whatever that is (MC_MoveSuperimposed).");
  d.required<&C::distance>(unit::u, "How far; negative: downwards.");
  d.defaulted<&C::velocity_difference>(unit::u_s, positive, "Largest velocity added; unset: what the limits leave.");
  DescribeRamps(d);
}

void describe(Description<HaltSuperimposed>& d) {
  using C = HaltSuperimposed;
  d.about("Brakes what was put on top of the motion in progress (MC_HaltSuperimposed).");
  d.defaulted<&C::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&C::jerk>(unit::u_s3, not_negative, kJerk);
}

void describe(Description<PositionProfile>& d) {
  using C = PositionProfile;
  d.about("Follows a table of positions over time (MC_PositionProfile).");
  d.required<&C::profile>("Name of a table of the machine: seconds and positions.");
  d.defaulted<&C::time_scale>(positive, "Stretches the time.");
  d.defaulted<&C::position_scale>("Stretches the positions.");
  d.defaulted<&C::offset>(unit::u, "Added to the positions.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

void describe(Description<VelocityProfile>& d) {
  using C = VelocityProfile;
  d.about("Follows a table of velocities over time, and goes on with the last one (MC_VelocityProfile).");
  d.required<&C::profile>("Name of a table of the machine: seconds and velocities.");
  d.defaulted<&C::time_scale>(positive, "Stretches the time.");
  d.defaulted<&C::velocity_scale>("Stretches the velocities.");
  d.defaulted<&C::offset>(unit::u_s, "Added to the velocities.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

void describe(Description<AccelerationProfile>& d) {
  using C = AccelerationProfile;
  d.about(
      "Follows a table of accelerations over time, and goes on with the velocity it ends with "
      "(MC_AccelerationProfile).");
  d.required<&C::profile>("Name of a table of the machine: seconds and accelerations.");
  d.defaulted<&C::time_scale>(positive, "Stretches the time.");
  d.defaulted<&C::acceleration_scale>("Stretches the accelerations.");
  d.defaulted<&C::offset>(unit::u_s2, "Added to the accelerations.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

}  // namespace takt::axis
