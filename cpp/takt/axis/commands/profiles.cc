#include "takt/axis/commands/profiles.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {

constexpr std::string_view kTimeScale = "Factor of the duration of the table.";

}  // namespace

void describe(Description<PositionProfile>& d) {
  using C = PositionProfile;
  d.about(
      "Follows a table of positions over time (MC_PositionProfile). An axis at another position, or slower than the "
      "table, catches up within its limits; a table beyond the SW limits is refused. Done at rest at the end of the "
      "table.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the position.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::position_scale>("Factor of the table's positions.");
  d.defaulted<&C::offset>(unit::u, "Offset added to the scaled positions.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<VelocityProfile>& d) {
  using C = VelocityProfile;
  d.about(
      "Follows a table of velocities over time (MC_VelocityProfile). An axis with another velocity, or with "
      "insufficient ramps, catches up within its limits; a table beyond the axis' velocity is refused. Done at the end "
      "of the table; the axis keeps the last velocity.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the velocity.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::velocity_scale>("Factor of the table's velocities.");
  d.defaulted<&C::offset>(unit::u_s, "Offset added to the scaled velocities.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<AccelerationProfile>& d) {
  using C = AccelerationProfile;
  d.about(
      "Follows a table of accelerations over time (MC_AccelerationProfile), from the velocity at its start. Velocity "
      "lost to the axis' limits is made up; a table beyond the axis' acceleration is refused. Done at the end of the "
      "table; the axis keeps the velocity reached.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the acceleration.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::acceleration_scale>("Factor of the table's accelerations.");
  d.defaulted<&C::offset>(unit::u_s2, "Offset added to the scaled accelerations.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

}  // namespace takt::axis
